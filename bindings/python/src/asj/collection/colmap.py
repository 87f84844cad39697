# SPDX-License-Identifier: BSD-2-Clause
"""A COLMAP database of a collection, written through pycolmap, so that it has the form of the installed version.

Key points are the junctions, each where all its matches together put it (locations.py), with their affine shape, moved by half a pixel
(COLMAP's first pixel has its centre at (0.5, 0.5)).
The shape takes the unit circle to an ellipse along two branches of the junction. Images have a camera each, SIMPLE_RADIAL, with the
focal length that was given, or that of their EXIF data (and then it is marked as known), or the median of what their pairs have found
with the motion, and 1.2 times the longer side elsewhere, as COLMAP itself guesses.

Where an epipolar geometry was asked for and accepted, that is the pair's two-view geometry, with all its matches as inliers, since what
contradicts it has gone; calibrated, with its pose, where the cameras are those that it was found with. COLMAP's own verification gives
the others: a homography speaks for one plane only.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import arrays
from ..output import whole_file
from . import locations
from .store import Store
from .tasks import Detected


def write(store: Store, path: Path, verify: bool = True, refine: bool = True) -> None:
    """Everything in the store; with `verify` also two-view geometries, which reconstruction needs. `refine`: junctions stand where their
    matches put them, not where each was detected."""
    import pycolmap

    with whole_file(path) as temporary:
        os.remove(temporary)
        database = pycolmap.Database.open(temporary)
        try:
            moved = locations.of_store(store) if refine else {}
            given, found = store.given_focal(), _found_focals(store)
            numbers = {}
            for number, name, detected in store.detected():
                if detected.features is not None:
                    camera = _camera(pycolmap, detected, given or detected.focal, found.get(number))
                    numbers[number] = _image(database, pycolmap, name, camera, detected, moved.get(number))
            for one, two, records in locations.matches_of(store):
                pairs = np.stack([records["junction1"], records["junction2"]], axis=1)
                database.write_matches(numbers[one], numbers[two], np.ascontiguousarray(pairs, np.uint32))
        finally:
            database.close()
        if verify:
            _verify(pycolmap, temporary)
        _write_geometries(store, pycolmap, temporary, numbers)
        for left in ("-wal", "-shm"):
            Path(f"{temporary}{left}").unlink(missing_ok=True)


def _verify(pycolmap: Any, path: Path) -> None:
    """COLMAP's own two-view geometries; of what it says while it looks for them, warnings."""
    level = pycolmap.logging.minloglevel
    pycolmap.logging.minloglevel = pycolmap.logging.WARNING.value
    try:
        pycolmap.geometric_verification(path)
    finally:
        pycolmap.logging.minloglevel = level


def _write_geometries(store: Store, pycolmap: Any, path: Path, numbers: dict[int, int]) -> None:
    """Accepted epipolar geometries, in place of what COLMAP may have found for these pairs."""
    database = pycolmap.Database.open(path)
    try:
        for one, two, matched in store.matched():
            found = json.loads(matched.geometry) if matched.geometry and matched.matches else None
            if found and found["status"] == "accepted" and found["model"] != "homography":
                records = np.frombuffer(matched.matches or b"", arrays.struct_type("asj_junction_match"))
                geometry = _geometry(pycolmap, found, np.stack([records["junction1"], records["junction2"]], axis=1))
                if database.exists_two_view_geometry(numbers[one], numbers[two]):
                    database.delete_two_view_geometry(numbers[one], numbers[two])
                database.write_two_view_geometry(numbers[one], numbers[two], geometry)
    finally:
        database.close()


_HALF_A_PIXEL = np.array([[1.0, 0.0, -0.5], [0.0, 1.0, -0.5], [0.0, 0.0, 1.0]])  # from COLMAP's pixels to ours


def _geometry(pycolmap: Any, found: dict[str, Any], pairs: NDArray[np.uint32]) -> Any:
    """As COLMAP has it: x2' F x1 = 0, cam2_from_cam1 = (R, t)."""
    kinds = pycolmap.TwoViewGeometryConfiguration
    geometry = pycolmap.TwoViewGeometry()
    # a focal length that was found belongs to this pair; the image's camera has one for all its pairs
    calibrated = found["model"] == "essential" and found["rotation"] and not found["focal_sd"]
    geometry.config = kinds.CALIBRATED if calibrated else kinds.UNCALIBRATED
    geometry.F = _HALF_A_PIXEL.T @ np.array(found["matrix"]) @ _HALF_A_PIXEL
    if geometry.config == kinds.CALIBRATED:
        rotation, t = np.array(found["rotation"]), np.array(found["translation"])
        geometry.cam2_from_cam1 = pycolmap.Rigid3d(pycolmap.Rotation3d(rotation), t)
        geometry.E = np.array([[0, -t[2], t[1]], [t[2], 0, -t[0]], [-t[1], t[0], 0]]) @ rotation
    geometry.inlier_matches = np.ascontiguousarray(pairs, np.uint32)
    return geometry


def _found_focals(store: Store) -> dict[int, list[float]]:
    """Of each image, px: what its pairs have found together with the motion."""
    found: dict[int, list[float]] = {}
    for one, two, matched in store.matched():
        geometry = json.loads(matched.geometry) if matched.geometry else None
        if geometry and geometry["status"] == "accepted" and geometry["focal_sd"] > 0:
            for image, focal in zip((one, two), geometry["focal"]):
                found.setdefault(image, []).append(focal)
    return found


def _camera(pycolmap: Any, detected: Detected, known: float | None, found: list[float] | None) -> Any:
    width, height = detected.width, detected.height
    focal = known or (float(np.median(found)) if found else 1.2 * max(width, height))
    camera = pycolmap.Camera(model="SIMPLE_RADIAL", width=width, height=height, params=[focal, width / 2, height / 2, 0.0])
    camera.has_prior_focal_length = known is not None
    return camera


def _image(database: Any, pycolmap: Any, name: str, camera: Any, detected: Detected, moved: NDArray[np.float32] | None) -> int:
    number = database.write_image(pycolmap.Image(name=name, camera_id=database.write_camera(camera)))
    points = key_points(np.frombuffer(detected.features or b"", arrays.struct_type("asj_junction")))
    if moved is not None:
        points[:, :2] = moved + np.float32(0.5)
    database.write_keypoints(number, points)
    return int(number)


def key_points(junctions: NDArray[Any]) -> NDArray[np.float32]:
    """(N, 6): x, y, then the matrix of the shape by rows."""
    branches = junctions["branches"]
    used = np.arange(branches.shape[1]) < junctions["branch_count"][:, None]
    # the pair of branches that opens most nearly by a right angle
    angle = branches["angle"]
    opening = np.abs(np.sin(angle[:, :, None] - angle[:, None, :]))
    opening[~(used[:, :, None] & used[:, None, :])] = -1
    best = opening.reshape(len(junctions), branches.shape[1] ** 2).argmax(axis=1)
    rows = np.arange(len(junctions))
    first, second = best // branches.shape[1], best % branches.shape[1]
    result = np.empty((len(junctions), 6), np.float32)
    result[:, 0], result[:, 1] = junctions["x"] + 0.5, junctions["y"] + 0.5
    for column, which in ((0, first), (1, second)):
        reach = np.maximum(junctions["scale"], 1)
        result[:, 2 + column] = reach * np.cos(angle[rows, which])
        result[:, 4 + column] = reach * np.sin(angle[rows, which])
    return result
