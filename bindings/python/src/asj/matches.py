# SPDX-License-Identifier: BSD-2-Clause
"""Matches of two images."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import arrays, images
from ._native import ffi, lib
from .context import Context, given
from .errors import ArgumentError
from .features import Features, detect, expect_features  # noqa: F401 (detect: the example of match())
from .geometry import Camera, Geometry
from .geometry import fill as fill_geometry
from .geometry import read as read_geometry
from .options import DETECTOR, MATCHER

_ENDS = {"cut": lib.ASJ_END_CUT, "inner": lib.ASJ_END_INNER, "both": lib.ASJ_END_BOTH}


class Matches:
    """Matched L-junctions (corners) of two images, smallest distance first."""

    #: (K,) records of the library's asj_junction_match
    matches: NDArray[Any]

    def __init__(self, result: Any, features: tuple[Features, Features] | None) -> None:
        self._result, self._features = result, features
        self.matches = arrays.view(result.matches, result.match_count, "asj_junction_match", result)
        self._l1 = arrays.view(result.l_junctions1, result.l_junction_count1, "asj_l_junction", result)
        self._l2 = arrays.view(result.l_junctions2, result.l_junction_count2, "asj_l_junction", result)

    def __len__(self) -> int:
        return len(self.matches)

    def __reduce__(self) -> Any:
        raise TypeError("asj.Matches hold a result of the library, and cannot be pickled or copied: send .matches, .geometry or .segments()")

    def __repr__(self) -> str:
        return f"<asj.Matches: {len(self)}>"

    def _both(self) -> tuple[Features, Features]:
        if self._features is None:
            raise AttributeError("matches of asj.match_images() have no features: it finds junctions of its own")
        return self._features

    @property
    def features1(self) -> Features:
        """What was matched, of the first image; matches of :func:`asj.match_images` have none."""
        return self._both()[0]

    @property
    def features2(self) -> Features:
        """The same of the second image."""
        return self._both()[1]

    @property
    def indices(self) -> NDArray[np.uint32]:
        """(K, 2) indices of the junctions in features1 and features2; of no use without these."""
        return np.stack([self.matches["junction1"], self.matches["junction2"]], axis=1)

    @property
    def l_indices(self) -> NDArray[np.uint32]:
        """(K, 2) indices of the L-junctions in l_junctions1 and l_junctions2."""
        return arrays.columns(self.matches, "l1", (2,), "u4")

    @property
    def l_junctions1(self) -> NDArray[Any]:
        """The L-junctions of the first image that the matcher used."""
        return self._l1

    @property
    def l_junctions2(self) -> NDArray[Any]:
        """The L-junctions of the second image that the matcher used."""
        return self._l2

    @property
    def xy1(self) -> NDArray[np.float32]:
        """(K, 2) locations in the first image, as detected."""
        return arrays.columns(self.matches, "x1", (2,))

    @property
    def xy2(self) -> NDArray[np.float32]:
        """(K, 2) locations in the second image, where the alignment of the match puts them."""
        return arrays.columns(self.matches, "x2", (2,))

    @property
    def affine(self) -> NDArray[np.float64]:
        """(K, 2, 3) affine maps from the first image to the second."""
        return arrays.columns(self.matches, "affine", (2, 3), "f8")

    @property
    def distance(self) -> NDArray[np.float32]:
        """(K,) distance of the patches."""
        return np.asarray(self.matches["distance"])

    @property
    def ratio(self) -> NDArray[np.float32]:
        """(K,) how much worse the second best at another place is; inf when there is none."""
        return np.asarray(self.matches["ratio"])

    @property
    def similarity(self) -> NDArray[np.float32]:
        """(K,) correlation of the aligned discs."""
        return np.asarray(self.matches["similarity"])

    @property
    def probability(self) -> NDArray[np.float32]:
        """(K,) that the match is right, given the geometry; 0 where none was accepted, low off the plane of a homography. NaN where
        none was asked for: ask for one (geometry="auto") to have it."""
        if self._result.geometry.status != lib.ASJ_GEOMETRY_NOT_ASKED:
            return np.asarray(self.matches["probability"])
        unknown = np.full(len(self), np.nan, np.float32)
        unknown.flags.writeable = False
        return unknown

    @property
    def stretch(self) -> tuple[float, float]:
        """How the images were looked at, along x and y: (1, 1) is as they are."""
        return self._result.stretch[0], self._result.stretch[1]

    @property
    def upsampled(self) -> bool:
        """Whether these are the matches of the upsampled images, with junctions of octave -1."""
        return bool(self._result.upsampled)

    @property
    def coloured(self) -> bool:
        """Whether colours, looked at where a geometry was not found without, are what it was found by."""
        return bool(self._result.coloured)

    @property
    def rejected(self) -> NDArray[Any]:
        """Records of what would match without the geometry, and contradicts it; of two at odds ("ambiguous") either one."""
        return arrays.view(self._result.rejected, self._result.rejected_count, "asj_junction_match", self._result)

    @property
    def geometry(self) -> Geometry | None:
        """What relates the two views; None unless :func:`asj.match` was asked for it."""
        return read_geometry(self._result.geometry)

    def segments(
        self, ends: str = "both", *, joined: bool = False
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.uint32]]:
        """Line segments that match: (S, 2, 2) in the first image, (S, 2, 2) in the second, (S,) index of the match. A segment seen from
        both its ends comes once; of an edge with corners on it there are segments from each, with joined=True one, from the first
        end to the last, whose index is that of a part of it, mostly the longest.

        They point where both images say, and begin at the match's points, joined ones also elsewhere; the branches as detected are ``features1.segments`` and
        ``features2.segments`` at :meth:`segment_indices`, in the second image some pixels beside these where the match moved the corner.

        ends   what must be known of the far ends: "both" (both branches' own ends correspond), "inner" (or a junction on the longer
               one does), "cut" (or the longer one was cut where the matches around put the end of the shorter one)
        """
        records = self._segment_records(ends, joined)
        return (arrays.columns(records, "x1", (2, 2)), arrays.columns(records, "x2", (2, 2)), np.asarray(records["match"]))

    def segment_indices(self, ends: str = "both", *, joined: bool = False) -> NDArray[np.int64]:
        """(S, 2) which of features1.segments and features2.segments those of :meth:`segments` (with the same arguments) are, by the
        branches they follow; matches of :func:`asj.match_images` have no features, and none."""
        records = self._segment_records(ends, joined)
        junctions = self.indices[records["match"]]
        columns = [
            _first_segments(features)[junctions[:, side]] + records[f"branch{side + 1}"]
            for side, features in enumerate((self.features1, self.features2))
        ]
        return np.stack(columns, axis=1)

    def _segment_records(self, ends: str, joined: bool) -> NDArray[Any]:
        if ends not in _ENDS:
            raise ValueError(f"ends is {ends!r}: one of {', '.join(_ENDS)}")
        count = lib.asj_match_segments(self._result, _ENDS[ends], ffi.NULL, 0)
        room = ffi.new("asj_segment_match[]", max(count, 1))
        lib.asj_match_segments(self._result, _ENDS[ends], room, count)
        if joined:
            count = lib.asj_join_segment_matches(room, count)
        return arrays.view(room, count, "asj_segment_match", room)


def _first_segments(features: Features) -> NDArray[np.int64]:
    """(N,) the index in features.segments of each junction's first branch."""
    counts = features.junctions["branch_count"].astype(np.int64)
    return np.cumsum(counts) - counts


