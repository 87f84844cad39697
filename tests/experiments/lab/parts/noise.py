# SPDX-License-Identifier: BSD-2-Clause
"""Part 1: control of the number of false detections, the paper's Table 1. The counting is tests/accuracy/noise.c's."""
import numpy as np

from .. import charts
from ..report import Part

EPSILONS = (0.01, 0.1, 1, 10, 100, 200)
PAPER = (0.002, 0.006, 0.198, 5.923, 66.472, 132.676)
PIXELS = 256 * 256
CHUNK = 25   # images a job, at most


def _count(limit, session, preset, way, images, first, options=()):
    """Mean false detections at each epsilon."""
    words = ["--images", images, "--first", first, "--preset", preset, "--ways", way, *options]
    out, _ = session.library.run("noise", words, limit)
    row = [line.split() for line in out.splitlines() if line.startswith(way)][0]
    return images, np.array([float(v) for v in row[1:1 + len(EPSILONS)]])


def _literal(limit, session, preset, way, images, first):
    """steps, with local branches filtered by eq:NFA-xia at the paper's number of tests: K NM F <= epsilon."""
    values = np.full(len(EPSILONS), np.nan)
    for k, epsilon in enumerate(EPSILONS):
        if epsilon / PIXELS >= 1e-6:  # the least that the option allows
            option = ["field_epsilon=%.9g" % (epsilon / PIXELS)]
            values[k] = _count(limit, session, preset, way, images, first, option)[1][k]
    return images, values


# row of the report -> function, preset, way, images of a default run
ROWS = {
    "default: strip test, length of the scan": (_count, "default", "scanned", 1000),
    "paper preset: strip test, length of the scan": (_count, "paper", "scanned", 1000),
    "default: strip test, best of 16 lengths": (_count, "default", "any", 40),
    "default: junctions of the whole detector": (_count, "default", "detector", 1000),
    "paper preset: junctions of the whole detector": (_count, "paper", "detector", 1000),
    "paper preset: junctions, every pixel a candidate": (_count, "paper", "everywhere", 1000),
    "paper preset: steps of the scan alone": (_count, "paper", "steps", 50),
    "the same, literal filter of local branches": (_literal, "paper", "steps", 25),
}
UNBOUNDED = ("paper preset: steps of the scan alone", "the same, literal filter of local branches")


def _images(session, usual):
    return min(usual, 3) if session.quick else 1000 if session.full else usual


def _mean(cells):
    """Mean over all images of a row's jobs: (images, values)"""
    images = sum(n for n, _ in cells)
    return images, sum(n * v for n, v in cells) / images


def _add_jobs(session, jobs):
    """All rows' first images, then all rows' next: when time is short, fewer images and no row less."""
    wanted = {row: _images(session, usual) for row, (_, _, _, usual) in ROWS.items()}
    for first in range(0, max(wanted.values()), CHUNK):
        for row, (function, preset, way, _) in ROWS.items():
            if first < wanted[row]:
                jobs.add((row, first), function, session, preset, way, min(CHUNK, wanted[row] - first), first + 1)


def _text(value):
    return "-" if np.isnan(value) else "%.3f" % value if value < 10 else "%.1f" % value


def run(session):
    part = Part("Control of the number of false detections")
    part.text("Images of 256 x 256 independent Gaussian pixels; a ray in a random direction from every pixel; what counts is in "
              "the first column, the bound is epsilon itself. A branch is reported when the strip along it is meaningful, so that "
              "is the library's counterpart of the paper's row. Whole detectors are asked for junctions, with epsilon for the "
              "isotropic junctions, the steps of the scan and the strips alike; where every pixel is a candidate, one meaningful "
              "radius is enough and branches may share pixels, so that the NFA is all that holds. The paper preset has no strip "
              "test; its scan alone keeps no bound, since a ray that follows local branches which were chosen as maxima finds "
              "more of them than the null model says. "
              "With local branches filtered by the paper's number of tests the scan comes to the size of the paper's row, but then "
              "hardly any branch of a photograph is left.")
    jobs = session.jobs("noise")
    _add_jobs(session, jobs)
    cells = jobs.run()
    rows = {row: _mean([v for k, v in cells.items() if k[0] == row]) for row in ROWS if any(k[0] == row for k in cells)}
    body = [["bound (epsilon)", ""] + ["%g" % e for e in EPSILONS], ["the paper's Table 1", 1000] + [_text(v) for v in PAPER]]
    body += [[row, n] + [_text(v) for v in values] for row, (n, values) in rows.items()]
    part.table(["false detections in an image at epsilon", "images"] + ["%g" % e for e in EPSILONS], body)
    series = {"bound": (EPSILONS, EPSILONS), "paper's Table 1": (EPSILONS, PAPER)}
    series.update({row: (EPSILONS, np.where(values > 0, values, np.nan)) for row, (_, values) in rows.items()})
    part.chart(charts.curves([{"x_label": "epsilon", "y_label": "false detections in an image", "log": True, "series": series}],
                             height=4.8), "Both axes logarithmic; zeros do not show.")
    broken = [row for row, (n, values) in rows.items() if row not in UNBOUNDED and not _bounded(n, values)]
    kept = [r for r in rows if r not in UNBOUNDED and r not in broken]
    part.findings.append("False detections: bounded by epsilon at every epsilon: %s." % ("; ".join(kept) or "none"))
    if broken:
        part.findings.append("False detections: above epsilon: %s." % "; ".join(broken))
    part.text(*part.findings)
    part.numbers = {"epsilon": EPSILONS, "paper": PAPER, "broken": broken,
                    "rows": {row: {"images": n, "mean": [None if np.isnan(v) else float(v) for v in values]}
                             for row, (n, values) in rows.items()}}
    part.account(jobs)
    return part


def _bounded(images, values):
    """At most three Poisson standard deviations, and one event, above what the bound allows in so many images."""
    allowed = np.array(EPSILONS) * images
    return bool(np.all(values * images <= allowed + 3 * np.sqrt(allowed) + 1))
