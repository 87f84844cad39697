# SPDX-License-Identifier: BSD-2-Clause
"""Line segments and their matches as LIMAP reads them.

segments/segments_<image>.txt: the count, then x1 y1 x2 y2 score in each line, px of the file (orientation.py), the centre of the first
one at (0, 0). Most edges are seen from both their corners, and stand here once, in the direction of the surer corner: their ends
come in either order. matches/matches_<image>.npy: a dictionary, by the number of each other image that the image makes a pair with,
of (K, 2) indices of segments, counted from 0, of the image and of the other one (numpy.load(path, allow_pickle=True).item()); every
pair stands in the files of both its images. matches/matches_<image1>_<image2>.txt: the same indices of one pair as text, two in
each line. images.txt says which photograph has which number, those of the COLMAP database, in JSON's quotes where a name has a line
break; store.txt which store all this was written from. Segments are the branches as each image by itself has them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

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
    """What is there under a name that write() writes to, and the store of that identity, whose images have numbers up to `highest`,
    has not written."""
    if identity is not None and written_from(folder) == identity:
        return  # also where a run was killed while it wrote: the mark is there first
    yield from (path for name in ("images.txt", "store.txt") if (path := folder / name).exists())
    wanted = {str(number) for number in range(1, highest + 1)}
    yield from (path for path in _numbered(folder) if _numbers_of(path) <= wanted)


def _numbered(folder: Path) -> Iterator[Path]:
    """The files of images and of pairs."""
    for kind in ("segments", "matches"):
        yield from sorted(path for path in (folder / kind).glob(f"{kind}_*") if path.suffix in (".txt", ".npy"))


def _numbers_of(path: Path) -> set[str]:
    """Of its image or images."""
    return set(path.stem.split("_")[1:])


def write(store: Store, folder: Path) -> None:
    """The segments of all images and the matches of all pairs. Files of images and pairs that an earlier run has written here, as its
    images.txt says, and this one has not, go; others stay."""
    earlier = _numbers(folder / "images.txt")
    (folder / "segments").mkdir(parents=True, exist_ok=True)
    (folder / "matches").mkdir(exist_ok=True)
    with whole_file(folder / "store.txt") as temporary:
        temporary.write_text(store.identity() + "\n", encoding="ascii")
    names = []
    written: set[Path] = set()
    of_branches: dict[int, NDArray[np.int64]] = {}
    for number, name, detected in store.detected():
        if detected.features is None:
            continue
        names.append(f"{number} {json.dumps(name) if len(name.splitlines()) > 1 else name}\n")
        segments, branches = segments_of(detected.junctions)
        kept, of_branches[number] = merge(segments, branches["log10_nfa"])
        scores = -branches["log10_nfa"][kept]
        segments = orientation.turn(orientation.to_stored(detected.orientation, detected.width, detected.height), segments[kept])
        written.add(path := folder / "segments" / f"segments_{number}.txt")
        _write_segments(path, segments, scores)
    with whole_file(folder / "images.txt") as temporary:
        temporary.write_text("".join(names), encoding="utf-8")
    written.update(_write_matches(store, folder / "matches", of_branches))
    for path in _numbered(folder):
        if path not in written and _numbers_of(path) <= earlier:
            path.unlink()


def _write_segments(path: Path, segments: NDArray[np.float32], scores: NDArray[np.float32]) -> None:
    with whole_file(path) as temporary, temporary.open("w", encoding="ascii") as file:
        file.write(f"{len(segments)}\n")
        for (start, end), score in zip(segments.tolist(), scores.tolist()):
            file.write(f"{start[0]:.6f} {start[1]:.6f} {end[0]:.6f} {end[1]:.6f} {score:.6f}\n")


def _write_matches(store: Store, folder: Path, of_branches: dict[int, NDArray[np.int64]]) -> Iterator[Path]:
    """Those of all pairs as text, and of all images as dictionaries; tells the paths."""
    of_image: dict[int, dict[int, NDArray[np.int64]]] = {number: {} for number in of_branches}
    for one, two, matched in store.matched():
        if matched.lines is None:
            continue
        branches = matched.segment_indices
        pairs = np.stack([of_branches[one][branches[:, 0]], of_branches[two][branches[:, 1]]], axis=1)
        _, first = np.unique(pairs, axis=0, return_index=True)  # seen from both ends, a match comes twice
        pairs = pairs[np.sort(first)]
        of_image[one][two], of_image[two][one] = pairs, pairs[:, ::-1]
        yield (path := folder / f"matches_{one}_{two}.txt")
        with whole_file(path) as temporary:
            temporary.write_text("".join(f"{i} {j}\n" for i, j in pairs.tolist()), encoding="ascii")
    for number, neighbours in of_image.items():
        yield (path := folder / f"matches_{number}.npy")
        with whole_file(path) as temporary, temporary.open("wb") as file:
            whole = {other: np.ascontiguousarray(pairs) for other, pairs in neighbours.items()}
            np.save(file, np.array(whole, object), allow_pickle=True)


SAME_END = 1.0  # px, between ends of what is one edge seen from both its corners


def merge(segments: NDArray[np.float32], log10_nfa: NDArray[np.float32]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Which segments (M, 2, 2) are kept so that each edge is there once, and of each segment the place of its own edge among these.
    Two are one where both their ends agree, in either order; the surest is kept.

    >>> seen = np.array([[[0, 0], [50, 0]], [[0, 0], [0, 30]], [[50.3, 0.4], [0.2, 0]], [[50.3, 0.4], [90, 0]]], np.float32)
    >>> [places.tolist() for places in merge(seen, np.array([-20, -9, -30, -5], np.float32))]
    [[1, 2, 3], [1, 0, 1, 2]]
    """
    cells: dict[tuple[int, int], list[int]] = {}  # of middles, SAME_END on a side: those of one edge are in neighbouring ones
    edge = np.arange(len(segments))
    middles = np.floor(segments.astype(np.float64).mean(axis=1) / SAME_END).astype(np.int64)
    for number in np.argsort(log10_nfa, kind="stable").tolist():
        x, y = middles[number].tolist()
        near = [other for i in (x - 1, x, x + 1) for j in (y - 1, y, y + 1) for other in cells.get((i, j), ())]
        same = [other for other in near if _is_one_edge(segments[number], segments[other])]
        if same:
            edge[number] = same[0]
        else:
            cells.setdefault((x, y), []).append(number)
    kept, places = np.unique(edge, return_inverse=True)
    return kept, places.reshape(-1)


def _is_one_edge(one: NDArray[np.float32], two: NDArray[np.float32]) -> bool:
    return any(bool((np.hypot(*(one - other).T) <= SAME_END).all()) for other in (two, two[::-1]))


def _numbers(path: Path) -> set[str]:
    """Those of an images.txt that was written here."""
    try:
        return {line.split(" ", 1)[0] for line in path.read_text(encoding="utf-8").splitlines()}
    except (OSError, ValueError):
        return set()