_KEYWORDS = ("geometry", "camera1", "camera2", "find_focal", "focal_sd", "preset", "context")


def match(
    features1: Features, features2: Features, *, geometry: str = "none", camera1: Camera | None = None, camera2: Camera | None = None,
    find_focal: bool = False, focal_sd: float = 0.0, preset: str = "default", context: Context | None = None,
    **options: object,
) -> Matches:  # fmt: skip
    """Matches the features of two images.

    geometry   "auto", "essential", "fundamental" or "homography": estimates what relates the two views, drops matches that contradict
               it and adds those that it makes likely; "none" does not
    camera1    of the first image: the matrix K, (fx, fy, cx, cy), or a focal length in pixels; None = not known. Pixel centres are at
               integers: cx and cy are those of COLMAP less 0.5. What is a camera in the order cx, cy, fx, fy only is refused, and
               a principal point outside of the image, or farther from its middle than a quarter of its size, is warned of
    camera2    of the second image; None = as camera1
    find_focal no camera is known: one focal length for both is found with the motion ("auto" and "essential")
    focal_sd   how well the cameras' focal lengths are known, as a part of them, 0.05 for instance where they are from EXIF data: the
               factor by which both are out is found with the motion (0 to 0.25; 0: they are exact)
    options    those of the matcher by name (:func:`asj.match_options` lists them), for instance ratio=1.3, descriptor="sift"

    >>> import numpy as np
    >>> random = np.random.default_rng(1)
    >>> wall = np.kron(random.integers(40, 220, (9, 12)), np.ones((40, 40))).astype(np.uint8)
    >>> found = match(detect(wall[:300, :400]), detect(wall[20:320, 30:430]))
    >>> np.median(found.xy1 - found.xy2, axis=0).round(1).tolist()
    [30.0, 20.0]
    """
    for features in (features1, features2):
        expect_features(features, "asj.match(asj.detect(image1), asj.detect(image2))")
        if features.preset == "default" and preset != "paper":
            warnings.warn('features of asj.detect(preset="default") give fewer matches; use preset="match"', stacklevel=2)
            break
    record = MATCHER.fill(preset, options, _KEYWORDS)
    cameras = (camera1, camera1 if camera2 is None else camera2)
    fill_geometry(record, geometry, cameras, [(one.width, one.height) for one in (features1, features2)], find_focal, focal_sd)
    context = given(context)
    place = ffi.new("asj_match_result **")
    one, two = features1.described(record, context), features2.described(record, context)
    context.call(lib.asj_match_features, one, two, record, place)
    return Matches(ffi.gc(place[0], _free), (features1, features2))


