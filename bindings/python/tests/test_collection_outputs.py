# SPDX-License-Identifier: BSD-2-Clause
"""What outputs of collections replace and what they leave alone; photographs that were taken with the camera turned; runs that are
killed."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from asj.__main__ import main
from asj.collection import orientation
from asj.images import orientation as orientation_of
from asj.images import read
from conftest import panels
from numpy.typing import NDArray
from PIL import Image

MODULE = [sys.executable, "-m", "asj", "collect"]
# what Pillow has to do to an upright picture for exif_transpose() to give it back
STORED = {
    1: None, 2: Image.Transpose.FLIP_LEFT_RIGHT, 3: Image.Transpose.ROTATE_180, 4: Image.Transpose.FLIP_TOP_BOTTOM,
    5: Image.Transpose.TRANSPOSE, 6: Image.Transpose.ROTATE_90, 7: Image.Transpose.TRANSVERSE, 8: Image.Transpose.ROTATE_270,
}  # fmt: skip


def save_turned(pixels: NDArray[np.uint8], turned: int, path: Path) -> None:
    way = STORED[turned]
    picture = Image.fromarray(pixels)
    data = Image.Exif()
    data[0x0112] = turned
    (picture if way is None else picture.transpose(way)).save(path, exif=data)


def refused(words: list[str], why: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["collect", *words, "--quiet"]) == 2
    assert why in capsys.readouterr().err


@pytest.fixture
def pair(tmp_path: Path) -> Path:
    """A folder with two views."""
    folder = tmp_path / "pair"
    folder.mkdir()
    Image.fromarray(panels()).save(folder / "a.png")
    Image.fromarray(panels(shift=(6, 4))).save(folder / "b.png")
    return folder


def test_files_of_others_stay(pair: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pycolmap")
    h5py = pytest.importorskip("h5py")
    foreign, folder = tmp_path / "scene.db", tmp_path / "h5"
    with sqlite3.connect(foreign) as connection:
        connection.execute("CREATE TABLE rigs (id INTEGER)")
    folder.mkdir()
    h5py.File(folder / "features.h5", "w").close()
    before = foreign.read_bytes()
    refused([str(pair), "--colmap", str(foreign)], "something else has written it", capsys)
    refused([str(pair), "--hdf5", str(folder)], "features.h5 is there, and something else", capsys)
    refused([str(pair), "--colmap", str(pair / "a.png")], "is a photograph", capsys)
    refused([str(pair), "--colmap", str(tmp_path / "x"), "--store", str(tmp_path / "x")], "is the store", capsys)
    refused([str(pair), "--colmap", str(tmp_path / "x"), "--store", str(pair / "a.png")], "a photograph", capsys)
    assert foreign.read_bytes() == before and not (tmp_path / "scene.db.work").exists()
    both = [str(pair), "--colmap", str(foreign), "--hdf5", str(folder), "--quiet"]
    assert main(["collect", *both, "--overwrite"]) == 0
    assert main(["collect", *both, "--resume"]) == 0  # its own may be written again
    (tmp_path / "scene.db-wal").write_bytes(b"a log that another program has left")
    refused([*both, "--resume"], "scene.db-wal is there", capsys)


def test_outputs_of_another_collection_stay(pair: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Only the store that they were written from may write them again."""
    pycolmap, h5py = pytest.importorskip("pycolmap"), pytest.importorskip("h5py")
    other, first, second = tmp_path / "other", tmp_path / "1.store", tmp_path / "2.store"
    other.mkdir()
    Image.fromarray(panels(seed=5)).save(other / "c.png")
    outputs = {"--colmap": tmp_path / "x.db", "--hdf5": tmp_path / "h5", "--limap": tmp_path / "lines"}
    every = [word for name, path in outputs.items() for word in (name, str(path))]
    run = ["--jobs", "1", "--quiet"]
    assert main(["collect", str(pair), *every, *run, "--store", str(first)]) == 0

    def content() -> dict[Path, bytes]:
        return {path: path.read_bytes() for place in outputs.values() for path in (place, *place.rglob("*")) if path.is_file()}

    before = content()
    assert len(before) == 1 + 2 + 7
    for name, path in outputs.items():
        for folder in (other, pair):
            refused([str(folder), name, str(path), "--store", str(second)], "another collection has written it, not", capsys)
    assert content() == before and not second.exists()
    shutil.copy(tmp_path / "x.db", tmp_path / "by_another_version.db")
    with contextlib.closing(sqlite3.connect(tmp_path / "by_another_version.db")) as connection:
        connection.execute("DROP TABLE asj_store")
    refused([str(pair), "--colmap", str(tmp_path / "by_another_version.db"), "--store", str(second)], "something else", capsys)
    for again in ("--resume", "--update"):
        assert main(["collect", str(pair), *every, *run, "--store", str(first), again]) == 0
    Image.fromarray(panels(shift=(3, 1))).save(pair / "c.png")
    assert main(["collect", str(pair), *every, *run, "--store", str(first), "--update"]) == 0
    assert main(["collect", str(other), *every, *run, "--store", str(second), "--overwrite"]) == 0
    assert main(["collect", str(other), *every, *run, "--store", str(second), "--resume"]) == 0
    names = sorted(path.name for path in outputs["--limap"].rglob("*.*"))
    assert names == ["images.txt", "matches_1.npy", "segments_1.txt", "store.txt"]
    with h5py.File(tmp_path / "h5" / "features.h5") as features:
        assert list(features) == ["c.png"]  # what reads them sees no group more
    database = pycolmap.Database.open(tmp_path / "x.db")
    assert [image.name for image in database.read_all_images()] == ["c.png"]
    database.close()
    refused([str(pair), *every, "--store", str(first), "--resume"], "another collection", capsys)


