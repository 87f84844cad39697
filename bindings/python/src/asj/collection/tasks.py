# SPDX-License-Identifier: BSD-2-Clause
"""What a worker does: junctions of one image, matches of one pair. A failure is a result too."""

from __future__ import annotations

import dataclasses
import json
import warnings
from collections import OrderedDict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import arrays, context, errors, images
from .._native import lib
from ..features import DescribedFeatures, Features, detect
from ..geometry import Geometry
from ..matches import Matches, match
from .plan import Plan

EXIF_FOCAL_SD = 0.05  # whole millimetres on 35 mm film, of a lens that changes with the distance that it is focused at
_KEPT = 512 << 20  # bytes of features that a process keeps in memory: a hundred photographs of a megapixel


@dataclass(frozen=True)
class Detected:
    """The result of one image: its junctions as the library's records, in the upright image, whose size it tells."""

    error: str | None
    width: int
    height: int
    focal: float | None
    features: bytes | None
    orientation: int = 1  # of the stored pixels: orientation.py
    camera: str | None = None  # images.camera_name()

    @property
    def junctions(self) -> NDArray[Any]:
        """(N,) records of the library's asj_junction, as Features.junctions; none of an image that failed."""
        return np.frombuffer(self.features or b"", arrays.struct_type("asj_junction"))

    @property
    def is_damaged(self) -> bool:
        """Whether the records cannot be what was saved."""
        if len(self.features or b"") % arrays.struct_type("asj_junction").itemsize:
            return True
        return bool((self.junctions["branch_count"] > lib.ASJ_MAX_BRANCHES).any() or (self.junctions["branch_count"] < 0).any())


@dataclass(frozen=True)
class Matched:
    """The result of one pair: the library's match records, index pairs of line segments, the geometry as JSON."""

    error: str | None
    matches: bytes | None
    lines: bytes | None
    geometry: str | None

    @property
    def junction_matches(self) -> NDArray[Any]:
        """(K,) records of the library's asj_junction_match, as Matches.matches; none of a pair that failed."""
        return np.frombuffer(self.matches or b"", arrays.struct_type("asj_junction_match"))

    @property
    def segment_indices(self) -> NDArray[np.uint32]:
        """(S, 2) which branches match, as Matches.segment_indices("cut")."""
        return np.frombuffer(self.lines or b"", np.uint32).reshape(-1, 2)

    @property
    def is_damaged(self) -> bool:
        """Whether the records cannot be what was saved."""
        return bool(len(self.matches or b"") % arrays.struct_type("asj_junction_match").itemsize or len(self.lines or b"") % 8)


def start(threads: int) -> None:
    """Called once in a worker process."""
    warnings.filterwarnings("ignore", "the (principal point|focal lengths)")  # the command has said so, once
    context.set_current(context.Context(threads=threads))


def detect_image(path: Path, detector: dict[str, str], matcher: dict[str, str]) -> tuple[Detected, Features | None]:
    """The junctions of an image file, and what matching needs of it."""
    try:
        pixels = images.read(path)
        features = detect(pixels, **_keywords(detector))
        exif = images.focal_length(path), features.junctions.tobytes(), images.orientation(path), images.camera_name(path)
        result = Detected(None, features.width, features.height, *exif)
        return result, features.without_image(**_keywords(matcher))
    except (errors.Error, OSError, MemoryError) as bad:
        return Detected(_line(bad), 0, 0, None, None), None


def match_images(one: Features, two: Features, focals: tuple[float | None, float | None], plan: Plan) -> Matched:
    """The matches of two images, and what relates them, where it is asked for. focals: from EXIF data, px."""
    try:
        found = match(one, two, **_keywords(plan.matcher), **_cameras(focals, plan))
        lines = found.segment_indices("cut").astype(np.uint32)
        return Matched(None, found.matches.tobytes(), lines.tobytes(), _as_json(found.geometry))
    except (errors.Error, MemoryError) as bad:
        return Matched(_line(bad), None, None, None)


def _cameras(focals: tuple[float | None, float | None], plan: Plan) -> dict[str, Any]:
    """Keywords of match(). A focal length that only one of both has is of no use."""
    if plan.geometry in ("none", "fundamental", "homography"):
        return {"geometry": plan.geometry}
    known = plan.focal == "exif" and None not in focals
    if plan.focal == "estimate" or (plan.geometry == "essential" and plan.focal == "exif" and not known):
        return {"geometry": plan.geometry, "find_focal": True}
    if known:
        return {"geometry": plan.geometry, "camera1": focals[0], "camera2": focals[1], "focal_sd": EXIF_FOCAL_SD}
    if plan.focal in ("exif", "none"):
        return {"geometry": plan.geometry}
    camera = plan.camera
    return {"geometry": plan.geometry, "camera1": camera if len(camera) > 1 else camera[0]}


def _as_json(geometry: Geometry | None) -> str | None:
    if geometry is None:
        return None
    values = dataclasses.asdict(geometry)
    return json.dumps({key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in values.items()})


class Kept:
    """The images that this process used last, up to a number of bytes."""

    def __init__(self, most: int = _KEPT) -> None:
        self._most, self._bytes = most, 0
        self._features: OrderedDict[Path, Features] = OrderedDict()

    def get(self, path: Path, records: bytes, detector: dict[str, str], matcher: dict[str, str]) -> Features:
        """The features of an image whose junctions are known."""
        features = self._features.get(path)
        if features is None:
            found = Features.from_records(images.read(path), records, **_keywords(detector))
            features = self.put(path, found.without_image(**_keywords(matcher)))
        else:
            self._features.move_to_end(path)
        return features

    def put(self, path: Path, features: Features) -> Features:
        """Keeps them; the least used ones go."""
        self._features[path] = features
        self._bytes += _size(features)
        while self._bytes > self._most and len(self._features) > 2:
            self._bytes -= _size(self._features.popitem(last=False)[1])
        return features


def _size(features: Features) -> int:
    return features.nbytes if isinstance(features, DescribedFeatures) else 0


def _keywords(options: dict[str, str]) -> dict[str, Any]:
    return dict(options)


def _line(bad: BaseException) -> str:
    line = (str(bad) or type(bad).__name__).replace("\n", "; ")
    return line.encode("utf-8", "backslashreplace").decode()  # the store has text; a folder's name need not be UTF-8
