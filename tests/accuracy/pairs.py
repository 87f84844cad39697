#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Which matches of pairs of photographs are right: pairs.py ASJ_CLI PAIRS [--cameras [--crops]] [-- OPTIONS OF MATCH]

PAIRS: folders in the format of tests/experiments/README.md, whose lab/score.py says what is right. For each pair: key points,
junctions (key points both of whose branches point the same way), line segments (the two branches of each match; with --lines among
the options its lines), right of all. Below them the sums, and the mean of the pairs' shares.

--cameras, with --geometry among the options: only pairs whose truth.json has F, K1, K2 and pose, with their cameras; also the error
of the pose (the larger one of rotation and direction of translation, degrees; 180 where there is none), the area under recall over
error, and how many matches are within 10 px of both epipolar lines. --crops: each pair six times, as it is and without its first
columns and rows, up to five: how much is luck of the pixels. Exit code 1 when there is no such pair, or match fails. Needs numpy,
and OpenCV with --crops.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "experiments"))

from lab import pairs, score  # noqa: E402
from pose_judge import area, camera_options, count_right, errors  # noqa: E402

LOOSE = 10.0  # px: poses of video frames are known to a few degrees
NO_POSE = 180.0
FAR_OUT = 10.0  # degrees
CROPS = ((1, 0), (0, 1), (1, 1), (2, 3), (4, 5))  # columns and rows
MEASURES = ("key points", "junctions", "segments")


def columns(rows, *names):
    """Points: n x 2 for each pair of names"""
    return [np.array([[row[x], row[y]] for row in rows], float).reshape(-1, 2) for x, y in names]


def judge(pair, found, lines):
    """measure -> verdicts, 1 right, 0 wrong"""
    judge_of = score.Judge(None, pair)
    p1, a1, b1, p2, a2, b2 = columns(found["matches"], *((s + "x" + k, s + "y" + k) for k in "12" for s in ("", "a", "b")))
    branches = [(p1, a1, p2, a2), (p1, b1, p2, b2)]
    out = {}
    if pair.kind != pairs.LINES:
        out["key points"] = judge_of.points(p1, p2)
        out["junctions"] = out["key points"] & judge_of.directions(*branches[0]) & judge_of.directions(*branches[1])
    if lines:
        start1, end1, start2, end2 = columns(found["lines"], ("x1", "y1"), ("ex1", "ey1"), ("x2", "y2"), ("ex2", "ey2"))
        out["segments"] = judge_of.segments(start1, end1, start2, end2, any_order=True)
    else:
        out["segments"] = np.concatenate([judge_of.segments(*branch) for branch in branches])
    return {name: verdict[~np.isnan(verdict.astype(float))].astype(bool) for name, verdict in out.items()}


def crop(folder, columns_rows, place):
    """The pairs with cameras without their first columns and rows, in the folder `place`"""
    import cv2

    x, y = columns_rows
    moved = np.array([[1, 0, x], [0, 1, y], [0, 0, 1]])
    for pair in pairs.read_folder(folder):
        truth = json.loads((folder / pair.name / "truth.json").read_text())
        if not has_cameras(pair, truth):
            continue
        (place / pair.name).mkdir()
        for side, path in (("1", pair.image1), ("2", pair.image2)):
            cv2.imwrite(str(place / pair.name / f"{side}.png"), cv2.imread(str(path), cv2.IMREAD_UNCHANGED)[y:, x:])
            truth["K" + side] = (np.linalg.inv(moved) @ np.reshape(truth["K" + side], (3, 3))).tolist()
        truth["F"] = (moved.T @ np.reshape(truth["F"], (3, 3)) @ moved).tolist()
        (place / pair.name / "truth.json").write_text(json.dumps(truth))


def has_cameras(pair, truth):
    return pair.kind == pairs.FUNDAMENTAL and all(truth.get(key) for key in ("K1", "K2", "pose"))


def match(cli, pair, options):
    with tempfile.TemporaryDirectory() as place:
        out = pathlib.Path(place) / "matches.json"
        ended = subprocess.run([cli, "match", "-q", *options, "--format", "json", "-o", str(out), pair.image1, pair.image2])
        if ended.returncode != 0:
            sys.exit(f"pairs.py: {pair.name}: match failed")
        return json.loads(out.read_text())


def pose_error(found, truth):
    geometry = found.get("geometry") or {}
    if not geometry.get("rotation"):
        return NO_POSE
    return max(errors(np.reshape(geometry["rotation"], (3, 3)), np.array(geometry["translation"]), np.array(truth["pose"])))


def print_poses(poses):
    error, loose, matches = map(np.array, zip(*poses))
    print("poses: AUC at 5, 10, 20 degrees", *(f"{area(error, limit):.1f}" for limit in (5, 10, 20)),
          f"told {(error < NO_POSE).sum()} of {len(error)}, beyond 10 degrees {((error > FAR_OUT) & (error < NO_POSE)).sum()};",
          f"matches within 10 px of their lines {loose.sum()} of {matches.sum()}")


def print_sums(table):
    for name in MEASURES:
        verdicts = [row[name] for row in table if name in row]
        some = [v.mean() for v in verdicts if len(v)]
        if some:
            print(f"{name}: {sum(v.sum() for v in verdicts)} of {sum(map(len, verdicts))} right,",
                  f"average {100 * np.mean(some):.1f} % of {len(some)} pairs")


def judge_all(given, options, folder):
    table, poses = [], []
    for pair in pairs.read_folder(folder):
        truth = json.loads((folder / pair.name / "truth.json").read_text())
        if given.cameras and not has_cameras(pair, truth):
            continue
        found = match(given.cli, pair, [*options, *(camera_options(truth) if given.cameras else [])])
        table.append(judge(pair, found, "--lines" in options))
        told = [f"{name} {v.sum()} / {len(v)}" for name, v in table[-1].items()]
        if given.cameras:
            loose = count_right(*columns(found["matches"], ("x1", "y1"), ("x2", "y2")), pair.matrix, LOOSE)
            poses.append((pose_error(found, truth), loose, len(found["matches"])))
            told.append(f"pose {poses[-1][0]:.1f}")
        print(f"{pair.name}: {', '.join(told)}", flush=True)
    return table, poses


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cli")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--cameras", action="store_true")
    parser.add_argument("--crops", action="store_true")
    words = sys.argv[1:]
    cut = words.index("--") if "--" in words else len(words)
    given, options = parser.parse_args(words[:cut]), words[cut + 1 :]
    if not given.folder.is_dir():
        parser.error(f"{given.folder} is no folder")
    if given.crops and not given.cameras:
        parser.error("--crops is for --cameras")
    table, poses = judge_all(given, options, given.folder)
    for which in CROPS if given.crops else ():
        with tempfile.TemporaryDirectory() as place:
            crop(given.folder, which, pathlib.Path(place))
            print("without", *which, "columns and rows:")
            more = judge_all(given, options, pathlib.Path(place))
        table += more[0]
        poses += more[1]
    if not table:
        sys.exit(f"{given.folder} has no such pairs")
    print_sums(table)
    if poses:
        print_poses(poses)


if __name__ == "__main__":
    main()
