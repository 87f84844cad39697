# SPDX-License-Identifier: BSD-2-Clause
"""Part 2: repeatability against ACJ, under zoom, blur, noise, compression and gain, and between the views of a homography."""
import os

import cv2
import numpy as np

from .. import charts, criteria, images, junctions, library, pairs
from ..report import Part


OURS, PAPER = "default, ASJ", "paper preset, ASJ"
APART, PAPER_APART = "default, L-junctions, ASJ", "paper preset, L-junctions, ASJ"
ACJ, STAGE = "isotropic stage of the paper preset, radii 3 to 10 px, ACJ", "isotropic stage of the default, ACJ"
BOUNDS = (12, 20, 30)   # px; the paper: "recommended to be set as in the range of [12, 30]"
ACJ_UP_TO = {bound: "ACJ detector, radii 3 to %d px, ACJ" % bound for bound in BOUNDS}
LIKE, LIKE_STAGE = "default, location and angles alone", "isotropic stage of the default, location and angles alone"
LIKE_PAPER = "paper preset, location and angles alone"
RIVALS = (PAPER, *ACJ_UP_TO.values(), ACJ, STAGE)
BY_CHANCE = (OURS, PAPER, ACJ, STAGE)   # rows for which chance is measured too


class Method:
    """A detector with the criterion that its junctions are judged by; apart: taken apart into L-junctions first."""

    def __init__(self, criterion, detector=None, apart=False, folder=None, name=None):
        self.criterion, self.detector, self.apart, self.folder, self.name = criterion, detector, apart, folder, name

    def found(self, session, path, limit, given=None):
        """Junctions of a picture, or None. given: {detector's name: file} beside the photograph"""
        if self.detector:
            found = session.library.detect(self.detector, path, limit)
        else:
            base = os.path.splitext(os.path.basename(path))[0]
            file = os.path.join(self.folder, base + ".asj") if self.folder else (given or {}).get(self.name)
            if not file or not os.path.exists(file):
                return None
            found = junctions.read_asj(file)
        return found.decomposed() if self.apart else found


def methods(session):
    """{name in the report: Method}"""
    out = {
        OURS: Method(criteria.ASJ, library.DEFAULT),
        PAPER: Method(criteria.ASJ, library.PAPER),
        ACJ: Method(criteria.ACJ, library.ISOTROPIC_PAPER),
        **{name: Method(criteria.ACJ, library.isotropic_up_to(bound)) for bound, name in ACJ_UP_TO.items()},
        STAGE: Method(criteria.ACJ, library.ISOTROPIC_DEFAULT),
        LIKE: Method(criteria.ANGLES, library.DEFAULT),
        LIKE_PAPER: Method(criteria.ANGLES, library.PAPER),
        LIKE_STAGE: Method(criteria.ANGLES, library.ISOTROPIC_DEFAULT),
        APART: Method(criteria.ASJ, library.DEFAULT, apart=True),
        PAPER_APART: Method(criteria.ASJ, library.PAPER, apart=True),
        "default, location alone": Method(criteria.PLACE, library.DEFAULT),
        "paper preset, location alone": Method(criteria.PLACE, library.PAPER),
    }
    for name, folder in session.arguments.detector:
        out["%s, L-junctions, ASJ" % name] = Method(criteria.ASJ, folder=folder, name=name, apart=True)
    for name in dict.fromkeys(n for p in session.pairs for n in p.detections):
        out.setdefault("%s, L-junctions, ASJ" % name, Method(criteria.ASJ, name=name, apart=True))
    return out


def _rate(limit, session, method, paths, change, given=({}, {})):
    first, second = (method.found(session, path, limit, files) for path, files in zip(paths, given))
    if first is None or second is None:
        return None
    correct, total = criteria.rate(first, second, change, method.criterion)
    return {"correct": correct, "total": total, "total_2": len(second)}


def _chance(limit, session, method, paths, change):
    first, second = (method.found(session, path, limit) for path in paths)
    height, width = cv2.imread(paths[1], cv2.IMREAD_GRAYSCALE).shape
    correct, total = criteria.chance(first, second, change, method.criterion, (width, height))
    return {"correct": correct, "total": total, "total_2": len(second)}


