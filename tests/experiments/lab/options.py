# SPDX-License-Identifier: BSD-2-Clause
"""What the presets differ in, as asj-cli reports it, so that an option added to the library is in the ablation by itself."""
import json
from dataclasses import dataclass

from . import library


@dataclass(frozen=True)
class Departure:
    """An option in which the default preset departs from the paper's."""
    key: str
    flag: str
    paper: str
    ours: str

    def __str__(self):
        return "%s: %s -> %s" % (self.key, self.paper, self.ours)


def _word(value):
    """A value of JSON as asj-cli takes it."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return ",".join(_word(v) for v in value)
    return "%.12g" % value if isinstance(value, float) else str(value)


# What makes the paper preset slow, first: without it everything else is quick. Without neighbours minimum_support leaves nothing,
# and of the default's two radii no three are in a row.
FIRST = ("refinement", "patches", "shortlist", "neighbours", "isotropic_persistence")


def _departures(ours, paper, shared=()):
    """In the order of the option table, which is that of the pipeline, but for FIRST. shared: keys that the detector has too"""
    found = [Departure(key, "--" + ("match-" if key in shared else "") + key.replace("_", "-"), _word(paper[key]), _word(value))
             for key, value in ours.items() if paper[key] != value]
    return sorted(found, key=lambda d: FIRST.index(d.key) if d.key in FIRST else len(FIRST))


def _detect_options(lib, detector, image):
    with open(lib.detect_file(detector, image)[0]) as file:
        return json.load(file)["options"]


def of_detector(lib, image):
    return _departures(_detect_options(lib, library.DEFAULT, image), _detect_options(lib, library.PAPER, image))


def of_matcher(lib, image1, image2):
    ours, paper = (lib.match(arguments, image1, image2)[0] for arguments in ((), ("--match-preset", "paper")))
    return _departures(ours["options"], paper["options"], set(ours["detect_options"]))


def words(departures, which):
    """Arguments that set these options: which is "paper" or "ours"."""
    return tuple(word for d in departures for word in (d.flag, getattr(d, which)))
