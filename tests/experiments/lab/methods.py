# SPDX-License-Identifier: BSD-2-Clause
"""The library as a matcher: with its presets, and on the junctions of other detectors."""
import os

from . import matches

DEFAULT = "libasj"
ARGUMENTS = {
    DEFAULT: (),
    "paper preset, raw": ("--preset", "paper"),
    "paper preset, sift": ("--preset", "paper", "--descriptor", "sift"),
}
# The junctions of another detector, its name before each.
MATCHERS = {
    " junctions, libasj": (),
    " junctions, paper's matcher, raw": ("--match-preset", "paper"),
    " junctions, paper's matcher, sift": ("--match-preset", "paper", "--descriptor", "sift"),
}


def slow(method):
    return method.endswith("sift")


def _detectors(session):
    """Names of detectors whose junctions are there for both views of some pair."""
    names = [name for name, _ in session.arguments.detector]
    return list(dict.fromkeys(names + [n for pair in session.pairs for n in pair.detections]))


def of_points(session):
    """Names of the library's rows, the slowest last."""
    rows = list(ARGUMENTS) + [name + matcher for name in _detectors(session) for matcher in MATCHERS]
    return sorted((r for r in rows if not (slow(r) and session.quick)), key=slow)


def _parts(method):
    """(the other detector's name, the matcher's arguments)"""
    return next((method[:-len(m)], words) for m, words in MATCHERS.items() if method.endswith(m))


def files(session, method, pair):
    """The junction files of another detector for a pair, or None."""
    name = _parts(method)[0]
    folder = dict(session.arguments.detector).get(name)
    if folder:
        given = tuple(os.path.join(folder, "%s-%d.asj" % (pair.key, i)) for i in (1, 2))
        return given if all(map(os.path.exists, given)) else None
    return pair.detections.get(name)


def applies(session, method, pair):
    return method in ARGUMENTS or files(session, method, pair) is not None


def match(session, method, pair, limit=None):
    """Matches of a pair by one of the library's rows."""
    arguments = ARGUMENTS.get(method)
    if arguments is None:
        first, second = files(session, method, pair)
        arguments = _parts(method)[1] + ("--junctions1", first, "--junctions2", second)
    return matches.of_library(*session.library.match(arguments, pair.image1, pair.image2, limit))
