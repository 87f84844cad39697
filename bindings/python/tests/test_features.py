# SPDX-License-Identifier: BSD-2-Clause
"""Detection: values, types of images, memory, bad input."""

from __future__ import annotations

import gc
import os
import pickle
import signal
import threading
import time
import warnings
from pathlib import Path
from typing import Any

import asj
import numpy as np
import pytest
from conftest import Scene, panels


def square() -> Scene:
    image = np.zeros((200, 200), np.uint8)
    image[60:140, 60:140] = 255
    return image


def corners(features: asj.Features) -> list[list[float]]:
    return sorted(np.round(features.xy * 2).astype(float).tolist())


CORNERS = sorted([[119.0, 119.0], [119.0, 279.0], [279.0, 119.0], [279.0, 279.0]])


def test_square() -> None:
    features = asj.detect(square(), preset="default")
    assert corners(features) == CORNERS
    assert len(features.branches) == 8 and features.segments.shape == (8, 2, 2)
    assert np.allclose(np.linalg.norm(features.segments[:, 1] - features.segments[:, 0], axis=1), features.branches["length"], atol=1e-3)
    assert features.l_junctions["junction"].tolist() == [0, 1, 2, 3]
    assert (features.branches["end"] == 1).all()  # at junctions
    sides = [features.xy[edge["junction_a"]] - features.xy[edge["junction_b"]] for edge in features.edges]
    assert len(sides) == 4 and np.allclose(np.linalg.norm(sides, axis=1), 80, atol=0.2)
    assert (features.log10_nfa < 0).all() and (features.uncertainty > 0).all()
    assert features.xy.base is not None and not features.xy.flags.writeable


@pytest.mark.parametrize(
    "same",
    [
        lambda g: g.astype(np.uint16) * 257, lambda g: (g / 255).astype(np.float32), lambda g: g / 255, lambda g: np.stack([g] * 3, 2),
        lambda g: np.stack([g] * 4, 2), lambda g: g.astype(bool), lambda g: np.asfortranarray(g), lambda g: np.pad(g, 7)[7:-7, 7:-7],
        lambda g: g[::-1, ::-1][::-1, ::-1], lambda g: g.astype(">u2") * 257, lambda g: g[:, :, None], lambda g: g.tolist()
        and np.array(g.tolist(), np.uint8),
    ],
)  # fmt: skip
def test_image_types(same: Any) -> None:
    assert corners(asj.detect(same(square()), preset="default")) == CORNERS


@pytest.mark.parametrize("mode", ["1", "L", "LA", "P", "PA", "RGB", "RGBA", "RGBX", "CMYK", "YCbCr", "HSV", "I", "I;16", "F"])
def test_images_of_pillow(tmp_path: Path, mode: str) -> None:
    """Samples of a palette, hues and inks are no grey levels."""
    from PIL import Image

    gray = Image.fromarray(np.where(square() > 0, 255, 0).astype(np.uint8))
    if mode == "P":
        image = Image.fromarray(np.where(square() > 0, 3, 200).astype(np.uint8))  # numbers of a palette that say nothing
        image.putpalette([255 if number == 3 else 0 for number in range(256) for _ in range(3)])
    elif mode in ("I;16", "F"):
        image = Image.fromarray(square().astype(np.uint16) * 257 if mode == "I;16" else square().astype(np.float32) / 255)
    elif mode == "I":
        image = Image.fromarray(square().astype(np.int32) * 257)
    else:
        image = gray.convert("P" if mode == "PA" else "RGB" if mode in ("CMYK", "YCbCr", "HSV", "RGBX") else mode).convert(mode)
    assert image.mode == mode and corners(asj.detect(image, preset="default")) == CORNERS