def _percent(cell):
    return 100.0 * cell["correct"] / cell["total"] if cell["total"] else 0.0


def _mean(cells):
    return float(np.mean([_percent(c) for c in cells])) if cells else float("nan")


def _pictures(session, kind):
    """Zoom, the paper's figure, takes them all; every second one is enough for the other changes."""
    chosen = session.pictures()
    return chosen[:1] if session.quick else chosen if kind == "zoom" or session.full else chosen[::2]


def _add_changes(session, jobs, all_methods):
    """Picture by picture: when time is short, fewer pictures."""
    for kind in ["zoom"] + list(images.CHANGES):
        for picture in _pictures(session, kind):
            for level, path, change in picture.copies(kind):
                paths = picture.original(), path
                for name, method in all_methods.items():
                    jobs.add((kind, level, name, picture.key), _rate, session, method, paths, change)
                for name in BY_CHANCE if kind == "zoom" and level < 1 else ():
                    jobs.add(("chance", level, name, picture.key), _chance, session, all_methods[name], paths, change)


def _add_homographies(session, jobs, all_methods):
    """The two views of pairs whose truth is a homography."""
    for pair in [p for p in session.real if p.kind == pairs.HOMOGRAPHY]:
        paths = [session.view(pair, i).original() for i in (1, 2)]
        height, width = cv2.imread(pair.image2, cv2.IMREAD_GRAYSCALE).shape
        change = criteria.Homography(pair.matrix, pair.side, (width, height))
        given = [{n: files[i] for n, files in pair.detections.items()} for i in (0, 1)]
        for name, method in all_methods.items():
            jobs.add(("homography", pair.name, name, pair.name), _rate, session, method, paths, change, given)


def _report_kind(part, cells, kind, levels, names, unit, head=""):
    """Table and panel for one kind of change, over the pictures that are there for every level and method."""
    pictures = dict.fromkeys(k[3] for k in cells if k[0] == kind)
    complete = {n: [p for p in pictures if all((kind, v, n, p) in cells for v in levels)] for n in names}
    names = [n for n in names if complete[n]]
    whole = [p for p in pictures if all(p in complete[n] for n in names)]
    if not whole:
        part.text("Under %s nothing was measured whole: see what was left out." % kind)
        return None
    rates = {n: [_mean([cells[kind, v, n, p] for p in whole]) for v in levels] for n in names}
    part.numbers[kind] = {"levels": levels, "percent": rates, "pictures": whole}
    part.table([head or "%% repeated: %s, %s" % (kind, unit)] + ["%g" % v for v in levels],
               [[n] + ["%.1f" % v for v in r] for n, r in rates.items()],
               "Mean of %d pictures: %s." % (len(whole), ", ".join(whole)))
    return {"title": kind, "x_label": "%s, %s" % (kind, unit), "y_label": "repeatability, %", "y_range": (0, 102),
            "series": {n: (levels, r) for n, r in rates.items()}, "ticks": levels}


def _report_homographies(part, cells, names):
    chosen = list(dict.fromkeys(k[1] for k in cells if k[0] == "homography"))
    if not chosen:
        return
    part.heading("Between the views of known homographies")
    rows = []
    for name in names:
        mine = [cells.get(("homography", p, name, p)) for p in chosen]
        if any(mine):
            part.numbers.setdefault("homography", {})[name] = dict(zip(chosen, mine))
            rows.append([name] + ["%.1f (%d / %d)" % (_percent(c), c["correct"], c["total"]) if c else "-" for c in mine])
    part.table(["percent of the junctions of image 1 that image 2 shows"] + chosen, rows)


TEXT = (
    "Share of the junctions of the original that have a correspondence in the changed copy, in percent, mean over the pictures. "
    "Corresponding: location within 3 px, every branch within pi/20 of one of the other's, the same number of branches, and (ACJ) "
    "isotropic scales or (ASJ) every branch length within 3 px of one of the other's. One to one, closest first.",
    "ASJ are whole junctions, branches followed to their ends; the authors' program prints L-junctions, so those rows are its "
    "like. "
    "The paper compares ASJ with the ACJ detector: its counterpart is the paper preset before branches are followed, with the "
    "candidates of that preset (near line segments). ACJ needs an upper bound of its scales, which its authors, says the paper, "
    "recommend between 12 and 30 px; the paper preset itself stops at 10. The default preset has an "
    "isotropic stage of its own, with sub-pixel lines that the ACJ detector lacks; it is shown beside, at the image's "
    "own size. A detector that is there as files has rows where its files are: beside the photographs, only for the "
    "views of known homographies.")
