# SPDX-License-Identifier: BSD-2-Clause
"""Collections with geometry: focal lengths from EXIF data, poses and fundamental matrices in the COLMAP database."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from asj.__main__ import main
from asj.collection import orientation
from asj.images import focal_length
from numpy.typing import NDArray

EXAMPLES = Path(__file__).parent.parent / "examples"
DIAGONAL = 43.26661530556787


def exif(**values: Any) -> Any:
    """EXIF data with some of the tags of a lens."""
    from PIL import Image

    tags = {"film": 0xA405, "mm": 0x920A, "per_unit": 0xA20E, "unit": 0xA210, "width": 0xA002, "height": 0xA003}
    made = Image.Exif()
    made.get_ifd(0x8769).update({tags[key]: value for key, value in values.items()})
    return made


@pytest.fixture
def rooms(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, list[Any]]:
    """Three views of a room with 28 mm in their EXIF data (518 px; the truth is 520), and a fourth without. The cameras. Pairs that
    are asked for a pose are two steps of the walk apart: one step tells the direction of the motion to a degree or two only."""
    from PIL import Image

    monkeypatch.syspath_prepend(str(EXAMPLES))
    import room

    folder = tmp_path / "rooms"
    folder.mkdir()
    walk = room.walk(6)
    views = [walk[0], walk[4], walk[2], walk[3]]
    for number, view in enumerate(views):
        picture = Image.fromarray(room.render(room.make(1), view, samples=4, seed=number))
        data = exif(film=28, width=640, height=480) if number < 3 else Image.Exif()
        picture.save(folder / f"{number}.jpg", quality=95, exif=data)
    return folder, views


def angle(cosine: float) -> float:
    return float(np.degrees(np.arccos(np.clip(cosine, -1, 1))))


def pose_error(rotation: NDArray[Any], translation: NDArray[Any], one: Any, two: Any) -> float:
    turn = two.rotation @ one.rotation.T
    move = two.rotation @ (one.position - two.position)
    cosine = abs(translation @ move) / np.linalg.norm(translation) / np.linalg.norm(move)
    return max(angle((np.trace(rotation.T @ turn) - 1) / 2), angle(cosine))


def test_focal_lengths(tmp_path: Path) -> None:
    from PIL import Image

    def focal(size: tuple[int, int], **values: Any) -> float | None:
        Image.new("L", size).save(tmp_path / "x.jpg", exif=exif(**values))
        return focal_length(tmp_path / "x.jpg")

    assert focal((40, 30)) is None
    assert focal((40, 30), film=35) == pytest.approx(35 * 50 / DIAGONAL)
    assert focal((30, 40), film=35, width=4000, height=3000, mm=5, per_unit=1.0, unit=2) == pytest.approx(35 * 50 / DIAGONAL)
    assert focal((40, 30), mm=5, per_unit=800.0, unit=4, width=4000, height=3000) == pytest.approx(40)
    assert focal((40, 30), mm=5, per_unit=2032 / 10, unit=2) == pytest.approx(40)
    assert focal((40, 30), film=35, width=4000, height=2250) is None  # cut
    assert focal((40, 30), film=1) is None
    assert focal((40, 30), mm=5, per_unit=800.0, unit=9) is None
    (tmp_path / "bad.jpg").write_bytes(b"no image")
    assert focal_length(tmp_path / "bad.jpg") is None


def from_lines(matrix: NDArray[Any], one: NDArray[Any], two: NDArray[Any]) -> NDArray[Any]:
    """Distances in px of the second image."""
    lines = np.c_[one, np.ones(len(one))] @ matrix.T
    distances: NDArray[Any] = np.abs((lines * np.c_[two, np.ones(len(two))]).sum(axis=1)) / np.hypot(lines[:, 0], lines[:, 1])
    return distances


def test_poses_reach_colmap(rooms: tuple[Path, list[Any]], tmp_path: Path) -> None:
    pycolmap = pytest.importorskip("pycolmap")
    folder, views = rooms
    listed = tmp_path / "pairs.txt"
    listed.write_text("0.jpg 2.jpg\n2.jpg 1.jpg\n2.jpg 3.jpg\n")  # one of them the other way round; one without a focal length
    scene = tmp_path / "scene.db"
    words = ["collect", str(folder), "--pairs", str(listed), "--colmap", str(scene), "--quiet", "--geometry", "auto", "--jobs", "1"]
    assert main([*words, "--no-verify"]) == 0
    with sqlite3.connect(scene) as connection:
        known = connection.execute("SELECT prior_focal_length FROM cameras ORDER BY camera_id").fetchall()
    assert known == [(1,), (1,), (1,), (0,)]
    with sqlite3.connect(tmp_path / "scene.db.work") as connection:
        stored = [json.loads(row[0]) for row in connection.execute("SELECT geometry FROM pairs ORDER BY id")]
    database = pycolmap.Database.open(scene)
    images = [database.read_image_with_name(f"{number}.jpg") for number in range(4)]
    points = [database.read_keypoints(image.image_id)[:, :2] for image in images]
    cameras = [one["cameras"] for one in stored]
    assert all(0 < one["focal_sd"] < 0.03 and abs(np.log(one["cameras"][0][0] / 520)) < 3 * one["focal_sd"] for one in stored[:2])
    assert database.read_camera(images[0].camera_id).focal_length == cameras[0][0][0]
    assert database.read_camera(images[2].camera_id).focal_length == pytest.approx((cameras[0][1][0] + cameras[1][0][0]) / 2)
    assert database.read_camera(images[3].camera_id).focal_length == 1.2 * 640
    for (one, two), ours in zip(((0, 2), (2, 1)), stored):
        found = database.read_two_view_geometry(images[one].image_id, images[two].image_id)
        first, second = (points[view][found.inlier_matches[:, side]] for side, view in ((0, one), (1, two)))
        assert len(first) > 30 and np.median(from_lines(found.F, first, second)) < 1
        assert found.config == pycolmap.TwoViewGeometryConfiguration.UNCALIBRATED  # by focal lengths of this pair
        assert pose_error(np.reshape(ours["rotation"], (3, 3)), np.array(ours["translation"]), views[one], views[two]) < 1
    assert not database.exists_two_view_geometry(images[2].image_id, images[3].image_id)
    database.close()
    with sqlite3.connect(tmp_path / "scene.db.work") as connection:
        stored = [json.loads(text) for (text,) in connection.execute("SELECT geometry FROM pairs ORDER BY id")]
    assert [(one["status"], one["model"]) for one in stored] == [("accepted", "essential")] * 2 + [("accepted", "homography")]
    assert stored[2]["cameras"] is None
    scene.unlink()
    assert main([*words, "--resume"]) == 0  # with COLMAP's verification, for what is not there
    database = pycolmap.Database.open(scene)
    assert len(database.read_two_view_geometry(images[2].image_id, images[3].image_id).inlier_matches) > 30
    database.close()


@pytest.mark.parametrize("focal", ["500", "estimate"])
def test_focal_lengths_reach_cameras(rooms: tuple[Path, list[Any]], tmp_path: Path, focal: str) -> None:
    """Stored poses are those of stored cameras; a length that was found with a motion is the camera's, and the pair uncalibrated."""
    pycolmap = pytest.importorskip("pycolmap")
    (tmp_path / "pairs.txt").write_text("0.jpg 2.jpg\n")
    words = ["--pairs", str(tmp_path / "pairs.txt"), "--geometry", "auto", "--focal", focal, "--no-verify", "--quiet", "--jobs", "1"]
    assert main(["collect", str(rooms[0]), "--colmap", str(tmp_path / "scene.db"), *words]) == 0
    with sqlite3.connect(tmp_path / "scene.db.work") as connection:
        stored = json.loads(connection.execute("SELECT geometry FROM pairs").fetchone()[0])
    database = pycolmap.Database.open(tmp_path / "scene.db")
    images = [database.read_image_with_name(f"{number}.jpg") for number in (0, 2, 3)]
    cameras = [database.read_camera(image.camera_id) for image in images]
    found = database.read_two_view_geometry(images[0].image_id, images[1].image_id)
    kinds = pycolmap.TwoViewGeometryConfiguration
    assert stored["status"] == "accepted" and stored["model"] == "essential"
    if focal == "500":
        assert [(camera.focal_length, camera.has_prior_focal_length) for camera in cameras] == [(500, True)] * 3
        assert found.config == kinds.CALIBRATED
        one, two = (camera.calibration_matrix() for camera in cameras[:2])
        f = np.linalg.inv(two).T @ found.E @ np.linalg.inv(one)
        assert np.allclose(f / np.linalg.norm(f), found.F / np.linalg.norm(found.F), atol=1e-6) or np.allclose(
            f / np.linalg.norm(f), -found.F / np.linalg.norm(found.F), atol=1e-6
        )
    else:
        assert stored["focal_sd"] > 0 and found.config == kinds.UNCALIBRATED
        # the file says how long it is, and so do the first three images' EXIF data
        assert all(camera.has_prior_focal_length for camera in cameras[:2]) and not cameras[2].has_prior_focal_length
    database.close()


