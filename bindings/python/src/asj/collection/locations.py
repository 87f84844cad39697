# SPDX-License-Identifier: BSD-2-Clause
"""One location for each junction that holds for all its matches.

A match is aligned on the pixels: it knows the place in image 2 of its junction in image 1 to a tenth of a pixel, while both junctions
were detected each by itself, to a third. Reconstruction wants one place for each junction, in all pairs. So each junction k may move by
d_k, and a match of i and j, whose map has the linear part A and which puts i a step e from where j was detected, asks for

    d_j - A d_i = e.

The sum of |d_k|^2 / PRIOR^2 and of the squared residuals in units of ALIGNED and of the scale of the map is least: a few rounds of
conjugate gradients, in which matches that contradict the others count less (weights of Cauchy). In a pair by itself both ends of a
match then stand where its alignment has them, as nearly as ALIGNED and PRIOR say; in a longer track the matches share the error. The
aligned points of single matches stay in the store.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .store import Store

PRIOR = 1.0  # px that a junction may stand wrong
ALIGNED = 0.1  # px that an alignment may be wrong
ROUNDS = 4  # of weights
STEPS = 30  # of conjugate gradients, at most

Array = NDArray[np.float64]


class Constraints:
    """What matches ask of junctions; `first` tells where the junctions of an image begin in a list of all."""

    def __init__(self, first: dict[int, int], total: int) -> None:
        self._first, self._total = first, total
        self._one: list[NDArray[np.int64]] = []
        self._two: list[NDArray[np.int64]] = []
        self._linear: list[Array] = []
        self._step: list[Array] = []

    def add(self, image1: int, image2: int, records: NDArray[np.void], xy2: NDArray[np.float32]) -> None:
        """The matches of two images; `xy2` are the locations of the junctions of image 2, as detected."""
        self._one.append(self._first[image1] + records["junction1"].astype(np.int64))
        self._two.append(self._first[image2] + records["junction2"].astype(np.int64))
        self._linear.append(records["affine"].reshape(-1, 2, 3)[:, :, :2])
        aligned = np.stack([records["x2"], records["y2"]], axis=1).astype(np.float64)
        self._step.append(aligned - xy2[records["junction2"]])

    def solve(self) -> Array:
        """(total, 2): the move of each junction, px."""
        if not self._one:
            return np.zeros((self._total, 2))
        one, two = np.concatenate(self._one), np.concatenate(self._two)
        linear, step = np.concatenate(self._linear), np.concatenate(self._step)
        # residuals are those of the smaller corner: a map that magnifies magnifies the error
        sd = ALIGNED * np.sqrt(np.maximum(np.abs(np.linalg.det(linear)), 1.0))
        moves = np.zeros((self._total, 2))
        weight = 1 / sd**2
        for _ in range(ROUNDS):
            moves = self._least(one, two, linear, step, weight, moves)
            residual = moves[two] - np.einsum("mij,mj->mi", linear, moves[one]) - step
            weight = 1 / (sd**2 + (residual**2).sum(axis=1) / 4)  # half the weight at a residual of two deviations
        return moves

    def _least(self, one: NDArray[np.int64], two: NDArray[np.int64], linear: Array, step: Array, weight: Array, start: Array) -> Array:
        def spread(residual: Array) -> Array:
            """J' W residual."""
            weighted = weight[:, None] * residual
            back = -np.einsum("mij,mi->mj", linear, weighted)
            return np.stack(
                [np.bincount(two, weighted[:, c], self._total) + np.bincount(one, back[:, c], self._total) for c in range(2)], axis=1
            )

        def normal(x: Array) -> Array:
            return spread(x[two] - np.einsum("mij,mj->mi", linear, x[one])) + x / PRIOR**2

        x = start.copy()
        gradient = spread(step) - normal(x)
        direction, size = gradient.copy(), float((gradient**2).sum())
        for _ in range(STEPS):
            if size < 1e-8:
                break
            turned = normal(direction)
            length = size / float((direction * turned).sum())
            x += length * direction
            gradient -= length * turned
            before, size = size, float((gradient**2).sum())
            direction = gradient + (size / before) * direction
        return x


def refine(xy: dict[int, NDArray[np.float32]], matches: Iterable[tuple[int, int, NDArray[np.void]]]) -> dict[int, NDArray[np.float32]]:
    """Locations of the junctions of each image that hold for all matches (image 1, image 2, records of asj_junction_match)."""
    first: dict[int, int] = {}
    total = 0
    for image, places in xy.items():
        first[image] = total
        total += len(places)
    constraints = Constraints(first, total)
    for image1, image2, records in matches:
        constraints.add(image1, image2, records, xy[image2])
    moves = constraints.solve().astype(np.float32)
    return {image: places + moves[first[image] : first[image] + len(places)] for image, places in xy.items()}


def matches_of(store: Store) -> Iterator[tuple[int, int, NDArray[Any]]]:
    """Image 1, image 2 and records of asj_junction_match of all pairs that have some."""
    for one, two, matched in store.matched():
        if matched.matches:
            yield one, two, matched.junction_matches


def of_store(store: Store) -> dict[int, NDArray[np.float32]]:
    """Where the junctions of each image stand for all their matches."""
    detected = {}
    for number, _, image in store.detected():
        if image.features is not None:
            junctions = image.junctions
            detected[number] = np.stack([junctions["x"], junctions["y"]], axis=1)
    return refine(detected, matches_of(store))
