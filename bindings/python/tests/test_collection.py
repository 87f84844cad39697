# SPDX-License-Identifier: BSD-2-Clause
"""Collections: the same content in one process, in several, on Dask, and after being killed; files that others read."""

from __future__ import annotations

import contextlib
import os
import random
import re
import shutil
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import asj
import numpy as np
import pytest
from asj.__main__ import main
from asj.arrays import struct_type
from asj.collection import Plan, Store, StoreError, all_pairs, find_images, read_pairs
from asj.collection.limap import merge
from asj.collection.locations import of_store
from asj.features import segments_of
from asj.output import whole_file
from PIL import Image

MODULE = [sys.executable, "-m", "asj", "collect"]


def content(store: Path) -> list[object]:
    """All results, without the times and places that may differ."""
    with sqlite3.connect(store) as connection:
        return [
            connection.execute("SELECT name, state, error, width, height, features FROM images ORDER BY id").fetchall(),
            connection.execute("SELECT image1, image2, state, error, matches, lines FROM pairs ORDER BY image1, image2").fetchall(),
        ]


@pytest.fixture
def done(photographs: Path, tmp_path: Path) -> Path:
    """The store of a run in one process."""
    assert main(["collect", str(photographs), "--limap", str(tmp_path / "limap"), "--jobs", "1", "--quiet"]) == 1
    return tmp_path / "limap.work"


def test_names_and_pairs(photographs: Path, tmp_path: Path) -> None:
    names = find_images(photographs)
    assert names == ["a.png", "b.png", "broken.png", "c.png", "more/d.png", "other.png"]
    assert len(all_pairs(names)) == 15
    listed = tmp_path / "pairs.txt"
    listed.write_text("a.png b.png # near\n\nb.png a.png\na.png more/d.png\n")
    assert read_pairs(listed, names) == [("a.png", "b.png"), ("a.png", "more/d.png")]
    listed.write_text('"a hall.png" a.png\n"more/d.png" "a hall.png" # "far\n')
    assert read_pairs(listed, ["a hall.png", *names]) == [("a hall.png", "a.png"), ("more/d.png", "a hall.png")]
    refused = {"a.png": "two names", "a hall.png b.png": "3 words .a name with blanks stands in double", "a.png z.png": "no image z.png", "a.png a.png": "itself", 'a.png "b.png': "a quote that"}
    for text, why in refused.items():
        listed.write_text(text)
        with pytest.raises(ValueError, match=why):
            read_pairs(listed, names)
    listed.write_text("a.png b.png\r\n", encoding="utf-8-sig")  # an editor on Windows
    assert read_pairs(listed, names) == [("a.png", "b.png")]
    listed.write_bytes(b"a.png b\xff.png\n")
    with pytest.raises(ValueError, match="pairs.txt: no list of pairs: not UTF-8"):
        read_pairs(listed, names)


