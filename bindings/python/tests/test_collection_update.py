# SPDX-License-Identifier: BSD-2-Clause
"""Collections that grow: what has been done and still holds stays, and all is as if it had been done at once."""

from __future__ import annotations

import contextlib
import os
import sqlite3
from pathlib import Path

import pytest
from asj.__main__ import main
from asj.collection import Plan, Store, StoreError, all_pairs, find_images, sequential_pairs

from conftest import panels


def by_name(store: Path) -> tuple[list[object], list[object]]:
    """All results, by the names of images."""
    with sqlite3.connect(store) as connection:
        return (
            connection.execute("SELECT name, stamp, state, error, width, height, focal, features FROM images ORDER BY name").fetchall(),
            connection.execute(
                "SELECT a.name, b.name, p.state, p.error, matches, lines FROM pairs p JOIN images a ON a.id = image1 "
                "JOIN images b ON b.id = image2 ORDER BY a.name, b.name"
            ).fetchall(),
        )


def waiting(store: Path) -> tuple[set[str], set[tuple[str, str]]]:
    """What is to be done, by name."""
    images, pairs = by_name(store)
    return {row[0] for row in images if row[2] == "waiting"}, {row[:2] for row in pairs if row[2] == "waiting"}  # type: ignore[index]


def collect(folder: Path, output: Path, *words: str) -> int:
    return main(["collect", str(folder), "--limap", str(output), "--jobs", "1", "--quiet", *words])


def test_new_changed_and_gone(photographs: Path, tmp_path: Path) -> None:
    from PIL import Image

    (photographs / "broken.png").unlink()
    aside = tmp_path / "aside.png"
    os.rename(photographs / "a.png", aside)  # comes later, and is the first by name
    assert collect(photographs, tmp_path / "grown", "--update") == 0  # nothing to go on with: a first run
    store = tmp_path / "grown.work"
    before = {row[0]: row for row in by_name(store)[0]}  # type: ignore[index]

    os.rename(aside, photographs / "a.png")
    (photographs / "other.png").unlink()
    Image.fromarray(panels(shift=(3, -7))).save(photographs / "b.png")
    assert collect(photographs, tmp_path / "grown", "--resume") == 2
    names = find_images(photographs)
    plan = Plan(photographs, names, all_pairs(names), {"preset": "match"}, {"preset": "default"})
    with Store.update(store, plan) as updated:
        assert updated.pairs_to_do() == 5
    assert waiting(store) == ({"a.png", "b.png"}, {pair for pair in plan.pairs if "a.png" in pair or "b.png" in pair})
    kept = {row[0]: row for row in by_name(store)[0]}  # type: ignore[index]
    assert kept["c.png"] == before["c.png"] and kept["more/d.png"] == before["more/d.png"] and "other.png" not in kept

    assert collect(photographs, tmp_path / "grown", "--resume") == 0  # goes on with the update
    assert collect(photographs, tmp_path / "once") == 0
    assert by_name(store) == by_name(tmp_path / "once.work")
    assert all(row[2] == "done" for part in by_name(store) for row in part)  # type: ignore[index]
    # numbers go by the order in which images came: the same lines, under other numbers
    numbers = {line.split(" ")[1]: line.split(" ")[0] for line in (tmp_path / "grown" / "images.txt").read_text().splitlines()}
    once = {line.split(" ")[1]: line.split(" ")[0] for line in (tmp_path / "once" / "images.txt").read_text().splitlines()}
    assert numbers.keys() == once.keys() and numbers != once
    for name, number in numbers.items():
        segments = (tmp_path / "grown" / "segments" / f"segments_{number}.txt").read_bytes()
        assert segments == (tmp_path / "once" / "segments" / f"segments_{once[name]}.txt").read_bytes()
    assert len(list((tmp_path / "grown" / "segments").iterdir())) == 4
    assert sorted(path.suffix for path in (tmp_path / "grown" / "matches").iterdir()) == [".npy"] * 4 + [".txt"] * 6
    # of b, c, more/d and other, other has gone: its number stays free
    assert numbers == {"a.png": "5", "b.png": "1", "c.png": "2", "more/d.png": "3"}
    (photographs / "a.png").unlink()
    assert collect(photographs, tmp_path / "grown", "--update") == 0
    Image.fromarray(panels(zoom=0.97)).save(photographs / "e.png")
    assert collect(photographs, tmp_path / "grown", "--update") == 0
    assert "6 e.png" in (tmp_path / "grown" / "images.txt").read_text().splitlines()


