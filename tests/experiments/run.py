#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Repeats the experiments of the paper's section "Experimental Analysis" and writes a report.

    python3 tests/experiments/run.py [--pairs DIR] [--out DIR] [--only PART,...] [--quick]

Builds the library, makes a virtual environment for Python's packages, runs the parts, and writes OUT/report.html (one page that
needs nothing else) and OUT/report.json (the numbers). tests/experiments/README.md says how to add a pair, a peer, a detector.
"""
import argparse
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, HERE)

PARTS = ("noise", "repeatability", "scale", "points", "lines", "agreement", "figures", "ablation")
SKIPPED = 77  # what meson takes for a skipped test


def named(text):
    """NAME=PATH"""
    name, equals, path = text.partition("=")
    if not name or not equals or not path:
        raise argparse.ArgumentTypeError("'%s' is not NAME=PATH" % text)
    return name, os.path.abspath(path)


def parts(text):
    wanted = text.split(",")
    for name in wanted:
        if name not in PARTS:
            raise argparse.ArgumentTypeError("'%s' is none of %s" % (name, ", ".join(PARTS)))
    return [name for name in PARTS if name in wanted]


def parse(arguments):
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--pairs", metavar="DIR", action="append", type=os.path.abspath, default=[],
                   help="folder of pairs: DIR/NAME/1.png, 2.png, truth.json; without it only rendered pairs are used")
    p.add_argument("--out", metavar="DIR", type=os.path.abspath, default=os.path.join(ROOT, "out", "experiments"),
                   help="folder of the report (%(default)s); DIR/work is made anew")
    p.add_argument("--only", metavar="PART,...", type=parts, default=list(PARTS), help="some of " + ", ".join(PARTS))
    p.add_argument("--quick", action="store_true", help="a cut of about a minute: few images, no slow method")
    p.add_argument("--check", action="store_true", help="only check the measures, against those of tests/accuracy too")
    p.add_argument("--full", action="store_true", help="no time budgets, 1000 images wherever the paper has them")
    p.add_argument("--keep", action="store_true", help="keep OUT/work: pictures, junctions and matches")
    p.add_argument("--build", metavar="DIR", type=os.path.abspath,
                   help="a build folder of meson's that is up to date; otherwise one is made")
    p.add_argument("--minutes", metavar="N", type=float, default=17, help="time for all parts together (%(default)s)")
    p.add_argument("--processes", metavar="N", type=int, default=2, help="jobs at a time (%(default)s)")
    p.add_argument("--detector", metavar="NAME=DIR", action="append", type=named, default=[],
                   help="another detector's junctions, .asj files: see README.md")
    p.add_argument("--line-matcher", metavar="NAME=DIR", action="append", type=named, default=[],
                   help="another matcher's line segments, DIR/PAIR.csv: see README.md")
    p.add_argument("--write-images", metavar="DIR", type=os.path.abspath,
                   help="only write every image that detectors are asked to work on")
    p.add_argument("--system-python", action="store_true", help="take Python's packages as they are, make no environment")
    return p.parse_args(arguments)


def main():
    arguments = parse(sys.argv[1:])
    from lab import environment
    try:
        environment.enter(ROOT, HERE, arguments.system_python)
        build = arguments.build or environment.build(ROOT)
    except environment.Unavailable as reason:
        print("SKIPPED: %s" % reason)
        return SKIPPED
    from lab import session
    return session.run(arguments, build)


if __name__ == "__main__":
    sys.exit(main())
