# SPDX-License-Identifier: BSD-2-Clause
"""Which matches are right, by the truth of their pair.

Points (the paper's "#correct" of key-points): homography: within 5 px of the mapped point; fundamental matrix: both epipolar
distances below 3 px; rendered rooms: the surface seen within 2 px of the place in the first view appears within 4 px of the place
in the second (tests/accuracy/room_pair.h, by its own code).

Segments (the paper's strict rule: "endpoints of corresponding line-segments are correct"): both ends, within 10 px or 5 % of the
length, whichever is more (homography), 3 px from the epipolar lines (fundamental matrix), 8 px (rooms); and where people have
labelled lines, segments that lie along labelled ones in both images must share a label. With labels alone (kind lines) these
judge, and segments that lie along no labelled line are not counted.
"""
import numpy as np

from . import pairs

POINT_LIMIT = {pairs.HOMOGRAPHY: 5.0, pairs.FUNDAMENTAL: 3.0, pairs.ROOM: 4.0}
END_LIMIT = {pairs.HOMOGRAPHY: 10.0, pairs.FUNDAMENTAL: 3.0, pairs.ROOM: 8.0}
END_SHARE = 0.05       # homography: of the segment's length in image 2
DIRECTION_LIMIT = 10.0      # deg
DIRECTION_LENGTH = 20.0     # px
DIRECTION_END_LIMIT = 5.0   # px
ALONG_DISTANCE = 3.0   # px: mean distance of a labelled segment's ends from the line; each at most twice that
ALONG_ANGLE = 5.0      # deg


def _homogeneous(p):
    return np.column_stack([p, np.ones(len(p))])


def _mapped(pair, p):
    """By the homography; NaN where points are not visible"""
    q = _homogeneous(p) @ pair.matrix.T
    with np.errstate(all="ignore"):
        return np.where(np.sign(q[:, 2:]) == pair.side, q[:, :2] / q[:, 2:], np.nan)


def _transfer_error(pair, p1, p2):
    return np.nan_to_num(np.hypot(*(_mapped(pair, p1) - p2).T), nan=np.inf)


def _epipolar_error(pair, p1, p2):
    """The larger of the distances of x2 from F x1 and of x1 from F' x2."""
    h1, h2 = _homogeneous(p1), _homogeneous(p2)
    line2, line1 = h1 @ pair.matrix.T, h2 @ pair.matrix
    residual = np.abs((line2 * h2).sum(1))
    with np.errstate(all="ignore"):
        return residual / np.minimum(np.hypot(*line1[:, :2].T), np.hypot(*line2[:, :2].T))


class Judge:
    """Judges the matches of one pair."""

    def __init__(self, library, pair):
        self.library, self.pair = library, pair

    def _near(self, p1, p2, limit):
        """Whether points correspond within `limit` px (a number or one for each)"""
        pair = self.pair
        if len(p1) == 0:
            return np.zeros(0, bool)
        if pair.kind == pairs.ROOM:
            rows = np.column_stack([p1, p2, np.broadcast_to(limit, len(p1))])
            text = "\n".join(" ".join("%.9g" % v for v in row) for row in rows)
            return np.array(self.library.run("room_judge", pair.room, text=text)[0].split(), int) == 1
        error = _transfer_error(pair, p1, p2) if pair.kind == pairs.HOMOGRAPHY else _epipolar_error(pair, p1, p2)
        return np.nan_to_num(error, nan=np.inf) < limit

    def points(self, p1, p2):
        """n booleans, or None where the truth says nothing of points."""
        if self.pair.kind == pairs.LINES:
            return None
        return self._near(p1, p2, POINT_LIMIT[self.pair.kind])

    def directions(self, p1, a1, p2, a2):
        """Whether branches from p to a point the same way: within 10 degrees (homography, from what it makes of the branch's first
        20 px), or the end within 5 px of its epipolar line."""
        if self.pair.kind != pairs.HOMOGRAPHY:
            return self._near(a1, a2, DIRECTION_END_LIMIT)
        with np.errstate(all="ignore"):
            length = np.hypot(*(a1 - p1).T)[:, None]
            q, r = (_mapped(self.pair, p) for p in (p1, p1 + (a1 - p1) * np.minimum(1, DIRECTION_LENGTH / length)))
            cosine = ((r - q) * (a2 - p2)).sum(1) / np.hypot(*(r - q).T) / np.hypot(*(a2 - p2).T)
        return np.nan_to_num(cosine, nan=-1) > np.cos(np.radians(DIRECTION_LIMIT))

    def segments(self, a1, b1, a2, b2, any_order=False):
        """1 right, 0 wrong, NaN not judged."""
        verdict = self._labels(a1, b1, a2, b2)
        if self.pair.kind == pairs.LINES:
            return np.where(verdict == 0, np.nan, verdict > 0)
        right = self._ends(a1, b1, a2, b2)
        if any_order:
            right |= self._ends(a1, b1, b2, a2)
        return (right & (verdict >= 0)).astype(float)

    def _ends(self, a1, b1, a2, b2):
        limit = END_LIMIT[self.pair.kind]
        if self.pair.kind == pairs.HOMOGRAPHY:
            limit = np.maximum(limit, END_SHARE * np.hypot(*(b2 - a2).T))
        return self._near(a1, a2, limit) & self._near(b1, b2, limit)

    def _labels(self, a1, b1, a2, b2):
        """+1 the same label in both images, -1 labelled differently, 0 at least one lies along no labelled line."""
        if self.pair.labels is None:
            return np.zeros(len(a1), int)
        groups = self.pair.labels["matches"]
        of1, of2 = (_along(self.pair.labels["segments%d" % i], a, b) @ _membership(groups, i - 1, self.pair.labels) > 0
                    for i, a, b in ((1, a1, b1), (2, a2, b2)))
        judged = of1.any(1) & of2.any(1)
        return np.where(judged, np.where((of1 & of2).any(1), 1, -1), 0)


def _membership(groups, side, labels):
    """labelled segments x groups: which belongs to which"""
    out = np.zeros((len(labels["segments%d" % (side + 1)]), len(groups)), int)
    for g, group in enumerate(groups):
        out[list(group[side]), g] = 1
    return out


def _along(labelled, a, b):
    """n x labelled: whether segment a-b and a labelled segment lie along each other, over half of the shorter"""
    labelled = np.array(labelled, float).reshape(-1, 4)
    p, q = labelled[None, :, :2], labelled[None, :, 2:]
    length = np.hypot(*(b - a).T)[:, None]
    with np.errstate(all="ignore"):
        u = ((b - a) / length)[:, None, :]
    normal = np.stack([-u[..., 1], u[..., 0]], -1)
    along = [((end - a[:, None]) * u).sum(-1) for end in (p, q)]
    across = [np.abs(((end - a[:, None]) * normal).sum(-1)) for end in (p, q)]
    other = np.hypot(*(q - p)[0].T)[None]
    with np.errstate(all="ignore"):
        cosine = np.abs(((q - p) * u).sum(-1)) / other
        overlap = np.minimum(np.maximum(*along), length) - np.maximum(np.minimum(*along), 0)
        close = (across[0] + across[1] < 2 * ALONG_DISTANCE) & (np.maximum(*across) < 2 * ALONG_DISTANCE)
        parallel = cosine > np.cos(np.radians(ALONG_ANGLE))
        return ((length >= 1) & close & parallel & (overlap > 0.5 * np.minimum(length, other))).astype(int)