@pytest.mark.parametrize(("module", "words"), [
    ("PIL.Image", ["--limap", "x"]), ("pycolmap", ["--colmap", "x"]), ("h5py", ["--hdf5", "x"]),
    ("distributed", ["--limap", "x", "--dask", "tcp://nowhere:1"]),
])  # fmt: skip
def test_what_is_missing_is_told_before_the_work(
    pair: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], module: str, words: list[str]
) -> None:
    """A store would block the next try."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, module, None)
    refused([str(pair), *words], f"this needs {module.replace('PIL.Image', 'Pillow')}: install it", capsys)
    assert [path.name for path in tmp_path.iterdir()] == ["pair"]


def test_protected_outputs_are_told_of_before_the_work(
    pair: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("pycolmap")
    (tmp_path / "x.db").touch(mode=0o444)
    monkeypatch.setattr("asj.output._may_write", lambda path: False)  # root may write everything
    refused([str(pair), "--colmap", str(tmp_path / "x.db"), "--overwrite"], "Permission denied", capsys)
    assert not (tmp_path / "x.db.work").exists()


def test_killed_while_lines_are_written(pair: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was written till then is its own."""
    class Killed(BaseException):
        pass

    def end(*_: object) -> Any:
        raise Killed

    words = ["collect", str(pair), "--limap", str(tmp_path / "lines"), "--jobs", "1", "--quiet"]
    with monkeypatch.context() as patched, pytest.raises(Killed):
        patched.setattr("asj.collection.limap._write_matches", end)
        main(words)
    (tmp_path / "lines" / "images.txt").unlink()  # as if it were earlier
    assert (tmp_path / "lines" / "segments" / "segments_1.txt").exists()
    assert main([*words, "--resume"]) == 0


def test_a_store_without_an_identity_gets_one(pair: Path, tmp_path: Path) -> None:
    words = ["collect", str(pair), "--limap", str(tmp_path / "lines"), "--jobs", "1", "--quiet"]
    assert main(words) == 0
    with sqlite3.connect(tmp_path / "lines.work") as connection:
        connection.execute("DELETE FROM about WHERE key = 'identity'")
    assert main([*words, "--resume", "--overwrite"]) == 0 and main([*words, "--resume"]) == 0


