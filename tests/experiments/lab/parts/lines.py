# SPDX-License-Identifier: BSD-2-Clause
"""Part 5: the line-segment matching table, by the paper's strict rule."""
import os

import numpy as np

from .. import matches, methods, peer_lines, score
from ..report import Part
from ..tables import accuracy_rows, finding, like

MERGED = "libasj, merged lines (--lines)"
BRANCHES = "%s, branches of the matches"


def _count(session, pair, segments, any_order, seconds):
    right = score.Judge(session.library, pair).segments(*segments, any_order)
    judged = np.isfinite(right)
    return {"total": int(judged.sum()), "correct": int(right[judged].sum()), "seconds": seconds}


def _library(limit, session, method, merged, pair):
    found = methods.match(session, method, pair, limit)
    segments = found.lines if merged else (found.a1, found.b1, found.a2, found.b2)
    return _count(session, pair, segments, False, found.seconds)


def _other(_limit, session, make, pair):
    found = make()
    return _count(session, pair, (found.a1, found.b1, found.a2, found.b2), found.any_order, found.seconds)


def _add_library(session, jobs):
    rows = {}
    for pair in session.pairs:
        jobs.add((MERGED, pair.name), _library, session, methods.DEFAULT, True, pair)
    for method in methods.of_points(session):
        if methods.slow(method) and "points" not in session.arguments.only:
            continue   # minutes for one row: only where part 4 has its matches
        rows[BRANCHES % method] = method
        for pair in session.pairs:
            if methods.applies(session, method, pair):
                jobs.add((BRANCHES % method, pair.name), _library, session, method, False, pair)
    return [MERGED] + list(rows)


def _add_peers(session, jobs):
    for name in peer_lines.PEERS if peer_lines.available() else ():
        for pair in session.pairs:
            jobs.add((name, pair.name), _other, session, lambda name=name, pair=pair: peer_lines.match(name, pair), pair)
    given = session.arguments.line_matcher
    for name, folder in given:
        for pair in session.pairs:
            path = os.path.join(folder, pair.key + ".csv")
            if os.path.exists(path):
                jobs.add((name, pair.name), _other, session, lambda path=path: matches.of_lines_file(path), pair)
    return list(peer_lines.PEERS) + [name for name, _ in given]


def run(session):
    part = Part("Line-segment matching")
    part.text("Strict rule: both end points must correspond, within 10 px or 5 % of the length (homography), 3 px from the "
              "epipolar lines (fundamental matrix), 8 px (rendered rooms); people's line labels, where there are any, must not "
              "contradict.")
    if not peer_lines.available():
        part.text("This OpenCV has no line descriptors (opencv-contrib has): no peers.")
    jobs = session.jobs("lines")
    peers = _add_peers(session, jobs)   # first: they are quick
    names = _add_library(session, jobs) + peers
    cells = jobs.run()
    for title, chosen in (("Photographs", session.real), ("Rendered pairs", session.rendered)):
        if chosen:
            part.heading(title)
            chosen = [p.name for p in chosen]
            part.table(*accuracy_rows(names, chosen, cells))
            what = "Line segments, " + title.lower()
            part.findings += filter(None, [sentence(what, names, chosen, cells) for sentence in (finding, like)])
    part.numbers = {"cells": [dict(c, method=m, pair=p) for (m, p), c in cells.items()]}
    part.account(jobs)
    return part
