# SPDX-License-Identifier: BSD-2-Clause
"""Which images have one camera in a COLMAP database, and cameras that no match depends on."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import Any

import pytest
from asj.__main__ import main
from asj.collection.colmap import CAMERA_MODES, shared_by
from asj.collection.tasks import Detected
from asj.images import camera_name
from conftest import panels
from PIL import Image

MAKE, MODEL, LENS, FILM, MM = 0x010F, 0x0110, 0x8769, 0xA405, 0x920A


def exif(make: str = "Maker", model: str = "One", film: float = 28, mm: float = 4.2) -> Any:
    data = Image.Exif()
    data[MAKE], data[MODEL] = make, model
    data.get_ifd(LENS).update({tag: value for tag, value in ((FILM, film), (MM, mm)) if value})
    return data


def test_names_of_cameras(tmp_path: Path) -> None:
    def name(data: Any) -> str | None:
        Image.new("L", (40, 30)).save(tmp_path / "x.jpg", exif=data)
        return camera_name(tmp_path / "x.jpg")

    assert name(exif()) == "Maker; One; 28; 4.2" == name(exif(make="Maker\0 "))
    assert name(exif(film=0)) == "Maker; One; 0; 4.2"
    assert len({name(exif()), name(exif(make="x")), name(exif(model="x")), name(exif(film=29)), name(exif(mm=4.3))}) == 5
    assert [name(data) for data in (Image.Exif(), exif(make=""), exif(model=" "), exif(film=0, mm=0))] == [None] * 4
    (tmp_path / "bad.jpg").write_bytes(b"no image")
    assert camera_name(tmp_path / "bad.jpg") is None


def test_what_is_shared() -> None:
    one = Detected(None, 40, 30, 31.0, None, 1, "Maker; One; 28; 4.2")
    turned = Detected(None, 30, 40, 31.0, None, 6, one.camera)  # the same pixels in the file
    others = [
        Detected(None, 30, 40, 31.0, None, 1, one.camera), Detected(None, 40, 30, 31.0, None, 1, "Maker; Two; 28; 4.2"),
        Detected(None, 40, 30, None, None, 1, one.camera), Detected(None, 40, 30, None, None), Detected(None, 40, 30, 31.0, None),
    ]  # fmt: skip
    assert shared_by("auto", 1, "a.jpg", one) == shared_by("auto", 2, "b/c.jpg", turned)
    assert len({shared_by("auto", number, "a.jpg", image) for number, image in enumerate([one, *others, *others[2:]])}) == 9
    assert shared_by("single", 1, "a.jpg", one) == shared_by("single", 2, "b/c.jpg", others[0])
    assert shared_by("per-folder", 1, "b/a.jpg", one) == shared_by("per-folder", 2, "b/c.jpg", one) != shared_by("per-folder", 3, "c.jpg", one)
    assert shared_by("per-image", 1, "a.jpg", one) != shared_by("per-image", 2, "a.jpg", one)


@pytest.fixture
def views(tmp_path: Path) -> Path:
    """Seven views of one size: of a camera that EXIF data tell, of one whose zoom they tell too, and of nobody knows which."""
    folder = tmp_path / "views"
    (folder / "more").mkdir(parents=True)
    named = ("a.jpg", exif()), ("b.jpg", exif()), ("c.jpg", exif(film=56, mm=8.4)), ("d.jpg", None), ("more/e.jpg", exif()), ("more/f.jpg", None)
    for number, (name, data) in enumerate(named):
        Image.fromarray(panels(shift=(3.0 * number, 2.0 * number))).save(folder / name, quality=95, **({"exif": data} if data else {}))
    return folder


def cameras(path: Path) -> tuple[dict[str, int], dict[int, Any]]:
    """Of each image its camera's number, and the cameras."""
    import pycolmap

    with contextlib.closing(pycolmap.Database.open(path)) as database:
        return {image.name: image.camera_id for image in database.read_all_images()}, {c.camera_id: c for c in database.read_all_cameras()}


