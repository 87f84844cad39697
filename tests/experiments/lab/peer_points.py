# SPDX-License-Identifier: BSD-2-Clause
"""Key-points of OpenCV, matched as the paper's table does: nearest neighbour from image 1 to image 2, kept when the second nearest
is farther by 1.5 in squared distance. The Hamming distance of binary descriptors is a squared distance.

Affine-SIFT finds the same point in several simulated views: its second nearest is the nearest that lies elsewhere (6 px), and of
matches between the same places (1 px) one counts. A new peer is a class with detect() and a line in PEERS."""
import time

import cv2
import numpy as np

from .matches import NONE, Matches

RATIO = 1.5
ELSEWHERE = 6.0  # px
NEAREST = 12     # candidates of Affine-SIFT looked at for one that lies elsewhere
BLOCK = 500      # rows of distances held at a time


def _make(name, *arguments, **options):
    """cv2.NAME_create, which some versions keep in xfeatures2d."""
    for module in (cv2, getattr(cv2, "xfeatures2d", None)):
        maker = getattr(module, name + "_create", None)
        if maker:
            return maker(*arguments, **options)
    return None


class Binary:
    """Binary descriptors."""

    def __init__(self, name, **options):
        self.extractor = _make(name, **options)

    def match(self, first, second):
        (p1, d1), (p2, d2) = (_features(self.extractor, image) for image in (first, second))
        if min(len(p1), len(p2)) < 2:
            return NONE, NONE
        found = cv2.BFMatcher(cv2.NORM_HAMMING).knnMatch(d1, d2, k=2)
        kept = [m.queryIdx for m, n in found if RATIO * m.distance <= n.distance]
        return p1[kept], p2[[found[i][0].trainIdx for i in kept]]


class Sift:
    """SIFT, and with simulated views Affine-SIFT."""

    def __init__(self, affine):
        self.affine = affine
        self.extractor = cv2.AffineFeature_create(cv2.SIFT_create()) if affine else cv2.SIFT_create()

    def match(self, first, second):
        (p1, d1), (p2, d2) = (_features(self.extractor, image) for image in (first, second))
        if min(len(p1), len(p2)) < 2:
            return NONE, NONE
        index, best, second_best = _nearest(d1, d2, p2 if self.affine else None)
        kept = RATIO * best <= second_best
        p1, p2 = p1[kept], p2[index[kept]]
        if self.affine and len(p1):
            kept = np.unique(np.round(np.column_stack([p1, p2])), axis=0, return_index=True)[1]
            p1, p2 = p1[kept], p2[kept]
        return p1, p2


def _features(extractor, image):
    points, descriptors = extractor.detectAndCompute(image, None)
    place = np.array([p.pt for p in points], float).reshape(-1, 2)
    return place, descriptors


def _nearest(d1, d2, places):
    """For each row of d1: index of the nearest row of d2, its squared distance, and that of the second nearest; with places the
    nearest of the first NEAREST that lies elsewhere."""
    d1, d2 = d1.astype(np.float32), d2.astype(np.float32)
    norm, out = (d2 * d2).sum(1), []
    for begin in range(0, len(d1), BLOCK):
        rows = d1[begin:begin + BLOCK]
        squared = norm - 2 * rows @ d2.T + (rows * rows).sum(1)[:, None]
        out.append(_two_best(squared, places))
    return tuple(np.concatenate(parts) for parts in zip(*out))


def _two_best(squared, places):
    every = np.arange(len(squared))
    first = squared.argmin(1)
    best = squared[every, first]
    current, second, left = first, np.zeros(len(squared), np.float32), every
    for _ in range(NEAREST):
        squared[left, current] = np.inf
        current = squared[left].argmin(1) if len(left) < len(squared) else squared.argmin(1)
        second[left] = squared[left, current]
        if places is None:
            break
        near = np.hypot(*(places[current] - places[first[left]]).T) <= ELSEWHERE
        left, current = left[near], current[near]
        if not len(left):
            break
    return first, best, second


# name -> maker of something with match(gray image, gray image) -> points of image 1, points of image 2
PEERS = {
    "SIFT": lambda: Sift(False),
    "Affine-SIFT": lambda: Sift(True),
    "ORB": lambda: Binary("ORB", nfeatures=2000),
    "AKAZE": lambda: Binary("AKAZE"),
    "BRISK": lambda: Binary("BRISK"),
}


def match(name, pair):
    start = time.thread_time()
    first, second = (cv2.imread(path, cv2.IMREAD_GRAYSCALE) for path in (pair.image1, pair.image2))
    p1, p2 = PEERS[name]().match(first, second)
    return Matches(p1, p2, seconds=time.thread_time() - start)