def test_a_list_of_pairs_that_never_ends(photographs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["collect", str(photographs), "--limap", str(photographs / "limap"), "--pairs", "/dev/zero"]
    assert main(words) == 2
    assert "/dev/zero: no list of pairs: a line of more than 65535 characters" in capsys.readouterr().err


def test_what_is_left_out_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """By their ending, or since outputs cannot have their names."""
    folder = tmp_path / os.fsdecode(b"photos \xe9")
    folder.mkdir()
    (folder / "a.png").write_bytes(b"no image")
    Image.fromarray(np.full((90, 120), 128, np.uint8)).save(folder / "b.PNG")
    for name in ("c.gif", "d.GIF", "notes", "e.txt"):
        (folder / name).touch()
    words = ["collect", str(folder), "--limap", str(tmp_path / "limap"), "--jobs", "1", "--quiet"]
    assert main([*words, "--overwrite"]) == 1
    said = capsys.readouterr().out.splitlines()
    assert said[1].startswith("  a.png: ") and "photos \\xe9/a.png" in said[1].replace("udce9", "xe9")
    assert said[2:] == ["not looked at, by their ending: 2 .gif, 1 without, 1 .txt"]
    (folder / "a.png").unlink()
    assert main([*words, "--update"]) == 0
    shutil.copy(folder / "b.PNG", folder / os.fsdecode(b"c\xff.png"))
    assert main([*words, "--resume"]) == 1
    misnamed = "  c\\xff.png: its name is not UTF-8, as outputs want it: rename it"
    assert capsys.readouterr().out.splitlines()[-2:] == [misnamed, said[2]]
    (folder / "b.PNG").unlink()
    assert main([*words, "--resume"]) == 2
    assert "no images there; c\\xff.png: its name is not UTF-8" in capsys.readouterr().err


def test_results(done: Path) -> None:
    images, pairs = content(done)
    assert [row[1] for row in images] == ["done", "done", "failed", "done", "done", "done"]  # type: ignore[attr-defined]
    counts = {(row[0], row[1]): len(row[4] or b"") for row in pairs}  # type: ignore[attr-defined]
    assert counts[1, 2] > 20 * 100 and counts[1, 3] == 0  # the third is no image


def test_several_processes(done: Path, photographs: Path, tmp_path: Path) -> None:
    assert main(["collect", str(photographs), "--limap", str(tmp_path / "again"), "--jobs", "3", "--quiet"]) == 1
    assert content(tmp_path / "again.work") == content(done)
    for file in (tmp_path / "limap").glob("*/*.txt"):
        assert file.read_bytes() == (tmp_path / "again" / file.relative_to(tmp_path / "limap")).read_bytes()


def test_killed_and_resumed(done: Path, photographs: Path, tmp_path: Path) -> None:
    words = [*MODULE, str(photographs), "--limap", str(tmp_path / "killed"), "--jobs", "2", "--quiet", "--resume"]
    times = random.Random(5)
    for _ in range(3):
        process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(times.uniform(0.3, 3))
        process.kill()
        process.wait()
    assert subprocess.run(words, stdout=subprocess.DEVNULL).returncode == 1
    assert content(tmp_path / "killed.work") == content(done)


def test_ended_before_the_store_was_whole(photographs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Killed(BaseException):
        pass

    def end(path: Path) -> str:
        raise Killed

    with monkeypatch.context() as patched, pytest.raises(Killed):
        patched.setattr("asj.collection.store._stamp", end)
        Store.create(tmp_path / "early.work", Plan(photographs, ["a.png"], []))
    assert not (tmp_path / "early.work").exists()  # and --resume begins


def test_a_store_without_tables_is_none(photographs: Path, tmp_path: Path) -> None:
    path, plan = tmp_path / "early.work", Plan(photographs, ["a.png"], [])
    for journal in ("DELETE", "WAL"):  # killed before and after the first page was written
        with contextlib.closing(sqlite3.connect(path)) as begun:
            begun.execute(f"PRAGMA journal_mode = {journal}")
        assert path.exists() and not Store.is_there(path)
    with pytest.raises(StoreError, match="not there"):
        Store.resume(path, plan)
    with Store.create(path, plan) as store:
        assert store.counts("images") == {"waiting": 1} and Store.is_there(path)
    with pytest.raises(StoreError, match="there already"):
        Store.create(path, plan)


def test_another_run_begins_meanwhile(photographs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, plan = tmp_path / "two.work", Plan(photographs, ["a.png"], [])
    others = []

    def begin(_: Path) -> str:
        monkeypatch.undo()
        others.append(Store.create(path, plan))
        return "late"

    monkeypatch.setattr("asj.collection.store._stamp", begin)
    with pytest.raises(StoreError, match="there already"):
        Store.create(path, plan)
    with others[0] as store:
        assert store._stamps()["a.png"][1] != "late"


def test_the_log_of_a_deleted_store_is_not_played_into_the_next(photographs: Path, tmp_path: Path) -> None:
    path, plan = tmp_path / "next.work", Plan(photographs, ["a.png"], [])
    killed = (
        "import os, pathlib, sys; from asj.collection import Plan, Store; from asj.collection.tasks import Detected;"
        "store = Store.create(pathlib.Path(sys.argv[1]), Plan(pathlib.Path(sys.argv[2]), ['a.png'], []));"
        "store.save_image(1, Detected('bad', 0, 0, None, None)); os._exit(9)"
    )
    assert subprocess.run([sys.executable, "-c", killed, str(path), str(photographs)]).returncode == 9
    assert path.with_name("next.work-wal").stat().st_size > 0
    path.unlink()
    with Store.create(path, plan) as store:
        assert store.counts("images") == {"waiting": 1}
    with contextlib.closing(sqlite3.connect(path)) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def test_dask_with_a_lost_worker(done: Path, photographs: Path, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    from asj.collection import collect
    from asj.collection.run import Dask

    names = find_images(photographs)
    plan = Plan(photographs, names, all_pairs(names), {"preset": "match"}, {"preset": "default"})
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
        Store.create(tmp_path / "dask.work", plan) as store,
    ):
        pids = list(client.run(lambda: __import__("os").getpid()).values())
        killed: list[int] = []

        def kill_one(what: str, number: int, total: int, left: float) -> None:
            del total, left
            if what == "pairs" and number == 2 and not killed:
                killed.append(pids[0])
                __import__("os").kill(pids[0], 9)

        workers = Dask(client)
        workers.portion = 2
        summary = collect(plan, store, workers, kill_one)
    assert killed and summary.failed_images == 1
    assert content(tmp_path / "dask.work") == content(done)


def test_dask_keeps_features_until_the_last_pair(photographs: Path, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    from asj.collection import collect
    from asj.collection.plan import sequential_pairs
    from asj.collection.run import Dask

    names = find_images(photographs)
    plan = Plan(photographs, names, sequential_pairs(names, 1), {"preset": "match"}, {"preset": "default"})
    kept: list[int] = []
    with (
        distributed.Client(processes=False, n_workers=1, threads_per_worker=1, dashboard_address=None) as client,
        Store.create(tmp_path / "flat.work", plan) as store,
    ):
        workers = Dask(client)
        workers.portion = 2
        told: list[tuple[str, int, int]] = []

        def count(what: str, number: int, total: int, left: float) -> None:
            assert left >= 0
            told.append((what, number, total))
            kept.append(len(workers._features))

        summary = collect(plan, store, workers, count)
    assert (summary.images, summary.failed_images, summary.skipped_pairs) == (6, 1, 2)
    assert max(kept) <= 3  # of six: the last one of a portion, and the two of the next
    assert [t for t in told if t[0] == "images"][-1] == ("images", 6, 6) and told[-1][1:] == (3, 3)


def test_colmap(done: Path, photographs: Path, tmp_path: Path) -> None:
    pycolmap = pytest.importorskip("pycolmap")
    shutil.copy(done, tmp_path / "scene.db.work")
    assert main(["collect", str(photographs), "--colmap", str(tmp_path / "scene.db"), "--resume", "--quiet"]) == 1
    database = pycolmap.Database.open(tmp_path / "scene.db")
    assert database.num_images() == 5
    first, second = (database.read_image_with_name(name).image_id for name in ("a.png", "b.png"))
    one, two = database.read_keypoints(first), database.read_keypoints(second)
    matches = database.read_matches(first, second)
    moved = two[matches[:, 1], :2] - one[matches[:, 0], :2]
    assert one.shape[1] == 6 and len(matches) > 20 and np.mean(np.linalg.norm(moved - (6, 4), axis=1) < 1.5) > 0.9
    assert len(database.read_two_view_geometry(first, second).inlier_matches) > 15
    database.close()


def test_image_without_junctions(tmp_path: Path) -> None:
    """Blank walls are in every output, with nothing in them."""
    pycolmap, _ = pytest.importorskip("pycolmap"), pytest.importorskip("h5py")
    (tmp_path / "walls").mkdir()
    for name in ("a", "b"):
        Image.fromarray(np.full((90, 120), 128, np.uint8)).save(tmp_path / "walls" / f"{name}.png")
    words = ["--colmap", str(tmp_path / "walls.db"), "--hdf5", str(tmp_path / "h5"), "--limap", str(tmp_path / "limap")]
    assert main(["collect", str(tmp_path / "walls"), *words, "--jobs", "1", "--quiet"]) == 0
    database = pycolmap.Database.open(tmp_path / "walls.db")
    assert database.num_images() == 2 and database.num_keypoints() == 0
    database.close()


def test_hdf5(done: Path, photographs: Path, tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    shutil.copy(done, tmp_path / "h5.work")
    assert main(["collect", str(photographs), "--hdf5", str(tmp_path / "h5"), "--resume", "--quiet"]) == 1
    with h5py.File(tmp_path / "h5" / "features.h5") as features, h5py.File(tmp_path / "h5" / "matches.h5") as matches:
        assert features["more/d.png"]["keypoints"].shape[1] == 2 and features["a.png"]["image_size"][:].tolist() == [480, 360]
        matches0 = matches["a.png"]["b.png"]["matches0"][:]
        assert len(matches0) == len(features["a.png"]["keypoints"]) and (matches0 >= 0).sum() > 20
        assert "more-d.png" in matches["a.png"]
        moved = features["b.png"]["keypoints"][:][matches0[matches0 >= 0]] - features["a.png"]["keypoints"][:][matches0 >= 0]
        assert np.median(np.linalg.norm(moved - (6, 4), axis=1)) < 1
        with Store(tmp_path / "h5.work", sqlite3.connect(tmp_path / "h5.work")) as store:
            places, detected = of_store(store), {number: result.features for number, _, result in store.detected()}
        assert np.array_equal(features["a.png"]["keypoints"][:], places[1])  # where its matches put them, as in COLMAP
        assert detected[1] is not None
        junctions = np.frombuffer(detected[1], struct_type("asj_junction"))
        assert np.abs(places[1] - np.stack([junctions["x"], junctions["y"]], 1)).max() > 0.05


def test_limap(done: Path, tmp_path: Path) -> None:
    del done
    names = dict(line.split(" ", 1) for line in (tmp_path / "limap" / "images.txt").read_text(encoding="utf-8").splitlines())
    assert names["1"] == "a.png" and names["2"] == "b.png"
    first = (tmp_path / "limap" / "segments" / "segments_1.txt").read_text().splitlines()
    second = (tmp_path / "limap" / "segments" / "segments_2.txt").read_text().splitlines()
    assert int(first[0]) == len(first) - 1
    one, two = (np.array([line.split() for line in lines[1:]], float) for lines in (first, second))
    pairs = np.array([line.split() for line in (tmp_path / "limap" / "matches" / "matches_1_2.txt").read_text().splitlines()], int)
    first_end, begin, end = one[pairs[:, 0], :2], two[pairs[:, 1], :2], two[pairs[:, 1], 2:4]
    swapped = np.linalg.norm(begin - first_end - (6, 4), axis=1) > np.linalg.norm(end - first_end - (6, 4), axis=1)  # either order
    moved = np.where(swapped[:, None], end, begin) - first_end
    turned = np.arctan2(*(end - begin).T) - np.arctan2(*(one[pairs[:, 0], 2:4] - first_end).T)
    assert len(pairs) > 30 and np.mean(np.linalg.norm(moved - (6, 4), axis=1) < 1.5) > 0.9 and np.median(np.abs(np.sin(turned))) < 0.02


def test_limap_has_each_edge_once(done: Path, tmp_path: Path) -> None:
    lines = {n: np.loadtxt(tmp_path / "limap" / "segments" / f"segments_{n}.txt", skiprows=1) for n in (1, 2, 4, 5, 6)}
    with Store.read(done) as store:
        detected = {number: image.junctions for number, _, image in store.detected() if image.error is None}
        branches = {number: segments_of(junctions) for number, junctions in detected.items()}
        matched = {(one, two): pair.segment_indices for one, two, pair in store.matched()}
    assert detected.keys() == lines.keys()
    for number, (segments, records) in branches.items():
        kept, places = merge(segments, records["log10_nfa"])
        written = lines[number][:, :4].reshape(-1, 2, 2)
        assert len(kept) == len(written) < 0.75 * len(segments)
        own = written[places]  # of each branch: both its ends are there
        apart = np.minimum(*(np.linalg.norm(segments - ends, axis=2).max(axis=1) for ends in (own, own[:, ::-1])))
        assert apart.max() <= 1.001 and (lines[number][places, 4] >= -records["log10_nfa"] - 1e-4).all()
        for other in (written, written[:, ::-1]):  # none twice
            ends = np.linalg.norm(written[:, None] - other, axis=-1).max(axis=-1)
            assert (ends + 9 * np.eye(len(written)) > 1).all()
    of_image = {n: np.load(tmp_path / "limap" / "matches" / f"matches_{n}.npy", allow_pickle=True).item() for n in lines}
    for (one, two), pairs in matched.items():
        places_one, places_two = (merge(branches[n][0], branches[n][1]["log10_nfa"])[1] for n in (one, two))
        expected = {(places_one[i], places_two[j]) for i, j in pairs}
        text = (tmp_path / "limap" / "matches" / f"matches_{one}_{two}.txt").read_text().splitlines()
        assert {tuple(map(int, line.split())) for line in text} == expected and len(text) == len(expected)
        assert of_image[one][two].tolist() == [[int(word) for word in line.split()] for line in text]
        assert np.array_equal(of_image[two][one], of_image[one][two][:, ::-1])
    assert all(neighbours.keys() == lines.keys() - {n} for n, neighbours in of_image.items())


def test_bad_use(done: Path, photographs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def says(words: list[str], why: str) -> None:
        assert main(["collect", *words]) == 2
        assert why in capsys.readouterr().err

    limap = ["--limap", str(tmp_path / "limap")]
    says([str(photographs)], "no output")
    says([str(tmp_path / "nowhere"), *limap], "not a folder")
    says([str(photographs), *limap], "is there already")
    other = "limap.work is of other work: no --set there, --set minimum_length=9 now; name another --store, or delete limap.work"
    says([str(photographs), *limap, "--resume", "--set", "minimum_length=9"], other)
    says([str(photographs), *limap, "--resume", "--match-set", "ratio=2"], "no --match-set there, --match-set ratio=2 now")
    says([str(photographs), *limap, "--resume", "--geometry", "auto"], "--geometry none there, --geometry auto --focal exif now")
    says([str(photographs), *limap, "--set", "minimum_lenght=9"], "did you mean")
    says([str(photographs), "--limap", "/proc/no/folder"], "no folder")
    says([str(photographs), *limap, "--jobs", "0", "--resume"], "jobs is 0")
    says([str(photographs), "--limap", str(tmp_path / "other"), "--jobs", "0"], "jobs is 0")
    assert not (tmp_path / "other.work").exists()
    (tmp_path / "file").touch()
    says([str(photographs), "--limap", str(tmp_path / "file")], "no folder")
    (photographs / "more-d.png").write_bytes((photographs / "more" / "d.png").read_bytes())
    says([str(photographs), "--hdf5", str(tmp_path / "h5")], "more-d.png and more/d.png")
    (photographs / "more-d.png").unlink()
    (tmp_path / "junk.work").write_bytes(b"this is no database" * 100)
    says([str(photographs), "--limap", str(tmp_path / "junk"), "--resume"], "junk.work")
    changed = (photographs / "a.png").stat()
    os.utime(photographs / "a.png", (1, 1))
    says([str(photographs), *limap, "--resume"], "not the file that it was")
    os.utime(photographs / "a.png", ns=(changed.st_atime_ns, changed.st_mtime_ns))
    with sqlite3.connect(done) as connection:
        connection.execute("UPDATE about SET value = 'asj-collection-0' WHERE key = 'format'")
    says([str(photographs), *limap, "--resume"], "asj-collection-0")
    plan = Plan(photographs, ["a.png"], [])
    with pytest.raises(StoreError):
        Store.create(done, plan)


def test_outputs_without_a_name(photographs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "here" / "below").mkdir(parents=True)
    for place, word in (("here", "."), ("here/below", "..")):
        monkeypatch.chdir(tmp_path / place)
        assert main(["collect", str(photographs), "--limap", word, "--jobs", "1", "--quiet", "--resume"]) == 1
        assert (tmp_path / "here.work").exists() and (tmp_path / "here" / "images.txt").exists()
    assert main(["collect", str(photographs), "--limap", "/"]) == 2
    assert "name the --store" in capsys.readouterr().err
    for words in (["--limap", ""], ["--limap", "lines", "--pairs", ""]):
        with pytest.raises(SystemExit, match="2"):
            main(["collect", str(photographs), *words])
        assert "an empty path names nothing" in capsys.readouterr().err


def test_links_to_nothing_are_told(photographs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (photographs / "broken.png").unlink()
    (photographs / "gone.png").symlink_to(tmp_path / "nowhere.png")
    (photographs / "notes").symlink_to(tmp_path / "nowhere")
    assert main(["collect", str(photographs), "--limap", str(tmp_path / "limap"), "--jobs", "1", "--quiet"]) == 1
    assert capsys.readouterr().out.splitlines()[1:] == ["  gone.png: a link to what is not there"]


def test_a_full_disk_is_told_with_the_file(photographs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A limit on the size of files stands in for it, as it does for asj-cli."""
    resource = pytest.importorskip("resource")
    words = [*MODULE, str(photographs), "--limap", str(tmp_path / "limap"), "--jobs", "1", "--quiet"]
    small = subprocess.run(
        words, capture_output=True, text=True, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
    )
    assert small.returncode == 2 and f"{tmp_path / 'limap.work'}: " in small.stderr, small.stderr
    with pytest.raises(OSError, match="full.txt"), whole_file(tmp_path / "full.txt") as temporary:
        temporary.write_text("")
        raise OSError(28, "No space left on device")
    assert not (tmp_path / "full.txt").exists()


@pytest.mark.parametrize(("table", "column", "begin", "instead", "what"), [
    ("images", "features", 1001, b"", "junctions of a.png"), ("images", "features", 20, b"\xff" * 4, "junctions of a.png"),
    ("pairs", "matches", 101, b"", "matches of a.png and b.png"), ("pairs", "lines", 6, b"", "matches of a.png and b.png"),
])  # fmt: skip
def test_damaged_results(
    done: Path, photographs: Path, capsys: pytest.CaptureFixture[str], table: str, column: str, begin: int, instead: bytes,
    what: str,
) -> None:
    """Cut, or with a number of branches that cannot be."""
    with contextlib.closing(sqlite3.connect(done)) as connection, connection:
        data = connection.execute(f"SELECT {column} FROM {table} WHERE id = 1").fetchone()[0]
        damaged = data[:begin] + (instead + data[begin + len(instead) :] if instead else b"")
        connection.execute(f"UPDATE {table} SET {column} = ? WHERE id = 1", (damaged,))
    capsys.readouterr()
    for output in ("--limap", "--colmap", "--hdf5"):
        place = f"{done.parent / 'limap'}{'' if output == '--limap' else output}"
        assert main(["collect", str(photographs), output, place, "--store", str(done), "--resume", "--quiet"]) == 2
        assert f"limap.work is damaged: the {what} are no whole records" in capsys.readouterr().err


def test_the_example_of_the_readme(photographs: Path, tmp_path: Path) -> None:
    """As it stands there, in a folder with photos/."""
    pytest.importorskip("pycolmap")
    (photographs / "broken.png").unlink()
    photographs.rename(tmp_path / "photos")
    text = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
    run, read = (block for block in re.findall("```python\n(.*?)```", text, re.S) if "Store." in block)
    (tmp_path / "run.py").write_text(run)
    (tmp_path / "read.py").write_text("from pathlib import Path\nfrom asj.collection import Store\n" + read)

    def said_by(script: str) -> list[str]:
        result = subprocess.run([sys.executable, script], cwd=tmp_path, stdout=subprocess.PIPE, text=True, check=True)
        return result.stdout.splitlines()

    assert "5 images, 10 pairs in" in said_by("run.py")[0] and (tmp_path / "scene.db").exists()
    lines = said_by("read.py")
    assert re.fullmatch(r"1 a.png \d\d+ 480 360", lines[0]) and len(lines) > 5 + 3 and lines[5].startswith("a.png ")
    with Store.read(tmp_path / "scene.work") as store:
        _, name, image = next(store.detected())
        assert image.features is not None
        again = asj.Features.from_records(asj.read_image(tmp_path / "photos" / name), image.features)
        assert np.array_equal(again.junctions, image.junctions) and len(again) == len(image.junctions)


def test_stores_to_read(done: Path, tmp_path: Path) -> None:
    with Store.read(done) as store:
        assert len(list(store.detected())) == 6 and len(list(store.matched())) == 10
    (tmp_path / "junk").write_bytes(b"this is no database" * 100)
    for path, why in ((tmp_path / "nothing", "is not there"), (tmp_path / "junk", "file is not a database")):
        with pytest.raises(StoreError, match=why):
            Store.read(path)
    with contextlib.closing(sqlite3.connect(done)) as connection, connection:
        connection.execute("UPDATE about SET value = 'asj-collection-0' WHERE key = 'format'")
    with pytest.raises(StoreError, match="asj-collection-0, not"):
        Store.read(done)


def test_full_disk(photographs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    assert main(["collect", str(photographs), "--limap", "/dev/full/x", "--quiet"]) == 2
    assert "/dev/full" in capsys.readouterr().err
