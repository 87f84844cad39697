# SPDX-License-Identifier: BSD-2-Clause
"""Junctions of one image."""

from __future__ import annotations

import operator
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import arrays, images
from ._native import ffi, lib
from .context import Context, current, given
from .errors import ArgumentError, FormatError, ImageError, OptionError
from .options import DETECTOR, MATCHER
from .output import whole_file

_MAGIC = b"\x89ASJF"  # of a file of features: asj-formats(5)


class Features:
    """Junctions of one image, most meaningful first, and what matching needs of it.

    Coordinates are pixels: the centre of the first pixel is (0, 0), x points right, y down. Angles are radians from +x towards +y.
    The arrays are read-only views of the library's memory. What matching needs (patches, a pyramid) is made when it is first asked for,
    and kept: an image that is matched with many is described once. Any number of threads may match the same features.
    """

    #: (N,) records of the library's asj_junction: x, y, scale, log10_nfa, location_sd, branch_count, octave,
    #: branches
    junctions: NDArray[Any]
    #: (L,) records of asj_l_junction: a junction, two of its branches in order, and their ends
    l_junctions: NDArray[Any]
    #: (E,) records of asj_edge: two junctions, a branch of each, log10 NFA of the edge between them
    edges: NDArray[Any]

    def __init__(
        self, view: images.View, junctions: NDArray[Any], l_junctions: NDArray[Any], edges: NDArray[Any], options: Any, preset: str
    ) -> None:
        self._view, self._options = view, options
        self._described: tuple[tuple[str, ...], Any] | None = None
        self.preset = preset
        self.width, self.height = view.width, view.height
        self.junctions, self.l_junctions, self.edges = junctions, l_junctions, edges

    @classmethod
    def from_records(
        cls, image: ArrayLike, records: bytes, edges: bytes = b"", *, preset: str = "match", white: float = 0.0, **options: object
    ) -> Features:
        """Features of an image whose junctions are known: `records` are those of `junctions.tobytes()`, found with these options,
        `edges` those of `edges.tobytes()`."""
        junctions, joined = _records(records, "asj_junction", "junctions"), _records(edges, "asj_edge", "edges")
        if len(junctions) and not 0 <= junctions["branch_count"].min() <= junctions["branch_count"].max() <= lib.ASJ_MAX_BRANCHES:
            raise ArgumentError(f"a junction has 0 to {lib.ASJ_MAX_BRANCHES} branches")
        record = DETECTOR.fill(preset, options)
        return cls(images.view(image, white), junctions, _decompose(junctions, record.minimum_opening), joined, record, preset)

    def described(self, options: Any, context: Context) -> Any:
        """The library's asj_features for these options of the matcher: those kept, or new ones."""
        key = MATCHER.of_an_image(options)
        kept = self._described
        if kept is None or kept[0] != key:
            place = ffi.new("asj_features **")
            source = arrays.pointer(self.junctions, "asj_junction")
            context.call(lib.asj_features_create, self._view.pointer, source, len(self.junctions), options, place)
            kept = self._described = key, ffi.gc(place[0], _free_described)
        return kept[1]

    def _check_options(self, preset: str, options: dict[str, object]) -> None:
        """Any can be had while the image is there."""

    def without_image(self, *, preset: str = "default", context: Context | None = None, **options: object) -> Features:
        """What matching needs, and no more: to keep many, and to send them elsewhere. `options` as for :meth:`save`."""
        self._check_options(preset, options)
        return DescribedFeatures(self.described(MATCHER.fill(preset, options), given(context)))

    def save(self, path: str | os.PathLike[str], *, preset: str = "default", context: Context | None = None, **options: object) -> None:
        """Writes a file of features (.asjf), all that matching needs: :func:`asj.load_features` and `asj-cli match` read it.

        options   those of the matcher that concern one image, for instance descriptor="sift"
        """
        self._check_options(preset, options)
        handle = self.described(MATCHER.fill(preset, options), given(context))
        size = lib.asj_features_save(handle, ffi.NULL, 0)
        data = ffi.new("char[]", size)
        lib.asj_features_save(handle, data, size)
        with whole_file(Path(path)) as file:
            file.write_bytes(ffi.buffer(data))

    def __reduce__(self) -> Any:
        return _restore, (self.image, self._view.pointer.white, self.junctions.tobytes(), self.edges.tobytes(), self.options, self.preset)

    def __len__(self) -> int:
        return len(self.junctions)

    def __repr__(self) -> str:
        return f"<asj.Features: {len(self)} junctions of an image of {self.width}x{self.height}>"

    @property
    def image(self) -> NDArray[Any]:
        """The pixels, as the library sees them."""
        return self._view.pixels

    @property
    def options(self) -> dict[str, str]:
        """All options of the detector that were used, as text."""
        return DETECTOR.values(self._options)

    @property
    def xy(self) -> NDArray[np.float32]:
        """(N, 2) locations; up to 10 px outside the image, where edges meet there."""
        return arrays.columns(self.junctions, "x", (2,))

    @property
    def scale(self) -> NDArray[np.float32]:
        """(N,) px: radius of the isotropic junction."""
        return np.asarray(self.junctions["scale"])

    @property
    def log10_nfa(self) -> NDArray[np.float32]:
        """(N,) log10 of the number of false alarms: the smaller the surer."""
        return np.asarray(self.junctions["log10_nfa"])

    @property
    def uncertainty(self) -> NDArray[np.float32]:
        """(N,) px: standard uncertainty of x and of y; 0 = not known."""
        return np.asarray(self.junctions["location_sd"])

    @property
    def branches(self) -> NDArray[Any]:
        """(M,) all branches: records of asj_branch with the index of their `junction` in front. M is the sum of branch_count."""
        return segments_of(self.junctions)[1]

    @property
    def segments(self) -> NDArray[np.float32]:
        """(M, 2, 2) line segments of all branches, in the order of `branches`: the junction, the branch's end."""
        return segments_of(self.junctions)[0]


