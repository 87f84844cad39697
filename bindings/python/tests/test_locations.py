# SPDX-License-Identifier: BSD-2-Clause
"""One location for each junction: known moves come back, matches that contradict the others do not matter."""

from __future__ import annotations

import asj
import numpy as np
import pytest
from asj import arrays
from asj.collection import locations
from conftest import panels

Record = np.ndarray


def _records(pairs: list[tuple[int, int]], affine: np.ndarray, aligned: np.ndarray) -> Record:
    records = np.zeros(len(pairs), arrays.struct_type("asj_junction_match"))
    records["junction1"], records["junction2"] = np.array(pairs).T
    records["affine"] = np.c_[affine, np.zeros(2)].ravel()
    records["x2"], records["y2"] = aligned.T
    return records


@pytest.fixture(scope="module")
def tracks() -> tuple[dict[int, np.ndarray], list[np.ndarray], list[tuple[int, int, Record]]]:
    """50 points in four images that turn and shrink; detected 0.4 px beside the truth, aligned to 0.02 px of where truth would be."""
    random = np.random.default_rng(3)
    true = [random.uniform(50, 400, (50, 2))]
    linear = [np.eye(2)]
    for turn in (0.2, -0.3, 0.5):
        linear.append((1 - abs(turn) / 2) * np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]))
        true.append(true[0] @ linear[-1].T)
    detected = {image: (xy + random.normal(0, 0.4, xy.shape)).astype(np.float32) for image, xy in enumerate(true)}
    matches = []
    for one in range(4):
        for two in range(one + 1, 4):
            a = linear[two] @ np.linalg.inv(linear[one])
            aligned = true[two] + (detected[one] - true[one]) @ a.T + random.normal(0, 0.02, true[two].shape)
            matches.append((one, two, _records([(k, k) for k in range(50)], a, aligned)))
    return detected, true, matches


def disagreement(xy: dict[int, np.ndarray], true: list[np.ndarray]) -> float:
    """px, root mean square over all pairs: how far apart points are that should be one, when brought to image 0."""
    to_first = [np.linalg.lstsq(points, true[0], rcond=None)[0] for points in true]
    places = np.stack([xy[image] @ to_first[image] for image in range(4)])
    return float(np.sqrt(places.var(axis=0).sum(axis=1).mean()))


def test_tracks(tracks: tuple[dict[int, np.ndarray], list[np.ndarray], list[tuple[int, int, Record]]]) -> None:
    detected, true, matches = tracks
    refined = locations.refine(detected, matches)
    assert disagreement(detected, true) > 0.4
    assert disagreement(refined, true) < 0.03
    for image in range(4):  # and no farther from the truth than before
        assert np.abs(refined[image] - true[image]).mean() < np.abs(detected[image] - true[image]).mean()


def test_wrong_matches_do_not_matter(tracks: tuple[dict[int, np.ndarray], list[np.ndarray], list[tuple[int, int, Record]]]) -> None:
    detected, true, matches = tracks
    wrong = [(one, two, records.copy()) for one, two, records in matches]
    wrong[0][2]["x2"][::5] += 6
    assert disagreement(locations.refine(detected, wrong), true) < 0.1


def test_a_pair_by_itself_keeps_the_aligned_points() -> None:
    one, two = asj.detect(panels()), asj.detect(panels(shift=(6, 4)))
    found = asj.match(one, two)
    refined = locations.refine({1: one.xy, 2: two.xy}, [(1, 2, found.matches)])
    first, second = found.indices.T
    moved = refined[2][second] - refined[1][first]
    assert np.median(np.linalg.norm(moved - (found.xy2 - found.xy1), axis=1)) < 0.02
    assert np.median(np.linalg.norm(moved - (6, 4), axis=1)) < 0.1
    alone = np.setdiff1d(np.arange(len(one)), first)
    assert np.array_equal(refined[1][alone], one.xy[alone])


def test_nothing_to_refine() -> None:
    places = np.zeros((3, 2), np.float32)
    assert np.array_equal(locations.refine({7: places}, [])[7], places)
    none = np.zeros(0, arrays.struct_type("asj_junction_match"))
    assert np.array_equal(locations.refine({7: places, 8: places}, [(7, 8, none)])[8], places)
