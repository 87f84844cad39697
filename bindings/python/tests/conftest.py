# SPDX-License-Identifier: BSD-2-Clause
"""Rendered scenes: no photographs are needed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

Scene = NDArray[np.uint8]


def panels(shift: tuple[float, float] = (0, 0), zoom: float = 1.0, size: tuple[int, int] = (360, 480), seed: int = 1) -> Scene:
    """Overlapping rectangles of many greys seen under a zoom and a shift, anti-aliased by 3 x 3 samples a pixel, with noise."""
    random = np.random.default_rng(seed)
    height, width = size
    places = random.uniform((20, 20, 30, 30), (width - 120, height - 120, 110, 100), (28, 4))
    greys = random.uniform(40, 215, len(places))
    fine = (np.arange(3) - 1) / 3
    y = (np.arange(height)[:, None] + fine).ravel()
    x = (np.arange(width)[:, None] + fine).ravel()
    x, y = (x - shift[0]) / zoom, (y - shift[1]) / zoom
    picture = np.full((len(y), len(x)), 128.0)
    for (left, top, wide, high), grey in zip(places, greys):
        rows, columns = (y > top) & (y < top + high), (x > left) & (x < left + wide)
        picture[np.ix_(rows, columns)] = grey
    picture = picture.reshape(height, 3, width, 3).mean((1, 3))
    return np.clip(np.rint(picture + np.random.default_rng(seed + 99).normal(0, 1, picture.shape)), 0, 255).astype(np.uint8)


@pytest.fixture(scope="session")
def scene() -> Scene:
    """A scene with some thirty rectangles."""
    return panels()


@pytest.fixture
def photographs(tmp_path: Path) -> Path:
    """A folder with five views of one scene, one of them in a folder of its own, and a file that is no image."""
    from PIL import Image

    folder = tmp_path / "photographs"
    (folder / "more").mkdir(parents=True)
    views: list[tuple[str, dict[str, Any]]] = [
        ("a.png", {}), ("b.png", {"shift": (6, 4)}), ("c.png", {"shift": (-9, 5), "zoom": 1.04}), ("more/d.png", {"zoom": 0.95}),
    ]  # fmt: skip
    for name, view in views:
        Image.fromarray(panels(**view)).save(folder / name)
    Image.fromarray(panels(seed=7)).save(folder / "other.png")
    (folder / "broken.png").write_bytes(b"\x89PNG\r\n\x1a\n, and then nothing that fits")
    return folder
