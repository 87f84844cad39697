# SPDX-License-Identifier: BSD-2-Clause
"""Part 4: the key-point matching table."""
import numpy as np

from .. import methods, pairs, peer_points, score
from ..report import Part
from ..tables import accuracy_rows, finding, like


def _score(limit, session, method, pair):
    found = methods.match(session, method, pair, limit)
    right = score.Judge(session.library, pair).points(found.p1, found.p2)
    return {"total": len(right), "correct": int(right.sum()), "seconds": found.seconds}


def _peer(_limit, session, name, pair):
    found = peer_points.match(name, pair)
    right = score.Judge(session.library, pair).points(found.p1, found.p2)
    session.shared[("points", name, pair.name)] = found
    return {"total": len(right), "correct": int(right.sum()), "seconds": found.seconds}


def run(session):
    part = Part("Key-point matching")
    part.text("Number of correct matches, of matches, accuracy, and seconds of processor time for the pair (reading, "
              "detecting, matching). Correct: within 5 px under the homography, both epipolar distances below 3 px under the "
              "fundamental matrix, and on rendered rooms the same place of the same surface (4 px). A pair without a match "
              "counts as 0 % in the average.",
              "Peers are OpenCV's, with their default settings (ORB: 2000 features), nearest neighbour, ratio 1.5 on squared "
              "distance, one way.")
    judged = [p for p in session.pairs if p.kind != pairs.LINES]
    jobs = session.jobs("points")
    for pair in judged:
        jobs.add((methods.DEFAULT, pair.name), _score, session, methods.DEFAULT, pair)
    for name in peer_points.PEERS:
        for pair in judged:
            if not (session.quick and name == "Affine-SIFT"):
                jobs.add((name, pair.name), _peer, session, name, pair)
    for method in methods.of_points(session):
        for pair in judged:
            if method != methods.DEFAULT and methods.applies(session, method, pair):
                jobs.add((method, pair.name), _score, session, method, pair)
    cells = jobs.run()
    names = list(dict.fromkeys([methods.DEFAULT] + methods.of_points(session) + list(peer_points.PEERS)))
    for title, chosen in (("Photographs", session.real), ("Rendered pairs", session.rendered)):
        chosen = [p.name for p in chosen if p in judged]
        if chosen:
            part.heading(title)
            header, rows = accuracy_rows(names, chosen, cells)
            part.table(header, rows, best=_best(rows))
            what = "Key-points, " + title.lower()
            part.findings += filter(None, [sentence(what, names, chosen, cells) for sentence in (finding, like)])
    part.numbers = {"cells": [dict(c, method=m, pair=p) for (m, p), c in cells.items()]}
    unjudged = [p.name for p in session.pairs if p not in judged]
    if unjudged:
        part.text("Not in these tables: %s, whose truth is labelled lines, which say nothing of points." % ", ".join(unjudged))
    part.account(jobs)
    return part


def _best(rows):
    """The cell of the highest average accuracy."""
    values = [float(r[1].split()[0]) if r[1][0].isdigit() else -1 for r in rows]
    return {(int(np.argmax(values)), 1)} if rows else ()
