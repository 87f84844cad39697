# SPDX-License-Identifier: BSD-2-Clause
"""A COLMAP database of a collection, written through pycolmap, so that it has the form of the installed version.

Key points are the junctions, each where all its matches together put it (locations.py), with their affine shape, in the pixels of the
file (orientation.py), moved by half a pixel (COLMAP's first pixel has its centre at (0.5, 0.5)).
The shape takes the unit circle to an ellipse along two branches of the junction. Images have the numbers of the store, which they
keep. Their cameras are SIMPLE_RADIAL, with the focal length that was given, or the median of what the pairs of their images have found
with the motion, or that of the EXIF data, and 1.2 times the longer side elsewhere, as COLMAP itself guesses. It is marked as known where
it was given or EXIF data tell one. Which images have one camera is asked for in the words of pycolmap.CameraMode (CAMERA_MODES); it has
the number of the first of them. Where the whole camera was given, all images of one size have that one, PINHOLE.

Where an epipolar geometry was asked for and accepted, that is the pair's two-view geometry, with all its matches as inliers, since what
contradicts it has gone; calibrated, with its pose, where the cameras are those that it was found with. COLMAP's own verification gives
the others: a homography speaks for one plane only.
"""

from __future__ import annotations

import contextlib
import json
import os
import sqlite3
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..output import whole_file
from . import locations, orientation
from .store import Store
from .tasks import Detected


#: by equal make, model, focal lengths and size in EXIF data, and else an image a camera; one for all; one for each folder; one for each
CAMERA_MODES = ("auto", "single", "per-folder", "per-image")

_APPLICATION = int.from_bytes(b"asj\0", "big")  # of a database that was written here
_STORE = "asj_store"  # a table of our own, which COLMAP passes over: the identity of the store that the database was written from


def written_from(path: Path) -> str | None:
    """The identity of the store that write() wrote the database from; None where something else has written it."""
    with path.open("rb") as file:
        header = file.read(100)
    if not header.startswith(b"SQLite format 3\0") or int.from_bytes(header[68:72], "big") != _APPLICATION:
        return None
    try:  # "immutable": SQLite leaves no logs beside it
        with contextlib.closing(sqlite3.connect(f"{path.absolute().as_uri()}?immutable=1", uri=True)) as connection:
            row = connection.execute(f"SELECT identity FROM {_STORE}").fetchone()
    except sqlite3.DatabaseError:
        return None
    return str(row[0]) if row else None


def refuse_logs(path: Path) -> None:
    """Raises FileExistsError where a database has such logs."""
    if logs := logs_of(path):
        raise FileExistsError(f"{logs[0]} is there: another program has {path.name} open, or was killed; open it once, or remove both")


def logs_of(path: Path) -> list[Path]:
    """What SQLite keeps beside a database that is open, or whose program was killed; it would take them for those of the next one."""
    return [log for kind in ("-wal", "-shm", "-journal") if (log := path.with_name(path.name + kind)).exists()]


def write(
    store: Store, path: Path, verify: bool = True, refine: bool = True, threads: int = -1, camera_mode: str = "auto"
) -> None:
    """Everything in the store, in place of a database that is there; with `verify` also two-view geometries, which reconstruction needs,
    by so many `threads`. `refine`: junctions stand where their matches put them, not where each was detected. `camera_mode`: which images
    have one camera, refined as one (CAMERA_MODES, as in COLMAP): "auto" those whose EXIF data tell the same make, model, focal length
    and size; "single" all; "per-folder" those of a folder; "per-image" none. Raises ValueError where these are of several sizes, and
    OSError where the database cannot be written."""
    import pycolmap

    if camera_mode not in CAMERA_MODES:
        raise ValueError(f"there is no camera mode {camera_mode!r}: one of {', '.join(CAMERA_MODES)}")
    refuse_logs(path)
    with whole_file(path) as temporary:
        os.remove(temporary)
        try:
            _fill(store, pycolmap, temporary, refine, threads if verify else None, camera_mode)
        except RuntimeError as bad:  # SQLite's errors, by way of pycolmap
            raise OSError(f"{path}: {str(bad).splitlines()[0]}") from bad
        finally:
            for log in logs_of(temporary):
                log.unlink()