def test_modes(views: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pycolmap = pytest.importorskip("pycolmap")
    scene = tmp_path / "scene.db"
    words = ["collect", str(views), "--colmap", str(scene), "--sequential", "1", "--jobs", "1", "--quiet", "--no-verify"]
    assert main(words) == 0
    numbers, found = cameras(scene)
    names = list(numbers)
    assert names == ["a.jpg", "b.jpg", "c.jpg", "d.jpg", "more/e.jpg", "more/f.jpg"]
    assert list(numbers.values()) == [1, 1, 3, 4, 1, 6] and sorted(found) == [1, 3, 4, 6]  # auto
    expected = {"single": [1] * 6, "per-folder": [1, 1, 1, 1, 5, 5], "per-image": [1, 2, 3, 4, 5, 6], "auto": [1, 1, 3, 4, 1, 6]}
    assert sorted(expected) == sorted(CAMERA_MODES) == sorted(mode.lower().replace("_", "-") for mode in pycolmap.CameraMode.__members__)
    for mode, wanted in expected.items():  # the whole database by the new mode each time
        assert main([*words, "--resume", "--camera-mode", mode]) == 0
        numbers, found = cameras(scene)
        assert [numbers[name] for name in names] == wanted and set(found) == set(wanted)
        assert all(camera.model.name == "SIMPLE_RADIAL" and (camera.width, camera.height) == (480, 360) for camera in found.values())
    # as COLMAP itself has them
    theirs = tmp_path / "theirs.db"
    pycolmap.Database.open(theirs).close()
    pycolmap.import_images(theirs, views, pycolmap.CameraMode.AUTO)
    of_theirs, _ = cameras(theirs)

    def together(of: dict[str, int]) -> set[frozenset[str]]:
        return {frozenset(name for name in of if of[name] == camera) for camera in of.values()}

    assert together(of_theirs) == together(numbers)
    # views of another size: a clear answer, and the database as it was
    Image.fromarray(panels(size=(480, 360))).save(views / "more" / "g.jpg", quality=95)
    before = scene.read_bytes()
    for mode, other in (("single", "a.jpg"), ("per-folder", "more/e.jpg")):
        assert main([*words, "--update", "--camera-mode", mode]) == 2
        assert f"camera mode {mode}: {other} has 480 x 360 pixels and more/g.jpg 360 x 480" in capsys.readouterr().err
        assert scene.read_bytes() == before
    assert main([*words, "--update"]) == 0
    assert list(cameras(scene)[0].values()) == [1, 1, 3, 4, 1, 6, 7]


def test_bad_use(views: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pycolmap")
    scene = ["--colmap", str(tmp_path / "x.db")]
    for words, why in ((["--limap", str(tmp_path / "x")], "without --colmap"), ([*scene, "--camera", "500,500,240,180"], "one camera of all")):
        assert main(["collect", str(views), *words, "--camera-mode", "single"]) == 2
        assert why in capsys.readouterr().err
    from asj.collection import colmap

    with pytest.raises(ValueError, match="no camera mode 'one'"):
        colmap.write(None, tmp_path / "x.db", camera_mode="one")  # type: ignore[arg-type]


def test_focal_length_of_a_shared_camera(views: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The median of what the pairs of all its images have found."""
    pytest.importorskip("pycolmap")
    from asj.collection import colmap

    monkeypatch.setattr(colmap, "_found_focals", lambda store: {1: [500.0, 520.0], 2: [540.0], 4: [300.0]})
    words = ["collect", str(views), "--sequential", "1", "--jobs", "1", "--quiet", "--no-verify", "--store", str(tmp_path / "store")]
    assert main([*words, "--colmap", str(tmp_path / "auto.db")]) == 0
    found = cameras(tmp_path / "auto.db")[1]
    exif_of_c = 56 * (480**2 + 360**2) ** 0.5 / 43.26661530556787
    expected = {1: (520, True), 3: (pytest.approx(exif_of_c), True), 4: (300, False), 6: (1.2 * 480, False)}
    assert {number: (camera.focal_length, camera.has_prior_focal_length) for number, camera in found.items()} == expected
    assert main([*words, "--colmap", str(tmp_path / "single.db"), "--resume", "--camera-mode", "single"]) == 0
    assert [camera.focal_length for camera in cameras(tmp_path / "single.db")[1].values()] == [510]


def test_camera_that_no_match_depends_on(views: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Another one goes into the database, and what was done stays; where matches depend on it, the way out is named."""
    pytest.importorskip("pycolmap")
    scene = tmp_path / "scene.db"
    words = ["collect", str(views), "--colmap", str(scene), "--sequential", "1", "--jobs", "1", "--quiet", "--no-verify"]
    for again, camera in enumerate(("500,500,239.5,179.5", "501,501,239.5,179.5")):
        assert main([*words, "--camera", camera, *(["--resume"] if again else [])]) == 0
        assert [list(c.params) for c in cameras(scene)[1].values()] == [[500 + again] * 2 + [240, 180]]
    assert main([*words, "--resume"]) == 0
    assert len(cameras(scene)[1]) == 4
    again = [*words, "--geometry", "auto", "--store", str(tmp_path / "auto.work"), "--overwrite"]
    assert main([*again, "--camera", "500,500,239.5,179.5"]) == 0
    capsys.readouterr()
    assert main([*again, "--camera", "501,501,239.5,179.5", "--resume"]) == 2
    said = capsys.readouterr().err
    assert "--geometry auto --camera 500,500,239.5,179.5 there, --geometry auto --camera 501,501,239.5,179.5 now" in said
    assert "name another --store, or delete auto.work" in said
