# SPDX-License-Identifier: BSD-2-Clause
"""Matching: a known shift, segments, bad junctions."""

from __future__ import annotations

import os
import pickle
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import asj
import matplotlib.pyplot
import numpy as np
import pytest
from asj._native import ffi, lib
from asj.geometry import read as read_geometry
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
    joined = found.segments("both", joined=True)
    assert 0 < len(joined[0]) < len(both[0])
    assert np.median(np.linalg.norm(joined[1] - joined[0] - (6, 4), axis=2)) < 1
    with pytest.raises(ValueError, match="both"):
        found.segments("all")


@pytest.mark.parametrize("joined", [False, True])
def test_segments_are_branches(pair: tuple[asj.Features, asj.Features], joined: bool) -> None:
    found = asj.match(*pair)
    *seen, which = found.segments("cut", joined=joined)
    numbers = found.segment_indices("cut", joined=joined)
    assert numbers.shape == (len(which), 2)
    for side, features in enumerate(pair):
        assert np.array_equal(features.branches["junction"][numbers[:, side]], found.indices[which, side])
        one, two = (np.diff(segments, axis=1)[:, 0] for segments in (features.segments[numbers[:, side]], seen[side]))
        along = np.abs((one * two).sum(axis=1)) if joined else (one * two).sum(axis=1)
        assert (along > 0.97 * np.linalg.norm(one, axis=1) * np.linalg.norm(two, axis=1)).all()


def test_stretched_images(scene: Scene) -> None:
    second = panels(shift=(6, 4))
    plain, by_two = asj.match_images(scene, second, stretch=1), asj.match(asj.detect(scene), asj.detect(second))
    assert np.array_equal(plain.matches, by_two.matches) and not hasattr(plain, "features1")
    for stretch in (2, (1.0, 1.5)):
        found = asj.match_images(scene, second, stretch=stretch)
        assert len(found) >= 25
        assert np.mean(np.linalg.norm(found.xy2 - found.xy1 - (6, 4), axis=1) < 1) > 0.9
        assert np.array_equal(found.xy1[:, 0], found.l_junctions1["x"][found.l_indices[:, 0]])
        assert found.stretch == (stretch if isinstance(stretch, tuple) else (stretch, stretch))
    with pytest.raises(asj.OptionError, match="stretch"):
        asj.match_images(scene, second, stretch=0.4)
    for wrong in ((1, 2, 3), ("x", "y"), {}):
        with pytest.raises(asj.ArgumentError, match="one for x and one for y"):
            asj.match_images(scene, second, stretch=wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="of 0"):
        asj.match_images(scene, second, stretch=(0, 0))
    with pytest.raises(ValueError, match="'much'"):
        asj.match_images(scene, second, stretch="much")


def test_images_of_another_white(scene: Scene) -> None:
    second = panels(shift=(6, 4))
    deep, floats = ([one.astype(kind) for one in (scene, second)] for kind in (np.uint16, np.float64))
    with pytest.raises(asj.ImageError, match="white=255"):
        asj.match_images(*floats, stretch=1)
    plain = asj.match_images(scene, second, stretch=1).matches
    for images in (deep, floats):
        assert np.array_equal(asj.match_images(*images, stretch=1, white=255).matches, plain)


def test_upsampled_by_themselves(scene: Scene) -> None:
    second = panels(shift=(6, 4))
    plain, found = asj.match_images(scene, second, stretch=1), asj.match_images(scene, second)
    assert found.upsampled and not plain.upsampled and found.stretch == (1, 1) and not found.coloured
    assert len(found) > len(plain)
    assert np.mean(np.linalg.norm(found.xy2 - found.xy1 - (6, 4), axis=1) < 1) > 0.9
    assert np.array_equal(found.xy1[:, 0], found.l_junctions1["x"][found.l_indices[:, 0]])
    assert np.array_equal(found.matches, asj.match_images(scene, second, stretch="auto").matches)
    assert np.array_equal(plain.matches, asj.match_images(scene, second, upsample_from=0).matches)


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
    with pytest.raises(asj.OptionError, match=r"'minimum_length': it is one of asj.detect\(\)"):
        asj.match(*pair, minimum_length=9)
    with pytest.raises(asj.OptionError, match="did you mean geometry"):
        asj.match(*pair, geometri="auto")
    with pytest.raises(asj.OptionError, match="did you mean stretch"):
        asj.match_images(pair[0].image, pair[1].image, strech=2)


