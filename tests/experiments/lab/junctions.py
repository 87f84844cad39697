# SPDX-License-Identifier: BSD-2-Clause
"""Junctions as arrays, and the two file formats that hold them."""
import json
from dataclasses import dataclass

import numpy as np

MAX_BRANCHES = 5


@dataclass
class Junctions:
    """n junctions; angles (rad, from +x towards +y) and lengths (px) are n x MAX_BRANCHES, NaN beyond a junction's branches."""
    place: np.ndarray    # n x 2, px
    scale: np.ndarray    # n, px: the isotropic scale
    angle: np.ndarray
    length: np.ndarray
    pairs: np.ndarray    # L-junctions: m x 3, indices of junction, branch a, branch b

    def __len__(self):
        return len(self.scale)

    @property
    def count(self):
        return np.isfinite(self.angle).sum(1)

    def decomposed(self):
        """The L-junctions as junctions of two branches: how the authors' program reports them."""
        j, ab = self.pairs[:, 0], self.pairs[:, 1:]
        both = [_padded(np.take_along_axis(values[j], ab, 1)) for values in (self.angle, self.length)]
        pairs = np.column_stack([np.arange(len(j)), np.zeros(len(j), int), np.ones(len(j), int)])
        return Junctions(self.place[j], self.scale[j], both[0], both[1], pairs)

    def ends(self):
        """Far ends of the branches: n x MAX_BRANCHES x 2."""
        step = np.stack([np.cos(self.angle), np.sin(self.angle)], -1)
        return self.place[:, None, :] + self.length[..., None] * step


def _padded(values):
    out = np.full((len(values), MAX_BRANCHES), np.nan)
    out[:, :values.shape[1]] = values
    return out


def _all_pairs(angle):
    """Every pair of branches of each junction, for files that do not list L-junctions."""
    return np.array([(n, a, b) for n, row in enumerate(angle) for a in range(MAX_BRANCHES) for b in range(a + 1, MAX_BRANCHES)
                     if np.isfinite(row[b])], int).reshape(-1, 3)


def _build(records, pairs=None):
    """records: (x, y, scale, [(angle, length), ...])"""
    n = len(records)
    angle, length = np.full((n, MAX_BRANCHES), np.nan), np.full((n, MAX_BRANCHES), np.nan)
    for i, record in enumerate(records):
        for k, (theta, r) in enumerate(record[3]):
            angle[i, k], length[i, k] = theta % (2 * np.pi), r
    place = np.array([r[:2] for r in records], float).reshape(-1, 2)
    scale = np.array([r[2] for r in records], float)
    return Junctions(place, scale, angle, length, _all_pairs(angle) if pairs is None else pairs)


def read_json(path):
    """asj-junctions-1, as asj-cli writes it."""
    with open(path) as file:
        data = json.load(file)
    records = [(j["x"], j["y"], j["scale"], [(b["angle"], b["length"]) for b in j["branches"]]) for j in data["junctions"]]
    pairs = np.array([(p["junction"], p["a"], p["b"]) for p in data["l_junctions"]], int).reshape(-1, 3)
    return _build(records, pairs)


def read_asj(path):
    """.asj text (asj-formats(5)); a location that several records share stays several junctions."""
    with open(path) as file:
        words = iter(file.read().split())
    records = []
    for _ in range(int(next(words))):
        x, y = float(next(words)), float(next(words))
        branches, scale = int(next(words)), float(next(words))
        next(words), next(words)
        rows = [(float(next(words)), float(next(words)), float(next(words))) for _ in range(branches)]
        records.append((x, y, scale, [(theta, length) for theta, _, length in rows]))
    return _build(records)
