# SPDX-License-Identifier: BSD-2-Clause
"""When two junctions correspond: the paper's section "Comparison with ACJ".

Junction 1 of the original and junction 2 of the changed image correspond when they have the same number of branches and

    |s p1 - p2| < 3 px                                    eq:corresponding-loc
    max over theta1, min over theta2, d(theta1, theta2) < pi / 20      eq:corresponding-ang
    ACJ:  |s r1 - r2| < 3 px                              eq:corresponding-iso-scale, r: the isotropic scale
    ASJ:  max over r1, min over r2, |s r1 - r2| < 3 px    r: the branches' lengths

The paper does not say what the rate is a share of, nor how several candidates are settled. Here correspondences are one to one,
closest first, and the rate is their share of the junctions of the original that the changed image shows. This is what
tests/accuracy/repeatability.c computes (column "rate"), for zooms; checks.py compares the two. "place" leaves everything but the
location away, "angles" the scales.

For maps that are no zoom, s p1 is the mapped point, a direction goes through the map's derivative at p1, s r1 of a branch is the
distance of the mapped ends, and s r1 of an isotropic scale uses the root of the derivative's determinant.
"""
from dataclasses import dataclass, replace

import numpy as np

PLACE_LIMIT = 3.0          # px
ANGLE_LIMIT = np.pi / 20   # rad
SCALE_LIMIT = 3.0          # px
ASJ, ACJ, PLACE, ANGLES = "asj", "acj", "place", "angles"


def angle_distance(a, b):
    """d_2pi(a, b) = min(|a - b|, 2 pi - |a - b|)"""
    d = np.abs(a - b) % (2 * np.pi)
    return np.minimum(d, 2 * np.pi - d)


@dataclass
class Zoom:
    """Points move with the pixels' areas: a pixel's centre lies at 0.5, 0.5 of it."""
    x: float = 1.0
    y: float = 1.0

    def expected(self, junctions):
        s = 0.5 * (self.x + self.y)
        place = (junctions.place + 0.5) * (self.x, self.y) - 0.5
        return replace(junctions, place=place, scale=s * junctions.scale, length=s * junctions.length), np.ones(len(place), bool)


@dataclass
class Homography:
    """matrix maps image 1 to image 2; side: sign of the third coordinate where points are visible; size: of image 2."""
    matrix: np.ndarray
    side: float
    size: tuple

    def points(self, p):
        q = np.concatenate([p, np.ones(p.shape[:-1] + (1,))], -1) @ self.matrix.T
        with np.errstate(all="ignore"):
            out = q[..., :2] / q[..., 2:]
        return np.where((np.sign(q[..., 2]) == self.side)[..., None], out, np.nan)

    def expected(self, junctions):
        place, ends, h = self.points(junctions.place), self.points(junctions.ends()), 0.5
        columns = [(self.points(junctions.place + d) - self.points(junctions.place - d)) / (2 * h) for d in ((h, 0), (0, h))]
        jacobian = np.stack(columns, -1)
        step = np.stack([np.cos(junctions.angle), np.sin(junctions.angle)], -1)
        turned = np.einsum("nij,nkj->nki", jacobian, step)
        with np.errstate(all="ignore"):
            scale = junctions.scale * np.sqrt(np.abs(np.linalg.det(jacobian)))
            visible = (place >= 0).all(1) & (place[:, 0] <= self.size[0] - 1) & (place[:, 1] <= self.size[1] - 1)
        length = np.hypot(*np.moveaxis(ends - place[:, None, :], -1, 0))
        angle = np.arctan2(turned[..., 1], turned[..., 0])
        return replace(junctions, place=place, scale=scale, angle=angle, length=length), visible


def _covered(distance, limit):
    """max over branches of 1, min over branches of 2 of `distance` (pairs x 5 x 5, NaN where there is no branch) < limit"""
    least = np.where(np.isfinite(distance), distance, np.inf).min(2)
    has = np.isfinite(distance).any(2)
    return np.where(has, least, -np.inf).max(1) < limit


def _agree(a, i, b, k, criterion):
    if criterion == PLACE:
        return np.ones(len(i), bool)
    angles = angle_distance(a.angle[i][:, :, None], b.angle[k][:, None, :])
    ok = (a.count[i] == b.count[k]) & _covered(angles, ANGLE_LIMIT)
    if criterion == ACJ:
        return ok & (np.abs(a.scale[i] - b.scale[k]) < SCALE_LIMIT)
    if criterion == ASJ:
        return ok & _covered(np.abs(a.length[i][:, :, None] - b.length[k][:, None, :]), SCALE_LIMIT)
    return ok


def _near(a, b):
    """Indices of all pairs of places closer than PLACE_LIMIT, and their distances."""
    by_x = np.argsort(b[:, 0], kind="stable")
    x = b[by_x, 0]
    known = np.nonzero(np.isfinite(a).all(1))[0]
    first, last = (np.searchsorted(x, a[known, 0] + d) for d in (-PLACE_LIMIT, PLACE_LIMIT))
    number = last - first
    i = np.repeat(known, number)
    k = by_x[np.arange(number.sum()) - np.repeat(np.cumsum(number) - number, number) + np.repeat(first, number)]
    d = np.hypot(*(a[i] - b[k]).T)
    near = d < PLACE_LIMIT
    return i[near], k[near], d[near]


def correspondences(a, b, criterion):
    """One-to-one pairs of indices of `a` (already mapped) and `b`, closest first."""
    i, k, d = _near(a.place, b.place)
    keep = _agree(a, i, b, k, criterion)
    i, k, d = i[keep], k[keep], d[keep]
    used_a, used_b, out = set(), set(), []
    for n in np.lexsort((k, i, d)):
        if i[n] not in used_a and k[n] not in used_b:
            used_a.add(i[n])
            used_b.add(k[n])
            out.append((i[n], k[n]))
    return np.array(out, int).reshape(-1, 2)


def rate(first, second, change, criterion):
    """(correspondences, junctions of the original that the changed image shows)"""
    expected, visible = change.expected(first)
    pairs = correspondences(expected, second, criterion)
    return int(visible[pairs[:, 0]].sum()), int(visible.sum())


SHIFTS = np.array([(0.5, 0.0), (0.0, 0.5), (0.5, 0.5)])   # of the image's size


def chance(first, second, change, criterion, size):
    """As rate(), after the changed image (width, height) went around by half its size: what the number of junctions and their usual
    directions make by chance. Mean over the shifts."""
    moved = [replace(second, place=(second.place + shift * size) % size) for shift in SHIFTS]
    rates = [rate(first, m, change, criterion) for m in moved]
    return float(np.mean([correct for correct, _ in rates])), rates[0][1]
