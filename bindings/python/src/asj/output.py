# SPDX-License-Identifier: BSD-2-Clause
"""Files that appear whole or not at all."""

from __future__ import annotations

import contextlib
import os
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path


_MASK = os.umask(0)  # read once: the way to read it sets it, for all threads
os.umask(_MASK)


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A name beside `path` to write to; it becomes `path` when the block ends without an exception, and vanishes otherwise. A link
    stays one and a file that was there gives its permissions; what is no file (a pipe, a device) is not replaced: `path` itself is
    written to."""
    path = path.resolve()
    if path.exists() and not path.is_file():
        yield path
        return
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.name}-", suffix=".tmp", dir=path.parent)
    except OSError as bad:
        raise type(bad)(bad.errno, bad.strerror, str(path)) from None
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        os.chmod(temporary, stat.S_IMODE(path.stat().st_mode) if path.exists() else 0o666 & ~_MASK)
        os.replace(temporary, path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