def match_images(
    image1: ArrayLike, image2: ArrayLike, *, stretch: float | tuple[float, float] | str = "auto", geometry: str = "none",
    camera1: Camera | None = None, camera2: Camera | None = None, find_focal: bool = False, focal_sd: float = 0.0,
    preset: str = "default", context: Context | None = None, white: float = 0.0, **options: object,
) -> Matches:  # fmt: skip
    """Detects in both images and matches them, upsampled or stretched before; everything comes in pixels of the images as they are.

    stretch    a factor of 0.5 to 8, or one for x and one for y. Photographs of up to some megapixels have about three times the matches
               at 2, in three to eight times the time; what is seen at a glancing angle, like things on a table, matches at (1, 3).
               "auto": as they are; from `upsample_from` matches on (8; fewer where a geometry is left open; 0 = never) also upsampled,
               which :attr:`Matches.upsampled` tells; images of more than 2 megapixels also halved, and upsampled from there; where no
               sure geometry is found also with colours (`look_at_colours`), which :attr:`Matches.coloured` tells; and where nothing comes
               of it at (1, 3) and (3, 1), then also upsampled; :attr:`Matches.stretch` tells which it was
    white      what means white in both images, as for :func:`asj.detect`
    preset     "default", or "paper": the published method, detector and matcher; "auto" is as they are then
    options    those of the matcher; the others as for :func:`asj.match`

    >>> import numpy as np
    >>> random = np.random.default_rng(1)
    >>> wall = np.kron(random.integers(40, 220, (9, 12)), np.ones((40, 40))).astype(np.uint8)
    >>> found = match_images(wall[:300, :400], wall[20:320, 30:430], stretch=1.5)
    >>> np.median(found.xy1 - found.xy2, axis=0).round(1).tolist()
    [30.0, 20.0]
    """
    views = (images.view(image1, white), images.view(image2, white))
    if isinstance(stretch, str) and stretch != "auto":
        raise ValueError(f"stretch {stretch!r} is no factor, no pair of factors, and not 'auto'")
    try:
        automatic = 1.0 if preset == "paper" else 0.0
        x, y = (automatic, automatic) if isinstance(stretch, str) else np.broadcast_to(np.asarray(stretch, float), 2)
    except (TypeError, ValueError):
        raise ArgumentError(f"stretch {stretch!r}: it takes a factor, or one for x and one for y") from None
    if not isinstance(stretch, str) and x == 0 and y == 0:
        raise ValueError("a stretch of 0")
    factors = ffi.new("asj_stretch *", {"x": float(x), "y": float(y)})
    record = MATCHER.fill(preset, options, ("stretch", "white", *_KEYWORDS))
    cameras = (camera1, camera1 if camera2 is None else camera2)
    fill_geometry(record, geometry, cameras, [(one.width, one.height) for one in views], find_focal, focal_sd)
    detector = DETECTOR.fill("paper" if preset == "paper" else "match", {})
    place = ffi.new("asj_match_result **")
    given(context).call(
        lib.asj_match_images, views[0].pointer, views[1].pointer, factors, detector, record, place
    )
    return Matches(ffi.gc(place[0], _free), None)


def _free(pointer: Any) -> None:
    place = ffi.new("asj_match_result **", pointer)
    lib.asj_match_result_free(place)
