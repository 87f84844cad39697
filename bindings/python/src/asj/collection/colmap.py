# SPDX-License-Identifier: BSD-2-Clause
"""A COLMAP database of a collection, written through pycolmap, so that it has the form of the installed version.

Key points are the junctions, each where all its matches together put it (locations.py), with their affine shape, in the pixels of the
file (orientation.py), moved by half a pixel (COLMAP's first pixel has its centre at (0.5, 0.5)).
The shape takes the unit circle to an ellipse along two branches of the junction. Images have the numbers of the store, which they
keep, and a camera each of the same number, SIMPLE_RADIAL, with the focal length that was given, or the median of what their pairs have
found with the motion, or that of their EXIF data, and 1.2 times the longer side elsewhere, as COLMAP itself guesses. It is marked as
known where it was given or EXIF data tell one. Where the whole camera was given, all images of one size have that one, PINHOLE, with
the number of the first of them.

Where an epipolar geometry was asked for and accepted, that is the pair's two-view geometry, with all its matches as inliers, since what
contradicts it has gone; calibrated, with its pose, where the cameras are those that it was found with. COLMAP's own verification gives
the others: a homography speaks for one plane only.
"""

from __future__ import annotations

import contextlib
import json
import os
import sqlite3
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import arrays
from ..output import whole_file
from . import locations, orientation
from .store import Store
from .tasks import Detected


_APPLICATION = int.from_bytes(b"asj\0", "big")  # of a database that was written here, and may be again


def is_ours(path: Path) -> bool:
    """Was the database written by write()?"""
    with path.open("rb") as file:  # SQLite itself would leave logs beside it
        header = file.read(100)
    return header.startswith(b"SQLite format 3\0") and int.from_bytes(header[68:72], "big") == _APPLICATION


def refuse_logs(path: Path) -> None:
    """Raises FileExistsError where a database has such logs."""
    if logs := logs_of(path):
        raise FileExistsError(f"{logs[0]} is there: another program has {path.name} open, or was killed; open it once, or remove both")


def logs_of(path: Path) -> list[Path]:
    """What SQLite keeps beside a database that is open, or whose program was killed; it would take them for those of the next one."""
    return [log for kind in ("-wal", "-shm", "-journal") if (log := path.with_name(path.name + kind)).exists()]


def write(store: Store, path: Path, verify: bool = True, refine: bool = True, threads: int = -1) -> None:
    """Everything in the store; with `verify` also two-view geometries, which reconstruction needs, by so many `threads`. `refine`:
    junctions stand where their matches put them, not where each was detected. Raises OSError where it cannot be written."""
    import pycolmap

    refuse_logs(path)
    with whole_file(path) as temporary:
        os.remove(temporary)
        try:
            _fill(store, pycolmap, temporary, refine, threads if verify else None)
        except RuntimeError as bad:  # SQLite's errors, by way of pycolmap
            raise OSError(f"{path}: {str(bad).splitlines()[0]}") from bad
        finally:
            for log in logs_of(temporary):
                log.unlink()


def _fill(store: Store, pycolmap: Any, path: Path, refine: bool, threads: int | None) -> None:
    database = pycolmap.Database.open(path)
    try:
        moved = locations.of_store(store) if refine else {}
        cameras = _Cameras(pycolmap, database, store)
        for number, name, detected in store.detected():
            if detected.features is not None:
                _image(database, pycolmap, number, name, cameras.of(number, detected), detected, moved.get(number))
        for one, two, records in locations.matches_of(store):
            pairs = np.stack([records["junction1"], records["junction2"]], axis=1)
            database.write_matches(one, two, np.ascontiguousarray(pairs, np.uint32))
    finally:
        database.close()
    if threads is not None:
        _verify(pycolmap, path, threads)
    _write_geometries(store, pycolmap, path)
    with contextlib.closing(sqlite3.connect(path)) as connection:
        connection.execute(f"PRAGMA application_id = {_APPLICATION}")
        connection.commit()


def _verify(pycolmap: Any, path: Path, threads: int) -> None:
    """COLMAP's own two-view geometries, the same ones each time; of what it says while it looks for them, warnings."""
    level = pycolmap.logging.minloglevel
    pycolmap.logging.minloglevel = pycolmap.logging.WARNING.value
    by, of_pair = pycolmap.GeometricVerifierOptions(), pycolmap.TwoViewGeometryOptions()
    by.num_threads, of_pair.ransac.random_seed = threads, 1
    try:
        pycolmap.geometric_verification(path, verifier_options=by, two_view_geometry_options=of_pair)
    finally:
        pycolmap.logging.minloglevel = level


