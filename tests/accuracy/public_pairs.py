#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Pairs of photographs that come with other software, with the truth that stands beside them.

    public_pairs.py ASJ_CLI OPENCV [--skimage SKIMAGE] [-- OPTIONS OF MATCH]

OPENCV is the folder with the pictures of OpenCV's samples (graf1.png, H1to3p.xml, aloeL.jpg, left01.jpg ...): samples/data of its
sources, or examples/data of a package of its documentation. SKIMAGE is the folder skimage/data of scikit-image up to 0.16
(motorcycle_left.png ...). Truth is

  graf        a homography; what is not on that wall counts as wrong
  aloe        disparities of rectified cameras; places without one are left out
  motorcycle  the same, of a garage
  stereo      thirteen pairs of two cameras and a chessboard, which calibrates them here; lenses' distortion is taken out first

Prints for each pair how many key points (distinct pairs of places) are right, within LIMIT px of the truth or, of the cameras with
a chessboard, within LINE_LIMIT of their epipolar line; how far off they are in the median; the model of the geometry where one is
asked for and accepted; and the sums.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

import cv2
import numpy as np

LIMIT, LINE_LIMIT = 5.0, 3.0  # px
AROUND = 3  # px in which disparities of an edge are looked for
BOARD = (9, 6)
VIEWS = [1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14]


def match(cli, files, options):
    """Places that are matched, and the model of their geometry."""
    command = [cli, "match", "-q", "--format", "json", *options, *map(str, files)]
    found = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    places = {tuple(round(m[key], 1) for key in ("x1", "y1", "x2", "y2")) for m in found["matches"]}
    return np.array(sorted(places)).reshape(-1, 4), (found.get("geometry") or {}).get("model", "")


def off_homography(matrix):
    return lambda places: np.hypot(*(cv2.perspectiveTransform(places[:, None, :2], matrix)[:, 0] - places[:, 2:]).T)


def off_disparity(disparity):
    def off(places):
        result = []
        for x1, y1, x2, y2 in places:
            x, y = int(round(x1)), int(round(y1))
            window = disparity[max(0, y - AROUND) : y + AROUND + 1, max(0, x - AROUND) : x + AROUND + 1]
            window = window[np.isfinite(window) & (window > 0)]
            result.append(np.hypot(np.min(np.abs(x1 - x2 - window)), y1 - y2) if window.size else np.nan)
        return np.array(result)

    return off


def off_lines(matrix):
    def off(places):
        first, second = (np.c_[places[:, k : k + 2], np.ones(len(places))] for k in (0, 2))
        in2, in1 = first @ matrix.T, second @ matrix
        return np.abs((second * in2).sum(1)) / np.sqrt((in2[:, :2] ** 2).sum(1) + (in1[:, :2] ** 2).sum(1))

    return off


def calibrate(folder):
    """Cameras, distortions and fundamental matrix of the undistorted views."""
    board = np.zeros((BOARD[0] * BOARD[1], 3), np.float32)
    board[:, :2] = np.mgrid[0 : BOARD[0], 0 : BOARD[1]].T.reshape(-1, 2)
    corners, stop = {"left": [], "right": []}, (3, 100, 1e-4)
    for side, list_ in corners.items():
        for view in VIEWS:
            picture = cv2.imread(str(folder / f"{side}{view:02d}.jpg"), 0)
            found, places = cv2.findChessboardCorners(picture, BOARD)
            assert found, (side, view)
            list_.append(cv2.cornerSubPix(picture, places, (5, 5), (-1, -1), stop))
    size, boards = picture.shape[::-1], [board] * len(VIEWS)
    lenses = {side: cv2.calibrateCamera(boards, list_, size, None, None)[1:3] for side, list_ in corners.items()}
    stereo = cv2.stereoCalibrate(boards, corners["left"], corners["right"], *lenses["left"], *lenses["right"], size,
                                 flags=cv2.CALIB_FIX_INTRINSIC)
    return lenses, stereo[8]


def pairs(opencv, skimage, place):
    """Name, both files, how far off, and the limit of that."""
    truth = np.array(ElementTree.parse(opencv / "H1to3p.xml").find(".//data").text.split(), float)
    yield "graf", (opencv / "graf1.png", opencv / "graf3.png"), off_homography(truth.reshape(3, 3)), LIMIT
    aloe = cv2.imread(str(opencv / "aloeGT.png"), 0).astype(float)
    yield "aloe", (opencv / "aloeL.jpg", opencv / "aloeR.jpg"), off_disparity(aloe), LIMIT
    if skimage:
        disparities = np.load(skimage / "motorcycle_disp.npz")
        garage = (skimage / "motorcycle_left.png", skimage / "motorcycle_right.png")
        yield "motorcycle", garage, off_disparity(disparities[disparities.files[0]]), LIMIT
    lenses, matrix = calibrate(opencv)
    for view in VIEWS:
        files = []
        for side, (camera, distortion) in lenses.items():
            files.append(place / f"{side}{view:02d}.png")
            picture = cv2.imread(str(opencv / f"{side}{view:02d}.jpg"), 0)
            cv2.imwrite(str(files[-1]), cv2.undistort(picture, camera, distortion, None, camera))
        yield f"stereo {view}", files, off_lines(matrix), LINE_LIMIT


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cli")
    parser.add_argument("opencv", type=pathlib.Path)
    parser.add_argument("--skimage", type=pathlib.Path)
    words = sys.argv[1:]
    cut = words.index("--") if "--" in words else len(words)
    given = parser.parse_args(words[:cut])
    right = count = 0
    with tempfile.TemporaryDirectory() as place:
        for name, files, off, limit in pairs(given.opencv, given.skimage, pathlib.Path(place)):
            places, geometry = match(given.cli, files, words[cut + 1 :])
            errors = off(places) if len(places) else np.zeros(0)
            errors = errors[np.isfinite(errors)]
            middle = f"{np.median(errors):.2f} px" if len(errors) else "-"
            print(f"{name:12} {np.sum(errors < limit):5} of {len(errors):5} right, median {middle} {geometry}", flush=True)
            right, count = right + int(np.sum(errors < limit)), count + len(errors)
    print(f"all          {right:5} of {count:5}")


if __name__ == "__main__":
    main()