def test_images_of_pillow_are_as_their_files(tmp_path: Path, scene: Scene) -> None:
    from PIL import Image

    picture = Image.fromarray(scene[:200]).convert("RGB").quantize(64)
    data = Image.Exif()
    data[0x0112] = 6
    picture.save(tmp_path / "turned.png", exif=data)
    read = asj.read_image(tmp_path / "turned.png")
    with Image.open(tmp_path / "turned.png") as file:
        assert file.mode == "P"
        found = asj.detect(file)
        assert asj.plot(file, found).images[0].get_array().shape == read.shape
    assert read.shape == (480, 200, 3) and (found.width, found.height) == (200, 480) and np.array_equal(found.image, read)
    with pytest.raises(asj.ImageError, match="an image of mode La: "):
        asj.detect(Image.new("La", (40, 30)))
    with pytest.raises(asj.ImageError, match="16 bits"):
        asj.detect(Image.fromarray(np.full((30, 40), 70000, np.int32)))
    with pytest.raises(asj.ImageError, match="convert it to L"):
        asj.detect(Image.fromarray(scene).convert("L").convert("I"))


def test_colours_of_other_types(scene: Scene) -> None:
    """Greys give the same junctions whatever the type; colours nearly so, since their grey is rounded."""
    kinds = (lambda pixels: pixels, lambda pixels: pixels.astype(np.uint16) * 257, lambda pixels: pixels / 255)
    gray = [asj.detect(kind(scene)).junctions for kind in kinds]
    assert np.array_equal(gray[0], gray[1]) and np.array_equal(gray[0], gray[2])
    coloured = np.stack([scene, np.roll(scene, 3, 0), scene // 2], 2)
    eight, *others = (asj.detect(kind(coloured), preset="default").xy for kind in kinds)
    for other in others:
        apart = np.linalg.norm(eight[:, None] - other[None], axis=2).min(axis=1)
        assert (apart < 0.5).mean() > 0.95 and abs(len(eight) - len(other)) <= 3


def test_floats_need_a_white() -> None:
    bright = square().astype(float)
    with pytest.raises(asj.ImageError, match="white=255"):
        asj.detect(bright)
    with pytest.raises(asj.ImageError, match="NaN or infinity"):
        asj.detect(np.where(bright > 100, np.inf, bright))
    assert corners(asj.detect(bright, white=255, preset="default")) == CORNERS
    assert corners(asj.detect(bright / 255 * 1.1, preset="default")) == CORNERS


def test_floats_beyond_single_precision() -> None:
    """Finite ones are cut at white as others are, without a warning of numpy."""
    for sample, type_ in ((1e300, np.float64), (-1e300, np.float64), (1e39, np.longdouble)):
        image = (square() / 255).astype(type_)
        image[100, 100] = sample
        for pixels in (image, np.stack([image] * 3, 2)):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                found = corners(asj.detect(pixels, white=1, preset="default"))
                assert all(corner in found for corner in CORNERS)
                if sample > 0:
                    with pytest.raises(asj.ImageError, match="white=255"):
                        asj.detect(pixels)


@pytest.mark.parametrize("shape", [(1 << 20, 1 << 20), (1, 1 << 31), (1 << 31, 1), (1 << 15, (1 << 14) + 1, 3)])
@pytest.mark.parametrize("type_", [np.uint8, np.float64])
def test_too_many_pixels_are_not_copied(shape: tuple[int, ...], type_: type) -> None:
    with pytest.raises(asj.LimitError, match="more than the library takes"):
        asj.detect(np.broadcast_to(type_(0), shape))


def test_part_of_the_image() -> None:
    left = [corner for corner in CORNERS if corner[0] < 200]
    allowed = np.zeros((200, 200), bool)
    allowed[:, :100] = True
    assert corners(asj.detect(square(), preset="default", region=(0, 0, 100, 200))) == left
    assert corners(asj.detect(square(), preset="default", mask=allowed)) == left
    assert corners(asj.detect(square(), preset="default", mask=allowed[::-1], region=(0, 0, 200, 100))) == left[:1]
    for region in ((0, 0, 10), (0.5, 0, 10, 10), "abcd", (10**30, 0, 1, 1), 5):
        with pytest.raises(asj.ArgumentError, match="four whole numbers"):
            asj.detect(square(), region=region)  # type: ignore[arg-type]
    for region in ((1, 0, 200, 200), (0, 0, 0, 0), (5, 5, 0, 5), (-1, 0, 5, 5)):
        with pytest.raises(ValueError):
            asj.detect(square(), region=region)
    with pytest.raises(ValueError, match="mask of 199 x 200"):
        asj.detect(square(), mask=allowed[:, 1:])


def test_views_are_not_copied(scene: Scene) -> None:
    padded = np.pad(scene, 5)
    part = padded[5:-5, 5:-5]
    assert np.shares_memory(asj.detect(part).image, padded)
    assert np.shares_memory(asj.detect(part[::-1]).image, padded)


def test_a_single_row_or_column() -> None:
    """numpy gives them any stride."""
    image = np.arange(60, dtype=np.uint8).reshape(6, 10)
    for part in (image[2:3], image.T[3:4], image[:, 4:5], image[::-1][:1], np.lib.stride_tricks.as_strided(image, (1, 10), (1, 1)),
                 np.lib.stride_tricks.as_strided(image, (10, 1), (1, 77)), np.broadcast_to(image[:1], (3, 10))):
        assert len(asj.detect(part)) == 0 and np.array_equal(asj.detect(part).image, part)


def test_colour_order() -> None:
    image = np.zeros((200, 200, 3), np.uint8)
    image[:, :, 2] = square() // 2  # blue is dark: 29 of 256
    gray = ((square() // 2).astype(int) * 29 + 128) >> 8
    one, two = asj.detect(image), asj.detect(gray.astype(np.uint8))
    assert np.array_equal(one.junctions, two.junctions)


@pytest.mark.parametrize(
    ("bad", "error"),
    [
        (np.zeros((3, 3, 5), np.uint8), asj.ImageError), (np.zeros(9, np.uint8), asj.ImageError), (np.zeros((0, 4), np.uint8), asj.ImageError),
        (np.full((9, 9), np.nan), asj.ImageError), (np.full((9, 9), np.inf, np.float32), asj.ImageError), (np.zeros((4, 4), complex), asj.ImageError),
        (np.zeros((4, 4), np.int32), asj.ImageError), (np.zeros((2, 70000), np.uint8), asj.LimitError), (None, asj.ImageError),
        ("a.png", asj.ImageError), (np.zeros((2, 2, 2, 2), np.uint8), asj.ImageError),
    ],
)  # fmt: skip
def test_bad_images(bad: Any, error: type[asj.Error]) -> None:
    with pytest.raises(error):
        asj.detect(bad)


def test_options() -> None:
    assert asj.detect(square(), preset="default", minimum_length=30).options["minimum_length"] == "30"
    assert len(asj.detect(square(), preset="default", minimum_length=500)) == 0
    assert asj.detect(square(), isotropic_radii=(5, 9), strip_test=False).options["isotropic_radii"] == "5,9"
    for radii in ((5.9, 9), ("small",)):
        with pytest.raises(asj.OptionError, match="isotropic_radii: '.*' is not a set of radii"):
            asj.detect(square(), isotropic_radii=radii)
    with pytest.raises(asj.OptionError, match="did you mean minimum_length"):
        asj.detect(square(), minimum_lenght=3)
    with pytest.raises(asj.OptionError, match=r"'ratio': it is one of asj.match\(\)"):
        asj.detect(square(), ratio=1.8)
    with pytest.raises(asj.OptionError, match="did you mean region"):
        asj.detect(square(), regoin=(0, 0, 9, 9))
    with pytest.raises(asj.OptionError, match="0 .. 1000"):
        asj.detect(square(), minimum_length=-1)
    with pytest.raises(asj.OptionError, match="did you mean default"):
        asj.detect(square(), preset="defualt")
    with pytest.raises(asj.OptionError, match="no preset None"):
        asj.detect(square(), preset=None)  # type: ignore[arg-type]
    assert {"epsilon", "minimum_length"} <= {option.key for option in asj.detect_options()}
    presets = {option.key: option.presets for option in asj.detect_options()}["octaves"]
    assert presets == {preset: asj.detect(square(), preset=preset).options["octaves"] for preset in presets}
    assert len(set(presets.values())) > 1
    assert len(set(asj.detect_options())) == len(asj.detect_options())


def test_results_outlive_the_context(scene: Scene) -> None:
    context = asj.Context(threads=1)
    features = asj.detect(scene, context=context)
    xy = features.xy
    expected = xy.copy()
    del context, features
    gc.collect()
    asj.detect(panels(seed=3))
    assert np.array_equal(xy, expected)


def test_pickle(scene: Scene) -> None:
    features = asj.detect(scene, minimum_length=5)
    again = pickle.loads(pickle.dumps(features))
    wrong = features.junctions.copy()
    wrong["branch_count"][0] = 1000000
    with pytest.raises(asj.ArgumentError, match="branches"):
        asj.Features.from_records(scene, wrong.tobytes())
    assert np.array_equal(again.junctions, features.junctions) and np.array_equal(again.l_junctions, features.l_junctions)
    assert len(features.edges) and np.array_equal(again.edges, features.edges)
    assert np.array_equal(again.image, features.image) and again.options == features.options


def test_progress_and_cancelling(scene: Scene) -> None:
    seen: list[tuple[str, float]] = []
    asj.detect(scene, context=asj.Context(progress=lambda stage, done: seen.append((stage, done))))
    assert len(seen) > 3 and [done for _, done in seen] == sorted(done for _, done in seen)
    with pytest.raises(asj.Cancelled):
        asj.detect(scene, context=asj.Context(progress=lambda stage, done: done > 0.3))
    with pytest.raises(ZeroDivisionError):
        asj.detect(scene, context=asj.Context(progress=lambda stage, done: 1 / 0))


def test_interrupt() -> None:
    big = np.random.default_rng(0).integers(0, 255, (3000, 4000), np.uint8)
    timer = threading.Timer(0.05, signal.raise_signal, (signal.SIGINT,))
    former = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
    begin = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            timer.start()
            for _ in range(50):
                asj.detect(big)
    finally:
        signal.signal(signal.SIGINT, former)
    assert time.monotonic() - begin < 20


def test_threads_work_at_once(scene: Scene) -> None:
    expected = asj.detect(scene).junctions
    wrong: list[int] = []

    def work() -> None:
        for _ in range(5):
            if not np.array_equal(asj.detect(scene).junctions, expected):
                wrong.append(1)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def test_devices() -> None:
    with pytest.raises(asj.DeviceError):
        asj.Context(backend="opencl", device="a device that nobody has")
    with pytest.raises(asj.OptionError):
        asj.Context(backend="cuda")
    with pytest.raises(asj.OptionError):
        asj.Context(threads=-1)


@pytest.mark.parametrize("kind", ["pgm", "tiff", "big.tiff", "float.tiff"])
def test_deep_files(tmp_path: Path, scene: Scene, kind: str) -> None:
    from PIL import Image

    path = tmp_path / f"deep.{kind}"
    deep = scene.astype(np.uint16) * 257
    if kind == "pgm":
        path.write_bytes(b"P5\n%d %d\n65535\n" % (deep.shape[1], deep.shape[0]) + deep.astype(">u2").tobytes())
    elif kind == "tiff":
        Image.fromarray(deep).save(path)
    elif kind == "big.tiff":
        Image.frombytes("I;16B", deep.shape[::-1], deep.astype(">u2").tobytes()).save(path)
    else:
        Image.fromarray(scene.astype(np.float32) / 255).save(path)
    image = asj.read_image(path)
    assert image.dtype == (np.float32 if kind == "float.tiff" else np.uint16)
    assert np.allclose(image / (1.0 if kind == "float.tiff" else 65535.0), scene / 255, atol=1e-6)
    assert len(asj.detect(image)) > 30


def test_files_of_many_pixels(tmp_path: Path, scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    """Up to what the library takes, without Pillow's warnings; more is refused by the head of the file."""
    from PIL import Image
    from asj import images

    head = b"P5\n%d %d\n255\n"
    (tmp_path / "large.pgm").write_bytes(head % (60000, 8947) + b"cut off")
    (tmp_path / "larger.pgm").write_bytes(head % (60000, 8948) + b"cut off")
    Image.fromarray(scene).save(tmp_path / "scene.png")
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 1000)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert images.size(tmp_path / "large.pgm") == (60000, 8947) and images.size(tmp_path / "larger.pgm") is None
        assert np.array_equal(asj.read_image(tmp_path / "scene.png"), scene)
        with pytest.raises(asj.LimitError, match="larger.pgm: 60000 x 8948 pixels; the library takes 536870912"):
            asj.read_image(tmp_path / "larger.pgm")
    assert Image.MAX_IMAGE_PIXELS == 1000 and images.orientation(tmp_path / "larger.pgm") == 1


def test_numbers_of_numpy() -> None:
    same = asj.detect(square(), epsilon=2.0, half_octaves=True)
    assert asj.detect(square(), epsilon=np.float64(2), half_octaves=np.bool_(True)).options == same.options
    assert asj.detect(square(), epsilon=np.float32(2), half_octaves=np.int64(1)).options == same.options
    with pytest.raises(asj.OptionError, match="text is str"):
        asj.detect(square(), epsilon=b"2")


def test_words_that_c_would_cut() -> None:
    for options in ({"epsilon": "2\0, and more"}, {"epsilon\0": 2}, {"epsilon": "\udcff"}, {"\udcff": 2}):
        with pytest.raises(asj.OptionError, match="NUL|UTF-8"):
            asj.detect(square(), **options)  # type: ignore[arg-type]
    for device in ("gpu\0", "\udcff"):
        with pytest.raises(asj.OptionError, match="device: .*(NUL|UTF-8)"):
            asj.Context(device=device)


def test_what_is_no_context() -> None:
    for threads in (10**12, -(10**12)):
        with pytest.raises(asj.OptionError, match="threads is -?10000"):
            asj.Context(threads=threads)
    features = asj.detect(square())
    calls = (
        lambda: asj.detect(square(), context=5), lambda: asj.match(features, features, context=0),
        lambda: asj.lines(features, context="cpu"), lambda: asj.vanishing_points(features, context=asj.Context),
        lambda: features.without_image(context=5), lambda: asj.set_current(5),
        lambda: asj.match_images(square(), square(), context=5),
    )  # fmt: skip
    for call in calls:
        with pytest.raises(TypeError, match="an asj.Context is wanted, not"):
            call()


def test_a_callback_that_calls_its_context() -> None:
    context = asj.Context(progress=lambda stage, done: len(asj.detect(square(), context=context)) < 0)
    with pytest.raises(asj.Error):
        asj.detect(square(), context=context)
    context.progress = None
    assert len(asj.detect(square(), context=context, preset="default")) == 4


def test_a_device_is_asked_for() -> None:
    with pytest.raises(asj.Error):
        asj.Context(device="there is no such device")
    with pytest.raises(asj.OptionError, match="changes nothing"):
        asj.Context(backend="cpu", device="gpu")


def test_files_keep_their_permissions(tmp_path: Path, scene: Scene) -> None:
    features, path = asj.detect(scene), tmp_path / "private.asjf"
    path.touch(mode=0o600)
    features.save(path)
    assert path.stat().st_mode & 0o777 == 0o600
    with pytest.raises(FileNotFoundError, match="nowhere/x.asjf'$"):
        features.save(tmp_path / "nowhere" / "x.asjf")
    loaded = asj.load_features(path)
    loaded.save(tmp_path / "again.asjf")
    assert (tmp_path / "again.asjf").read_bytes() == path.read_bytes()
    for refused in (loaded.without_image, lambda **options: loaded.save(path, **options)):
        with pytest.raises(asj.OptionError, match="other options"):
            refused(descriptor="sift")


def test_protected_files_stay(tmp_path: Path, scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    features, path = asj.detect(scene), tmp_path / "kept.asjf"
    path.write_bytes(b"of last year")
    path.chmod(0o444)
    if os.geteuid() == 0:  # root may write everything
        monkeypatch.setattr("asj.output._may_write", lambda path: False)
    with pytest.raises(PermissionError, match="kept.asjf'$"):
        features.save(path)
    assert path.read_bytes() == b"of last year" and list(tmp_path.iterdir()) == [path]
    monkeypatch.undo()
    path.chmod(0o644)
    features.save(path)
    assert path.stat().st_size > 1000


def test_long_names(tmp_path: Path, scene: Scene) -> None:
    path = tmp_path / ("n" * 250 + ".asjf")
    features = asj.detect(scene)
    features.save(path)
    assert len(asj.load_features(path)) == len(features) and list(tmp_path.iterdir()) == [path]


def test_short_words_for_long_arrays(scene: Scene) -> None:
    features = asj.detect(scene)
    found = asj.match(features, features, geometry="auto")
    for thing in (asj.lines(features), asj.vanishing_points(features), found.geometry):
        assert repr(thing).startswith("<asj.") and len(repr(thing)) < 100