def test_features_are_described_once(pair: tuple[asj.Features, asj.Features]) -> None:
    one, two = (asj.detect(image) for image in (pair[0].image, pair[1].image))
    expected = asj.match(one, two).matches
    described = one._described
    assert described is not None and np.array_equal(asj.match(one, two, ratio=2, minimum_support=1).features1.xy, one.xy)
    assert one._described is described  # options of the pair change nothing in them
    asj.match(one, two, descriptor="sift")
    assert one._described is not described
    with ThreadPoolExecutor(3) as threads:
        for found in threads.map(lambda _: asj.match(one, two).matches, range(6)):
            assert np.array_equal(found, expected)


def test_files_of_features(tmp_path: Path, pair: tuple[asj.Features, asj.Features]) -> None:
    pair[0].save(tmp_path / "one.asjf")
    loaded = asj.load_features(tmp_path / "one.asjf")
    expected = asj.match(*pair)
    assert np.array_equal(asj.match(loaded, pair[1]).matches, expected.matches)
    assert np.array_equal(asj.match(pickle.loads(pickle.dumps(loaded)), pair[1]).matches, expected.matches)
    assert np.array_equal(loaded.xy, pair[0].xy) and len(loaded.l_junctions) > 20 and (loaded.width, loaded.height) == (480, 360)
    with pytest.raises(asj.OptionError, match="descriptor raw, not sift"):
        asj.match(loaded, pair[1], descriptor="sift")
    with pytest.raises(AttributeError):
        _ = loaded.image
    data = (tmp_path / "one.asjf").read_bytes()
    for bad in (b"", data[:100], data[:-1], data[:500] + b"?" + data[501:]):
        (tmp_path / "bad.asjf").write_bytes(bad)
        with pytest.raises(asj.FormatError):
            asj.load_features(tmp_path / "bad.asjf")
    with pytest.raises(asj.FormatError, match="no features"):
        asj.load_features("/dev/zero")
    with pytest.raises(FileNotFoundError):
        pair[0].save(tmp_path / "nowhere" / "one.asjf")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bad.asjf", "one.asjf"]
    mask = os.umask(0o022)
    pair[0].save(tmp_path / "bad.asjf")
    os.umask(mask)
    assert (tmp_path / "bad.asjf").stat().st_mode & 0o777 == 0o644 and (tmp_path / "bad.asjf").read_bytes() == data


def test_features_into_what_is_no_file(tmp_path: Path, pair: tuple[asj.Features, asj.Features]) -> None:
    """A link and a pipe stay what they are."""
    (tmp_path / "link").symlink_to("one.asjf")
    pair[0].save(tmp_path / "link")
    assert (tmp_path / "link").is_symlink() and not (tmp_path / "one.asjf").is_symlink()
    os.mkfifo(tmp_path / "pipe")
    with ThreadPoolExecutor(1) as threads:
        read = threads.submit((tmp_path / "pipe").read_bytes)
        pair[0].save(tmp_path / "pipe")
        assert read.result(10) == (tmp_path / "one.asjf").read_bytes()
    assert (tmp_path / "pipe").is_fifo()


def test_images_are_no_features(pair: tuple[asj.Features, asj.Features]) -> None:
    blank = np.zeros((30, 40), np.uint8)
    for call in (lambda: asj.match(pair[0], blank), lambda: asj.lines(blank), lambda: asj.vanishing_points(blank)):  # type: ignore[arg-type]
        with pytest.raises(asj.ArgumentError, match="features are wanted, not ndarray"):
            call()
    with pytest.raises(TypeError, match=r"send \.matches"):
        pickle.dumps(asj.match(*pair))


