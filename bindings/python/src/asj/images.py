# SPDX-License-Identifier: BSD-2-Clause
"""Images as arrays, and from files."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._native import ffi, lib
from .errors import ImageError, LimitError, extra

_GRAY = {"uint8": lib.ASJ_FORMAT_GRAY8, "uint16": lib.ASJ_FORMAT_GRAY16, "float32": lib.ASJ_FORMAT_GRAY_FLOAT}
FLOATS_UP_TO = 2  # what overshoots 1.0 a little, resampled or sharpened, may
_COLOUR = {3: lib.ASJ_FORMAT_RGB8, 4: lib.ASJ_FORMAT_RGBA8}


@dataclass(frozen=True)
class View:
    """An array as the library sees it. The pixels stay where they are unless their layout has to change."""

    pixels: NDArray[Any]
    pointer: Any
    width: int
    height: int


def view(image: ArrayLike, white: float = 0.0) -> View:
    """HxW of uint8, uint16 or float (1.0 is white), or HxWx3 or HxWx4 of uint8, uint16 or float in the order red, green, blue.

    `white` is the value that means white, if it is not the type's: 1023 for a 10-bit camera in uint16. Floats far above 1 are refused
    without it: most of them would be cut. An image of Pillow is taken as read() takes its file.
    """
    pixels = as_array(image)
    if pixels.dtype.kind in "USO":
        raise ImageError(f"not an array of pixels: {image!r:.60}; asj.read_image() reads files")
    _check_size(pixels)
    if pixels.dtype == np.bool_:
        pixels = pixels.astype(np.uint8) * np.uint8(255)
    if pixels.dtype.kind == "f" and pixels.dtype.itemsize != 4:
        pixels = _single(pixels)
    if not pixels.dtype.isnative:
        pixels = pixels.astype(pixels.dtype.newbyteorder("="))
    if pixels.dtype.name not in _GRAY:
        raise ImageError(f"an image of type {pixels.dtype.name}: uint8, uint16 or float")
    if pixels.dtype.kind == "f" and white == 0 and pixels.size and FLOATS_UP_TO < pixels.max() < np.inf:
        raise ImageError(f"floats up to {pixels.max():g}: white=255, or what is white here (white=1 cuts them)")
    if pixels.ndim == 3 and pixels.shape[2] == 1:
        pixels = pixels[:, :, 0]
    if pixels.ndim == 3 and pixels.shape[2] in _COLOUR and pixels.dtype != np.uint8:
        pixels = _luma(pixels)
    if pixels.ndim not in (2, 3) or (pixels.ndim == 3 and pixels.shape[2] not in _COLOUR):
        raise ImageError(f"an image of shape {pixels.shape}: (height, width), (height, width, 3) or (height, width, 4)")
    if pixels.shape[0] < 1 or pixels.shape[1] < 1:
        raise ImageError(f"an image of {pixels.shape[1]} x {pixels.shape[0]} pixels")
    if not _fits(pixels):
        pixels = np.ascontiguousarray(pixels)
    record = ffi.new("asj_image *")
    record.data = ffi.cast("void *", pixels.ctypes.data)
    record.format = _GRAY[pixels.dtype.name] if pixels.ndim == 2 else _COLOUR[pixels.shape[2]]
    record.height, record.width = pixels.shape[:2]
    record.white = white
    record.stride = pixels.strides[0] if record.height > 1 else 0  # that of a single row says nothing
    return View(pixels, record, record.width, record.height)


def _check_size(pixels: NDArray[Any]) -> None:
    """Refuses more pixels than the library takes before any is copied: a broadcast array may have more than there is memory for."""
    if pixels.ndim in (2, 3):
        height, width = pixels.shape[:2]
        if max(height, width) > lib.ASJ_MAX_SIDE or height * width > lib.ASJ_MAX_PIXELS:
            limits = f"side {lib.ASJ_MAX_SIDE}, {lib.ASJ_MAX_PIXELS} pixels in all"
            raise LimitError(f"{width} x {height} pixels are more than the library takes ({limits})")


def _single(pixels: NDArray[Any]) -> NDArray[Any]:
    """Floats of any size in single precision. What is finite stays so: it is cut at white anyway."""
    with np.errstate(over="ignore"):
        single = pixels.astype(np.float32)
    beyond = np.isinf(single) & np.isfinite(pixels)
    single[beyond] = np.copysign(np.finfo(np.float32).max, pixels[beyond])
    return single


def _fits(pixels: NDArray[Any]) -> bool:
    """Rows from top to bottom or from bottom to top, in each the samples side by side."""
    channels = 1 if pixels.ndim == 2 else pixels.shape[2]
    inner = pixels.strides[1] == channels * pixels.itemsize and (pixels.ndim == 2 or pixels.strides[2] == pixels.itemsize)
    row = pixels.shape[1] * channels * pixels.itemsize
    return inner and (pixels.shape[0] == 1 or (abs(pixels.strides[0]) >= row and pixels.strides[0] % pixels.itemsize == 0))


def _luma(pixels: NDArray[Any]) -> NDArray[Any]:
    """Gray from 16-bit or float colour, with the library's weights (include/asj/image.h)."""
    weights = np.array([77, 150, 29]) / 256
    gray = pixels[..., 0] * weights[0] + pixels[..., 1] * weights[1] + pixels[..., 2] * weights[2]
    if pixels.dtype.kind == "u":
        gray = np.rint(gray)
    return np.ascontiguousarray(gray.astype(pixels.dtype))


