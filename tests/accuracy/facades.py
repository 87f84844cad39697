#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Two views of a facade of equal windows: a geometry shifted by a window is as exact as the right one, and should not be accepted.

    facades.py ASJ_CLI [--seeds N] [--stains SD,SD,..] [-- OPTIONS OF MATCH]

Renders a wall of 30 x 18 windows, 100 x 110 px each, with stains between them (grey levels, standard deviation; 0: nothing tells
one window from another), in 640 x 480 px from two cameras of focal length 600 px, four pairs of stands for each seed, blur .8 px,
noise 2. The options of match default to --geometry auto --focal 600. Prints for each of the stains how many pairs are ambiguous or
chance, and how many are accepted with most probable matches right (within 5 px) and wrong; exit code 1 when any is accepted wrong.
"""

import argparse
import collections
import concurrent.futures
import json
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

PITCH_X, PITCH_Y, COLUMNS, ROWS = 100, 110, 30, 18
FOCAL, WIDTH, HEIGHT, STAIN = 600, 640, 480, 40
STANDS = ((20, -25, 2), (0, 5, 1), (30, 10, 3), (-35, -20, 1))  # degrees to either side, distance in windows


def paint(seed, stains):
    wall = np.full((ROWS * PITCH_Y, COLUMNS * PITCH_X), 170, np.float32)
    for top in range(22, ROWS * PITCH_Y, PITCH_Y):
        for left in range(20, COLUMNS * PITCH_X, PITCH_X):
            cv2.rectangle(wall, (left, top), (left + 60, top + 66), 235, -1)
            cv2.rectangle(wall, (left + 6, top + 6), (left + 54, top + 60), 70, -1)
            cv2.line(wall, (left + 30, top + 6), (left + 30, top + 60), 235, 4)
            cv2.line(wall, (left + 6, top + 22), (left + 54, top + 22), 235, 4)
    random = np.random.default_rng(seed)
    coarse = random.normal(0, 1, (ROWS * PITCH_Y // STAIN, COLUMNS * PITCH_X // STAIN)).astype(np.float32)
    return wall + stains * cv2.resize(coarse, wall.shape[::-1], interpolation=cv2.INTER_CUBIC), random


def camera(yaw, pitch, roll, x, y, distance):
    """From the plane of the wall to the picture."""
    turns = []
    for angle, (i, k) in ((yaw, (2, 0)), (pitch, (1, 2)), (roll, (0, 1))):
        turn = np.eye(3)
        turn[i, i] = turn[k, k] = np.cos(np.radians(angle))
        turn[k, i], turn[i, k] = np.sin(np.radians(angle)), -np.sin(np.radians(angle))
        turns.append(turn)
    rotation = turns[2] @ turns[1] @ turns[0]
    inner = np.array([[FOCAL, 0, (WIDTH - 1) / 2], [0, FOCAL, (HEIGHT - 1) / 2], [0, 0, 1]])
    return inner @ np.column_stack([rotation[:, 0], rotation[:, 1], -rotation @ np.array([x, y, -distance])])


def judge(path, onto_second):
    found = json.loads(path.read_text())
    if found["geometry_status"] != "accepted":
        return found["geometry_status"]
    sure = [m for m in found["matches"] if m["probability"] > 0.5]
    places = np.array([[m["x1"], m["y1"], 1, m["x2"], m["y2"]] for m in sure]).reshape(-1, 5)
    there = places[:, :3] @ onto_second.T
    far = np.hypot(*(there[:, :2] / there[:, 2:] - places[:, 3:]).T) > 5
    return "accepted wrong" if np.count_nonzero(far) > len(far) / 2 else "accepted right"


def run(cli, options, place, seed, stains, stand):
    first, second, apart = stand
    wall, random = paint(seed, stains)
    middle = COLUMNS * PITCH_X / 2
    cameras = [
        camera(first, 3, 0, middle - apart * PITCH_X / 2, ROWS * PITCH_Y / 2, 750),
        camera(second, -2, 3, middle + apart * PITCH_X / 2, ROWS * PITCH_Y / 2 + PITCH_Y * 0.3, 800),
    ]
    stem = f"{place}/{seed}_{stains}_{first}"
    for which, matrix in enumerate(cameras):
        view = cv2.warpPerspective(wall, matrix, (WIDTH, HEIGHT), borderMode=cv2.BORDER_REPLICATE)
        view = cv2.GaussianBlur(view, (0, 0), 0.8) + random.normal(0, 2, view.shape)
        cv2.imwrite(f"{stem}_{which + 1}.png", np.clip(view, 0, 255).astype(np.uint8))
    command = [cli, "match", "-q", "--threads", "1", *options, "-o", f"{stem}.json", f"{stem}_1.png", f"{stem}_2.png"]
    subprocess.run(command, check=True)
    return judge(pathlib.Path(f"{stem}.json"), cameras[1] @ np.linalg.inv(cameras[0]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cli")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--stains", default="0,6,15")
    words = sys.argv[1:]
    cut = words.index("--") if "--" in words else len(words)
    given = parser.parse_args(words[:cut])
    options = words[cut + 1 :] or ["--geometry", "auto", "--focal", str(FOCAL)]
    wrong = 0
    with tempfile.TemporaryDirectory() as place, concurrent.futures.ThreadPoolExecutor(2) as pool:
        for stains in map(float, given.stains.split(",")):
            asked = [(seed, stand) for seed in range(1, given.seeds + 1) for stand in STANDS]
            found = pool.map(lambda one: run(given.cli, options, place, one[0], stains, one[1]), asked)
            counts = collections.Counter(found)
            wrong += counts["accepted wrong"]
            print(f"stains {stains:g}:", ", ".join(f"{count} {name}" for name, count in sorted(counts.items())), flush=True)
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
