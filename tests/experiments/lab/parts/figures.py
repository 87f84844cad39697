# SPDX-License-Identifier: BSD-2-Clause
"""Part 7: pictures of junctions and of matches."""
import numpy as np

from .. import drawing, junctions, library, methods, pairs, peer_points, score
from ..library import Failure
from ..report import Part

MOST_DRAWN = 2000   # files of others stand in no order: of more, a part of the picture would be empty


def _detections(session, picture, given):
    """The photograph with the junctions of the default preset, of the paper preset, and of those that stand in files:
    (JPEG bytes, {name: how many places})"""
    path = picture.original()
    found = {d.name: session.library.detect(d, path) for d in (library.DEFAULT, library.PAPER)}
    found.update({name: junctions.read_asj(file) for name, file in given.items()})
    canvas = []
    for each in found.values():
        canvas.append(drawing.pale(path))
        for i in range(min(len(each), MOST_DRAWN)):
            drawing.junction(canvas[-1], each, i, drawing.RED)
    return drawing.encode(drawing.beside(canvas)), {name: len(np.unique(each.place, axis=0)) for name, each in found.items()}


def _junction_matches(session, pair, clean):
    """Both views with matched junctions: cyan right, yellow wrong; clean: the right ones alone, on white, no connections."""
    found = methods.match(session, methods.DEFAULT, pair)
    right = score.Judge(session.library, pair).points(found.p1, found.p2)
    canvas = drawing.beside([(drawing.white_like if clean else drawing.pale)(p) for p in (pair.image1, pair.image2)])
    shift, n = drawing.offset(drawing.pale(pair.image1)), len(found.p1)
    for i in np.argsort(right):
        colour = drawing.BLACK if clean else drawing.CYAN if right[i] else drawing.YELLOW
        if clean and not right[i]:
            continue
        for end in (i, n + i):  # branches a and b
            drawing.line(canvas, found.a1[end], found.b1[end], colour, 1 if clean else 2)
            drawing.line(canvas, found.a2[end] + shift, found.b2[end] + shift, colour, 1 if clean else 2)
        if not clean:
            drawing.line(canvas, found.p1[i], found.p2[i] + shift, colour)
    return drawing.encode(canvas), int(right.sum()), n


def _line_matches(session, pair):
    """Matched line segments, their middles connected."""
    a1, b1, a2, b2 = methods.match(session, methods.DEFAULT, pair).lines
    right = score.Judge(session.library, pair).segments(a1, b1, a2, b2)
    canvas = drawing.beside([drawing.pale(p) for p in (pair.image1, pair.image2)])
    shift = drawing.offset(drawing.pale(pair.image1))
    for i in np.argsort(np.nan_to_num(right, nan=-1)):
        colour = drawing.BLACK if np.isnan(right[i]) else drawing.CYAN if right[i] else drawing.YELLOW
        drawing.line(canvas, a1[i], b1[i], colour, 2)
        drawing.line(canvas, a2[i] + shift, b2[i] + shift, colour, 2)
        drawing.line(canvas, (a1[i] + b1[i]) / 2, (a2[i] + b2[i]) / 2 + shift, colour)
    return drawing.encode(canvas), int(np.nansum(right)), int(np.isfinite(right).sum())


def _peer_clean(session, pair, name):
    """The right key-points of a peer on white."""
    found = session.shared.get(("points", name, pair.name)) or peer_points.match(name, pair)
    right = score.Judge(session.library, pair).points(found.p1, found.p2)
    canvas = drawing.beside([drawing.white_like(p) for p in (pair.image1, pair.image2)])
    shift = drawing.offset(drawing.white_like(pair.image1))
    for i in np.nonzero(right)[0]:
        drawing.circle(canvas, found.p1[i], 2, drawing.BLACK, -1)
        drawing.circle(canvas, found.p2[i] + shift, 2, drawing.BLACK, -1)
    return drawing.encode(canvas), int(right.sum()), len(right)


def _draw(part, session, pair):
    if pair.kind != pairs.LINES:
        data, right, total = _junction_matches(session, pair, False)
        part.picture(data, "jpeg", "%s: matched junctions, %d right (cyan) of %d; wrong ones yellow" % (pair.name, right, total))
    data, right, total = _line_matches(session, pair)
    part.picture(data, "jpeg", "%s: matched line segments, %d right (cyan) of %d; wrong ones yellow, without a verdict black"
                 % (pair.name, right, total))


def _draw_clean(part, session, pair):
    data, right, _ = _junction_matches(session, pair, True)
    part.picture(data, "jpeg", "%s: the %d right junctions without the photograph" % (pair.name, right))
    data, right, _ = _peer_clean(session, pair, "SIFT")
    part.picture(data, "jpeg", "%s: the %d right key-points of SIFT without the photograph" % (pair.name, right))


def run(session):
    part = Part("Figures")
    pictures, chosen = session.pictures(), session.pairs
    if session.quick:
        pictures, chosen = pictures[:1], session.pairs[:1]
    files = {session.view(p, 1).key: {name: both[0] for name, both in p.detections.items()} for p in session.pairs}
    steps = [("junctions of " + p.key, lambda p=p: _figure_of_junctions(part, session, p, files[p.key])) for p in pictures]
    steps += [("matches of " + p.name, lambda p=p: _draw(part, session, p)) for p in chosen]
    clean = [p for p in chosen if p.kind != pairs.LINES][:4]
    steps += [("clean matches of " + p.name, lambda p=p: _draw_clean(part, session, p)) for p in clean]
    for name, step in steps:
        try:
            step()
        except Failure as reason:
            part.cut.append("%s: %s" % (name, reason))
    return part


def _figure_of_junctions(part, session, picture, given):
    data, counts = _detections(session, picture, given)
    part.numbers[picture.key] = counts
    part.picture(data, "jpeg", "%s, places, from the left: %s" % (
        picture.key, "; ".join("%s, %d" % item for item in counts.items())))
