# SPDX-License-Identifier: BSD-2-Clause
"""Part 8: what each departure from the paper is worth. Two ways: from the paper preset to the default one option at a time, and the
default with a single option set back. The detector's options are judged by repeatability and by what the default matcher makes of
the junctions, and on synthetic scenes; the matcher's options on the junctions that asj-cli match finds."""
import json

import numpy as np

from .. import criteria, library, matches, options, pairs, score
from ..library import Detector
from ..report import Part
from ..tables import accuracy

FACTORS = (0.9, 0.7, 0.5)
POINTS = ("accuracy", "repeatability", "lines accuracy", "recall", "precision", "lengths")   # differences count in points
SHARES = ("correct", "lines correct")                                                      # these in percent
TIMES = ("seconds", "detection")
NOTICEABLE_POINTS, NOTICEABLE_SHARE, NOTICEABLE_TIME = 0.5, 0.01, 0.2
NEEDS_BACK = {"neighbours": ("minimum_support",),            # nobody asked, no support
              "isotropic_persistence": ("isotropic_radii",)}  # three in a row are more than there are
SYNTHETIC = {"recall": "recall", "precision": "precision", "lengths": "<=3"}


def _configurations(departures):
    """[(kind, departure or None, words)]: the path from all of the paper's values, then the default with one set back"""
    path = [("path", d, options.words(departures[n + 1:], "paper")) for n, d in enumerate(departures)]
    path.insert(0, ("path", None, options.words(departures, "paper")))
    return path + [("back", d, options.words(_together(d, departures), "paper")) for d in departures]


def _together(departure, departures):
    """The options that are set back with this one."""
    return [d for d in departures if d == departure or d.key in NEEDS_BACK.get(departure.key, ())]


def _is_default(configuration):
    return not configuration[2]


def _is_paper(configuration):
    return configuration[:2] == ("path", None)


def _ends(configurations):
    """The two ends of the path and one option set back."""
    last = max(n for n, c in enumerate(configurations) if c[0] == "path")
    return [configurations[0], configurations[last], configurations[-1]]


# ---- jobs ----

def _repeatability(limit, session, detector, picture):
    first = session.library.detect(detector, picture.original(), limit)
    rates = []
    for factor in FACTORS:
        path, change = picture.zoomed(factor)
        correct, total = criteria.rate(first, session.library.detect(detector, path, limit), change, criteria.ASJ)
        rates.append(100.0 * correct / total if total else 0.0)
    return {"repeatability": float(np.mean(rates)), "junctions": len(first),
            "detection": session.library.detect_file(detector, picture.original(), limit)[1]}


def _junction_files(session, detector, pair, limit):
    return [session.library.detect_file(detector, session.view(pair, i).original(), limit)[0] for i in (1, 2)]


def _matching(limit, session, detector, words, pair):
    first, second = _junction_files(session, detector, pair, limit)
    data, seconds = session.library.match(words + ("--junctions1", first, "--junctions2", second), pair.image1, pair.image2, limit)
    found = matches.of_library(data, seconds)
    judge = score.Judge(session.library, pair)
    right, lines = judge.points(found.p1, found.p2), judge.segments(*found.lines)
    judged = np.isfinite(lines)
    return {"total": len(right), "correct": int(right.sum()), "seconds": seconds, "lines total": int(judged.sum()),
            "lines correct": int(lines[judged].sum())}


def _synthetic(limit, session, words):
    """Means over the scenes of tests/accuracy/accuracy.c, in percent."""
    options = ["%s=%s" % (flag[2:].replace("-", "_"), value) for flag, value in zip(words[::2], words[1::2])]
    scenes = 1 if session.quick else 4
    text = session.library.run("accuracy", ["--scenes", scenes, "--threads", 1, "--format", "json"] + options, limit)[0]
    rows = [json.loads(line) for line in text.splitlines() if line.startswith("{")]
    mean = {name: np.mean([row[key] for row in rows if row[key] is not None]) for name, key in SYNTHETIC.items()}
    return {name: 100.0 * float(value) for name, value in mean.items()}


# ---- report ----

def _accuracy(cell, prefix):
    return accuracy({n: cell[prefix + n] for n in ("correct", "total")})


def _summary(cells, key):
    """Measures of one configuration, from the jobs that were done."""
    repeats = [c for k, c in cells.items() if k[:-1] == key + ("repeat",)]
    matched = [c for k, c in cells.items() if k[:-1] == key + ("match",)]
    out = {}
    if repeats:
        out = {name: float(np.mean([c[name] for c in repeats])) for name in ("repeatability", "junctions", "detection")}
        out["pictures"] = len(repeats)
    out.update(cells.get(key + ("synthetic", "scenes"), {}))
    if matched:
        for prefix in ("", "lines "):
            out[prefix + "accuracy"] = float(np.mean([_accuracy(c, prefix) for c in matched]))
            out.update({prefix + n: sum(c[prefix + n] for c in matched) for n in ("correct", "total")})
        out.update(seconds=float(np.mean([c["seconds"] for c in matched])), pairs=len(matched))
    return out


COLUMNS = (("accuracy", "points: accuracy, %", "%.1f"), ("correct", "correct", "%d"), ("total", "total", "%d"),
           ("lines accuracy", "lines: accuracy, %", "%.1f"), ("lines correct", "correct", "%d"), ("lines total", "total", "%d"),
           ("seconds", "matching, s", "%.2f"), ("repeatability", "repeat- ability, %", "%.1f"), ("recall", "recall, %", "%.1f"),
           ("precision", "precision, %", "%.1f"), ("lengths", "lengths, %", "%.1f"), ("junctions", "junctions", "%.0f"),
           ("detection", "detection, s", "%.2f"))


