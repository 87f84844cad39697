# SPDX-License-Identifier: BSD-2-Clause
"""Junctions of one image."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import arrays, images
from ._native import ffi, lib
from .context import Context, current
from .options import DETECTOR


class Features:
    """Junctions of one image, most meaningful first, and what matching needs of it.

    Coordinates are pixels: the centre of the first pixel is (0, 0), x points right, y down. Angles are radians from +x towards +y.
    The arrays are read-only views of the library's memory.
    """

    #: (N,) records of the library's asj_junction: x, y, scale, log10_nfa, location_sd, branch_count, branches
    junctions: NDArray[Any]
    #: (L,) records of asj_l_junction: a junction, two of its branches in order, and their ends
    l_junctions: NDArray[Any]

    def __init__(self, view: images.View, detection: Any, options: Any, preset: str) -> None:
        self._view, self._detection, self._options = view, detection, options
        self.preset = preset
        self.width, self.height = view.width, view.height
        self.junctions = arrays.view(detection.junctions, detection.junction_count, "asj_junction", detection)
        self.l_junctions = arrays.view(detection.l_junctions, detection.l_junction_count, "asj_l_junction", detection)

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
        """(N, 2) locations."""
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
        counts = self.junctions["branch_count"]
        used = np.arange(lib.ASJ_MAX_BRANCHES) < counts[:, None]
        fields = arrays.struct_type("asj_branch")
        names = [name for name in fields.names or () if not name.startswith("reserved")]
        result = np.zeros(int(counts.sum()), [("junction", "u4")] + [(name, fields[name]) for name in names])
        result["junction"] = np.repeat(np.arange(len(self), dtype=np.uint32), counts)
        for name in names:
            result[name] = self.junctions["branches"][name][used]
        return result

    @property
    def segments(self) -> NDArray[np.float32]:
        """(M, 2, 2) line segments of all branches, in the order of `branches`: the junction, the branch's end."""
        branches = self.branches
        start = self.xy[branches["junction"]]
        along = np.stack([np.cos(branches["angle"]), np.sin(branches["angle"])], axis=1)
        return np.stack([start, start + along * branches["length"][:, None]], axis=1).astype(np.float32)


def detect(image: ArrayLike, *, preset: str = "match", context: Context | None = None, white: float = 0.0, **options: object) -> Features:
    """Finds the junctions of an image: an array of HxW, HxWx3 or HxWx4 (red, green, blue), uint8, uint16 or float (1.0 is white).

    preset   "match" for features that are to be matched: weaker junctions too, since the matcher tells the false ones. "default"
             for junctions that are to be looked at; "paper" for the published method
    options  those of the detector by name (:func:`asj.detect_options` lists them), for instance minimum_length=30

    >>> import numpy as np
    >>> square = np.zeros((200, 200), np.uint8); square[60:140, 60:140] = 255
    >>> sorted(np.round(detect(square, preset="default").xy).astype(int).tolist())
    [[60, 60], [60, 140], [140, 60], [140, 140]]
    """
    record = DETECTOR.fill(preset, options)
    view = images.view(image, white)
    place = ffi.new("asj_detection **")
    (context or current()).call(lib.asj_detect, view.pointer, record, place)
    return Features(view, ffi.gc(place[0], _free), record, preset)


def _free(pointer: Any) -> None:
    place = ffi.new("asj_detection **", pointer)
    lib.asj_detection_free(place)
