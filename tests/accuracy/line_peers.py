#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""OpenCV's line segment detectors judged as `lines` judges ours: line_peers.py LINES [OPTIONS OF LINES]

LINES: the program tests/accuracy/lines of a build folder, which renders the views and judges. Prints its line for LSD
(createLineSegmentDetector) and EDLines (ximgproc.createEdgeDrawing, detectEdges and detectLines). Needs numpy and OpenCV with its
contributed modules (README.md here: OpenCV 5.0)."""

import pathlib
import subprocess
import sys
import tempfile

import cv2


def by_lsd(image):
    return cv2.createLineSegmentDetector().detect(image)[0]


def by_edlines(image):
    drawing = cv2.ximgproc.createEdgeDrawing()
    drawing.detectEdges(image)
    return drawing.detectLines()


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if not hasattr(cv2, "ximgproc"):
        sys.exit("line_peers.py: OpenCV is without its contributed modules (opencv-contrib-python-headless)")
    for name, detector in (("LSD", by_lsd), ("EDLines", by_edlines)):
        with tempfile.TemporaryDirectory() as folder:
            if subprocess.run([*sys.argv[1:], "--save", folder], stdout=subprocess.DEVNULL).returncode != 0:
                sys.exit("line_peers.py: no views")
            for view in pathlib.Path(folder).glob("*.pgm"):
                found = detector(cv2.imread(str(view), cv2.IMREAD_GRAYSCALE))
                segments = [] if found is None else found.reshape(-1, 4)
                view.with_suffix(".txt").write_text("".join("%.3f %.3f %.3f %.3f\n" % tuple(s) for s in segments))
            judged = subprocess.run([*sys.argv[1:], "--judge", folder], check=True, capture_output=True, text=True).stdout
        print(name, judged.splitlines()[-1].removeprefix("others").strip(), flush=True)


if __name__ == "__main__":
    main()
