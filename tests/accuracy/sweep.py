#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""The table of sensitivity.md here: every number of the matcher a fifth lower and a fifth higher, the others as they are.

    sweep.py [--last SEED] BUILD PAIRS

BUILD is a build folder of the library, PAIRS a folder of pairs in the format of tests/experiments/README.md. Rooms: the random
rooms 1 to SEED (24) of `match_room --sweep`, all matches together. Pairs: `match_pairs`, average accuracy of those that have
truth for points. Needs NumPy.
"""
import argparse
import csv
import os
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "experiments"))

from lab import pairs, score  # noqa: E402


def judge_pairs(build, folder, known, change):
    """Right matches of all pairs, and the mean of their accuracies in per cent."""
    right, shares = 0, []
    with tempfile.TemporaryDirectory() as out:
        command = [os.path.join(build, "tests", "accuracy", "match_pairs"), "--threads", "1"]
        subprocess.run(command + (["--match", change] if change else []) + [folder, out], check=True, stdout=subprocess.DEVNULL)
        for pair in known:
            with open(os.path.join(out, pair.name + ".csv"), newline="") as file:
                rows = [[float(r[k]) for k in ("x1", "y1", "x2", "y2")] for r in csv.DictReader(file)]
            points = np.array(rows).reshape(-1, 4)
            verdict = score.Judge(None, pair).points(points[:, :2], points[:, 2:])
            right += int(verdict.sum())
            shares.append(100 * verdict.mean() if len(verdict) else 0)
    return "%d, %.1f %%" % (right, np.mean(shares))


def judge_rooms(build, last):
    """("key", "value") or None as they are -> right matches and accuracy."""
    command = [os.path.join(build, "tests", "accuracy", "match_room"), "--sweep", "--last", str(last), "--threads", "1"]
    lines = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()[1:]
    out = {}
    for line in lines:
        words = line.split()
        name, counts = (None, words[3:]) if words[:3] == ["as", "they", "are"] else (tuple(words[:2]), words[2:])
        out[name] = "%s, %s %%" % (counts[0], counts[3])
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--last", type=int, default=24)
    parser.add_argument("build")
    parser.add_argument("pairs")
    a = parser.parse_args()
    rooms = judge_rooms(a.build, a.last)
    known = [p for p in pairs.read_folder(a.pairs) if p.kind != pairs.LINES]
    print("As they are: rooms %s; pairs %s\n" % (rooms.pop(None), judge_pairs(a.build, a.pairs, known, None)))
    print("| option | rooms, lower | rooms, higher | real, lower | real, higher |\n| --- | --- | --- | --- | --- |")
    keys = list(dict.fromkeys(key for key, _ in rooms))
    for key in keys:
        values = [v for k, v in rooms if k == key]
        if len(values) < 2:  # switched off by its lowest value
            continue
        first = ["%s: %s" % (v, rooms[key, v]) for v in values]
        second = ["%s: %s" % (v, judge_pairs(a.build, a.pairs, known, "%s=%s" % (key, v))) for v in values]
        print("| `%s` | %s |" % (key, " | ".join(first + second)), flush=True)


if __name__ == "__main__":
    main()
