# SPDX-License-Identifier: BSD-2-Clause
"""Part 6: whether other detectors find the same places; for the authors' own files, whether the paper preset is what they mean.

Distinct places (a detector may write one record for each pair of branches), NEAR px apart at most, since theirs are whole pixels.
At the places found: the share of their branches that have one of ours within pi / 20, and of these the share whose lengths differ
by at most 3 px. This is what tests/accuracy/agreement.c computes."""
import numpy as np

from .. import criteria, junctions, library
from ..report import Part

NEAR = 4.0   # px
DETECTORS = (library.PAPER, library.DEFAULT, library.ISOTROPIC_PAPER)


def _nearest(places, others):
    """For each place the index of the nearest of the others, -1 where none is near."""
    if not len(others) or not len(places):
        return np.full(len(places), -1)
    distance = np.hypot(*np.moveaxis(places[:, None] - others[None], -1, 0))
    return np.where(distance.min(1) <= NEAR, distance.argmin(1), -1)


def _branches(theirs, ours, partner):
    """(their branches at places found, those with one of ours at their angle, those with its length)"""
    i = np.nonzero(partner >= 0)[0]
    apart = criteria.angle_distance(theirs.angle[i][:, :, None], ours.angle[partner[i]][:, None, :])
    apart = np.where(np.isfinite(apart), apart, np.inf)
    there, found = np.isfinite(theirs.angle[i]), apart.min(2) < criteria.ANGLE_LIMIT
    lengths = np.take_along_axis(ours.length[partner[i]], apart.argmin(2), 1)
    close = found & (np.abs(lengths - theirs.length[i]) <= criteria.SCALE_LIMIT)
    return int(there.sum()), int(found.sum()), int(close.sum())


def _compare(limit, session, detector, picture, file):
    ours, theirs = session.library.detect(detector, picture.original(), limit), junctions.read_asj(file)
    _, distinct = np.unique(theirs.place, axis=0, return_index=True)
    partner = _nearest(theirs.place, ours.place)
    return {"theirs": len(distinct), "ours": len(ours), "found": int((partner[distinct] >= 0).sum()),
            "near": int((_nearest(ours.place, theirs.place) >= 0).sum()), "branches": _branches(theirs, ours, partner)}


def _share(part, whole):
    return part / whole if whole else 0.0


def _means(cells):
    """Every photograph counts the same; branches of all photographs together."""
    all_of, found, close = np.sum([c["branches"] for c in cells], 0)
    return {"ratio": np.mean([_share(c["ours"], c["theirs"]) for c in cells]),
            "found": np.mean([_share(c["found"], c["theirs"]) for c in cells]),
            "near": np.mean([_share(c["near"], c["ours"]) for c in cells]),
            "branches": _share(found, all_of), "lengths": _share(close, found)}


def _report(part, name, cells):
    means = {d: _means([c for k, c in cells.items() if k[:2] == (name, d)]) for d in dict.fromkeys(k[1] for k in cells)}
    part.heading("Places of: " + name)
    part.table(["mean of photographs", "places to one of theirs", "theirs found", "ours near theirs", "their branches",
                "of these lengths"],
               [[d] + ["%.2f" % m[k] for k in ("ratio", "found", "near", "branches", "lengths")] for d, m in means.items()])
    pictures = dict.fromkeys(k[2] for k in cells if k[0] == name)
    rows = []
    for picture in pictures:
        mine = [cells.get((name, d, picture)) for d in means]
        rows.append([picture, next("%d" % c["theirs"] for c in mine if c)] + [
            "%d: %d found, %d near" % (c["ours"], c["found"], c["near"]) if c else "-" for c in mine])
    part.table(["photograph", "theirs"] + list(means), rows)
    for d, m in means.items():
        part.findings.append("%s beside %s: %.2f of theirs found, %.2f of ours near theirs, %.2f places to one of theirs." % (
            d, name, m["found"], m["near"], m["ratio"]))
    part.numbers[name] = means


def run(session):
    part = Part("The same places as other detectors")
    part.text("Detectors whose files stand beside the photographs. Agreement is no accuracy: none is complete nor always right.")
    jobs = session.jobs("agreement")
    for pair in session.pairs:
        for name, files in pair.detections.items():
            for index, file in enumerate(files, 1):
                picture = session.view(pair, index)
                for detector in DETECTORS:
                    jobs.add((name, detector.name, picture.key), _compare, session, detector, picture, file)
    cells = jobs.run()
    for name in dict.fromkeys(k[0] for k in cells):
        _report(part, name, cells)
    if not cells:
        part.text("There are none here.")
    part.account(jobs)
    return part
