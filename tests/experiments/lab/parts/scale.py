# SPDX-License-Identifier: BSD-2-Clause
"""Part 3: scale consistency, the paper's figure of circles: does the measured scale follow the zoom?

Junctions of the original and of the zoomed copy are paired by location and branch orientation alone, as the paper does there. Of
every pair of branches (closest in angle) the ratio r2 / r1 of the measured scales should be the zoom factor s: branch lengths for
ASJ, the isotropic scale of the junction for ACJ."""
import cv2
import numpy as np

from .. import charts, criteria, drawing, images, library
from ..report import Part

ROWS = {
    "anisotropic: branch lengths, default": (library.DEFAULT, False),
    "anisotropic: branch lengths, paper preset": (library.PAPER, False),
    "isotropic: scale, default": (library.ISOTROPIC_DEFAULT, True),
    "isotropic: scale, paper preset": (library.ISOTROPIC_PAPER, True),
}
LEAST_DRAWN = 600      # px: a copy narrower than that is drawn enlarged
LEAST_LENGTH = 20.0   # px in the original: below, the unit of the isotropic radii counts more than the zoom


def paired(first, second, change):
    """Indices of junctions that agree in location and angles."""
    return criteria.correspondences(change.expected(first)[0], second, criteria.ANGLES)


def _ratios(limit, session, detector, isotropic, picture, factor):
    path, change = picture.zoomed(factor)
    first, second = (session.library.detect(detector, p, limit) for p in (picture.original(), path))
    i, k = paired(first, second, change).T
    if isotropic:
        return second.scale[k] / first.scale[i]
    distance = criteria.angle_distance(first.angle[i][:, :, None], second.angle[k][:, None, :])
    partner = np.where(np.isfinite(distance), distance, np.inf).argmin(2)
    lengths = np.take_along_axis(second.length[k], partner, 1)
    return (lengths / first.length[i])[first.length[i] >= LEAST_LENGTH]


def _circles(session, picture, factor):
    """The zoomed copy with circles: yellow s r1, red r2 (isotropic); lines: yellow s times the branch, green the branch found."""
    path, change = picture.zoomed(factor)
    ground = cv2.imread(path, cv2.IMREAD_COLOR)
    times = max(1, round(LEAST_DRAWN / ground.shape[1]))
    ground = cv2.resize(ground, None, fx=times, fy=times, interpolation=cv2.INTER_NEAREST)
    canvas, enlarge = [ground.copy(), ground.copy()], criteria.Zoom(times, times)
    for which, detector in enumerate((library.ISOTROPIC_PAPER, library.PAPER)):
        first, second = (session.library.detect(detector, p) for p in (picture.original(), path))
        partners = paired(first, second, change)
        wanted, found = (enlarge.expected(j)[0] for j in (change.expected(first)[0], second))
        for i, k in partners:
            if which == 0:
                drawing.circle(canvas[0], wanted.place[i], wanted.scale[i], drawing.YELLOW, 2)
                drawing.circle(canvas[0], found.place[k], found.scale[k], drawing.RED, 2)
            else:
                drawing.junction(canvas[1], wanted, i, drawing.YELLOW, 3)
                drawing.junction(canvas[1], found, k, drawing.GREEN, 1)
    return drawing.encode(drawing.beside(canvas))


def run(session):
    part = Part("Scale consistency")
    part.text("Junctions of the original and of the copy zoomed by s, paired by location and orientation alone: the ratio of their "
              "measured scales should be s. Isotropic scales are bounded by the largest radius tested, so they stay. The slope is "
              "the least-squares fit of the median ratio against s, 1 when the scale follows; only branches of 20 px and more.")
    jobs, pictures = session.jobs("scale"), session.pictures()
    pictures = pictures[:1] if session.quick else pictures
    for picture in pictures:
        for factor in images.FACTORS:
            for name, (detector, isotropic) in ROWS.items():
                jobs.add((name, factor, picture.key), _ratios, session, detector, isotropic, picture, factor)
    cells = jobs.run()
    series, rows, shares = {"the zoom itself": (images.FACTORS, images.FACTORS)}, [], []
    for name in ROWS:
        ratios = [np.concatenate([c for k, c in cells.items() if k[:2] == (name, f)] or [np.zeros(0)]) for f in images.FACTORS]
        median = [float(np.median(r)) if len(r) else float("nan") for r in ratios]
        spread = [[float(v) for v in np.percentile(r, (25, 75))] if len(r) else None for r in ratios]
        known = np.isfinite(median)
        slope = float(np.polyfit(np.array(images.FACTORS)[known], np.array(median)[known], 1)[0]) if known.sum() > 1 else None
        close = [float(np.mean(np.abs(r - f) < 0.1 * f)) if len(r) else float("nan") for r, f in zip(ratios, images.FACTORS)]
        series[name] = (images.FACTORS, median)
        rows.append([name, "-" if slope is None else "%.2f" % (round(slope, 2) + 0.0)] + [
            "%.2f" % m if len(r) else "-" for m, r in zip(median, ratios)])
        shares.append([name] + ["%.0f (%d)" % (100 * c, len(r)) if len(r) else "-" for r, c in zip(ratios, close)])
        part.findings.append("Scale against zoom, %s: slope %s." % (name, rows[-1][1]))
        part.numbers[name] = {"slope": slope, "factors": images.FACTORS, "median": median, "quartiles": spread,
                              "count": [len(r) for r in ratios], "within_tenth": close}
    part.table(["median ratio of scales at zoom s", "slope"] + ["%.1f" % f for f in images.FACTORS], rows)
    part.table(["% of ratios within a tenth of s (ratios)"] + ["%.1f" % f for f in images.FACTORS], shares)
    part.chart(charts.curves([{"x_label": "zoom factor s", "y_label": "median of r2 / r1", "y_range": (0, 1.3), "series": series}],
                             height=4))
    for factor in (0.6, 0.3):
        part.picture(_circles(session, pictures[0], factor), "jpeg",
                     "%s zoomed by %.1f, paper preset. Left: isotropic scales, yellow: s r1, red: r2. Right: branches, yellow: "
                     "those of the original times s, green: those found." % (pictures[0].key, factor))
    part.account(jobs)
    return part
