# SPDX-License-Identifier: BSD-2-Clause
"""Features and matches as HDF5 files in the layout of hloc (hierarchical localization).

features: a group an image with `keypoints` (N, 2) float32 in pixels of the file (centre of the first pixel (0, 0); orientation.py), the
junctions, each where all its matches together put it (locations.py), `scores` (N,), `image_size` (width, height). matches: a group for
each pair, names with - for /, with `matches0` (N,) int32, -1 = none, and `matching_scores0`.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from .. import __version__
from ..output import whole_file
from . import locations, orientation
from .store import Store


_MARK = "asj"  # attribute of a file that was written here: the version
_STORE = "asj_store"  # another one: the identity of the store that the file was written from


def written_from(path: Path) -> str | None:
    """The identity of the store that write_features() or write_matches() wrote the file from; None where something else has."""
    import h5py

    try:
        with h5py.File(path) as file:
            return str(file.attrs[_STORE]) if _STORE in file.attrs else None
    except OSError:
        return None


def check_names(names: Iterable[str]) -> None:
    """Raises ValueError when two images would be one group of the matches."""
    seen: dict[str, str] = {}
    for name in names:
        other = seen.setdefault(name.replace("/", "-"), name)
        if other != name:
            raise ValueError(f"--hdf5: {other} and {name} would be one group, with - for /")


def write_features(store: Store, path: Path) -> None:
    """The key points of all images."""
    import h5py

    with whole_file(path) as temporary, h5py.File(temporary, "w") as file:
        places = locations.of_store(store)
        file.attrs[_MARK], file.attrs[_STORE] = __version__, store.identity()
        for number, name, detected in store.detected():
            if detected.features is None:
                continue
            junctions = detected.junctions
            group = file.create_group(name)
            size = detected.width, detected.height
            group["keypoints"] = orientation.turn(orientation.to_stored(detected.orientation, *size), places[number])
            group["scores"] = -junctions["log10_nfa"]
            group["image_size"] = np.array(orientation.stored_size(detected.orientation, *size))


def write_matches(store: Store, path: Path) -> None:
    """The matches of all pairs."""
    import h5py

    names = dict(store.images())
    sizes = {n: len(d.junctions) for n, _, d in store.detected()}
    with whole_file(path) as temporary, h5py.File(temporary, "w") as file:
        file.attrs[_MARK], file.attrs[_STORE] = __version__, store.identity()
        for one, two, matched in store.matched():
            if matched.matches is None:
                continue
            records = matched.junction_matches
            matches = np.full(sizes[one], -1, np.int32)
            scores = np.zeros(sizes[one], np.float32)
            matches[records["junction1"]] = records["junction2"]
            scores[records["junction1"]] = np.clip(records["similarity"], 0, 1)
            group = file.create_group(names[one].replace("/", "-") + "/" + names[two].replace("/", "-"))
            group["matches0"] = matches
            group["matching_scores0"] = scores
