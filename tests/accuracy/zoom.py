#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Junctions that stay where they are when photographs shrink, beside the corners of OpenCV's goodFeaturesToTrack.

    zoom.py ASJ_CLI IMAGE... [-- OPTIONS OF DETECT]

Each photograph, in grey, is made smaller (INTER_AREA, JPEG of quality 95). Points of it and of the copy correspond within 3 px of
the copy, one to one, the nearest first; told is their share of the shorter list, percent, the mean over the photographs. In each
image OpenCV finds as many points as there are junctions (quality 1e-3, 5 px apart). Needs NumPy and OpenCV.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

FACTORS = [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3]
WITHIN = 3.0


def copies(image):
    height, width = image.shape
    for factor in FACTORS:
        small = cv2.resize(image, (round(width * factor), round(height * factor)), interpolation=cv2.INTER_AREA)
        yield cv2.imdecode(cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, 95])[1], cv2.IMREAD_GRAYSCALE)


def junctions(cli, options, image):
    with tempfile.TemporaryDirectory() as place:
        cv2.imwrite(f"{place}/image.png", image)
        command = [cli, "detect", "-q", "-f", "json", *options, f"{place}/image.png"]
        out = subprocess.run(command, check=True, stdout=subprocess.PIPE)
    return np.array([(found["x"], found["y"]) for found in json.loads(out.stdout)["junctions"]]).reshape(-1, 2)


def good_features(image, count):
    found = cv2.goodFeaturesToTrack(image, count, 1e-3, 5) if count else None
    return np.zeros((0, 2)) if found is None else found.reshape(-1, 2)


def repeated(points, shape, others, other_shape):
    """Percent of the shorter list; pixel centres are integers."""
    if not len(points) or not len(others):
        return 0.0
    scale = np.divide(other_shape[::-1], shape[::-1])
    moved = (points + 0.5) * scale - 0.5
    distances = np.linalg.norm(moved[:, None] - others[None], axis=2)
    one, other = np.nonzero(distances <= WITHIN)
    used = set(), set()
    for k in np.argsort(distances[one, other], kind="stable"):
        if one[k] not in used[0] and other[k] not in used[1]:
            used[0].add(one[k])
            used[1].add(other[k])
    return 100 * len(used[0]) / min(len(points), len(others))


def shares(images, lists):
    return [repeated(lists[0], images[0].shape, points, image.shape) for image, points in zip(images[1:], lists[1:])]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cli")
    parser.add_argument("images", nargs="+", type=pathlib.Path)
    words = sys.argv[1:]
    cut = words.index("--") if "--" in words else len(words)
    given = parser.parse_args(words[:cut])
    ours, theirs, count = [], [], 0
    for path in given.images:
        image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
        if image is None:
            parser.error(f"{path}: cannot be read")
        images = [image, *copies(image)]
        found = [junctions(given.cli, words[cut + 1 :], each) for each in images]
        count += len(found[0])
        ours.append(shares(images, found))
        theirs.append(shares(images, [good_features(each, len(points)) for each, points in zip(images, found)]))
    print("| zoom |", " | ".join(f"{factor:.1f}" for factor in FACTORS), "|")
    print("| --- |", " | ".join("---" for _ in FACTORS), "|")
    for name, rows in ((f"junctions ({count} in {len(ours)} images)", ours), ("goodFeaturesToTrack, as many", theirs)):
        print(f"| {name} |", " | ".join(f"{share:.1f}" for share in np.mean(rows, axis=0)), "|")


if __name__ == "__main__":
    sys.exit(main())