def test_nothing_is_done_twice(photographs: Path, tmp_path: Path) -> None:
    assert collect(photographs, tmp_path / "out") == 1
    store = tmp_path / "out.work"
    before = by_name(store)
    names = find_images(photographs)
    with Store.update(store, Plan(photographs, names, all_pairs(names), {"preset": "match"}, {"preset": "default"})) as updated:
        assert updated.waiting_images() == [] and updated.waiting_pairs() == []
    assert by_name(store) == before
    # fewer pairs, and the rest again
    assert collect(photographs, tmp_path / "out", "--update", "--sequential", "1") == 1
    assert {row[:2] for row in by_name(store)[1]} == set(sequential_pairs(names, 1))  # type: ignore[index]
    assert collect(photographs, tmp_path / "out", "--update") == 1
    assert by_name(store) == before


def test_no_pairs_first(photographs: Path, tmp_path: Path) -> None:
    pycolmap, _ = pytest.importorskip("pycolmap"), pytest.importorskip("h5py")
    words = ["--colmap", str(tmp_path / "x.db"), "--hdf5", str(tmp_path / "h5")]
    assert collect(photographs, tmp_path / "out", *words, "--no-pairs") == 1
    images, pairs = by_name(tmp_path / "x.db.work")
    assert len(images) == 6 and pairs == []
    with contextlib.closing(pycolmap.Database.open(tmp_path / "x.db")) as database:
        assert database.num_images() == 5 and database.num_keypoints() > 100
    (tmp_path / "pairs.txt").write_text("a.png b.png\n")
    assert collect(photographs, tmp_path / "out", *words, "--update", "--pairs", str(tmp_path / "pairs.txt")) == 1
    again, pairs = by_name(tmp_path / "x.db.work")
    assert again == images and [row[2] for row in pairs] == ["done"]  # type: ignore[index]


def test_database(photographs: Path, tmp_path: Path) -> None:
    pycolmap = pytest.importorskip("pycolmap")
    (photographs / "broken.png").unlink()
    words = ["collect", str(photographs), "--jobs", "1", "--quiet", "--colmap"]
    aside = tmp_path / "aside.png"
    os.rename(photographs / "a.png", aside)
    assert main([*words, str(tmp_path / "grown.db")]) == 0
    os.rename(aside, photographs / "a.png")
    assert main([*words, str(tmp_path / "grown.db"), "--update"]) == 0
    assert main([*words, str(tmp_path / "once.db")]) == 0
    with contextlib.closing(pycolmap.Database.open(tmp_path / "grown.db")) as database:
        # those that were there keep their numbers, and so do their cameras
        found_numbers = {image.name: (image.image_id, image.camera_id) for image in database.read_all_images()}
    assert found_numbers == {"b.png": (1, 1), "c.png": (2, 2), "more/d.png": (3, 3), "other.png": (4, 4), "a.png": (5, 5)}
    found = []
    for name in ("grown.db", "once.db"):
        database = pycolmap.Database.open(tmp_path / name)
        numbers = {image.name: image.image_id for image in database.read_all_images()}
        of_pairs = {}
        for one, two in all_pairs(sorted(numbers)):
            of_pairs[one, two] = database.read_matches(numbers[one], numbers[two]).tolist()
        found.append((sorted(numbers), of_pairs))
        database.close()
    assert found[0] == found[1] and sum(len(rows) for rows in found[0][1].values()) > 100


def test_of_other_options(photographs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert collect(photographs, tmp_path / "out") == 1
    before = by_name(tmp_path / "out.work")
    assert collect(photographs, tmp_path / "out", "--update", "--set", "minimum_length=9") == 2
    assert "other work" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        collect(photographs, tmp_path / "out", "--update", "--resume")
    (photographs / "new.png").write_bytes((photographs / "a.png").read_bytes())
    with pytest.raises(StoreError, match="--update"):
        names = find_images(photographs)
        Store.resume(tmp_path / "out.work", Plan(photographs, names, all_pairs(names), {"preset": "match"}, {"preset": "default"}))
    assert by_name(tmp_path / "out.work") == before
