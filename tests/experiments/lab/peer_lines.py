# SPDX-License-Identifier: BSD-2-Clause
"""Line segments of opencv-contrib (LSD or EDLines) with its LBD descriptors. Matched in two ways: as the key-points are (ratio 1.5,
one way), and as OpenCV's own sample does (nearest, Hamming distance at most 25). A new peer is a line in PEERS."""
import time

import cv2
import numpy as np

from .matches import Matches

RATIO = 1.5
LIMIT = 25  # of 256 bits


def available():
    return hasattr(cv2, "line_descriptor") and hasattr(cv2.line_descriptor, "BinaryDescriptor")


def _segments(detector, image):
    """Segments x1 y1 x2 y2 and descriptors; one octave."""
    describe = cv2.line_descriptor.BinaryDescriptor.createBinaryDescriptor()
    if detector == "LSD":
        lines = cv2.line_descriptor.LSDDetector.createLSDDetector().detect(image, 2, 1)
    else:
        lines = describe.detect(image)
    if len(lines) == 0:
        return np.zeros((0, 4)), None
    lines, descriptors = describe.compute(image, lines)
    lines = lines[0] if len(lines) and isinstance(lines[0], (tuple, list)) else lines
    return np.array([(k.startPointX, k.startPointY, k.endPointX, k.endPointY) for k in lines], float), descriptors


def _pairs(d1, d2, by_ratio):
    matcher = cv2.BFMatcher(cv2.NORM_HAMMING)
    if by_ratio:
        kept = [m for m, n in matcher.knnMatch(d1, d2, k=2) if RATIO * m.distance <= n.distance]
    else:
        kept = [m for m in matcher.match(d1, d2) if m.distance <= LIMIT]
    return np.array([(m.queryIdx, m.trainIdx) for m in kept], int).reshape(-1, 2)


PEERS = {
    "LSD + LBD, ratio 1.5": ("LSD", True),
    "LSD + LBD, distance 25": ("LSD", False),
    "EDLines + LBD, ratio 1.5": ("EDLines", True),
    "EDLines + LBD, distance 25": ("EDLines", False),
}


def match(name, pair):
    detector, by_ratio = PEERS[name]
    start = time.thread_time()
    (s1, d1), (s2, d2) = (_segments(detector, cv2.imread(p, cv2.IMREAD_GRAYSCALE)) for p in (pair.image1, pair.image2))
    if min(len(s1), len(s2)) < 2:
        return Matches(any_order=True, seconds=time.thread_time() - start)
    i, k = _pairs(d1, d2, by_ratio).T
    return Matches(a1=s1[i, :2], b1=s1[i, 2:], a2=s2[k, :2], b2=s2[k, 2:], any_order=True, seconds=time.thread_time() - start)
