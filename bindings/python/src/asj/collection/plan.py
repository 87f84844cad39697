# SPDX-License-Identifier: BSD-2-Clause
"""Which images, and which pairs of them."""

from __future__ import annotations

import os
import shlex
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

ENDINGS = {".avif", ".bmp", ".heic", ".heif", ".jp2", ".jpeg", ".jpg", ".pgm", ".png", ".pnm", ".ppm", ".tif", ".tiff", ".webp"}
_LONGEST_LINE = 65536  # two names of a few thousand letters
_TILE = 16  # images along a side of a tile of pairs: a process keeps that many in memory


@dataclass(frozen=True)
class Plan:
    """The work: images by name below a folder, pairs of names, options of detector and matcher by name, as text (with "preset",
    that of the matcher "default"), the geometry."""

    folder: Path
    images: list[str]
    pairs: list[tuple[str, str]]
    detector: dict[str, str] = field(default_factory=dict)
    matcher: dict[str, str] = field(default_factory=dict)
    geometry: str = "none"
    focal: str = "exif"  # where cameras are known from; "estimate", "none", or what camera_of() reads

    @property
    def camera(self) -> list[float]:
        """camera_of(focal)."""
        return camera_of(self.focal)


def camera_of(word: str) -> list[float]:
    """A focal length in pixels, or fx,fy,cx,cy, that all images share; nothing where the word says where to take it from.

    >>> camera_of("520"), camera_of("520,521,319.5,240"), camera_of("exif")
    ([520.0], [520.0, 521.0, 319.5, 240.0], [])
    """
    return [] if word in ("exif", "estimate", "none") else [float(number) for number in word.split(",")]


@dataclass(frozen=True)
class Found:
    """What there is below a folder."""

    images: list[str]  # names of the image files, sorted, with / between folders
    misnamed: list[str]  # image files whose names are not UTF-8, which no output can have; what is not is written as \x..
    endings: dict[str, int]  # of the other files, in small letters, and how many have it; "" is none
    dangling: list[str] = field(default_factory=list)  # names of image files that are links to what is not there

    def left_out(self) -> str:
        """A line about the other files; empty where there are none.

        >>> Found([], [], {".txt": 1, "": 1, ".gif": 12}).left_out()
        'not looked at, by their ending: 12 .gif, 1 without, 1 .txt'
        """
        counts = sorted(self.endings.items(), key=lambda item: (-item[1], item[0]))
        words = ", ".join(f"{count} {ending or 'without'}" for ending, count in counts)
        return f"not looked at, by their ending: {words}" if words else ""


def look_in(folder: Path) -> Found:
    """The images below the folder, and what is left out."""
    if not folder.is_dir():
        raise NotADirectoryError(f"{folder} is not a folder")
    images, misnamed, dangling, endings = [], [], [], Counter[str]()
    for path in folder.rglob("*"):
        if path.is_symlink() and not path.exists() and path.suffix.lower() in ENDINGS:
            dangling.append(_printable(path.relative_to(folder).as_posix()))
        if not path.is_file():
            continue
        if path.suffix.lower() not in ENDINGS:
            endings[_printable(path.suffix.lower())] += 1
            continue
        name = path.relative_to(folder).as_posix()
        if _printable(name) == name:
            images.append(name)
        else:
            misnamed.append(_printable(name))
    return Found(sorted(images), sorted(misnamed), dict(endings), sorted(dangling))


def _printable(name: str) -> str:
    """A name of the file system as text: what is not UTF-8 in it as \\x.."""
    return os.fsencode(name).decode("utf-8", "backslashreplace")


def find_images(folder: Path) -> list[str]:
    """Names of the image files below the folder, sorted, with / between folders."""
    return look_in(folder).images


def all_pairs(names: list[str]) -> list[tuple[str, str]]:
    """Every pair, tile by tile, so that neighbouring pairs need the same images.

    >>> all_pairs(["a", "b", "c"])
    [('a', 'b'), ('a', 'c'), ('b', 'c')]
    """
    order = [(i, j) for i in range(len(names)) for j in range(i + 1, len(names))]
    order.sort(key=lambda pair: (pair[0] // _TILE, pair[1] // _TILE, pair))
    return [(names[i], names[j]) for i, j in order]


def sequential_pairs(names: list[str], reach: int) -> list[tuple[str, str]]:
    """Each image with the `reach` images that follow it.

    >>> sequential_pairs(["a", "b", "c"], 1)
    [('a', 'b'), ('b', 'c')]
    """
    return [(name, other) for i, name in enumerate(names) for other in names[i + 1 : i + 1 + reach]]


def _words(line: str) -> list[str]:
    """Words of a line, also with blanks between double quotes; # begins a comment.

    >>> _words('"a b.png" c.png # both')
    ['a b.png', 'c.png']
    """
    lexer = shlex.shlex(line, posix=True)
    lexer.whitespace_split, lexer.commenters, lexer.quotes, lexer.escape = True, "#", '"', ""
    return list(lexer)


def _lines(path: Path) -> Iterator[str]:
    """Lines of a text file, which a device that never ends is none of."""
    with path.open(encoding="utf-8-sig") as file:  # editors on Windows put a byte order mark before text
        try:
            while line := file.readline(_LONGEST_LINE):
                if len(line) == _LONGEST_LINE and not line.endswith("\n"):
                    raise ValueError(f"{path}: no list of pairs: a line of more than {_LONGEST_LINE - 1} characters")
                yield line
        except UnicodeDecodeError:
            raise ValueError(f"{path}: no list of pairs: not UTF-8") from None


def read_pairs(path: Path, names: Iterable[str]) -> list[tuple[str, str]]:
    """Pairs from a text file, two names a line, those with blanks in double quotes; # begins a comment. Pairs that come twice, or
    turned round, stay once."""
    known = set(names)
    seen: set[frozenset[str]] = set()
    pairs = []
    for number, line in enumerate(_lines(path), 1):
        try:
            words = _words(line)
        except ValueError:
            raise ValueError(f"{path}, line {number}: a quote that does not end") from None
        if not words:
            continue
        if len(words) != 2:
            raise ValueError(f"{path}, line {number}: two names of images, not {len(words)} words (a name with blanks stands in double quotes)")
        for word in words:
            if word not in known:
                raise ValueError(f"{path}, line {number}: there is no image {word}")
        if words[0] == words[1]:
            raise ValueError(f"{path}, line {number}: an image cannot be matched with itself")
        if frozenset(words) not in seen:
            seen.add(frozenset(words))
            pairs.append((words[0], words[1]))
    return pairs