def expect_features(features: object, example: str) -> None:
    """Raises ArgumentError for anything else."""
    if not isinstance(features, Features):
        raise ArgumentError(f"features are wanted, not {type(features).__name__}: {example}")


class DescribedFeatures(Features):
    """Features without the photograph, as files have them. The options of the detector are not there either."""

    def __init__(self, handle: Any) -> None:
        info = ffi.new("asj_features_info *")
        lib.asj_features_get_info(handle, info)
        #: bytes of memory
        self.nbytes = int(info.bytes)
        self._described = MATCHER.of_an_image(info.options), handle
        self.preset = "match"
        self.width, self.height = info.width, info.height
        self.junctions = arrays.view(info.junctions, info.junction_count, "asj_junction", handle)
        self.l_junctions = arrays.view(info.l_junctions, info.l_junction_count, "asj_l_junction", handle)
        self.edges = np.zeros(0, arrays.struct_type("asj_edge"))

    def _check_options(self, preset: str, options: dict[str, object]) -> None:
        """Without the image they cannot be described once more."""
        assert self._described is not None
        if (options or preset != "default") and MATCHER.of_an_image(MATCHER.fill(preset, options)) != self._described[0]:
            raise OptionError("these features are described with other options, and without their image they stay so")

    def described(self, options: Any, context: Context) -> Any:
        """Those that there are: the library refuses other options."""
        del options, context
        assert self._described is not None
        return self._described[1]

    @property
    def image(self) -> NDArray[Any]:
        """Not there."""
        raise AttributeError("these features are without their image")

    @property
    def options(self) -> dict[str, str]:
        """Not there."""
        raise AttributeError("features without their image do not tell the options of the detector")

    def __reduce__(self) -> Any:
        handle = self.described(None, current())
        data = ffi.new("char[]", lib.asj_features_save(handle, ffi.NULL, 0))
        lib.asj_features_save(handle, data, len(data))
        return _load, (bytes(ffi.buffer(data)),)


def load_features(path: str | os.PathLike[str]) -> Features:
    """Features that :meth:`asj.Features.save` or `asj-cli detect --format asjf` wrote.

    Damaged files and those of later versions raise FormatError or Error with the cause.
    """
    with Path(path).open("rb") as file:
        head = file.peek(len(_MAGIC))[: len(_MAGIC)]  # of another file, which may be long or a device, no more is read
        return _load(file.read() if head == _MAGIC else head)


def _load(data: bytes) -> Features:
    place = ffi.new("asj_features **")
    current().call(lib.asj_features_load, ffi.from_buffer(data), len(data), place)
    return DescribedFeatures(ffi.gc(place[0], _free_described))


def _free_described(pointer: Any) -> None:
    place = ffi.new("asj_features **", pointer)
    lib.asj_features_free(place)


def segments_of(junctions: NDArray[Any]) -> tuple[NDArray[np.float32], NDArray[Any]]:
    """Segments and branches of an array of junctions."""
    counts = junctions["branch_count"]
    used = np.arange(lib.ASJ_MAX_BRANCHES) < counts[:, None]
    fields = arrays.struct_type("asj_branch")
    names = [name for name in fields.names or () if not name.startswith("reserved")]
    branches = np.zeros(int(counts.sum()), [("junction", "u4")] + [(name, fields[name]) for name in names])
    branches["junction"] = np.repeat(np.arange(len(junctions), dtype=np.uint32), counts)
    for name in names:
        branches[name] = junctions["branches"][name][used]
    start = np.stack([junctions["x"], junctions["y"]], axis=1)[branches["junction"]]
    along = np.stack([np.cos(branches["angle"]), np.sin(branches["angle"])], axis=1)
    return np.stack([start, start + along * branches["length"][:, None]], axis=1).astype(np.float32), branches


