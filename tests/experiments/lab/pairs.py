# SPDX-License-Identifier: BSD-2-Clause
"""Pairs of pictures with their truth: folders in the format of README.md, and rooms that the library renders."""
import json
import os
from dataclasses import dataclass, field

import numpy as np

HOMOGRAPHY, FUNDAMENTAL, LINES, ROOM = "homography", "fundamental", "lines", "room"


@dataclass
class Pair:
    name: str
    kind: str                    # what the truth is
    image1: str
    image2: str
    matrix: np.ndarray = None    # homography: image 1 to image 2; fundamental: x2' F x1 = 0
    side: float = 1.0            # homography: sign of the third coordinate where points are visible
    labels: dict = None          # lines that people labelled: segments1, segments2, matches
    room: tuple = ()             # arguments of sample-room and room_judge
    detections: dict = field(default_factory=dict)   # name of another detector -> its files for image 1 and 2

    @property
    def key(self):
        """The name as part of a file's name."""
        return self.name.replace(":", "").replace(" ", "-")


def _detections(folder):
    """1.NAME.asj and 2.NAME.asj beside the pictures"""
    names = [n[2:-4] for n in sorted(os.listdir(folder)) if n.startswith("1.") and n.endswith(".asj") and len(n) > 6]
    files = {n: tuple(os.path.join(folder, "%d.%s.asj" % (i, n)) for i in (1, 2)) for n in names}
    return {n: f for n, f in files.items() if os.path.exists(f[1])}


def read_folder(folder):
    """Every FOLDER/NAME with 1.png, 2.png and truth.json, in order of name."""
    out = []
    for name in sorted(os.listdir(folder)):
        place = os.path.join(folder, name)
        truth_file = os.path.join(place, "truth.json")
        if not os.path.exists(truth_file):
            continue
        with open(truth_file) as file:
            truth = json.load(file)
        pair = Pair(name, truth["kind"], os.path.join(place, "1.png"), os.path.join(place, "2.png"),
                    labels=truth.get("lines"), detections=_detections(place))
        if pair.kind == HOMOGRAPHY:
            pair.matrix = np.array(truth["H"], float)
            side = truth.get("wref")
            pair.side = np.sign(pair.matrix[2, 2] if side is None else side)
        elif pair.kind == FUNDAMENTAL:
            pair.matrix = np.array(truth["F"], float)
        elif pair.kind != LINES:
            raise ValueError("%s: kind %s is none of homography, fundamental, lines" % (truth_file, pair.kind))
        out.append(pair)
    return out


# name, arguments: what each is for stands in the name; seeds modulo 4 are the kinds of tests/synth/random_room.c
ROOMS = (
    ("room: parallax", ("--first", "0", "--second", "1")),
    ("room: far apart", ("--first", "0", "--second", "4")),
    ("room: low texture", ("--room", "4")),
    ("room: repeated texture", ("--room", "5")),
    ("room: occlusion", ("--room", "6")),
    ("room: pictures", ("--room", "7")),
)


def check_names(chosen):
    """Results go by the names of pairs, pictures by their keys."""
    keys = [p.key for p in chosen]
    twice = sorted({k for k in keys if keys.count(k) > 1})
    if twice:
        raise ValueError("several pairs are called %s" % ", ".join(twice))


def render(library, folder, quick):
    """The rendered pairs, written into `folder` by sample-room."""
    out = []
    for name, arguments in ROOMS[:2] if quick else ROOMS:
        if quick:
            arguments += ("--width", "526", "--height", "390")
        pair = Pair(name, ROOM, "", "", room=arguments)
        place = os.path.join(folder, pair.key)
        os.makedirs(place)
        library.run("sample-room", arguments + (place,))
        pair.image1, pair.image2 = os.path.join(place, "1.png"), os.path.join(place, "2.png")
        out.append(pair)
    return out
