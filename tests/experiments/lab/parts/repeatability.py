# SPDX-License-Identifier: BSD-2-Clause
"""Part 2: repeatability against ACJ, under zoom, blur, noise, compression and gain."""
import numpy as np

from .. import charts, criteria, images, library
from ..report import Part

# name in the report -> detector, criterion, whether its junctions are taken apart into L-junctions
METHODS = {
    "default, ASJ": (library.DEFAULT, criteria.ASJ, False),
    "paper, ASJ": (library.PAPER, criteria.ASJ, False),
    "isotropic of default, ACJ": (library.ISOTROPIC_DEFAULT, criteria.ACJ, False),
    "isotropic of paper, ACJ": (library.ISOTROPIC_PAPER, criteria.ACJ, False),
    "default, L-junctions": (library.DEFAULT, criteria.ASJ, True),
    "default, place alone": (library.DEFAULT, criteria.PLACE, False),
}


def _found(session, method, path, limit):
    detector, _, apart = METHODS[method]
    found = session.library.detect(detector, path, limit)
    return found.decomposed() if apart else found


def _rate(limit, session, method, original, changed, change):
    first, second = (_found(session, method, path, limit) for path in (original, changed))
    correct, total = criteria.rate(first, second, change, METHODS[method][1])
    return {"correct": correct, "total": total, "total_2": len(second)}


def _percent(cell):
    return 100.0 * cell["correct"] / cell["total"] if cell["total"] else 0.0


def _mean(cells):
    return float(np.mean([_percent(c) for c in cells])) if cells else float("nan")


def run(session):
    part = Part("Repeatability against ACJ")
    part.text("Share of the junctions of the original that have a correspondence in the changed copy, in percent, mean over the "
              "pictures. Corresponding: location within 3 px, every branch within pi/20 of one of the other's, the same number of "
              "branches, and (ACJ) isotropic scales or (ASJ) every branch length within 3 px of one of the other's.")
    jobs, pictures = session.jobs("repeatability"), session.pictures()
    if session.quick:
        pictures = pictures[:1]
    for picture in pictures:
        for factor in images.FACTORS:
            path, change = picture.zoomed(factor)
            for method in METHODS:
                jobs.add(("zoom", factor, method, picture.key), _rate, session, method, picture.original(), path, change)
    cells = jobs.run()
    rates = {m: [_mean([c for k, c in cells.items() if k[:3] == ("zoom", f, m)]) for f in images.FACTORS] for m in METHODS}
    part.chart(charts.curves([{"x_label": "zoom factor", "y_label": "repeatability, %", "y_range": (0, 102),
                               "series": {m: (images.FACTORS, r) for m, r in rates.items()}}]),
               "Mean of %d pictures." % len(pictures))
    part.table(["zoom"] + ["%.1f" % f for f in images.FACTORS], [[m] + ["%.1f" % v for v in r] for m, r in rates.items()])
    part.numbers["zoom"] = {"factors": images.FACTORS, "rates": rates,
                            "cells": [dict(c, factor=k[1], method=k[2], picture=k[3]) for k, c in cells.items()]}
    part.cut = jobs.cut
    return part
