# SPDX-License-Identifier: BSD-2-Clause
"""Straight edges: each once, and which branches are parts of it."""

from __future__ import annotations

import asj
import numpy as np
import pytest


@pytest.fixture(scope="module")
def panels() -> asj.Features:
    """Four panels in a row, whose upper edges lie on one line with grey between them."""
    image = np.full((200, 420), 70, np.uint8)
    for left in range(20, 400, 100):
        image[40:140, left : left + 80] = 180
    return asj.detect(image, preset="default")


def test_each_edge_once(panels: asj.Features) -> None:
    found = asj.lines(panels)
    lengths = np.linalg.norm(found.segments[:, 1] - found.segments[:, 0], axis=1)
    assert len(panels) == 16 and len(panels.segments) == 32 and len(found) == 16
    assert np.all(np.diff(lengths) <= 0) and np.allclose(lengths, [100] * 8 + [80] * 8, atol=0.5)
    assert found.segments.dtype == np.float32 and found.log10_nfa.max() < -5
    assert np.array_equal(np.bincount(found.of_segments), found.records["branch_count"])


def test_branches_are_parts_of_lines(panels: asj.Features) -> None:
    found = asj.lines(panels)
    for (start, end), line in zip(panels.segments, found.segments[found.of_segments]):
        along = (line[1] - line[0]) / np.linalg.norm(line[1] - line[0])
        for point in (start, end):
            x, y = point - line[0]
            assert abs(along[0] * y - along[1] * x) < 2


def test_lines_outlive_what_they_come_from() -> None:
    image = np.full((90, 120), 60, np.uint8)
    image[21:71, 31:101] = 200
    segments = asj.lines(asj.detect(image, preset="default"), context=asj.Context()).segments
    assert np.allclose(np.sort(segments.reshape(-1, 2), axis=0)[[0, -1]], [[30.5, 20.5], [100.5, 70.5]], atol=0.1)


def test_nothing() -> None:
    found = asj.lines(asj.detect(np.full((60, 80), 90, np.uint8)))
    assert len(found) == 0 and found.segments.shape == (0, 2, 2) and found.of_segments.shape == (0,)
