# SPDX-License-Identifier: BSD-2-Clause
"""Straight edges of one image: from end to end, each once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import arrays
from ._native import ffi, lib
from .context import Context, given
from .features import Features, expect_features


@dataclass(frozen=True)
class Lines:
    """The straight edges of an image, the longest first: S of them."""

    #: (S,) records of the library's asj_segment: ends, their uncertainties, what is at them, junctions, log10_nfa, ...
    records: NDArray[Any]
    #: (M,) of every branch, in the order of features.segments, the index of the line that it is a part of; -1: it has no length
    of_segments: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.records)

    def __repr__(self) -> str:
        return f"<asj.Lines: {len(self)} straight edges>"

    @property
    def segments(self) -> NDArray[np.float32]:
        """(S, 2, 2) the two ends of each."""
        return arrays.columns(self.records, "x1", (2, 2))

    @property
    def log10_nfa(self) -> NDArray[np.float32]:
        """(S,) log10 of the number of false alarms, of the surest branch: the smaller the surer."""
        return np.asarray(self.records["log10_nfa"])


def lines(features: Features, *, context: Context | None = None) -> Lines:
    """The straight edges of an image, each once, whichever corners have a branch along it.

    Of features of preset "default": those of preset "match", for :func:`asj.match`, have many weak branches of all octaves, and so have
    their lines.

    >>> import asj, numpy as np
    >>> square = np.full((90, 120), 60, np.uint8); square[21:71, 31:101] = 200
    >>> found = asj.lines(asj.detect(square, preset="default"))
    >>> len(found), np.linalg.norm(found.segments[:, 1] - found.segments[:, 0], axis=1).round(1).tolist()
    (4, [70.0, 70.0, 50.0, 50.0])
    """
    expect_features(features, "asj.lines(asj.detect(image))")
    return lines_of(features.junctions, features.edges, given(context))


def lines_of(junctions: NDArray[Any], edges: NDArray[Any], context: Context) -> Lines:
    """Those of records of asj_junction and of asj_edge."""
    place = ffi.new("asj_segment_list **")
    source, joined = arrays.pointer(junctions, "asj_junction"), arrays.pointer(edges, "asj_edge")
    context.call(lib.asj_find_segments, source, len(junctions), joined, len(edges), place)
    found = ffi.gc(place[0], _free)
    slots = np.array(ffi.unpack(found.of_branches, len(junctions) * lib.ASJ_MAX_BRANCHES), np.int64).reshape(-1, lib.ASJ_MAX_BRANCHES)
    slots[slots == lib.ASJ_NO_SEGMENT] = -1
    of_segments = slots[np.arange(lib.ASJ_MAX_BRANCHES) < junctions["branch_count"][:, None]]
    return Lines(arrays.view(found.segments, found.count, "asj_segment", found), of_segments)


def _free(pointer: Any) -> None:
    place = ffi.new("asj_segment_list **", pointer)
    lib.asj_segment_list_free(place)