def test_found_focal_lengths() -> None:
    """The median of what the pairs of an image have found."""
    from asj.collection import colmap
    from asj.collection.tasks import Matched

    class Two:
        @staticmethod
        def matched() -> list[tuple[int, int, Matched]]:
            rows = [(1, 2, 500.0, 0.1), (1, 3, 520.0, 0.2), (2, 3, 400.0, 0.0), (1, 4, 530.0, 0.1)]

            def told(f: float, sd: float) -> str:
                return json.dumps({"status": "accepted", "cameras": [[f, f, 0, 0], [f + 1, f + 1, 0, 0]], "focal_sd": sd})

            return [(one, two, Matched(None, b"", None, told(f, sd))) for one, two, f, sd in rows]

    found = colmap._found_focals(Two())  # type: ignore[arg-type]
    assert found == {1: [500.0, 520.0, 530.0], 2: [501.0], 3: [521.0], 4: [531.0]}
    cases: tuple[tuple[float | None, int, list[float]], ...] = ((None, 1, [500.0]), (600.0, 1, [500.0]), (None, 9, [500.0, 502.0]), (None, 9, []))
    assert [colmap.focal_of(given, found.get(number, []), exif, 640) for given, number, exif in cases] == [520.0, 600.0, 501.0, 768.0]


