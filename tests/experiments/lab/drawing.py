# SPDX-License-Identifier: BSD-2-Clause
"""Junctions, matches and segments drawn over pictures. Colours are OpenCV's: blue, green, red."""
import cv2
import numpy as np

YELLOW, RED, GREEN, CYAN, BLACK = (0, 220, 255), (40, 40, 230), (60, 200, 0), (230, 200, 0), (0, 0, 0)
SHIFT = 4  # bits of sub-pixel places
GAP = 8    # px between pictures


def _fixed(point):
    return tuple(int(round(v * (1 << SHIFT))) for v in point)


def line(canvas, a, b, colour, width=1):
    if np.isfinite([*a, *b]).all():
        cv2.line(canvas, _fixed(a), _fixed(b), colour, width, cv2.LINE_AA, SHIFT)


def circle(canvas, centre, radius, colour, width=1):
    if np.isfinite([*centre, radius]).all():
        cv2.circle(canvas, _fixed(centre), int(round(radius * (1 << SHIFT))), colour, width, cv2.LINE_AA, SHIFT)


def junction(canvas, junctions, index, colour, width=1):
    """A junction's branches and its place."""
    for end in junctions.ends()[index]:
        line(canvas, junctions.place[index], end, colour, width)
    circle(canvas, junctions.place[index], 2, colour, -1)


def pale(path):
    """A picture with its contrast lowered, as a ground to draw on."""
    return (cv2.imread(path, cv2.IMREAD_COLOR) // 2 + 120).astype(np.uint8)


def white_like(path):
    return np.full_like(cv2.imread(path, cv2.IMREAD_COLOR), 255)


def beside(pictures):
    """Pictures in a row, white between them."""
    height = max(p.shape[0] for p in pictures)
    out = []
    for p in pictures:
        out.append(cv2.copyMakeBorder(p, 0, height - p.shape[0], 0, GAP, cv2.BORDER_CONSTANT, value=(255, 255, 255)))
    return np.hstack(out)[:, :-GAP]


def offset(picture):
    """Where the picture beside this one begins."""
    return np.array([picture.shape[1] + GAP, 0.0])


def encode(picture, most=1400):
    """JPEG bytes, at most `most` px wide."""
    if picture.shape[1] > most:
        size = (most, int(round(picture.shape[0] * most / picture.shape[1])))
        picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    return cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 88])[1].tobytes()
