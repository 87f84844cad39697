#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""What each ingredient of the two-view geometry is worth: the table of README.md here.

    ingredients.py [--seeds N] [--only WORD] PAIRS

PAIRS holds folders with 1.png, 2.png and truth.json (K1, K2, pose [R | t], F). Each row leaves something out or takes something
else; error of a pair: the larger one of rotation and direction of translation, 180 degrees where no pose is told. Needs the Python
package, numpy and OpenCV (its five-point RANSAC, for rows without a geometry of ours).
"""

import argparse
import json
import pathlib
import sys

import asj
import cv2
import numpy as np
from asj import matches as of_matches
from asj._native import ffi, lib
from asj.context import current
from asj.options import MATCHER
from pose_judge import area, count_right, errors

LOOSE = {"ratio": 1, "mutual": 0, "minimum_support": 0.5, "verify_agreement": 0, "guided_rounds": 0, "shortlist": 16}
ROWS = [
    ("matches by default, five-point RANSAC", {}, None),
    ("loose options, five-point RANSAC", LOOSE, None),
    ("points alone: no angle or scale of affine maps, no directions of the room", {},
     {"angle_sd": 45, "scale_sd": 1, "no_directions": 1}),
    ("points and angles", {}, {"scale_sd": 1, "no_directions": 1}),
    ("points, angles and scales", {}, {"no_directions": 1}),
    ("and the directions of the room: as it is", {}, {}),
    ("as it is, grey images", {}, {"grey": 1}),
    ("as it is, 250 samples instead of 1000", {}, {"samples": 250}),
    ("as it is, 4000 samples", {}, {"samples": 4000}),
    ("as it is, lists of 32 instead of 16", {"shortlist": 32}, {}),
    ("as it is, SIFT descriptors of the patches", {"descriptor": "sift"}, {}),
    ("as it is, focal length not known", {}, {"find_focal": 1}),
]


def match(features, cameras, options, geometry, seed):
    record = MATCHER.fill("default", options)
    if geometry is not None:
        record.geometry.model = lib.ASJ_GEOMETRY_AUTO
        record.geometry.seed = seed
        for key, value in geometry.items():
            if key == "no_directions":
                for k in (0, 4, 8):  # of one image alone: given, and no use
                    record.geometry.directions[0][k] = 1
            elif key != "grey":
                setattr(record.geometry, key, value)
        for place, matrix in zip(record.geometry.cameras, cameras):
            if not geometry.get("find_focal"):
                place.fx, place.fy, place.cx, place.cy = matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2]
    place = ffi.new("asj_match_result **")
    context = current()
    one, two = (f.described(record, context) for f in features)
    context.call(lib.asj_match_features, one, two, record, place)
    return of_matches.Matches(ffi.gc(place[0], of_matches._free), tuple(features))


def ransac(found, cameras, seed):
    if len(found) < 6:
        return None
    rays = [cv2.undistortPoints(points.astype(np.float64)[:, None], matrix, None)[:, 0]
            for points, matrix in zip((found.xy1, found.xy2), cameras)]
    cv2.setRNGSeed(seed)
    essential, mask = cv2.findEssentialMat(rays[0], rays[1], np.eye(3), cv2.RANSAC, 0.9999, 1.5 / cameras[0][0, 0], 10000)
    if essential is None or essential.shape != (3, 3):
        return None
    _, rotation, translation, _ = cv2.recoverPose(essential, rays[0], rays[1], np.eye(3), mask=mask)
    return rotation, translation[:, 0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pairs", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--only", default="")
    given = parser.parse_args()
    folders = [path.parent for path in sorted(given.pairs.glob("*/truth.json")) if "pose" in json.loads(path.read_text())]
    truths = [json.loads((folder / "truth.json").read_text()) for folder in folders]
    images = [[asj.read_image(folder / f"{k}.png") for k in (1, 2)] for folder in folders]
    features = [[asj.detect(image) for image in both] for both in images]
    in_grey = [[asj.detect(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)) for image in both] for both in images]
    print("| what | AUC 5 / 10 / 20 | poses told, of these beyond 10 degrees | right within 10 px of all matches |")
    print("|---|---|---|---|")
    for name, options, geometry in ROWS:
        if given.only not in name:
            continue
        apart, told, wrong, good, total = [], 0, 0, 0, 0
        for seed in range(1, given.seeds + 1):
            for both, truth in zip(in_grey if geometry and "grey" in geometry else features, truths):
                cameras = [np.array(truth[key]) for key in ("K1", "K2")]
                found = match(both, cameras, options, geometry, seed)
                of_pair = found.geometry
                pose = ransac(found, cameras, seed) if of_pair is None else None
                if of_pair and of_pair.rotation is not None:
                    pose = of_pair.rotation, of_pair.translation
                apart.append(max(errors(*pose, np.array(truth["pose"]))) if pose else 180.0)
                told += pose is not None
                wrong += pose is not None and apart[-1] > 10
                good += count_right(found.xy1, found.xy2, np.array(truth["F"]), 10)
                total += len(found)
        n = given.seeds
        areas = " / ".join(f"{area(apart, limit):.1f}" for limit in (5, 10, 20))
        print(f"| {name} | {areas} | {told / n:g} of {len(folders)}, {wrong / n:g} | {good / n:g} of {total / n:g} |", flush=True)


if __name__ == "__main__":
    sys.exit(main())
