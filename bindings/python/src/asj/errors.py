# SPDX-License-Identifier: BSD-2-Clause
"""What the library reports as a status arrives here as an exception with the library's own message."""

from __future__ import annotations

import importlib
from typing import Any

from ._native import ffi, lib


class Error(Exception):
    """Something that the library refused or could not do; the text says what and why."""


class OptionError(Error, ValueError):
    """An option that does not exist, or a value out of its range."""


class ImageError(Error, ValueError):
    """An array that is no image: wrong shape or type, NaN, infinity."""


class ArgumentError(Error, ValueError):
    """Arguments that contradict each other, or junctions that cannot be."""


class LimitError(Error):
    """Larger than a documented limit."""


class OutOfMemoryError(Error, MemoryError):
    """The memory that a call needs is not there."""


class DeviceError(Error):
    """The back end or device that was asked for by name is not there, or failed."""


class Cancelled(Error):
    """A progress callback asked to stop."""


class FormatError(Error, ValueError):
    """A file or block of bytes that is damaged, or not what it should be."""


_CLASSES: dict[int, type[Error]] = {
    lib.ASJ_ERROR_ARGUMENT: ArgumentError,
    lib.ASJ_ERROR_OPTION: OptionError,
    lib.ASJ_ERROR_IMAGE: ImageError,
    lib.ASJ_ERROR_LIMIT: LimitError,
    lib.ASJ_ERROR_MEMORY: OutOfMemoryError,
    lib.ASJ_ERROR_CANCELLED: Cancelled,
    lib.ASJ_ERROR_DEVICE: DeviceError,
    lib.ASJ_ERROR_FORMAT: FormatError,
}


def extra(module: str, name: str) -> Any:
    """A module that only a part of the package needs; says how to install it where it is missing."""
    try:
        return importlib.import_module(module)
    except ImportError as missing:
        package = module.partition(".")[0].replace("PIL", "Pillow")
        raise ImportError(f"this needs {package}: install it, or this package with its extra [{name}]") from missing


def as_bytes(word: str, what: str) -> bytes:
    """A word as a C string, which ends at its first NUL."""
    try:
        data = word.encode()
    except UnicodeEncodeError:
        raise OptionError(f"{what}: {word!r} is no text that can be encoded as UTF-8") from None
    if b"\0" in data:
        raise OptionError(f"{what}: {word!r} holds a NUL")
    return data


def text(pointer: object) -> str:
    """A C string as a Python one."""
    return str(ffi.string(pointer).decode("utf-8", "replace"))


def error(status: int, message: str = "") -> Error:
    """The exception for a status of the library."""
    return _CLASSES.get(status, Error)(message or text(lib.asj_status_string(status)))