WHY = (
    "The ACJ criterion asks little near 1: isotropic scales end at the largest radius tested (14 px in the default preset, 10 px "
    "in the paper's), where |s r1 - r2| stays below 3 px down to a zoom of 0.79 and 0.7. There isotropic junctions are judged by "
    "location and angles alone, ASJ by every branch length besides. The rows \"location and angles alone\" ask the same of both.")


def run(session):
    part = Part("Repeatability against ACJ")
    part.text(*TEXT)
    all_methods, jobs = methods(session), session.jobs("repeatability")
    _add_homographies(session, jobs, all_methods)   # first: few, and the only ones with other detectors' files
    _add_changes(session, jobs, all_methods)
    cells = {k: c for k, c in jobs.run().items() if c}
    part.heading("Zoom: the paper's figure")
    zoom = _report_kind(part, cells, "zoom", list(images.FACTORS), all_methods, "factor")
    if zoom:
        part.chart(charts.curves([zoom], height=4.6))
    part.heading("By chance")
    part.text("The same after the junctions of the copy were moved around by half the image (mean of three ways): what their "
              "number and the usual directions of walls make by chance.")
    _report_kind(part, cells, "chance", [f for f in images.FACTORS if f < 1], BY_CHANCE, "factor", "% by chance: zoom, factor")
    if zoom:
        _compare(part)
    part.heading("Blur, noise, compression, gain")
    panels = [_report_kind(part, cells, kind, list(levels), all_methods, unit)
              for kind, (levels, _, unit) in images.CHANGES.items()]
    for some in (panels[:2], panels[2:]):
        if any(some):
            part.chart(charts.curves([p for p in some if p], height=3.8))
    _report_homographies(part, cells, all_methods)
    part.numbers["cells"] = [dict(c, change=k[0], level=k[1], method=k[2], picture=k[3]) for k, c in cells.items()]
    part.account(jobs)
    return part


def _above(rates, factors, ours, theirs):
    below = ["%g" % f for f, a, b in zip(factors, rates[ours], rates[theirs]) if f < 1 and not a > b]
    return "no, not at " + ", ".join(below) if below else "yes"


def _compare(part):
    """At which zoom factors below 1 the default preset repeats more than its rivals, and the paper preset than the ACJ detector."""
    rates, factors = part.numbers["zoom"]["percent"], part.numbers["zoom"]["levels"]
    for ours, what in ((PAPER, "the paper preset"), (PAPER_APART, "the paper preset's L-junctions")):
        for name in [n for n in (*ACJ_UP_TO.values(), ACJ) if n in rates and ours in rates]:
            part.findings.append("Repeatability of %s (ASJ criterion) above %s at every zoom below 1: %s." % (
                what, name, _above(rates, factors, ours, name)))
    for name in [n for n in RIVALS if n in rates and OURS in rates]:
        part.findings.append("Repeatability of the default preset (ASJ criterion) above %s at every zoom below 1: %s." % (
            name, _above(rates, factors, OURS, name)))
    if LIKE in rates and LIKE_STAGE in rates:
        part.findings.append("Repeatability of locations and angles alone, the default preset above its isotropic stage at every "
                             "zoom below 1: %s." % _above(rates, factors, LIKE, LIKE_STAGE))
    if LIKE in rates:
        share = tuple(rates[name][factors.index(0.9)] for name in (LIKE, OURS, LIKE_STAGE, STAGE))
        part.findings.append("At a zoom of 0.9, %.1f %% of the default's junctions come back in location and angles, %.1f %% in "
                             "every branch length too; of its isotropic stage %.1f %% in location and angles, %.1f %% by ACJ."
                             % share)
    part.text(*part.findings, WHY)