def test_limap_of_others_stays(pair: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "lines"
    (folder / "segments").mkdir(parents=True)
    (folder / "matches").mkdir()
    others = [folder / "segments" / "segments_500.txt", folder / "segments" / "segments_deep.txt", folder / "matches" / "matches_1_500.txt"]
    for path in others:
        path.write_text("not ours\n")
    Image.fromarray(panels(seed=3)).save(pair / "c\nd.png")
    words = ["--limap", str(folder), "--jobs", "1", "--quiet"]
    assert main(["collect", str(pair), *words]) == 0
    assert (folder / "images.txt").read_text().splitlines() == ["1 a.png", "2 b.png", '3 "c\\nd.png"']
    assert (folder / "segments" / "segments_3.txt").exists() and (folder / "matches" / "matches_1_3.txt").exists()
    (pair / "c\nd.png").unlink()
    assert main(["collect", str(pair), *words, "--store", str(tmp_path / "second.work"), "--overwrite"]) == 0
    assert not (folder / "segments" / "segments_3.txt").exists() and not (folder / "matches" / "matches_1_3.txt").exists()
    assert all(path.read_text() == "not ours\n" for path in others)
    (tmp_path / "new" / "matches").mkdir(parents=True)
    (tmp_path / "new" / "matches" / "matches_1_2.txt").write_text("not ours\n")
    refused([str(pair), "--limap", str(tmp_path / "new")], "matches_1_2.txt is there, and something else", capsys)


def test_orientations(tmp_path: Path) -> None:
    upright = np.arange(35, dtype=np.uint8).reshape(5, 7)
    xy = np.stack(np.meshgrid(np.arange(7), np.arange(5)), axis=-1).astype(np.float32)
    for turned in STORED:
        path = tmp_path / f"{turned}.png"
        save_turned(upright, turned, path)
        assert orientation_of(path) == turned and np.array_equal(read(path), upright)
        stored = np.array(Image.open(path))
        assert orientation.stored_size(turned, 7, 5) == stored.shape[::-1]
        places = orientation.turn(orientation.to_stored(turned, 7, 5), xy)
        assert np.array_equal(stored[places[..., 1].astype(int), places[..., 0].astype(int)], upright)
        linear = orientation.to_stored(turned, 7, 5)[:2, :2]
        assert np.linalg.det(linear) == (-1 if orientation.is_mirrored(turned) else 1)
    Image.fromarray(upright).save(tmp_path / "none.png")
    assert orientation_of(tmp_path / "none.png") == 1


def test_turned_cameras(tmp_path: Path) -> None:
    """The same pair upright and stored in other ways: key points, shapes, lines and geometry of the pixels of the files."""
    pycolmap, h5py = pytest.importorskip("pycolmap"), pytest.importorskip("h5py")
    views = panels(size=(360, 480)), panels(shift=(6, 4), zoom=1.1)
    results: dict[tuple[int, int], Any] = {}
    for turned in ((1, 1), (6, 8), (3, 6), (1, 5)):
        folder = tmp_path / f"{turned[0]}{turned[1]}"
        folder.mkdir()
        for name, view, way in zip("ab", views, turned):
            save_turned(view, way, folder / f"{name}.png")
        outputs = ["--colmap", str(folder / "x.db"), "--hdf5", str(folder / "h5"), "--limap", str(folder / "limap")]
        how = ["--geometry", "auto", "--camera", "500,510,239.5,179.5", "--jobs", "1", "--quiet"]
        assert main(["collect", str(folder), *outputs, *how]) == 0
        database = pycolmap.Database.open(folder / "x.db")
        images = [database.read_image_with_name(f"{name}.png") for name in "ab"]
        cameras = [database.read_camera(image.camera_id) for image in images]
        points = [database.read_keypoints(image.image_id) for image in images]
        matches = database.read_matches(images[0].image_id, images[1].image_id)
        database.close()
        with h5py.File(folder / "h5" / "features.h5") as features:
            in_file = [features[f"{name}.png"]["keypoints"][:] for name in "ab"]
        lines = [np.loadtxt(folder / "limap" / "segments" / f"segments_{n}.txt", skiprows=1)[:, :4].reshape(-1, 2) for n in (1, 2)]
        results[turned] = points, matches, in_file, lines
        for camera, way, xy in zip(cameras, turned, in_file):
            assert (camera.width, camera.height) == orientation.stored_size(way, 480, 360)
            assert camera.model.name == "PINHOLE" and camera.has_prior_focal_length
            sideways = way in (5, 6, 7, 8)
            assert list(camera.params) == ([510, 500, 180, 240] if sideways else [500, 510, 240, 180])
            assert (xy >= -1).all() and (xy <= (camera.width, camera.height)).all()
    plain = results[1, 1]
    for turned, (points, matches, in_file, lines) in results.items():
        assert np.array_equal(matches, plain[1])
        for n, way in enumerate(turned):
            matrix = orientation.to_stored(way, 480, 360)
            assert np.allclose(in_file[n], orientation.turn(matrix, plain[2][n]), atol=1e-3)
            assert np.allclose(lines[n], orientation.turn(matrix, plain[3][n]), atol=1e-3)
            assert np.allclose(points[n][:, :2], in_file[n] + 0.5, atol=1e-3)
            shape, before = (p[:, 2:].reshape(-1, 2, 2) for p in (points[n], plain[0][n]))
            assert np.allclose(shape, matrix[:2, :2] @ before, atol=1e-4)


def processes_of(parent: int) -> list[int]:
    return [int(word) for word in Path(f"/proc/{parent}/task/{parent}/children").read_text().split()]


def is_running(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, signal.SIGHUP])
def test_workers_end_with_their_parent(pair: Path, tmp_path: Path, how: signal.Signals) -> None:
    if not Path("/proc/self/task").exists():
        pytest.skip("no /proc here")
    for n in range(40):
        shutil.copy(pair / "a.png", pair / f"more{n}.png")
    output = tmp_path / "out.db" if how != signal.SIGKILL else tmp_path / "out"
    words = [*MODULE, str(pair), "--colmap" if how != signal.SIGKILL else "--limap", str(output), "--jobs", "2"]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    store = Path(f"{output}.work")
    end = time.monotonic() + 60
    done = 0
    while done < 3 and time.monotonic() < end:
        time.sleep(0.1)
        if store.exists():
            try:
                with sqlite3.connect(store) as connection:
                    done = connection.execute("SELECT COUNT(*) FROM images WHERE state = 'done'").fetchone()[0]
            except sqlite3.OperationalError:
                pass
    workers = processes_of(process.pid)
    assert done >= 3 and len(workers) >= 2
    os.kill(process.pid, how)
    process.communicate(timeout=60)  # pipes that workers keep open would never end
    assert process.returncode == (-9 if how == signal.SIGKILL else 128 + how)
    while any(map(is_running, workers)) and time.monotonic() < end + 60:
        time.sleep(0.1)
    assert not any(map(is_running, workers))


