# SPDX-License-Identifier: BSD-2-Clause
"""The measures of the experiments, checked before they are used: against the library's own test programs, which compute some of
them too, and on cases whose answer is known."""
import os

import numpy as np

from . import criteria, images, junctions, library, matches, pairs, score, tables


class Wrong(Exception):
    """A measure does not give what it must."""


def _expect(what, got, wanted):
    if got != wanted:
        raise Wrong("%s: %s, expected %s" % (what, got, wanted))


def _square(scale=1.0):
    """Two junctions, 50 px apart, three branches each."""
    angle = np.full((2, junctions.MAX_BRANCHES), np.nan)
    length = angle.copy()
    angle[:, :3], length[:, :3] = (0.0, 1.5, 6.2), (40.0, 60.0, 80.0)
    return junctions.Junctions(np.array([[10.0, 20.0], [60.0, 20.0]]) * scale, np.array([12.0, 12.0]), angle, length * scale,
                               np.zeros((0, 3), int))


def _check_criteria():
    first, second = _square(), _square(0.5)
    half = criteria.Homography(np.diag([0.5, 0.5, 1.0]), 1.0, (100, 100))
    _expect("ASJ of a half-size copy", criteria.rate(first, second, half, criteria.ASJ), (2, 2))
    _expect("ACJ of scales that do not follow", criteria.rate(first, second, half, criteria.ACJ), (0, 2))
    second.angle[0, 1] += np.pi / 20 + 0.01
    _expect("a branch that turned too far", criteria.rate(first, second, half, criteria.ASJ), (1, 2))
    second.length[1, 2] += 3.01
    _expect("and a length that is 3.01 px off, with no other near it", criteria.rate(first, second, half, criteria.ASJ), (0, 2))
    _expect("location alone", criteria.rate(first, second, half, criteria.PLACE), (2, 2))


def _check_score(lib):
    shifted = pairs.Pair("shift", pairs.HOMOGRAPHY, "", "", np.array([[1.0, 0, 7], [0, 1, 0], [0, 0, 1]]))
    judge, p = score.Judge(lib, shifted), np.array([[10.0, 10.0], [30.0, 40.0]])
    _expect("points 4.9 and 5.1 px off", list(judge.points(p, p + [[11.9, 0], [12.1, 0]])), [True, False])
    far = p + [[0, 30.0], [0, 30.0]]
    _expect("segments with swapped ends", list(judge.segments(p, far, far + [7, 0], p + [7, 0])), [0.0, 0.0])
    _expect("the same, in any order", list(judge.segments(p, far, far + [7, 0], p + [7, 0], True)), [1.0, 1.0])
    end = [score.DIRECTION_LENGTH * np.array([np.cos(turn), np.sin(turn)]) for turn in np.radians([9.5, 10.5])]
    _expect("branches that turn by 9.5 and 10.5 degrees", list(judge.directions(p, p + [50.0, 0], p + [7, 0], p + [7, 0] + end)),
            [True, False])
    rows = pairs.Pair("rows", pairs.FUNDAMENTAL, "", "", np.array([[0.0, 0, 0], [0, 0, -1], [0, 1, 0]]))
    _expect("epipolar lines that are rows", list(score.Judge(lib, rows).points(p, p + [[50, 2.9], [50, 3.1]])), [True, False])
    _expect("branches whose ends are 4.9 and 5.1 px off their rows",
            list(score.Judge(lib, rows).directions(p, far, p, far + [[9, 4.9], [9, 5.1]])), [True, False])
    labels = {"segments1": [[0, 0, 100, 0], [0, 50, 100, 50]], "segments2": [[0, 9, 100, 9], [0, 59, 100, 59]],
              "matches": [[[0], [0]], [[1], [1]]]}
    judge = score.Judge(lib, pairs.Pair("labels", pairs.LINES, "", "", labels=labels))
    a1, b1 = np.array([[5.0, 1], [5, 1], [5, 25]]), np.array([[95.0, 1], [95, 1], [95, 25]])
    a2, b2 = a1 + [[0, 9], [0, 59], [0, 9]], b1 + [[0, 9], [0, 59], [0, 9]]
    _expect("labelled lines: the same, another, none", [str(float(v)) for v in judge.segments(a1, b1, a2, b2)],
            ["1.0", "0.0", "nan"])


def _check_tables():
    right = {"correct": 1, "total": 2, "seconds": 0.0}
    cells = {("a", "one"): right, ("a", "two"): dict(right, correct=0), ("b", "two"): right}
    _expect("a sentence on the pairs of two", tables.like("Points", ("a", "b"), ("one", "two"), cells),
            "Points, 1 pairs that all have, average accuracy: a 0.0 % (0 / 2); b 50.0 % (1 / 2).")
    _expect("nobody has some pairs alone", tables.like("Points", ("a",), ("one", "two"), cells), None)


def _check_repeatability(session):
    """criteria.py and images.py against tests/accuracy/repeatability.c."""
    pair = session.rendered[0]
    picture = images.Picture("check", pair.image1, os.path.join(session.work, "images"))
    text = session.library.run("repeatability", [picture.original()])[0]
    theirs = {float(w[0]): w[1:6] for w in (line.split() for line in text.splitlines()) if len(w) == 8 and w[-1] == "junctions"}
    whole = session.library.detect(library.DEFAULT, picture.original())
    for detector in (library.ISOTROPIC_DEFAULT, library.ISOTROPIC_PAPER):
        _expect("%s finds something" % detector.name, len(session.library.detect(detector, picture.original())) > 10, True)
    for factor in images.FACTORS[1:]:
        path, change = picture.zoomed(factor)
        found = session.library.detect(library.DEFAULT, path)
        ours = [criteria.rate(whole, found, change, c) for c in (criteria.ASJ, criteria.PLACE)]
        ours.append(criteria.rate(whole.decomposed(), found.decomposed(), change, criteria.ASJ))
        _expect("repeatability at zoom %.1f: whole, place, L" % factor, ["%.1f" % (100.0 * n / t) for n, t in ours],
                [theirs[factor][i] for i in (0, 3, 4)])


def _check_rooms(session):
    """score.py against tests/accuracy/match_room.c: points right and all, for the sample room's first pair."""
    lib, folder = session.library, os.path.join(session.work, "check")
    os.makedirs(folder, exist_ok=True)
    lib.run("sample-room", [folder])
    pair = pairs.Pair("check", pairs.ROOM, os.path.join(folder, "1.png"), os.path.join(folder, "2.png"))
    found = matches.of_library(*lib.match(("--stretch", "1"), pair.image1, pair.image2))
    right = score.Judge(lib, pair).points(found.p1, found.p2)
    text = lib.run("match_room", ["--last", 1, "--threads", 1])[0]
    row = [line.split() for line in text.splitlines() if line.startswith("0-1")][0]
    _expect("right points of the sample room", (int(right.sum()), len(right)), (int(row[1]), int(row[3])))


def run(session):
    _check_criteria()
    _check_score(session.library)
    _check_tables()
    _check_repeatability(session)
    _check_rooms(session)
    print("the measures agree with those of tests/accuracy", flush=True)
