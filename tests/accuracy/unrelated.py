#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Pairs of photographs that have nothing in common: no geometry should be accepted, and nothing matched.

    unrelated.py ASJ_CLI PAIRS [--limit N] [--every K] [--same NAME,NAME] [--whole] [-- OPTIONS OF MATCH]

PAIRS holds folders with 1.png, 2.png and truth.json (K1 and K2, 3 x 3, where the cameras are known). Each image of a folder is
paired with those of the folders after it, but for folders named by --same, which show one scene. Cameras are given where both are
known, unless the options of match name a focal length. Features of every image are made once; with --whole, match gets the
photographs themselves, and looks at them upsampled and stretched by itself. Prints what was accepted or ambiguous, or has matches
where the options of match say --geometry none; exit code 1 when any was accepted.
"""

import argparse
import collections
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile
import time


def camera(folder, which):
    truth = json.loads((folder / "truth.json").read_text())
    matrix = truth.get(f"K{which}")
    return matrix and f"{matrix[0][0]},{matrix[1][1]},{matrix[0][2]},{matrix[1][2]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cli")
    parser.add_argument("pairs", type=pathlib.Path)
    parser.add_argument("--limit", type=int)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--same", default="LePoint2,LePoint3,evd_mag")
    parser.add_argument("--whole", action="store_true")
    words = sys.argv[1:]
    cut = words.index("--") if "--" in words else len(words)
    given = parser.parse_args(words[:cut])
    options = words[cut + 1 :]
    same = set(given.same.split(","))
    folders = sorted(path for path in given.pairs.iterdir() if (path / "2.png").exists())
    images = [(folder, which) for folder in folders for which in (1, 2)]
    chosen = [(a, b) for a, b in itertools.combinations(images, 2) if a[0] != b[0] and not {a[0].name, b[0].name} <= same]
    chosen = chosen[:: given.every][: given.limit]
    if not chosen:
        sys.exit(f"{given.pairs} has no two folders with images of different things")
    ended, counts, begin = collections.Counter(), [], time.monotonic()
    with tempfile.TemporaryDirectory() as place:
        for folder, which in {image for pair in chosen for image in pair if not given.whole}:
            subprocess.run([given.cli, "detect", "-q", "--for", "matching", "-o", f"{place}/{folder.name}-{which}.asjf",
                            str(folder / f"{which}.png")], check=True)
        for pair in chosen:
            if given.whole:
                files = [str(folder / f"{which}.png") for folder, which in pair]
            else:
                files = [f"{place}/{folder.name}-{which}.asjf" for folder, which in pair]
            cameras = [camera(*image) for image in pair]
            known = all(cameras) and not {"--focal", "none"} & set(options)
            with_cameras = [f"--camera{k + 1}={cameras[k]}" for k in range(2)] if known else []
            out = subprocess.run([given.cli, "match", "-q", "-f", "json", "--geometry", "auto", *with_cameras, *options, *files],
                                 check=True, capture_output=True, text=True)
            found = json.loads(out.stdout)
            status = found.get("geometry_status", "not asked")
            ended[status] += 1
            count = len(found["matches"])
            if status in ("accepted", "ambiguous") or (status == "not asked" and count):
                name = " ".join(f"{folder.name}/{which}" for folder, which in pair)
                geometry = found.get("geometry") or {}
                print(f"{status}: {name} {count} matches {geometry.get('log10_nfa', '')}", flush=True)
            counts.append(count)
    matched = sum(count > 0 for count in counts)
    print(f"{len(chosen)} pairs: {dict(ended)}; {matched} with matches, {sum(counts)} in all; {time.monotonic() - begin:.0f} s")
    return 1 if ended["accepted"] else 0


if __name__ == "__main__":
    sys.exit(main())
