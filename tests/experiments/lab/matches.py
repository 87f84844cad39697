# SPDX-License-Identifier: BSD-2-Clause
"""Matches of a pair as arrays, whoever found them."""
import csv
from dataclasses import dataclass, field

import numpy as np

NONE = np.zeros((0, 2))


@dataclass
class Matches:
    """Points p1 in image 1 and p2 in image 2, n x 2; segments from a to b in image 1 and 2, m x 2 each.
    Seconds: processor time of all that it took."""
    p1: np.ndarray = field(default_factory=lambda: NONE)
    p2: np.ndarray = field(default_factory=lambda: NONE)
    a1: np.ndarray = field(default_factory=lambda: NONE)
    b1: np.ndarray = field(default_factory=lambda: NONE)
    a2: np.ndarray = field(default_factory=lambda: NONE)
    b2: np.ndarray = field(default_factory=lambda: NONE)
    lines: tuple = None      # (a1, b1, a2, b2) merged lines, where the matcher has such
    any_order: bool = False  # the ends of a segment are in no order: those of image 2 may be swapped
    seconds: float = 0.0


def _columns(rows, *names):
    return np.array([[row[n] for n in names] for row in rows], float).reshape(-1, len(names))


def of_library(data, seconds):
    """asj-matches-1: the points of the matches, the two branches of each, and the merged lines."""
    rows, lines = data["matches"], data["lines"]
    p1, p2 = _columns(rows, "x1", "y1"), _columns(rows, "x2", "y2")
    far = [np.concatenate([_columns(rows, "ax%d" % i, "ay%d" % i), _columns(rows, "bx%d" % i, "by%d" % i)]) for i in (1, 2)]
    merged = tuple(_columns(lines, x + str(i), y + str(i)) for i in (1, 2) for x, y in (("x", "y"), ("ex", "ey")))
    return Matches(p1, p2, np.concatenate([p1, p1]), far[0], np.concatenate([p2, p2]), far[1], merged, False, seconds)


def of_lines_file(path):
    """CSV of a line matcher: the columns ax1,ay1,bx1,by1,ax2,ay2,bx2,by2 of a header; others are passed over."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    ends = [_columns(rows, e + "x" + i, e + "y" + i) for i in "12" for e in "ab"]
    return Matches(a1=ends[0], b1=ends[1], a2=ends[2], b2=ends[3], any_order=True, seconds=float("nan"))
