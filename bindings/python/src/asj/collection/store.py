# SPDX-License-Identifier: BSD-2-Clause
"""What has been done so far: an SQLite file that survives a process killed at any moment. One process writes it."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import secrets
import sqlite3
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType

from .. import __version__
from .plan import Plan, camera_of
from .tasks import Detected, Matched

_FORMAT = "asj-collection-4"
_FOCAL = "focal"  # Plan.focal, for outputs
_IDENTITY = "identity"  # by chance: outputs have it too, so that no other collection's are replaced
_HIGHEST = "highest image"  # the highest number that an image has had: with it, no other image gets one that was in use
_SCHEMA = """
CREATE TABLE about (key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT;
CREATE TABLE images (
    id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, stamp TEXT NOT NULL, state TEXT NOT NULL DEFAULT 'waiting', error TEXT,
    width INTEGER, height INTEGER, focal REAL, features BLOB, orientation INTEGER, camera TEXT) STRICT;
CREATE TABLE pairs (
    id INTEGER PRIMARY KEY, image1 INTEGER NOT NULL REFERENCES images(id), image2 INTEGER NOT NULL REFERENCES images(id),
    state TEXT NOT NULL DEFAULT 'waiting', error TEXT, matches BLOB, lines BLOB, geometry TEXT,
    UNIQUE (image1, image2)) STRICT;
"""


class StoreError(Exception):
    """A store that cannot be used: of another version, of other work, damaged."""


class Store:
    """The results of a collection. A transaction holds one result: it is there whole, or not yet."""

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._connection = connection

    @classmethod
    def create(cls, path: Path, plan: Plan) -> Store:
        """A new store with all work waiting, in one transaction. In its place, and not written beside it and renamed: so SQLite itself
        lets one of two runs begin, and removes the log of a store that was killed and deleted."""
        there = f"{path} is there already: go on with it, or write its outputs again (--resume), or remove it"
        if cls.is_there(path):
            raise StoreError(there)
        numbers = {name: number for number, name in enumerate(plan.images, 1)}
        images = [(number, name, _stamp(plan.folder / name)) for name, number in numbers.items()]
        about = [*_about(plan).items(), (_FOCAL, plan.focal), (_HIGHEST, str(len(numbers))), (_IDENTITY, _new_identity())]
        connection = _connect(path)
        try:
            with connection:
                connection.execute("BEGIN IMMEDIATE")
                if _has_tables(connection):  # of another run, meanwhile
                    raise StoreError(there)
                for table in _SCHEMA.split(";")[:-1]:
                    connection.execute(table)
                connection.executemany("INSERT INTO about VALUES (?, ?)", about)
                connection.executemany("INSERT INTO images (id, name, stamp) VALUES (?, ?, ?)", images)
                connection.executemany(
                    "INSERT INTO pairs (image1, image2) VALUES (?, ?)", [(numbers[one], numbers[two]) for one, two in plan.pairs]
                )
        except BaseException:
            connection.close()
            raise
        return cls(path, connection)

    @staticmethod
    def is_there(path: Path) -> bool:
        """A file without tables, which a run leaves that is killed as it begins, is as good as none."""
        if not path.exists():
            return False
        try:
            with contextlib.closing(sqlite3.connect(path, timeout=60)) as connection:
                return _has_tables(connection)
        except sqlite3.DatabaseError:
            return True  # something else

    @staticmethod
    def before_outputs(path: Path, plan: Plan) -> tuple[str | None, int]:
        """Of the store that is there: its identity, None where there is no store, or one of a version that had none; and the
        highest number that an image of the plan will have."""
        try:
            if Store.is_there(path):
                with contextlib.closing(sqlite3.connect(path, timeout=60)) as connection:
                    about = dict(connection.execute("SELECT key, value FROM about"))
                    known = dict(connection.execute("SELECT name, id FROM images"))
                new = sum(name not in known for name in plan.images)
                return about.get(_IDENTITY), max(int(about.get(_HIGHEST, 0)), *known.values(), 0) + new
        except sqlite3.DatabaseError:
            pass  # something else: opening it tells what
        return None, len(plan.images)

    @classmethod
    def read(cls, path: Path) -> Store:
        """The store of any work, to read its results: detected(), matched(), failures()."""
        if not cls.is_there(path):
            raise StoreError(f"{path} is not there")
        connection = _connect(path)
        try:
            found = connection.execute("SELECT value FROM about WHERE key = 'format'").fetchone()
            if not found or found[0] != _FORMAT:
                raise StoreError(f"{path} is of another version of stores: {found[0] if found else 'none is told'}, not {_FORMAT}")
        except sqlite3.DatabaseError as bad:
            connection.close()
            raise StoreError(f"{path} is no store of a collection: {bad}") from bad
        except BaseException:
            connection.close()
            raise
        return cls(path, connection)

    @classmethod
    def resume(cls, path: Path, plan: Plan) -> Store:
        """The store of the same work, with what has been done."""
        store = cls._open(path, plan)
        try:
            stamps = store._stamps()
            if stamps.keys() != set(plan.images) or set(store._pairs()) != set(plan.pairs):
                raise StoreError(f"{path} is of other work: its images or pairs differ (--update takes them over)")
            for name, (_, stamp) in stamps.items():
                if _stamp(plan.folder / name) != stamp:
                    raise StoreError(f"{path} is of other work: {plan.folder / name} is not the file that it was (--update takes it over)")
        except BaseException:
            store.close()
            raise
        return store

    @classmethod
    def update(cls, path: Path, plan: Plan) -> Store:
        """The store of work whose images or pairs have become others since, with what has been done and still holds: what is new
        waits, as an image whose file is another one does with its pairs, and what is gone is forgotten."""
        store = cls._open(path, plan)
        try:
            with store._connection:
                store._take_over(plan)
        except BaseException:
            store.close()
            raise
        return store

    @classmethod
    def _open(cls, path: Path, plan: Plan) -> Store:
        """A store that is there, with results of the same options."""
        if not cls.is_there(path):
            raise StoreError(f"{path} is not there: nothing to go on with")
        connection = _connect(path)
        try:
            found = dict(connection.execute("SELECT key, value FROM about"))
        except sqlite3.DatabaseError as bad:
            connection.close()
            raise StoreError(f"{path} is no store of a collection: {bad}") from bad
        for key, wanted in _about(plan).items():
            if found.get(key) != wanted:
                connection.close()
                there, now = _in_words(key, found.get(key)), _in_words(key, wanted)
                raise StoreError(
                    f"{path} is of other work: {there} there, {now} now; name another --store, or delete {path.name} to begin anew"
                )
        with connection:
            if found.get(_FOCAL) != plan.focal:  # no match depends on it
                connection.execute("INSERT OR REPLACE INTO about VALUES (?, ?)", (_FOCAL, plan.focal))
            if _IDENTITY not in found:
                connection.execute("INSERT INTO about VALUES (?, ?)", (_IDENTITY, _new_identity()))
        return cls(path, connection)

    def _stamps(self) -> dict[str, tuple[int, str]]:
        """Number and stamp of every image by its name."""
        return {name: (number, stamp) for number, name, stamp in self._connection.execute("SELECT id, name, stamp FROM images ORDER BY id")}

    def _highest(self) -> int:
        """0 in a store of a version that did not keep it."""
        row = self._connection.execute("SELECT value FROM about WHERE key = ?", (_HIGHEST,)).fetchone()
        return int(row[0]) if row else 0

    def _pairs(self) -> dict[tuple[str, str], int]:
        """The number of every pair of names."""
        rows = self._connection.execute(
            "SELECT a.name, b.name, p.id FROM pairs p JOIN images a ON a.id = image1 JOIN images b ON b.id = image2"
        )
        return {(one, two): number for one, two, number in rows}

    def _take_over(self, plan: Plan) -> None:
        """Makes the images and pairs those of the plan; inside a transaction."""
        connection, stamps, pairs = self._connection, self._stamps(), self._pairs()
        now = {name: _stamp(plan.folder / name) for name in plan.images}
        wanted = set(plan.pairs)
        highest = max(self._highest(), *(number for number, _ in stamps.values()), 0)
        connection.executemany("DELETE FROM pairs WHERE id = ?", [(number,) for names, number in pairs.items() if names not in wanted])
        connection.executemany("DELETE FROM images WHERE id = ?", [(number,) for name, (number, _) in stamps.items() if name not in now])
        changed = [(now[name], number) for name, (number, stamp) in stamps.items() if name in now and now[name] != stamp]
        connection.executemany(
            "UPDATE images SET stamp = ?, state = 'waiting', error = NULL, width = NULL, height = NULL, focal = NULL, features = NULL, "
            "orientation = NULL, camera = NULL WHERE id = ?",
            changed,
        )
        without = "(SELECT id FROM images WHERE state = 'waiting')"
        connection.execute(
            "UPDATE pairs SET state = 'waiting', error = NULL, matches = NULL, lines = NULL, geometry = NULL "
            f"WHERE state <> 'waiting' AND (image1 IN {without} OR image2 IN {without})"
        )
        new = [(number, name, now[name]) for number, name in enumerate((name for name in plan.images if name not in stamps), highest + 1)]
        connection.executemany("INSERT INTO images (id, name, stamp) VALUES (?, ?, ?)", new)
        connection.execute("INSERT OR REPLACE INTO about VALUES (?, ?)", (_HIGHEST, str(highest + len(new))))
        numbers = {name: number for name, (number, _) in self._stamps().items()}
        connection.executemany(
            "INSERT INTO pairs (image1, image2) VALUES (?, ?)", [(numbers[one], numbers[two]) for one, two in plan.pairs if (one, two) not in pairs]
        )

    def close(self) -> None:
        """Ends the connection; the write-ahead log goes into the file."""
        self._connection.close()

    def __enter__(self) -> Store:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def images(self) -> list[tuple[int, str]]:
        """Number and name of every image."""
        return self._connection.execute("SELECT id, name FROM images ORDER BY id").fetchall()

    def identity(self) -> str:
        """What tells this store from any other one; its outputs have it too."""
        value: str = self._connection.execute("SELECT value FROM about WHERE key = ?", (_IDENTITY,)).fetchone()[0]
        return value

    def given_camera(self) -> list[float]:
        """What the user gave for all images, px: a focal length, or two and the principal point, or nothing."""
        value: str = self._connection.execute("SELECT value FROM about WHERE key = ?", (_FOCAL,)).fetchone()[0]
        return camera_of(value)

    def waiting_images(self) -> list[tuple[int, str]]:
        """Those without a result."""
        return self._connection.execute("SELECT id, name FROM images WHERE state = 'waiting' ORDER BY id").fetchall()

    def waiting_pairs(self) -> list[tuple[int, int, int]]:
        """Number of the pair and of its two images, of those without a result whose images both have one."""
        return self._connection.execute(
            "SELECT p.id, image1, image2 FROM pairs p JOIN images a ON a.id = image1 JOIN images b ON b.id = image2 "
            "WHERE p.state = 'waiting' AND a.state = 'done' AND b.state = 'done' ORDER BY p.id"
        ).fetchall()

    def pairs_to_do(self) -> int:
        """How many have no result yet, without those of images that failed."""
        count: int = self._connection.execute(
            "SELECT COUNT(*) FROM pairs p JOIN images a ON a.id = image1 JOIN images b ON b.id = image2 "
            "WHERE p.state = 'waiting' AND a.state <> 'failed' AND b.state <> 'failed'"
        ).fetchone()[0]
        return count

    def images_wanted_later(self) -> set[int]:
        """Those that have a result, and a pair with an image that has none yet."""
        rows = self._connection.execute(
            "SELECT image1 FROM pairs p JOIN images b ON b.id = image2 WHERE p.state = 'waiting' AND b.state = 'waiting' "
            "UNION SELECT image2 FROM pairs p JOIN images a ON a.id = image1 WHERE p.state = 'waiting' AND a.state = 'waiting'"
        )
        return {image for (image,) in rows}

    def save_image(self, number: int, result: Detected) -> None:
        """The result of one image, in a transaction of its own."""
        with self._connection:
            self._connection.execute(
                "UPDATE images SET state = ?, error = ?, width = ?, height = ?, focal = ?, features = ?, orientation = ?, camera = ? "
                "WHERE id = ?",
                (_state(result.error), *dataclasses.astuple(result), number),
            )

    def save_pair(self, number: int, result: Matched) -> None:
        """The result of one pair, in a transaction of its own."""
        with self._connection:
            self._connection.execute(
                "UPDATE pairs SET state = ?, error = ?, matches = ?, lines = ?, geometry = ? WHERE id = ?",
                (_state(result.error), result.error, result.matches, result.lines, result.geometry, number),
            )

    def detected(self) -> Iterator[tuple[int, str, Detected]]:
        """Number, name and result of every image that has one, in order."""
        for number, name, error, width, height, focal, features, orientation, camera in self._connection.execute(
            "SELECT id, name, error, width, height, focal, features, orientation, camera FROM images WHERE state <> 'waiting' ORDER BY id"
        ):
            detected = Detected(error, width or 0, height or 0, focal, features, orientation or 1, camera)
            self._refuse_damaged(detected, name)
            yield number, name, detected

    def features(self, number: int) -> Detected:
        """The result of one image."""
        name, *row = self._connection.execute(
            "SELECT name, error, width, height, focal, features, orientation, camera FROM images WHERE id = ?", (number,)
        ).fetchone()
        detected = Detected(*row)
        self._refuse_damaged(detected, name)
        return detected

    def _refuse_damaged(self, result: Detected | Matched, *names: str) -> None:
        if result.is_damaged:
            what = "junctions" if isinstance(result, Detected) else "matches"
            of = " and ".join(names)
            raise StoreError(f"{self.path} is damaged: the {what} of {of} are no whole records; delete it to begin anew")

    def matched(self) -> Iterator[tuple[int, int, Matched]]:
        """Numbers of both images and result of every pair that has one, ordered by the images."""
        for one, two, error, matches, lines, geometry in self._connection.execute(
            "SELECT image1, image2, error, matches, lines, geometry FROM pairs WHERE state <> 'waiting' ORDER BY image1, image2"
        ):
            matched = Matched(error, matches, lines, geometry)
            if matched.is_damaged:
                names = dict(self.images())
                self._refuse_damaged(matched, names[one], names[two])
            yield one, two, matched

    def counts(self, table: str) -> dict[str, int]:
        """How many images or pairs are in which state."""
        if table not in ("images", "pairs"):
            raise ValueError(table)
        return dict(self._connection.execute(f"SELECT state, count(*) FROM {table} GROUP BY state"))

    def failures(self) -> list[tuple[str, str]]:
        """Names of what failed, and why."""
        rows: list[tuple[str, str]] = self._connection.execute("SELECT name, error FROM images WHERE state = 'failed' ORDER BY id").fetchall()
        rows += self._connection.execute(
            "SELECT a.name || ' ' || b.name, p.error FROM pairs p JOIN images a ON a.id = image1 JOIN images b ON b.id = image2 "
            "WHERE p.state = 'failed' ORDER BY p.id"
        ).fetchall()
        return rows


def _new_identity() -> str:
    return secrets.token_hex(16)


def _stamp(path: Path) -> str:
    """Tells a file from another one of its name: size and time of the last change."""
    try:
        about = path.stat()
    except OSError:
        return "not there"
    return f"{about.st_size} {about.st_mtime_ns}"


def _state(error: str | None) -> str:
    return "failed" if error else "done"


def _about(plan: Plan) -> dict[str, str]:
    return {
        "format": _FORMAT,
        "version": __version__,
        "detector": json.dumps(plan.detector, sort_keys=True),
        "matcher": json.dumps(plan.matcher, sort_keys=True),
        # a camera that no match depends on is none of what the results are of
        "geometry": json.dumps([plan.geometry, plan.focal] if plan.geometry in ("auto", "essential") else [plan.geometry]),
    }


def _in_words(key: str, value: str | None) -> str:
    """A row of _about() as the options that ask for it.

    >>> _in_words("geometry", '["auto", "520"]'), _in_words("detector", '{"octaves": "1", "preset": "match"}'), _in_words("version", "1.0")
    ('--geometry auto --focal 520', '--set octaves=1', 'version 1.0')
    """
    if value is None or key in ("format", "version"):
        return f"{key} {value}"
    if key == "geometry":
        model, *focal = json.loads(value)
        return " ".join([f"--geometry {model}", *(f"--{'camera' if len(camera_of(word)) > 1 else 'focal'} {word}" for word in focal)])
    option = "--set" if key == "detector" else "--match-set"
    return " ".join(f"{option} {name}={word}" for name, word in json.loads(value).items() if name != "preset") or f"no {option}"


def _has_tables(connection: sqlite3.Connection) -> bool:
    return bool(connection.execute("SELECT COUNT(*) FROM sqlite_master").fetchone()[0])


def _connect(path: Path) -> sqlite3.Connection:
    try:
        connection = sqlite3.connect(path, timeout=60)
        connection.execute("PRAGMA journal_mode = WAL")
        connection.execute("PRAGMA synchronous = NORMAL")
    except sqlite3.DatabaseError as bad:
        raise StoreError(f"{path}: {bad}") from bad
    return connection
