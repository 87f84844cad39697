# SPDX-License-Identifier: BSD-2-Clause
"""Line segments as LIMAP reads them, and their matches as text.

segments/segments_<image>.txt: the count, then x1 y1 x2 y2 score in each line, px of the file (orientation.py), the centre of the first
one at (0, 0). LIMAP keeps matches in matches/matches_<image>.npy, a dictionary; matches/matches_<image1>_<image2>.txt here has two
indices, counted from 0, in each line. images.txt says which photograph has which number, those of the COLMAP database, in JSON's
quotes where a name has a line break; store.txt which store all this was written from. Segments are the branches as each image by
itself has them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ..features import segments_of
from ..output import whole_file
from . import orientation
from .store import Store


def written_from(folder: Path) -> str | None:
    """The identity of the store that write() wrote the folder from; None where something else has written it."""
    try:
        return (folder / "store.txt").read_text(encoding="ascii").strip()
    except (OSError, ValueError):
        return None


def foreign_files(folder: Path, identity: str | None, highest: int) -> Iterator[Path]:
    """What is there under a name that write() writes to, and the store of that identity, whose images have numbers up to `highest`, has
    not written."""
    ours = identity is not None and written_from(folder) == identity
    earlier = _numbers(folder / "images.txt") if ours else set()
    if not ours:
        yield from (path for name in ("images.txt", "store.txt") if (path := folder / name).exists())
    wanted = {str(number) for number in range(1, highest + 1)}
    for path in _numbered(folder):
        numbers = _numbers_of(path)
        if numbers <= wanted and not numbers <= earlier:
            yield path


def _numbered(folder: Path) -> Iterator[Path]:
    """The files of images and of pairs."""
    for kind in ("segments", "matches"):
        yield from sorted((folder / kind).glob(f"{kind}_*.txt"))


def _numbers_of(path: Path) -> set[str]:
    """Of its image or images."""
    return set(path.stem.split("_")[1:])


def write(store: Store, folder: Path) -> None:
    """The segments of all images and the matches of all pairs. Files of images and pairs that an earlier run has written here, as its
    images.txt says, and this one has not, go; others stay."""
    earlier = _numbers(folder / "images.txt")
    (folder / "segments").mkdir(parents=True, exist_ok=True)
    (folder / "matches").mkdir(exist_ok=True)
    names = []
    written: set[Path] = set()
    for number, name, detected in store.detected():
        if detected.features is None:
            continue
        names.append(f"{number} {json.dumps(name) if len(name.splitlines()) > 1 else name}\n")
        junctions = detected.junctions
        segments, branches = segments_of(junctions)
        segments = orientation.turn(orientation.to_stored(detected.orientation, detected.width, detected.height), segments)
        written.add(path := folder / "segments" / f"segments_{number}.txt")
        with whole_file(path) as temporary, temporary.open("w", encoding="ascii") as file:
            file.write(f"{len(segments)}\n")
            for (start, end), branch in zip(segments.tolist(), branches):
                file.write(f"{start[0]:.6f} {start[1]:.6f} {end[0]:.6f} {end[1]:.6f} {-branch['log10_nfa']:.6f}\n")
    with whole_file(folder / "images.txt") as temporary:
        temporary.write_text("".join(names), encoding="utf-8")
    with whole_file(folder / "store.txt") as temporary:
        temporary.write_text(store.identity() + "\n", encoding="ascii")
    for one, two, matched in store.matched():
        if matched.lines is None:
            continue
        lines = matched.segment_indices
        written.add(path := folder / "matches" / f"matches_{one}_{two}.txt")
        with whole_file(path) as temporary:
            temporary.write_text("".join(f"{i} {j}\n" for i, j in lines.tolist()), encoding="ascii")
    for path in _numbered(folder):
        if path not in written and _numbers_of(path) <= earlier:
            path.unlink()


def _numbers(path: Path) -> set[str]:
    """Those of an images.txt that was written here."""
    try:
        return {line.split(" ", 1)[0] for line in path.read_text(encoding="utf-8").splitlines()}
    except (OSError, ValueError):
        return set()
