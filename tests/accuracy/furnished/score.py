#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Poses and matches of pairs with known poses, as render.py makes them.

    score.py ASJ_CLI FOLDER [--verbose] [-- OPTIONS OF MATCH]
    score.py --sift FOLDER [--verbose]

Matches every pair of FOLDER that has K1, K2 and pose in its truth.json, cameras given; with --sift OpenCV's SIFT does (5000 key
points at most, ratio test .8, essential matrix by MAGSAC++ with 1 px, matches of it). Errors are the larger one of rotation's and
translation's direction, degrees, 180 where there is no pose. Prints the area under recall over error at 1, 2, 5, 10, 20 degrees,
how many are accepted (of those with a third in common), how many of these are out by more than 3 degrees, how many matches lie
within 3 px of both true epipolar lines, and errors over told standard deviations (of all three axes together): the median and nine
of ten, of rotations and of translations.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from pose_judge import area, camera_options, count_right, errors

LIMITS = (1, 2, 5, 10, 20)
NO_POSE = 180.0
WRONG = 3.0  # degrees
NEAR = 3.0  # px
THIRD = 1 / 3


def by_library(cli, options, folder, truth):
    """Rotation, translation and told deviations of both, degrees, or None; is a geometry accepted?; matches x1 y1 x2 y2."""
    with tempfile.TemporaryDirectory() as place:
        out = pathlib.Path(place) / "matches.json"
        subprocess.run([cli, "match", "-q", "--geometry", "auto", *camera_options(truth), *options, "-o", str(out),
                        str(folder / "1.png"), str(folder / "2.png")], check=True)
        found = json.loads(out.read_text())
    geometry = found["geometry"] or {}
    rotation, translation = geometry.get("rotation"), geometry.get("translation")
    pose = None
    if rotation and translation:
        variances = np.diag(np.reshape(geometry["covariance"], (6, 6)))
        told = np.degrees(np.sqrt([variances[:3].sum(), variances[3:].sum()]))
        pose = np.reshape(rotation, (3, 3)), np.array(translation), told
    places = np.array([[m["x1"], m["y1"], m["x2"], m["y2"]] for m in found["matches"]]).reshape(-1, 4)
    return pose, found["geometry_status"] == "accepted", places


def by_sift(folder, truth):
    import cv2

    sift, inner = cv2.SIFT_create(5000), [np.array(truth[f"K{which}"]) for which in (1, 2)]
    sides = [sift.detectAndCompute(cv2.imread(str(folder / f"{which}.png"), 0), None) for which in (1, 2)]
    pairs = cv2.BFMatcher().knnMatch(sides[0][1], sides[1][1], k=2)
    good = [pair[0] for pair in pairs if len(pair) == 2 and pair[0].distance < 0.8 * pair[1].distance]
    places = np.array([[*sides[0][0][m.queryIdx].pt, *sides[1][0][m.trainIdx].pt] for m in good]).reshape(-1, 4)
    if len(places) < 6:
        return None, False, places[:0]
    rays = [((places[:, 2 * k : 2 * k + 2] - inner[k][:2, 2]) / inner[k][[0, 1], [0, 1]]) for k in (0, 1)]
    matrix, inliers = cv2.findEssentialMat(*rays, np.eye(3), cv2.USAC_MAGSAC, 0.9999, 1 / inner[0][0, 0])
    if matrix is None or matrix.shape != (3, 3):
        return None, False, places[:0]
    _, rotation, translation, _ = cv2.recoverPose(matrix, *rays, np.eye(3), mask=inliers.copy())
    return (rotation, translation.ravel(), None), True, places[inliers.ravel() > 0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cli", nargs="?")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--sift", action="store_true")
    parser.add_argument("--verbose", action="store_true")
    words = sys.argv[1:]
    cut = words.index("--") if "--" in words else len(words)
    given = parser.parse_args(words[:cut])
    if bool(given.cli) == given.sift:
        parser.error("either ASJ_CLI or --sift")
    rows, over_told = [], []
    for folder in sorted(path.parent for path in given.folder.glob("*/truth.json")):
        truth = json.loads((folder / "truth.json").read_text())
        if "pose" not in truth:
            continue
        pose, accepted, places = by_sift(folder, truth) if given.sift else by_library(given.cli, words[cut + 1 :], folder, truth)
        apart = errors(*pose[:2], np.array(truth["pose"])) if pose else (NO_POSE, NO_POSE)
        if pose and pose[2] is not None:
            over_told.append(np.divide(apart, pose[2]))
        right = count_right(places[:, :2], places[:, 2:], np.array(truth["F"]), NEAR)
        common = truth.get("common", 0)
        rows.append((max(apart), accepted, common >= THIRD, right, len(places)))
        if given.verbose:
            print(f"{folder.name} common {common:.2f} error {max(apart):.1f} matches {right}/{len(places)}", flush=True)
    if not rows:
        sys.exit(f"{given.folder} has no pairs with poses")
    worst, accepted, third, right, matches = map(np.array, zip(*rows))
    print(f"{len(rows)} pairs: AUC at 1, 2, 5, 10, 20 degrees", *(f"{area(worst, limit):.1f}" for limit in LIMITS),
          f"accepted {accepted.sum()}, of those with a third in common {(accepted & third).sum()} of {third.sum()}; "
          f"out by more than 3 degrees {((worst > WRONG) & (worst < NO_POSE)).sum()};",
          f"matches {right.sum()} of {matches.sum()} right")
    if over_told:
        (turn, way), (most_turn, most_way) = np.quantile(over_told, (0.5, 0.9), axis=0)
        print(f"errors over told deviations: rotation {turn:.2f}, {most_turn:.2f}; translation {way:.2f}, {most_way:.2f}")


if __name__ == "__main__":
    main()
