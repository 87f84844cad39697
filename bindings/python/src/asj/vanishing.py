# SPDX-License-Identifier: BSD-2-Clause
"""Vanishing points: where the parallel edges of a room meet in its image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import arrays
from ._native import ffi, lib
from .context import Context, given
from .features import Features, expect_features
from .geometry import Camera, numbers


@dataclass(frozen=True)
class VanishingPoints:
    """Up to three directions of parallel edges, the surest first: K of them. With a focal length they are at right angles."""

    #: (K, 3) homogeneous points of the image, of length 1: the pixel is p[:2] / p[2], far away where p[2] is nearly 0
    points: NDArray[np.float64]
    #: (K, 3) in camera coordinates (x right, y down, z forward), of length 1, sign unknown; None without a focal length
    directions: NDArray[np.float64] | None
    #: (K,) log10 of how many directions with so many branches chance brings in such an image
    log10_nfa: NDArray[np.float64]
    #: (K,) branches that agree, those of one line counted once
    branch_count: NDArray[np.int64]
    #: (fx, fy, cx, cy) px, given, or found from two directions; None when it is not known
    camera: tuple[float, float, float, float] | None
    #: "unknown", "given", "found"
    focal_source: str

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        return f"<asj.VanishingPoints: {len(self)} directions, focal length {self.focal_source}>"


def vanishing_points(
    features: Features, *, camera: Camera | None = None, epsilon: float | None = None, context: Context | None = None
) -> VanishingPoints:
    """Where the parallel edges of the scene meet, by the branches of an image's junctions.

    camera    a matrix K (3, 3), (fx, fy, cx, cy) or a focal length in pixels; pixel centres are at integers (COLMAP's cx and cy less
              0.5), judged as :func:`asj.match` does. Without one the focal length is found where two
              directions determine it
    epsilon   how many chance directions an image without any may show on average

    >>> import asj, numpy as np
    >>> flat = np.full((60, 80), 90, np.uint8)
    >>> len(asj.vanishing_points(asj.detect(flat)))
    0
    """
    expect_features(features, "asj.vanishing_points(asj.detect(image))")
    options, result = ffi.new("asj_vanishing_options *"), ffi.new("asj_vanishing_points *")
    lib.asj_vanishing_options_init(options)
    options.width, options.height = features.width, features.height
    if epsilon is not None:
        options.epsilon = epsilon
    if camera is not None:
        place = options.camera
        place.fx, place.fy, place.cx, place.cy = numbers(camera, features.width, features.height, stacklevel=3)
    source = arrays.pointer(features.junctions, "asj_junction")
    given(context).call(lib.asj_find_vanishing_points, source, len(features.junctions), options, result)
    points = [result.points[i] for i in range(result.count)]
    sources = {lib.ASJ_FOCAL_UNKNOWN: "unknown", lib.ASJ_FOCAL_GIVEN: "given", lib.ASJ_FOCAL_FOUND: "found"}
    known = result.focal_source != lib.ASJ_FOCAL_UNKNOWN
    return VanishingPoints(
        np.array([list(point.point) for point in points], np.float64).reshape(-1, 3),
        np.array([list(point.direction) for point in points], np.float64).reshape(-1, 3) if known else None,
        np.array([point.log10_nfa for point in points], np.float64),
        np.array([point.branch_count for point in points], np.int64),
        (result.camera.fx, result.camera.fy, result.camera.cx, result.camera.cy) if known else None,
        sources[result.focal_source],
    )  # fmt: skip