def _deep(pixels: NDArray[Any]) -> NDArray[Any]:
    """Gray of more than 8 bits: float32, or uint16 in this machine's order of bytes."""
    if pixels.dtype.kind == "f":
        return pixels.astype(np.float32)
    if pixels.size and (pixels.min() < 0 or pixels.max() > 65535):
        raise ValueError("values that are not of 16 bits")
    return pixels.astype(np.uint16)


def as_array(image: Any) -> NDArray[Any]:
    """The numbers of an image. Those of Pillow are converted by their mode, since the samples of most are no grey and no colours:
    numbers of a palette, hues, inks."""
    pillow = sys.modules.get("PIL.Image")  # where nobody has loaded it, this is no image of it
    if pillow is not None and isinstance(image, pillow.Image):
        try:
            if image.mode == "I" and image.size[0] * image.size[1] and image.getextrema()[1] <= 255:
                raise ValueError("no sample is above 255: white is 65535 there; convert it to L")
            return _of_pillow(image)
        except UNREADABLE as bad:
            raise ImageError(f"an image of mode {image.mode}: {bad}") from bad
    return np.asarray(image)


def _of_pillow(image: Any) -> NDArray[Any]:
    """Upright; gray, or red, green and blue."""
    from PIL import ImageOps

    upright = ImageOps.exif_transpose(image)
    if upright.mode in ("F", "I") or upright.mode.startswith("I;16"):
        return _deep(np.array(upright))
    return np.array(upright.convert("L" if upright.mode in ("1", "L", "LA") else "RGB"))


def read(path: str | os.PathLike[str]) -> NDArray[Any]:
    """An image file as an array, upright (its EXIF orientation is applied): HxW, or HxWx3 in the order red, green, blue; uint8, of
    gray files of more bits uint16 or float32.

    Needs Pillow. Damaged files raise ImageError, and those of more pixels than the library takes (2^29) LimitError, before they are
    decoded.
    """
    try:
        with _opened(path) as file:
            return _of_pillow(file)
    except FileNotFoundError:
        raise
    except (*UNREADABLE, MemoryError) as bad:
        raise ImageError(f"{os.fspath(path)}: {bad}") from bad


UNREADABLE = OSError, ValueError, SyntaxError  # what Pillow raises
_limit = threading.Lock()


