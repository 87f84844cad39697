# SPDX-License-Identifier: BSD-2-Clause
"""The library's results, through asj-cli and the C programs beside the tests."""
import json
import os
import signal
import subprocess
import tempfile
import threading
from dataclasses import dataclass

from . import junctions

PATHS = {"asj-cli": "cli/asj-cli", "noise": "tests/accuracy/noise", "accuracy": "tests/accuracy/accuracy",
         "repeatability": "tests/accuracy/repeatability", "match_room": "tests/accuracy/match_room",
         "sample-room": "tests/synth/sample-room",
         "isotropic_junctions": "tests/experiments/isotropic_junctions", "room_judge": "tests/experiments/room_judge"}


ALONE = ("--quiet", "--backend", "cpu", "--threads", "1")  # other jobs run beside it, and processor time is what is reported


class Failure(Exception):
    """A program failed or took longer than it may."""


@dataclass(frozen=True)
class Detector:
    """A name for the report and arguments of asj-cli detect; isotropic: the junctions before their branches are followed."""
    name: str
    arguments: tuple = ()
    isotropic: bool = False


DEFAULT = Detector("default preset")
PAPER = Detector("paper preset", ("--preset", "paper"))
MATCHING = Detector("matching", ("--preset", "match"))
ISOTROPIC_DEFAULT = Detector("isotropic stage, default preset", (), True)
ISOTROPIC_PAPER = Detector("isotropic stage, paper preset", ("--preset", "paper"), True)


def isotropic_up_to(bound):
    """The isotropic stage of the paper preset with radii up to `bound` px."""
    return Detector("isotropic stage, paper preset, radii to %d px" % bound,
                    ("--preset", "paper", "isotropic_radii=3-%d" % bound), True)



def _wait(process, limit):
    """(exit code, seconds of processor time: what runs beside it does not count); kills it after `limit` seconds"""
    timer = threading.Timer(limit, process.kill) if limit is not None else None
    if timer:
        timer.start()
    _, status, usage = os.wait4(process.pid, 0)
    if timer:
        timer.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, usage.ru_utime + usage.ru_stime


class Library:
    """Runs the programs of a build, one thread each. What was computed once in a run is not computed again."""

    def __init__(self, build, work):
        self.build, self.work = build, work
        self.lock, self.results, self.serial = threading.Lock(), {}, 0
        self.spent = threading.local()   # .seconds: processor time of the programs that this thread ran
        os.makedirs(work, exist_ok=True)

    def programs_seconds(self):
        """Processor time of the programs that the calling thread has run so far."""
        return getattr(self.spent, "seconds", 0.0)

    def run(self, program, arguments, limit=None, text=""):
        """(standard output, seconds of processor time)"""
        command = [os.path.join(self.build, PATHS[program])] + [str(a) for a in arguments]
        with tempfile.TemporaryFile("w+") as given, tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as errors:
            given.write(text)
            given.seek(0)
            try:
                code, seconds = _wait(subprocess.Popen(command, stdin=given, stdout=out, stderr=errors), limit)
            except OSError as error:
                raise Failure("%s: %s" % (program, error.strerror)) from error
            self.spent.seconds = self.programs_seconds() + seconds
            for file in (out, errors):
                file.seek(0)
            if code == -signal.SIGKILL and limit is not None:
                raise Failure("%s: stopped after %.0f s" % (program, limit))
            if code != 0:
                raise Failure("%s: %s" % (program, (errors.read() or "exit code %d" % code).strip()))
            return out.read(), seconds

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
        """Path of a JSON file with the junctions of an image, and the seconds of processor time that the program took."""
        def compute():
            path = self._file(".json")
            if detector.isotropic:
                return path, self.run("isotropic_junctions", detector.arguments + (image, path), limit)[1]
            words = ("detect",) + ALONE + detector.arguments + ("-o", path, image)
            return path, self.run("asj-cli", words, limit)[1]
        return self._once((detector, image), compute)

    def detect(self, detector, image, limit=None):
        path = self.detect_file(detector, image, limit)[0]
        return self._once(("junctions", path), lambda: junctions.read_json(path))

    def match(self, arguments, image1, image2, limit=None):
        """What asj-cli match writes as JSON, line segments included, and the seconds of processor time."""
        def compute():
            path = self._file(".match.json")
            words = ("match",) + ALONE + tuple(arguments) + ("--lines", "-o", path, image1, image2)
            seconds = self.run("asj-cli", words, limit)[1]
            with open(path) as file:
                return json.load(file), seconds
        return self._once(("match", tuple(arguments), image1, image2), compute)

    def version(self):
        return self.run("asj-cli", ["--version"])[0].strip()
