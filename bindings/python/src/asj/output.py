# SPDX-License-Identifier: BSD-2-Clause
"""Files that appear whole or not at all."""

from __future__ import annotations

import contextlib
import errno
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
    stays one and a file that was there gives its permissions; one that is protected against writing is not replaced. What is no
    file (a pipe, a device) is not either: `path` itself is written to."""
    path = path.resolve()
    if path.exists() and not path.is_file():
        yield path
        return
    refuse_protected(path)
    try:  # a short name, as the library's own: that of the target may be as long as names can be
        handle, name = tempfile.mkstemp(prefix=f".asj-{os.getpid()}-", suffix=".tmp", dir=path.parent)
    except OSError as bad:
        raise type(bad)(bad.errno, bad.strerror, str(path)) from None
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        os.chmod(temporary, stat.S_IMODE(path.stat().st_mode) if path.exists() else 0o666 & ~_MASK)
        os.replace(temporary, path)
    except BaseException as bad:
        temporary.unlink(missing_ok=True)
        if isinstance(bad, OSError) and bad.filename is None and bad.errno is not None:  # of a write, which has only a number
            raise type(bad)(bad.errno, bad.strerror, str(path)) from None
        raise


def refuse_protected(path: Path) -> None:
    """Raises PermissionError for a file that is there and protected against writing."""
    if path.exists() and not _may_write(path):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))


def _may_write(path: Path) -> bool:
    """A rename asks the folder alone, and would replace a protected file."""
    return os.access(path, os.W_OK, effective_ids=os.access in os.supports_effective_ids)