def _cells(measures, columns):
    return [form % measures[name] if name in measures else "-" for name, _, form in columns]


def _gains(default, back):
    """By how many times what is noticeable the default is better, for every measure."""
    out = {n: (default[n] - back[n]) / NOTICEABLE_POINTS for n in POINTS if n in default and n in back}
    out.update({n: (default[n] - back[n]) / max(default[n], 1) / NOTICEABLE_SHARE for n in SHARES if n in default and n in back})
    out.update({n: (back[n] - default[n]) / back[n] / NOTICEABLE_TIME for n in TIMES if n in default and back.get(n)})
    return out


def _verdict(default, back):
    """What the departure is worth: the default against the default with this option set back."""
    if not default or any(default.get(n) != back.get(n) for n in ("pairs", "pictures")):
        return "not measured"
    titles = {"seconds": "matching time", "detection": "detection time", "correct": "correct points"}
    up, down = [], []
    for name, gain in _gains(default, back).items():
        if abs(gain) >= 1:
            (up if gain > 0 else down).append(titles.get(name, name))
    if up and down:
        return "mixed: + %s, - %s" % (", ".join(up), ", ".join(down))
    return "pays: " + ", ".join(up) if up else "costs: " + ", ".join(down) if down else "no difference"


def _tables(part, title, cells, configurations):
    part.heading(title)
    known = {(kind, d): _summary(cells, (title, kind, d)) for kind, d, _ in configurations}
    columns = [c for c in COLUMNS if any(c[0] in m for m in known.values())]
    header = [c[1] for c in columns]
    path = [(d, m) for (kind, d), m in known.items() if kind == "path"]
    part.table(["from the paper preset, one option at a time"] + header,
               [[str(d) if d else "paper preset"] + _cells(m, columns) for d, m in path])
    default = path[-1][1]
    rows = [["default"] + _cells(default, columns) + [""]]
    single = [d for kind, d, _ in configurations if kind == "back"]
    for d in single:
        name = ", ".join("%s = %s" % (e.key, e.paper) for e in _together(d, single))
        rows.append([name] + _cells(known["back", d], columns) + [_verdict(default, known["back", d])])
    part.table(["the default with one option set back to the paper's"] + header + ["the departure"], rows)
    for verdict in ("pays", "costs", "mixed", "no difference", "not measured"):
        keys = [r[0] for r in rows[1:] if r[-1].startswith(verdict)]
        if keys:
            part.findings.append("%s, %s: the departure from %s." % (title, verdict, "; ".join(keys)))
    part.numbers[title] = {
        "path": [dict(m, option=str(d) if d else "paper preset") for d, m in path],
        "back": [dict(m, option=d.key, value=d.paper, departure=_verdict(default, m))
                 for (kind, d), m in known.items() if kind == "back"]}


def _add_detector(session, jobs, kind, departure, words, pictures, some_pairs):
    found = Detector("ablation", words)
    jobs.add(("Detector", kind, departure, "synthetic", "scenes"), _synthetic, session, words)
    for picture in pictures:
        jobs.add(("Detector", kind, departure, "repeat", picture.key), _repeatability, session, found, picture)
    for pair in some_pairs:
        jobs.add(("Detector", kind, departure, "match", pair.name), _matching, session, found, (), pair)


def run(session):
    part = Part("Ablation: what each departure from the paper is worth")
    part.text("Accuracy: mean over the pairs, of key-points and of merged lines; repeatability: ASJ criterion, mean over zooms "
              "0.9, 0.7, 0.5 and the pictures; recall, precision, lengths within 3 px: means over synthetic scenes "
              "(tests/accuracy); times: processor seconds of the program, for a picture or a pair. A departure pays when the "
              "default is better than the default without it by at least 0.5 points, 1 % of the correct matches or 20 % of the "
              "time, and nothing is worse by as much.")
    judged = [p for p in session.pairs if p.kind != pairs.LINES]
    pictures, few = session.pictures()[::2], judged[::2]
    if session.quick:
        judged, pictures, few = judged[-1:], pictures[:1], judged[-1:]
    lib, sample = session.library, session.rendered[0]
    detector = _configurations(options.of_detector(lib, sample.image1))
    matcher = _configurations(options.of_matcher(lib, sample.image1, sample.image2))
    if session.quick:
        detector, matcher = (_ends(c) for c in (detector, matcher))
    jobs = session.jobs("ablation")
    # the two defaults and paper presets, single options set back, the paths from their ends: what is near the paper takes longest
    ranks = (_is_default, _is_paper, lambda c: c[0] == "back", lambda c: c[0] == "path" and not _is_default(c) and not _is_paper(c))
    for rank in ranks:
        for kind, d, words in filter(rank, reversed(detector)):
            _add_detector(session, jobs, kind, d, words, pictures, few)
        for kind, d, words in filter(rank, reversed(matcher)):
            for pair in judged:
                jobs.add(("Matcher", kind, d, "match", pair.name), _matching, session, library.MATCHING, words, pair)
    cells = jobs.run()
    part.text("Detector: pictures %s; pairs %s. Matcher: pairs %s." % (
        ", ".join(p.key for p in pictures), ", ".join(p.name for p in few), ", ".join(p.name for p in judged)))
    _tables(part, "Detector", cells, detector)
    _tables(part, "Matcher", cells, matcher)
    part.account(jobs)
    return part
