#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Straight edges that come twice: crossing_lines.py ASJ_CLI IMAGE...

Of the lines that `detect --lines` finds in all images: how many pairs cross at less than 6 degrees, with at least 4 px of what both
cover to either side of the crossing and 6 px from each other there at most; and of the samples along the lines, 1 px apart, how
many lie within 1.5 px of a largest gradient across, of a grey level at least. Needs numpy and cv2."""
import json
import subprocess
import sys

import cv2
import numpy as np

BESIDE, DEEP, SINE = 6, 4, 0.1  # px, px, 1


def lines_of(program, image):
    """The ends of the lines, the longest first."""
    text = subprocess.run([program, "detect", "--lines", "-q", "-o", "/dev/stdout", "--format", "json", image], check=True,
                          capture_output=True).stdout
    return np.array([[line[key] for key in ("x1", "y1", "x2", "y2")] for line in json.loads(text)["lines"]]).reshape(-1, 2, 2)


def crosses(longer, shorter):
    """Whether both lie along one edge and cross."""
    length = np.hypot(*(longer[1] - longer[0]))
    along = (longer[1] - longer[0]) / length
    at = (shorter - longer[0]) @ along
    beside = (shorter - longer[0]) @ np.array([-along[1], along[0]])
    if beside[0] * beside[1] >= 0 or abs(beside[1] - beside[0]) > SINE * np.hypot(*(shorter[1] - shorter[0])):
        return False
    crossing = at[0] + (at[1] - at[0]) * beside[0] / (beside[0] - beside[1])
    sides = crossing - max(min(at), 0), min(max(at), length) - crossing
    slope = abs((beside[1] - beside[0]) / (at[1] - at[0]))
    return min(sides) >= DEEP and max(sides) * slope <= BESIDE


def on_edge(gradient, line):
    """Samples of the line, and how many of them lie on an edge."""
    length = np.hypot(*(line[1] - line[0]))
    along = (line[1] - line[0]) / max(length, 1e-9)
    across = np.array([-along[1], along[0]])
    steps, offsets = np.arange(3, length - 3), np.arange(-2, 2.01, 0.5)
    if len(steps) == 0:
        return 0, 0
    places = (line[0] + steps[:, None, None] * along + offsets[None, :, None] * across).astype(np.float32)
    steep = abs(sum(cv2.remap(gradient[k], places[..., 0], places[..., 1], cv2.INTER_LINEAR) * across[k] for k in range(2)))
    top = (steep[:, 1:-1] > steep[:, :-2]) & (steep[:, 1:-1] >= steep[:, 2:]) & (steep[:, 1:-1] > 1)
    return len(steps), int(top.any(axis=1).sum())


def main():
    """One line for all images."""
    count = pairs = samples = good = 0
    for image in sys.argv[2:]:
        lines = lines_of(sys.argv[1], image)
        smooth = cv2.GaussianBlur(cv2.imread(image, cv2.IMREAD_GRAYSCALE).astype(np.float32), (0, 0), 1)
        gradient = [cv2.Sobel(smooth, cv2.CV_32F, 1 - k, k) / 8 for k in range(2)]
        count += len(lines)
        pairs += sum(crosses(lines[k], lines[n]) for n in range(len(lines)) for k in range(n))
        for line in lines:
            some, on = on_edge(gradient, line)
            samples, good = samples + some, good + on
    print(f"{count} lines, {pairs} pairs cross; of {samples} px along them {good / max(samples, 1):.3f} on an edge")


if __name__ == "__main__":
    main()
