# SPDX-License-Identifier: BSD-2-Clause
"""Vanishing points: a box of known directions, seen by a known camera."""

from __future__ import annotations

import asj
import numpy as np
import pytest
from numpy.typing import NDArray

FOCAL, SIZE = 500.0, (480, 640)
CAMERA = np.array([[FOCAL, 0, 319.5], [0, FOCAL, 239.5], [0, 0, 1]])


def _turned() -> NDArray[np.float64]:
    """Camera coordinates from those of the room: 35 degrees about the vertical, 10 about the horizontal."""
    a, b = np.radians(35), np.radians(10)
    about_y = np.array([[np.cos(a), 0, -np.sin(a)], [0, 1, 0], [np.sin(a), 0, np.cos(a)]])
    return np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]]) @ about_y


def _walls() -> NDArray[np.uint8]:
    """Two walls and the floor with rectangles on them; each pixel's ray meets the nearest of the three."""
    turned = _turned()
    rows, columns = np.mgrid[0 : SIZE[0] : 0.5, 0 : SIZE[1] : 0.5] - 0.25
    rays = np.stack([columns - 319.5, rows - 239.5, np.full(rows.shape, FOCAL)], -1) / FOCAL @ turned
    image, depth = np.full(rows.shape, 128.0), np.full(rows.shape, np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        for axis, distance, base in ((0, 1.5, 90.0), (2, 3.0, 150.0), (1, 1.2, 200.0)):
            reach = distance / rays[..., axis]
            nearer = (reach > 0) & (reach < depth)
            places = np.nan_to_num(np.delete(rays * reach[..., None], axis, -1), posinf=0, neginf=0)
            cell = np.floor(places / 0.4).astype(np.int64)
            grey = base + 35 * np.sin(1.7 * cell[..., 0] + 4.1 * cell[..., 1] + axis)
            image, depth = np.where(nearer, grey, image), np.where(nearer, reach, depth)
    image = image.reshape(SIZE[0], 2, SIZE[1], 2).mean((1, 3))
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


@pytest.fixture(scope="module")
def walls() -> asj.Features:
    return asj.detect(_walls(), preset="default")


def _degrees_off(found: asj.VanishingPoints) -> float:
    assert found.directions is not None
    cosines = np.abs(found.directions @ _turned())  # rows: found; columns: those of the room
    return float(np.degrees(np.arccos(np.clip(cosines.max(1), -1, 1))).max())


def test_directions_with_a_camera(walls: asj.Features) -> None:
    found = asj.vanishing_points(walls, camera=CAMERA)
    assert len(found) == 3 and found.focal_source == "given" and found.camera == (FOCAL, FOCAL, 319.5, 239.5)
    assert _degrees_off(found) < 0.3
    assert (found.log10_nfa < -2).all() and (found.branch_count > 5).all()
    pixels = found.points @ np.linalg.inv(CAMERA).T
    assert np.allclose(np.abs((pixels / np.linalg.norm(pixels, axis=1)[:, None] * found.directions).sum(1)), 1, atol=1e-6)


def test_the_focal_length_is_found(walls: asj.Features) -> None:
    found = asj.vanishing_points(walls)
    assert found.focal_source == "found" and found.camera is not None
    assert abs(found.camera[0] / FOCAL - 1) < 0.02 and _degrees_off(found) < 1


def test_nothing_to_find() -> None:
    found = asj.vanishing_points(asj.detect(np.full((60, 80), 90, np.uint8)))
    assert len(found) == 0 and found.points.shape == (0, 3) and found.directions is None and found.camera is None


def test_bad_input(walls: asj.Features) -> None:
    with pytest.raises(asj.ArgumentError):
        asj.vanishing_points(walls, camera=-5.0)
    with pytest.raises(asj.OptionError):
        asj.vanishing_points(walls, epsilon=5.0)