@contextlib.contextmanager
def _opened(path: str | os.PathLike[str]) -> Iterator[Any]:
    """A file of Pillow, of up to as many pixels as the library takes. Pillow's own limit, of a sixth of that, is the whole
    process's, and a warning: it is put aside while the head of the file is read."""
    image = extra("PIL.Image", "images")
    with _limit:
        former, image.MAX_IMAGE_PIXELS = image.MAX_IMAGE_PIXELS, None
        try:
            file = image.open(path)
        finally:
            image.MAX_IMAGE_PIXELS = former
    with file:
        width, height = file.size
        if width * height > lib.ASJ_MAX_PIXELS:
            raise LimitError(f"{os.fspath(path)}: {width} x {height} pixels; the library takes {lib.ASJ_MAX_PIXELS}")
        yield file


def orientation(path: str | os.PathLike[str]) -> int:
    """The EXIF orientation, 1 to 8, that read() applies; 1 where there is none that can be."""
    try:
        with _opened(path) as file:
            value = int(file.getexif().get(0x0112, 1))
    except (*UNREADABLE, LimitError, TypeError, KeyError):
        return 1
    return value if 1 <= value <= 8 else 1


def size(path: str | os.PathLike[str]) -> tuple[int, int] | None:
    """Width and height of the upright image, from the head of the file; None where it cannot be read."""
    try:
        with _opened(path) as file:
            width, height = file.size
    except (*UNREADABLE, LimitError):
        return None
    return (height, width) if orientation(path) in (5, 6, 7, 8) else (width, height)


def camera_name(path: str | os.PathLike[str]) -> str | None:
    """Make, model and focal lengths (on 35 mm film, and in mm) of the EXIF data as a line of text, which tells cameras apart as COLMAP's
    CameraMode.AUTO does; None where make, model or both focal lengths are missing."""
    try:
        with _opened(path) as file:
            data = file.getexif()
            lens = data.get_ifd(0x8769)
        names = [" ".join(str(data.get(tag, "")).replace("\0", " ").split()) for tag in (0x010F, 0x0110)]
        lengths = [float(lens.get(tag, 0)) for tag in (0xA405, 0x920A)]
    except (*UNREADABLE, LimitError, TypeError, ArithmeticError, KeyError):
        return None
    return "; ".join([*names, *(f"{length:g}" for length in lengths)]) if all(names) and max(lengths) > 0 else None


_FILM_DIAGONAL = 43.26661530556787  # mm, of 36 x 24
_MM_PER_UNIT = {2: 25.4, 3: 10.0, 4: 1.0, 5: 0.001}


def focal_length(path: str | os.PathLike[str]) -> float | None:
    """Focal length in pixels of the upright image, from EXIF data; None where there is none that can be.

    From the focal length on 35 mm film, by the diagonal, or else from the focal length and the resolution on the focal plane. A picture
    that was cut since has none. The same as the library's asj_image_file.focal_length (src/io/lens.c).
    """
    try:
        with _opened(path) as file:
            longer, shorter = max(file.size), min(file.size)
            exif = file.getexif().get_ifd(0x8769)
        was = [float(exif.get(tag, 0)) for tag in (0xA002, 0xA003)]
        film, mm, per_unit = (float(exif.get(tag, 0)) for tag in (0xA405, 0x920A, 0xA20E))
        unit = _MM_PER_UNIT.get(int(exif.get(0xA210, 2)), 0.0)
    except (*UNREADABLE, LimitError, TypeError, ArithmeticError, KeyError):
        return None
    if min(was) > 0 and not abs(max(was) * shorter / (min(was) * longer) - 1) <= 0.01:
        return None
    focal = film * np.hypot(longer, shorter) / _FILM_DIAGONAL
    if not film > 0 and unit > 0:
        focal = mm * per_unit / unit * (longer / max(was) if max(was) > 0 else 1)
    return float(focal) if 0.2 * longer <= focal <= 50 * longer else None