def test_verification_is_repeated(tmp_path: Path) -> None:
    """COLMAP's own two-view geometries are drawn by chance, and are the same each time."""
    pytest.importorskip("pycolmap")
    folder = tmp_path / "views"
    folder.mkdir()
    for n in range(4):
        Image.fromarray(panels(shift=(3.0 * n, 2.0 * n), zoom=1 + 0.03 * n)).save(folder / f"{n}.png")
    rows = []
    for n in range(2):
        database = tmp_path / f"{n}.db"
        assert main(["collect", str(folder), "--colmap", str(database), "--quiet"]) == 0
        with sqlite3.connect(database) as connection:
            rows.append(connection.execute("SELECT * FROM two_view_geometries ORDER BY pair_id").fetchall())
    assert len(rows[0]) == 6 and rows[0] == rows[1]


def test_full_disk_names_the_file(pair: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """SQLite's error, which pycolmap hands on, becomes a line that names the database, and nothing is left beside it."""
    pycolmap = pytest.importorskip("pycolmap")
    opened = pycolmap.Database.open

    class Full:
        @staticmethod
        def open(path: Path) -> Any:
            opened(path).close()
            Path(f"{path}-wal").write_bytes(b"left")
            raise RuntimeError("[database_sqlite.cc:1] SQLite error: database or disk is full")

    keep, pycolmap.Database = pycolmap.Database, Full
    try:
        refused([str(pair), "--colmap", str(tmp_path / "x.db")], "x.db: [database_sqlite.cc:1] SQLite error", capsys)
    finally:
        pycolmap.Database = keep
    assert sorted(path.name for path in tmp_path.iterdir() if path.name.startswith((".asj", "x.db"))) == ["x.db.work"]


def test_cameras_that_cannot_be(pair: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = [str(pair), "--limap", str(tmp_path / "x")]
    for camera in ("500", "500,500,240", "0,500,240,180", "500,nan,240,180", "f,500,240,180", "500,500,1e9,180"):
        refused([*words, "--camera", camera], "is not FX,FY,CX,CY", capsys)
    refused([*words, "--geometry", "auto", "--focal", "500", "--camera", "500,500,240,180"], "exclude each other", capsys)
    refused([*words, "--camera", "240,180,500,500"], "is this cx,cy,fx,fy? (240,180,500,500, image 480 x 360) (a.png)", capsys)
    assert not (tmp_path / "x.work").exists()
    assert main(["collect", *words, "--quiet", "--camera", "500,500,380,180", "--geometry", "auto"]) == 0
    said = capsys.readouterr().err
    far = "warning: --camera: the principal point is far from the middle of the image: the camera of another size"
    assert said.count(far) == 1