def test_fundamental_matrix_in_colmaps_pixels() -> None:
    pycolmap = pytest.importorskip("pycolmap")
    from asj.collection import colmap
    from asj.collection.tasks import Detected

    random = np.random.default_rng(3)
    matrix = np.array([[0, -1e-3, 0.2], [1e-3, 0, -0.4], [-0.2, 0.4, 0]])  # [t]x: every point moves along a line through (400, 200)
    one = random.uniform(0, 500, (20, 2))
    two = one + random.uniform(0.1, 0.4, (20, 1)) * ([400, 200] - one)
    assert from_lines(matrix, one, two).max() < 1e-9
    found = {"model": "fundamental", "matrix": matrix.tolist(), "rotation": None, "translation": None, "focal_sd": 0}
    for turned in (1, 3, 6, 7):  # image 2 is stored so
        views = Detected(None, 500, 400, None, b""), Detected(None, 500, 400, None, b"", turned)
        geometry = colmap._geometry(pycolmap, found, np.zeros((0, 2), np.uint32), *views)
        stored = two @ orientation.to_stored(turned, 500, 400)[:2, :2].T + orientation.to_stored(turned, 500, 400)[:2, 2]
        assert geometry.config == pycolmap.TwoViewGeometryConfiguration.UNCALIBRATED
        assert from_lines(geometry.F, one + 0.5, stored + 0.5).max() < 1e-9


def test_pose_of_turned_cameras() -> None:
    """x2 ~ R x1 + t in the stored images' own camera coordinates, and their fundamental matrix, agree; a mirrored one has no pose."""
    pycolmap = pytest.importorskip("pycolmap")
    from asj.collection import colmap
    from asj.collection.tasks import Detected

    random = np.random.default_rng(5)
    rotation, _ = np.linalg.qr(random.normal(size=(3, 3)) * 0.2 + np.eye(3))
    rotation *= np.sign(np.linalg.det(rotation))
    t = np.array([0.6, -0.1, 0.3])
    inverse = np.linalg.inv([[500, 0, 319.5], [0, 500, 239.5], [0, 0, 1]])
    cross = np.array([[0, -t[2], t[1]], [t[2], 0, -t[0]], [-t[1], t[0], 0]])
    matrix = inverse.T @ cross @ rotation @ inverse
    found = {"model": "essential", "matrix": matrix.tolist(), "rotation": rotation.tolist(), "translation": t.tolist(), "focal_sd": 0}
    for turned in ((1, 1), (6, 8), (3, 6), (2, 1)):
        views = [Detected(None, 640, 480, None, b"", way) for way in turned]
        geometry = colmap._geometry(pycolmap, found, np.zeros((0, 2), np.uint32), *views)
        assert (geometry.config == pycolmap.TwoViewGeometryConfiguration.CALIBRATED) == (turned != (2, 1))
        if turned == (2, 1):
            continue
        sizes = [orientation.stored_size(way, 640, 480) for way in turned]
        back = [np.linalg.inv([[500, 0, w / 2], [0, 500, h / 2], [0, 0, 1]]) for w, h in sizes]
        again = back[1].T @ geometry.E @ back[0]
        assert np.allclose(again / np.linalg.norm(again), geometry.F / np.linalg.norm(geometry.F) * np.sign((again * geometry.F).sum()), atol=1e-9)


def test_bad_use(rooms: tuple[Path, list[Any]], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def says(words: list[str], why: str) -> None:
        assert main(["collect", str(rooms[0]), "--limap", str(tmp_path / "limap"), *words]) == 2
        assert why in capsys.readouterr().err

    says(["--geometry", "auto", "--focal", "-5"], "not a length")
    says(["--geometry", "auto", "--focal", "nan"], "not a length")
    says(["--focal", "600"], "changes nothing")
    says(["--geometry", "essential", "--focal", "none"], "needs focal lengths")
