# SPDX-License-Identifier: BSD-2-Clause
"""Matching: a known shift, segments, bad junctions."""

from __future__ import annotations

import warnings
from pathlib import Path

import asj
import matplotlib
import numpy as np
import pytest
from conftest import Scene, panels

matplotlib.use("Agg")


@pytest.fixture(scope="module")
def pair(scene: Scene) -> tuple[asj.Features, asj.Features]:
    return asj.detect(scene), asj.detect(panels(shift=(6, 4)))


def test_shift(pair: tuple[asj.Features, asj.Features]) -> None:
    found = asj.match(*pair)
    assert len(found) >= 25
    moved = found.xy2 - found.xy1
    assert np.mean(np.linalg.norm(moved - (6, 4), axis=1) < 1) > 0.95
    assert np.allclose(found.xy1, pair[0].xy[found.indices[:, 0]])
    assert found.affine.shape == (len(found), 2, 3)
    mapped = np.einsum("kij,kj->ki", found.affine, np.c_[found.xy1, np.ones(len(found))])
    assert np.allclose(mapped, found.xy2, atol=1e-2)
    assert np.array_equal(found.l_junctions1["junction"][found.l_indices[:, 0]], found.indices[:, 0])
    assert (np.diff(found.distance) >= 0).all() and (found.ratio >= 1).all()


def test_segments(pair: tuple[asj.Features, asj.Features]) -> None:
    found = asj.match(*pair)
    both, cut = found.segments("both"), found.segments("cut")
    assert 0 < len(both[0]) <= len(cut[0]) and both[0].shape[1:] == (2, 2)
    assert np.median(np.linalg.norm(both[1] - both[0] - (6, 4), axis=2)) < 1
    with pytest.raises(ValueError, match="both"):
        found.segments("all")


def test_nothing_in_common(scene: Scene) -> None:
    assert len(asj.match(asj.detect(scene), asj.detect(np.full((50, 60), 9, np.uint8)))) == 0


def test_records(pair: tuple[asj.Features, asj.Features]) -> None:
    again = [asj.Features.from_records(one.image, one.junctions.tobytes()) for one in pair]
    assert np.array_equal(asj.match(*again).matches, asj.match(*pair).matches)
    with pytest.raises(asj.FormatError):
        asj.Features.from_records(pair[0].image, b"123")
    broken = pair[0].junctions.copy()
    broken["x"][0] = np.nan
    with pytest.raises(asj.ArgumentError):
        asj.match(asj.Features.from_records(pair[0].image, broken.tobytes()), pair[1])


def test_options(pair: tuple[asj.Features, asj.Features]) -> None:
    assert len(asj.match(*pair, ratio=10)) <= len(asj.match(*pair))
    with pytest.raises(asj.OptionError, match="did you mean"):
        asj.match(*pair, ratoi=2)


def test_warning_about_features_for_looking(scene: Scene, pair: tuple[asj.Features, asj.Features]) -> None:
    with pytest.warns(UserWarning, match='preset="match"'):
        asj.match(asj.detect(scene, preset="default"), pair[1])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        asj.match(*pair)


def test_plots(tmp_path: Path, scene: Scene, pair: tuple[asj.Features, asj.Features]) -> None:
    for number, axes in enumerate((asj.plot(scene, pair[0]), asj.plot_matches(scene, scene, asj.match(*pair)))):
        axes.figure.savefig(tmp_path / f"{number}.png")
        assert (tmp_path / f"{number}.png").stat().st_size > 10000