def _write_geometries(store: Store, pycolmap: Any, path: Path) -> None:
    """Accepted epipolar geometries, in place of what COLMAP may have found for these pairs."""
    images = {number: replace(image, features=None) for number, _, image in store.detected()}
    database = pycolmap.Database.open(path)
    try:
        for one, two, matched in store.matched():
            found = json.loads(matched.geometry) if matched.geometry and matched.matches else None
            if found and found["status"] == "accepted" and found["model"] != "homography":
                records = np.frombuffer(matched.matches or b"", arrays.struct_type("asj_junction_match"))
                pairs = np.stack([records["junction1"], records["junction2"]], axis=1)
                geometry = _geometry(pycolmap, found, pairs, images[one], images[two])
                if database.exists_two_view_geometry(one, two):
                    database.delete_two_view_geometry(one, two)
                database.write_two_view_geometry(one, two, geometry)
    finally:
        database.close()


_HALF_A_PIXEL = np.array([[1.0, 0.0, -0.5], [0.0, 1.0, -0.5], [0.0, 0.0, 1.0]])  # from COLMAP's pixels to ours


def _to_stored(image: Detected) -> NDArray[np.float64]:
    return orientation.to_stored(image.orientation, image.width, image.height)


def _geometry(pycolmap: Any, found: dict[str, Any], pairs: NDArray[np.uint32], one: Detected, two: Detected) -> Any:
    """As COLMAP has it, of the stored pixels: x2' F x1 = 0, cam2_from_cam1 = (R, t)."""
    kinds = pycolmap.TwoViewGeometryConfiguration
    geometry = pycolmap.TwoViewGeometry()
    # a focal length that was found belongs to this pair; the image's camera has one for all its pairs
    mirrored = orientation.is_mirrored(one.orientation) or orientation.is_mirrored(two.orientation)
    calibrated = found["model"] == "essential" and found["rotation"] and not found["focal_sd"] and not mirrored
    geometry.config = kinds.CALIBRATED if calibrated else kinds.UNCALIBRATED
    back1, back2 = (np.linalg.inv(_to_stored(image)) @ _HALF_A_PIXEL for image in (one, two))
    geometry.F = back2.T @ np.array(found["matrix"]) @ back1
    if calibrated:
        turn1, turn2 = np.eye(3), np.eye(3)  # of the cameras' coordinates, as of their pixels
        turn1[:2, :2], turn2[:2, :2] = _to_stored(one)[:2, :2], _to_stored(two)[:2, :2]
        rotation, t = turn2 @ np.array(found["rotation"]) @ turn1.T, turn2 @ np.array(found["translation"])
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
            for image, camera in zip((one, two), geometry["cameras"]):
                found.setdefault(image, []).append(camera[0])
    return found


def focal_of(given: float | None, found: list[float] | None, exif: float | None, longer: float) -> float:
    """Of an image, px: as it was given, or in the median of what its pairs have found, or from EXIF data, or as COLMAP guesses it."""
    return given or (float(np.median(found)) if found else exif or 1.2 * longer)


class _Cameras:
    """A camera for each image; one for all of one size where the user has given all four numbers of it."""

    def __init__(self, pycolmap: Any, database: Any, store: Store) -> None:
        self._pycolmap, self._database = pycolmap, database
        self._given, self._found = store.given_camera(), _found_focals(store)
        self._shared: dict[tuple[float, ...], int] = {}

    def of(self, number: int, detected: Detected) -> int:
        """Its number in the database."""
        size = orientation.stored_size(detected.orientation, detected.width, detected.height)
        if len(self._given) == 4:
            fx, fy, cx, cy = self._given
            if size != (detected.width, detected.height):
                fx, fy = fy, fx
            cx, cy = (_to_stored(detected) @ (cx, cy, 1))[:2] + 0.5
            key = (*size, fx, fy, cx, cy)
            if key not in self._shared:
                self._shared[key] = self._write(number, "PINHOLE", size, [fx, fy, cx, cy], True)
            return self._shared[key]
        given = self._given[0] if self._given else None
        focal = focal_of(given, self._found.get(number), detected.focal, max(size))
        known = given is not None or detected.focal is not None
        return self._write(number, "SIMPLE_RADIAL", size, [focal, size[0] / 2, size[1] / 2, 0.0], known)

    def _write(self, number: int, model: str, size: tuple[int, int], parameters: list[float], known: bool) -> int:
        camera = self._pycolmap.Camera(camera_id=number, model=model, width=size[0], height=size[1], params=parameters)
        camera.has_prior_focal_length = known
        return int(self._database.write_camera(camera, use_camera_id=True))


def _image(
    database: Any, pycolmap: Any, number: int, name: str, camera: int, detected: Detected, moved: NDArray[np.float32] | None
) -> None:
    database.write_image(pycolmap.Image(image_id=number, name=name, camera_id=camera), use_image_id=True)
    points = key_points(np.frombuffer(detected.features or b"", arrays.struct_type("asj_junction")))
    if moved is not None:
        points[:, :2] = moved + np.float32(0.5)
    matrix = _to_stored(detected)
    points[:, :2] = orientation.turn(matrix, points[:, :2] - np.float32(0.5)) + np.float32(0.5)
    points[:, 2:] = (matrix[:2, :2] @ points[:, 2:].reshape(-1, 2, 2)).reshape(-1, 4)
    database.write_keypoints(number, points)


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
