# SPDX-License-Identifier: BSD-2-Clause
"""Pixels as a file stores them. Photographs are looked at upright, by their EXIF orientation; COLMAP, and what builds on it, reads the
pixels of the file and leaves the orientation alone. So what is written for them is turned back.

The matrices take pixels (x, y, 1) of the upright image, whose centres are whole numbers, to those of the stored one. Orientations as
in EXIF 2.3, tag 0x0112: 1 as it is, 3 upside down, 6 and 8 turned by a quarter, 2, 4, 5 and 7 mirrored as well.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]


def to_stored(orientation: int, width: int, height: int) -> Matrix:
    """From an upright image of that size."""
    right, low = width - 1, height - 1
    rows = {
        1: ((1, 0, 0), (0, 1, 0)), 2: ((-1, 0, right), (0, 1, 0)), 3: ((-1, 0, right), (0, -1, low)), 4: ((1, 0, 0), (0, -1, low)),
        5: ((0, 1, 0), (1, 0, 0)), 6: ((0, 1, 0), (-1, 0, right)), 7: ((0, -1, low), (-1, 0, right)), 8: ((0, -1, low), (1, 0, 0)),
    }  # fmt: skip
    return np.array([*rows.get(orientation, rows[1]), (0, 0, 1)], np.float64)


def stored_size(orientation: int, width: int, height: int) -> tuple[int, int]:
    """Width and height of the stored image."""
    return (height, width) if orientation in (5, 6, 7, 8) else (width, height)


def is_mirrored(orientation: int) -> bool:
    """No rotation of the camera takes one to the other then."""
    return orientation in (2, 4, 5, 7)


def turn(matrix: Matrix, xy: NDArray[np.float32]) -> NDArray[np.float32]:
    """Points (..., 2) of the upright image as points of the stored one."""
    return (xy @ matrix[:2, :2].T + matrix[:2, 2]).astype(np.float32)