def _fill(store: Store, pycolmap: Any, path: Path, refine: bool, threads: int | None, camera_mode: str) -> None:
    database = pycolmap.Database.open(path)
    try:
        moved = locations.of_store(store) if refine else {}
        cameras = _write_cameras(pycolmap, database, store, camera_mode)
        for number, name, detected in store.detected():
            if detected.features is not None:
                _image(database, pycolmap, number, name, cameras[number], detected, moved.get(number))
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
        connection.execute(f"CREATE TABLE {_STORE} (identity TEXT NOT NULL)")
        connection.execute(f"INSERT INTO {_STORE} VALUES (?)", (store.identity(),))
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
                records = matched.junction_matches
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


def focal_of(given: float | None, found: Sequence[float], exif: Sequence[float], longer: float) -> float:
    """Of a camera, px: as it was given, or in the median of what the pairs of its images have found, or of EXIF data, or as COLMAP
    guesses it."""
    return given or (float(np.median(found or exif)) if found or exif else 1.2 * longer)


def shared_by(mode: str, number: int, name: str, image: Detected) -> tuple[object, ...]:
    """Equal for images that have one camera. What was cut, and has no focal length therefore, may have been cut differently each time."""
    if mode == "single":
        return ()
    if mode == "per-folder":
        return (name.rpartition("/")[0],)
    if mode == "auto" and image.camera and image.focal:
        return (image.camera, image.focal, *_size(image))
    return (number,)


def _size(image: Detected) -> tuple[int, int]:
    return orientation.stored_size(image.orientation, image.width, image.height)


def _write_cameras(pycolmap: Any, database: Any, store: Store, mode: str) -> dict[int, int]:
    """The number of each image's camera."""
    given, found = store.given_camera(), _found_focals(store)
    sharing: dict[tuple[object, ...], list[tuple[int, str, Detected]]] = {}
    for number, name, detected in store.detected():
        if detected.features is not None:
            image = replace(detected, features=None)
            key = (*_size(image), *_given_camera(given, image)) if len(given) == 4 else shared_by(mode, number, name, image)
            sharing.setdefault(key, []).append((number, name, image))
    cameras = {}
    for images in sharing.values():
        first, name, image = images[0]
        for _, other, view in images:
            if _size(view) != _size(image):
                sizes = [f"{wide} x {high}" for wide, high in (_size(image), _size(view))]
                raise ValueError(
                    f"camera mode {mode}: {name} has {sizes[0]} pixels and {other} {sizes[1]}: they are of two cameras "
                    "(--resume with another --camera-mode writes the database)"
                )
        if len(given) == 4:
            model, parameters, known = "PINHOLE", _given_camera(given, image), True
        else:
            told = [view.focal for _, _, view in images if view.focal is not None]
            together = [focal for number, _, _ in images for focal in found.get(number, [])]
            focal = focal_of(given[0] if given else None, together, told, max(_size(image)))
            model, parameters, known = "SIMPLE_RADIAL", [focal, _size(image)[0] / 2, _size(image)[1] / 2, 0.0], bool(given or told)
        camera = pycolmap.Camera(camera_id=first, model=model, width=_size(image)[0], height=_size(image)[1], params=parameters)
        camera.has_prior_focal_length = known
        database.write_camera(camera, use_camera_id=True)
        cameras.update({number: first for number, _, _ in images})
    return cameras


def _given_camera(given: list[float], image: Detected) -> list[float]:
    """Of the stored image, in COLMAP's pixels."""
    fx, fy, cx, cy = given
    if _size(image) != (image.width, image.height):
        fx, fy = fy, fx
    cx, cy = (_to_stored(image) @ (cx, cy, 1))[:2] + 0.5
    return [fx, fy, float(cx), float(cy)]


def _image(
    database: Any, pycolmap: Any, number: int, name: str, camera: int, detected: Detected, moved: NDArray[np.float32] | None
) -> None:
    database.write_image(pycolmap.Image(image_id=number, name=name, camera_id=camera), use_image_id=True)
    points = key_points(detected.junctions)
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