def test_rival_of_a_geometry() -> None:
    record = ffi.new("asj_geometry *", {"status": lib.ASJ_GEOMETRY_AMBIGUOUS, "model": lib.ASJ_GEOMETRY_ESSENTIAL, "log10_nfa": -30})
    found = read_geometry(record)
    assert found is not None and not found and found.status == "ambiguous"
    assert found.rival_log10_nfa is None and found.rival_rotation is None and found.rival_translation is None
    assert found.cameras is None and found.focal == (0, 0) and found.picture_agreement is None
    record.has_rival, record.rival_log10_nfa, record.picture_agreement = 1, -25.5, 0.75
    record.rival_rotation = [0, -1, 0, 1, 0, 0, 0, 0, 1]
    record.rival_translation = [0, 0, -1]
    found = read_geometry(record)
    assert found is not None and found.rival_log10_nfa == -25.5 and found.picture_agreement == 0.75
    assert found.rival_rotation is not None and (found.rival_rotation @ (1, 0, 0) == (0, 1, 0)).all()
    assert found.rival_translation is not None and (found.rival_translation == (0, 0, -1)).all()


def test_camera_that_only_turns() -> None:
    record = ffi.new("asj_geometry *", {"status": lib.ASJ_GEOMETRY_ACCEPTED, "model": lib.ASJ_GEOMETRY_HOMOGRAPHY, "only_turns": 1})
    record.rotation = [0, -1, 0, 1, 0, 0, 0, 0, 1]
    record.covariance = [0.25] + 35 * [0]
    found = read_geometry(record)
    assert found is not None and found and found.rotation is None and found.translation is None and found.covariance is None
    assert found.turn is not None and (found.turn @ (1, 0, 0) == (0, 1, 0)).all() and "only turns" in repr(found)
    assert found.turn_covariance is not None and found.turn_covariance.shape == (3, 3) and found.turn_covariance[0, 0] == 0.25
    record.only_turns = 0
    found = read_geometry(record)
    assert found is not None and found.turn is None and found.turn_covariance is None


def test_geometry(pair: tuple[asj.Features, asj.Features]) -> None:
    plain = asj.match(*pair)
    assert plain.geometry is None and plain.probability.shape == (len(plain),) and plain.probability.dtype == np.float32
    assert np.isnan(plain.probability).all() and not plain.probability.flags.writeable
    apart = asj.match(pair[0], asj.detect(panels(seed=9)), geometry="essential", camera1=500)
    assert not apart.geometry and not apart.probability.any()
    found = asj.match(*pair, geometry="homography")
    assert found.geometry and found.geometry.model == "homography" and found.geometry.log10_nfa < -7
    moved = found.geometry.matrix @ (100, 50, 1)
    assert np.allclose(moved[:2] / moved[2], (106, 54), atol=0.3)
    assert (found.probability > 0.5).mean() > 0.8 and found.geometry.rotation is None
    for camera in (500.0, (500, 500, 239.5, 179.5), np.array([[500, 0, 239.5], [0, 500, 179.5], [0, 0, 1]])):
        assert asj.match(*pair, geometry="auto", camera1=camera).geometry
    posed = asj.match(*pair, geometry="essential", camera1=(600, 610, 300, 200), camera2=500).geometry
    assert posed is not None and posed.cameras is not None and posed.focal == (600, 500)
    assert posed.cameras[0].tolist() == [600, 610, 300, 200] and posed.cameras[1, 0] == posed.cameras[1, 1] == 500
    with pytest.raises(asj.OptionError, match="auto"):
        asj.match(*pair, geometry="affine")
    with pytest.raises(asj.OptionError, match="changes nothing"):
        asj.match(*pair, camera1=500)
    matrix = np.array([[500, 0, 239.5], [0, 500, 179.5], [0, 0, 1]])
    for bad, why in ((matrix.T, r"last row of a matrix K is \(0, 0, 1\), not \(239.5, 179.5, 1\): is it transposed"),
                     (matrix * [[1], [1], [0]], "last row"), (matrix + [[0, 0, 0], [9, 0, 0], [0, 0, 0]], "second row, not 9")):
        with pytest.raises(asj.ArgumentError, match=why):
            asj.match(*pair, geometry="auto", camera1=bad)
    assert asj.match(*pair, geometry="auto", camera1=2 * matrix).geometry  # of any scale
    for wrong in ((1, 2), -5.0, np.full((3, 3), np.nan)):
        with pytest.raises(asj.ArgumentError):
            asj.match(*pair, geometry="auto", camera1=wrong)


