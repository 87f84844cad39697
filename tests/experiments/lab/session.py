# SPDX-License-Identifier: BSD-2-Clause
"""One run of the command: what the parts share, and the parts in order."""
import importlib
import os
import platform
import shutil
import sys
import time

import cv2

from . import checks, images, jobs, library, pairs, report

# The parts' shares of the time; what one leaves over goes to those after it.
SHARES = {"noise": 200, "repeatability": 200, "scale": 15, "points": 520, "lines": 25, "agreement": 25, "figures": 20,
          "ablation": 600}


class Session:
    def __init__(self, arguments, build):
        self.start = time.monotonic()
        self.arguments, self.quick, self.full = arguments, arguments.quick, arguments.full
        self.out = arguments.out
        self.work = os.path.join(self.out, "work")
        shutil.rmtree(self.work, ignore_errors=True)
        self.library = library.Library(build, os.path.join(self.work, "junctions"))
        self.shared = {}   # what a part leaves for later ones
        self.real = [p for folder in arguments.pairs for p in pairs.read_folder(folder)]
        self.rendered = pairs.render(self.library, os.path.join(self.work, "rendered"), self.quick)
        if self.quick:
            self.real = self.real[:1]
        self.pairs = self.real + self.rendered
        pairs.check_names(self.pairs)

    def jobs(self, name):
        """The jobs of a part, with its share of the time that is left."""
        left = 60 * self.arguments.minutes - (time.monotonic() - self.start)
        wanted = self.arguments.only[self.arguments.only.index(name):]
        budget = max(left, 0) * SHARES[name] / sum(SHARES[n] for n in wanted)
        return jobs.Jobs(name, self.arguments.processes, None if self.full else budget,
                         self.library.programs_seconds)

    def view(self, pair, index):
        """Image 1 or 2 of a pair, KEY-1 or KEY-2, in grey."""
        folder = self.arguments.write_images or os.path.join(self.work, "images")
        return images.Picture("%s-%d" % (pair.key, index), (pair.image1, pair.image2)[index - 1], folder)

    def pictures(self):
        """First views: of the photographs, where there are any, else of the rendered rooms."""
        return [self.view(p, 1) for p in self.real or self.rendered]

    def write_images(self):
        """What other detectors have to work on for --detector."""
        for pair in self.pairs:
            for index in (1, 2):
                self.view(pair, index).original()
        for picture in self.pictures():
            for kind in ["zoom"] + list(images.CHANGES):
                picture.copies(kind)

    def about(self, seconds):
        real = ", ".join(p.name for p in self.real) or "none given: rendered pairs alone (--pairs DIR names a folder of pairs)"
        return {"library": self.library.version().splitlines()[0], "pairs of photographs": real,
                "rendered pairs": ", ".join(p.name for p in self.rendered),
                "cut": "quick run: numbers mean little" if self.quick else "full run" if self.full else "default run",
                "machine": "%s, %d processors, %d jobs at a time of one thread each"
                           % (platform.machine(), os.cpu_count(), self.arguments.processes),
                "OpenCV": cv2.__version__, "seconds": round(seconds)}


def _processor_seconds():
    """Of this process and of the programs that it ran."""
    t = os.times()
    return t.user + t.system + t.children_user + t.children_system


def run(arguments, build):
    cv2.setNumThreads(1)
    start = time.monotonic()
    session, done = Session(arguments, build), {}
    if arguments.write_images:
        session.write_images()
        return 0
    if arguments.check or arguments.quick:
        checks.run(session)
    for name in () if arguments.check else arguments.only:
        begin, spent = time.monotonic(), _processor_seconds()
        part = importlib.import_module("lab.parts." + name).run(session)
        part.seconds = time.monotonic() - begin
        part.processor = _processor_seconds() - spent
        done[name] = part
        page = report.write(session.out, session.about(time.monotonic() - start), done)
    if not arguments.keep:
        shutil.rmtree(session.work, ignore_errors=True)
    if done:
        print("%s (%.0f s)" % (page, time.monotonic() - start))
    for name, part in done.items():
        for line in part.cut:
            print("left out: %s: %s" % (name, line), file=sys.stderr)
    return 0