def detect(
    image: ArrayLike,
    *,
    preset: str = "match",
    context: Context | None = None,
    white: float = 0.0,
    mask: ArrayLike | None = None,
    region: tuple[int, int, int, int] | None = None,
    **options: object,
) -> Features:
    """Finds the junctions of an image: an array of HxW, HxWx3 or HxWx4 (red, green, blue), uint8, uint16 or float (1.0 is white);
    or an image of Pillow, which is taken as :func:`asj.read_image` takes its file: converted by its mode, and upright where it has
    an EXIF orientation, with locations in the upright image (:attr:`Features.image`).

    preset   "match" for features that are to be matched: weaker junctions too, since the matcher tells the false ones. "default"
             for junctions that are to be looked at; "paper" for the published method
    white    the value that means white, where it is not the type's: 1023 of a 10-bit camera in uint16, 255 of floats up to that
    mask     HxW of bool or uint8: no junction where it is 0
    region   x, y, width, height: only junctions in this part of the image; branches may leave it
    options  those of the detector by name (:func:`asj.detect_options` lists them), for instance minimum_length=30

    Colours count by their grey (77 R + 150 G + 29 B of 256), which is rounded as the type's numbers are: the same colours in 8 bits
    and in 16 bits or floats may differ by a few junctions; the same greys do not. With `colours` those of 8 bits are looked at, too:
    corners between surfaces that are equally bright.

    The array is not copied, and matching and saving look at it: pass image.copy() where a buffer is filled anew meanwhile, or take
    :meth:`Features.without_image` before.

    >>> import numpy as np
    >>> square = np.zeros((200, 200), np.uint8); square[60:140, 60:140] = 255
    >>> sorted(np.round(detect(square, preset="default").xy).astype(int).tolist())
    [[60, 60], [60, 140], [140, 60], [140, 140]]
    >>> sorted(np.round(detect(square, preset="default", region=(0, 0, 100, 200)).xy).astype(int).tolist())
    [[60, 60], [60, 140]]
    """
    record = DETECTOR.fill(preset, options, ("preset", "context", "white", "mask", "region"))
    view = images.view(image, white)
    part = ffi.new("asj_region *")
    if region is not None:
        try:
            part.x, part.y, part.width, part.height = (operator.index(number) for number in region)
        except (TypeError, ValueError, OverflowError):
            raise ArgumentError(f"region {region!r}: it takes four whole numbers, x, y, width and height in px") from None
        if part.width == 0:
            raise ImageError("a region without pixels")
    allowed = images.view(mask) if mask is not None else None  # lives until the call has ended
    part.mask = allowed.pointer if allowed else ffi.NULL
    place = ffi.new("asj_detection **")
    given(context).call(lib.asj_detect_region, view.pointer, part, record, place)
    found = ffi.gc(place[0], _free)
    junctions = arrays.view(found.junctions, found.junction_count, "asj_junction", found)
    l_junctions = arrays.view(found.l_junctions, found.l_junction_count, "asj_l_junction", found)
    edges = arrays.view(found.edges, found.edge_count, "asj_edge", found)
    return Features(view, junctions, l_junctions, edges, record, preset)


def _decompose(junctions: NDArray[Any], opening: float) -> NDArray[Any]:
    source = arrays.pointer(junctions, "asj_junction")
    count = lib.asj_decompose(source, len(junctions), opening, ffi.NULL, 0)
    room = ffi.new("asj_l_junction[]", max(count, 1))
    lib.asj_decompose(source, len(junctions), opening, room, count)
    return arrays.view(room, count, "asj_l_junction", room)


def _records(data: bytes, name: str, what: str) -> NDArray[Any]:
    dtype = arrays.struct_type(name)
    if len(data) % dtype.itemsize:
        raise FormatError(f"{len(data)} bytes are no whole number of {what} of {dtype.itemsize} bytes")
    return np.frombuffer(data, dtype)


def _restore(image: NDArray[Any], white: float, records: bytes, edges: bytes, options: dict[str, str], preset: str) -> Features:
    return Features.from_records(image, records, edges, preset=preset, white=white, **options)


def _free(pointer: Any) -> None:
    place = ffi.new("asj_detection **", pointer)
    lib.asj_detection_free(place)