def test_cameras_with_swapped_numbers(pair: tuple[asj.Features, asj.Features]) -> None:
    """cx, cy, fx, fy would give a pose, and a wrong one."""
    swapped = (239.5, 179.5, 500, 500)
    question = "is this cx,cy,fx,fy"
    with pytest.raises(asj.ArgumentError, match=question):
        asj.vanishing_points(pair[0], camera=swapped)
    with pytest.raises(asj.ArgumentError, match="is outside of the image.*image 480 x 360"):
        asj.match(*pair, geometry="essential", camera1=500, camera2=swapped)
    aside = (500, 500, 380, 179.5)  # farther from the middle than a quarter of the width
    cut = np.array([[500, 0, 500], [0, 500, 179.5], [0, 0, 1]])
    for camera in (aside, cut, (500, 500, -1, 179.5)):
        for call in (
            lambda: asj.match(*pair, geometry="auto", camera1=camera),  # noqa: B023
            lambda: asj.vanishing_points(pair[0], camera=camera),  # noqa: B023
        ):
            with pytest.warns(UserWarning, match="another size, or before the image was cut") as seen:
                call()
            assert seen[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        asj.match(*pair, geometry="auto", camera1=(500, 500, 350, 95))


def test_geometry_with_colours(scene: Scene, tmp_path: Path) -> None:
    """Tints of things are seen, in numpy arrays too, and a redder light in the other image is none of them."""
    tints = np.random.default_rng(3).uniform(0.6, 1.0, (256, 3))

    def tinted(picture: Scene, light: tuple[float, float, float] = (1, 1, 1)) -> Scene:
        return np.clip(picture[..., None] * tints[(picture // 4) * 4] * light, 0, 255).astype(np.uint8)

    grey = [asj.detect(picture) for picture in (scene, panels(shift=(6, 4)))]
    coloured = [asj.detect(tinted(scene)), asj.detect(tinted(panels(shift=(6, 4)), (1, 0.9, 0.8)))]
    for name, features in zip("gc", (grey[0], coloured[0])):
        features.save(tmp_path / name)
    colours, junctions = 36, min(len(grey[0].junctions), len(coloured[0].junctions))
    assert (tmp_path / "c").stat().st_size > (tmp_path / "g").stat().st_size + colours * junctions // 2
    for other in (grey[1], coloured[1]):
        found = asj.match(coloured[0], other, geometry="homography")
        assert found.geometry and found.geometry.log10_nfa < -7 and (found.probability > 0.5).mean() > 0.8
        moved = found.geometry.matrix @ (100, 50, 1)
        assert np.allclose(moved[:2] / moved[2], (106, 54), atol=0.5)


def test_warning_about_features_for_looking(scene: Scene, pair: tuple[asj.Features, asj.Features]) -> None:
    with pytest.warns(UserWarning, match='preset="match"'):
        asj.match(asj.detect(scene, preset="default"), pair[1])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        asj.match(*pair)


def test_presets_of_images(scene: Scene) -> None:
    second = np.roll(scene, (3, 5), (0, 1))
    found = asj.match_images(scene, second, preset="paper")
    plain = asj.match(asj.detect(scene, preset="paper"), asj.detect(second, preset="paper"), preset="paper")
    assert found.stretch == (1, 1) and np.array_equal(found.matches["x1"], plain.matches["x1"]) and len(found) > 5


def test_plots(tmp_path: Path, scene: Scene, pair: tuple[asj.Features, asj.Features]) -> None:
    for number, axes in enumerate((asj.plot(scene, pair[0]), asj.plot_matches(scene, scene, asj.match(*pair)))):
        axes.figure.savefig(tmp_path / f"{number}.png")
        assert (tmp_path / f"{number}.png").stat().st_size > 10000
    from asj.plot import _hues

    with_legend, without = asj.plot(scene, pair[0]), asj.plot(scene, pair[0], legend=False)
    assert len(without.child_axes) == 0 and "log10 NFA" in with_legend.child_axes[0].child_axes[0].get_xlabel()
    assert len(asj.plot(scene[:100, :100], asj.detect(scene[:100, :100], preset="default")).child_axes) == 0  # no room
    places = np.random.default_rng(1).uniform(0, 640, 300)  # neighbours have hues that differ, wherever they are
    hues = _hues(places)[np.argsort(places)]
    for step in (1, 2, 3):
        apart = np.abs(hues[step:] - hues[:-step])
        assert np.minimum(apart, 1 - apart).min() > 0.1
    assert len(_hues(places[:0])) == 0
    deep = np.repeat(scene[:, :, None], 3, 2).astype(np.uint16) * 257
    shown = asj.plot(deep, pair[0], pale=False).images[0].get_array()
    assert np.abs(shown[:, :, 1].astype(float) / shown.max() - scene / scene.max()).max() < 0.01
    pale = asj.plot(deep, pair[0]).images[0].get_array()[:, :, 1].astype(float)
    assert np.abs(pale - (255 - 0.45 * (255 - shown[:, :, 1]))).max() <= 1
    drawn = with_legend.collections[0].get_array()  # of the branches, each by itself, the surest on top
    assert np.array_equal(drawn, -pair[0].branches["log10_nfa"][::-1]) and len(np.unique(drawn)) > len(pair[0])
    with pytest.raises(asj.ImageError, match="pixels"):
        asj.plot("scene.png", pair[0])


def test_plots_of_odd_images(scene: Scene, pair: tuple[asj.Features, asj.Features]) -> None:
    """What detect() takes is shown, without a warning of numpy; what it refuses is refused with its error."""
    holes = scene / 255
    holes[:2, :3] = np.nan, np.inf, -np.inf
    matches = asj.match(*pair)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plain = asj.plot(scene, pair[0]).images[0].get_array()
        shown = asj.plot(holes, pair[0]).images[0].get_array()
        assert np.abs(plain[2:, 3:].astype(int) - shown[2:, 3:]).max() <= 1
        assert asj.plot(-1 - scene.astype(int), pair[0]).images[0].get_array().max() == 140  # black, which is pale
        assert np.array_equal(asj.plot(scene[:, :, None], pair[0]).images[0].get_array(), plain)
        assert asj.plot_matches(scene[:, :, None], scene > 99, matches).images[0].get_array().shape == (360, 960, 3)
        matplotlib.pyplot.close("all")
    for bad in (scene[:0], np.stack([scene] * 2, 2), scene[0]):
        with pytest.raises(asj.ImageError):
            asj.plot(bad, pair[0])
        with pytest.raises(asj.ImageError):
            asj.plot_matches(scene, bad, matches)
    with pytest.raises(asj.ArgumentError, match="features are wanted, not Matches"):
        asj.plot(scene, matches)  # type: ignore[arg-type]
    with pytest.raises(asj.ArgumentError, match="matches are wanted, not Features"):
        asj.plot_matches(scene, scene, pair[0])  # type: ignore[arg-type]
