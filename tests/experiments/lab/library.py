# SPDX-License-Identifier: BSD-2-Clause
"""The library's results, through asj-cli and the C programs beside the tests."""
import json
import os
import subprocess
import threading
import time
from dataclasses import dataclass

from . import junctions

PATHS = {"asj-cli": "cli/asj-cli", "noise": "tests/accuracy/noise", "accuracy": "tests/accuracy/accuracy",
         "repeatability": "tests/accuracy/repeatability", "match_room": "tests/accuracy/match_room",
         "sample-room": "tests/synth/sample-room",
         "isotropic_junctions": "tests/experiments/isotropic_junctions", "room_judge": "tests/experiments/room_judge"}


class Failure(Exception):
    """A program failed or took longer than it may."""


@dataclass(frozen=True)
class Detector:
    """A name for the report and arguments of asj-cli detect; isotropic: the junctions before their branches are followed."""
    name: str
    arguments: tuple = ()
    isotropic: bool = False


DEFAULT = Detector("default")
PAPER = Detector("paper", ("--preset", "paper"))
ISOTROPIC_DEFAULT = Detector("isotropic, default", (), True)
ISOTROPIC_PAPER = Detector("isotropic, paper", ("--preset", "paper"), True)


class Library:
    """Runs the programs of a build, one thread each. What was computed once in a run is not computed again."""

    def __init__(self, build, work):
        self.build, self.work = build, work
        self.lock, self.results, self.serial = threading.Lock(), {}, 0
        os.makedirs(work, exist_ok=True)

    def run(self, program, arguments, limit=None, text=None):
        """(standard output, seconds)"""
        command = [os.path.join(self.build, PATHS[program])] + [str(a) for a in arguments]
        start = time.monotonic()
        try:
            done = subprocess.run(command, input=text, capture_output=True, text=True, timeout=limit)
        except subprocess.TimeoutExpired as late:
            raise Failure("%s: stopped after %.0f s" % (program, limit)) from late
        except OSError as error:
            raise Failure("%s: %s" % (program, error.strerror)) from error
        if done.returncode != 0:
            raise Failure("%s: %s" % (program, (done.stderr or "exit code %d" % done.returncode).strip()))
        return done.stdout, time.monotonic() - start

    def _file(self, ending):
        with self.lock:
            self.serial += 1
            return os.path.join(self.work, "%05d%s" % (self.serial, ending))

    def _once(self, key, compute):
        with self.lock:
            entry = self.results.setdefault(key, [threading.Lock(), None])
        with entry[0]:
            if entry[1] is None:
                entry[1] = compute()
            return entry[1]

    def detect_file(self, detector, image, limit=None):
        """Path of a JSON file with the junctions of an image, and the milliseconds that the detection took."""
        def compute():
            path = self._file(".json")
            if detector.isotropic:
                words = [a for a in detector.arguments]
                self.run("isotropic_junctions", words + [image, path], limit)
            else:
                self.run("asj-cli", ("detect", "--quiet", "--threads", 1) + detector.arguments + ("-o", path, image), limit)
            with open(path) as file:
                return path, json.load(file)["timing"]["total_ms"]
        return self._once((detector, image), compute)

    def detect(self, detector, image, limit=None):
        return junctions.read_json(self.detect_file(detector, image, limit)[0])

    def match(self, arguments, image1, image2, limit=None):
        """What asj-cli match writes as JSON, line segments included, and the seconds that the program took."""
        def compute():
            path = self._file(".match.json")
            words = ("match", "--quiet", "--threads", 1) + tuple(arguments) + ("--lines", "-o", path, image1, image2)
            seconds = self.run("asj-cli", words, limit)[1]
            with open(path) as file:
                return json.load(file), seconds
        return self._once(("match", tuple(arguments), image1, image2), compute)

    def version(self):
        return self.run("asj-cli", ["--version"])[0].strip()
