# SPDX-License-Identifier: BSD-2-Clause
"""A long collection on a Dask cluster of this machine: images a second against the number of workers, memory of each over time:
cluster.py [--images N] [--workers N ...] [--reach N]   (needs dask and distributed)
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from pathlib import Path
from typing import Any

import distributed
import numpy as np
import room
from numpy.typing import NDArray
from PIL import Image

from asj.collection import Plan, Store, collect
from asj.collection.plan import find_images, sequential_pairs
from asj.collection.run import Dask

WIDTH, HEIGHT, VIEWS, SAMPLES = 300, 225, 20, 16


def write_images(folder: Path, count: int) -> None:
    """Views of rooms, VIEWS of each on a walk, again and again: shifted, brightened, with noise of their own."""
    rooms: list[list[NDArray[np.uint8]]] = []
    for seed in range(1, min(5, count // VIEWS) + 1):
        views, things = room.walk(VIEWS), room.make(seed)
        rooms.append([room.render(things, view, seed=100 * seed + n) for n, view in enumerate(views)])
    random = np.random.default_rng(1)
    for number in range(count):
        picture = rooms[number // VIEWS % len(rooms)][number % VIEWS]
        x, y = random.integers(0, 640 - 2 * WIDTH + 1), random.integers(0, 480 - 2 * HEIGHT + 1)
        small = picture[y : y + 2 * HEIGHT, x : x + 2 * WIDTH].reshape(HEIGHT, 2, WIDTH, 2).mean(axis=(1, 3))
        changed = small * random.uniform(0.7, 1.1) + random.normal(0, 1.5, small.shape)
        Image.fromarray(np.clip(changed, 0, 255).astype(np.uint8)).save(folder / f"{number:05}.png")


def state() -> tuple[int, float]:
    """Resident memory in MB and seconds of processor time of the process that it runs in (Linux)."""
    with open("/proc/self/statm") as file:
        pages = int(file.read().split()[1])
    times = os.times()
    return pages * os.sysconf("SC_PAGE_SIZE") >> 20, times.user + times.system


def run(folder: Path, work: Path, workers: int, reach: int) -> None:
    """One collection; prints a line."""
    names = find_images(folder)
    plan = Plan(folder, names, sequential_pairs(names, reach), {"preset": "match"}, {"preset": "default"})
    samples: list[dict[str, tuple[int, float]]] = []
    with (
        distributed.LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
        Store.create(work, plan) as store,
    ):
        before = client.run(state)

        def watch(what: str, number: int, total: int, left: float) -> None:
            del what, left
            if number % max(1, total * 2 // SAMPLES) == 0:
                samples.append(client.run(state))

        begin = time.monotonic()
        summary: Any = collect(plan, store, Dask(client), watch)
        seconds = time.monotonic() - begin
        after = client.run(state)
    spent = sum(after[w][1] - before[w][1] for w in after)
    failed = summary.failed_images + summary.failed_pairs
    print(f"{workers} workers: {summary.images} images, {summary.pairs} pairs, {failed} failed: "
          f"{seconds:.0f} s, {summary.images / seconds:.1f} images/s; {spent:.0f} s of processor time, "
          f"{summary.images / spent * workers:.1f} images a second of {workers} processors")
    for n, worker in enumerate(after, 1):
        print(f"  worker {n}, MB: {before[worker][0]} | {' '.join(str(s[worker][0]) for s in samples)}", flush=True)


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--images", type=int, default=2000)
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--reach", type=int, default=1)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "images"
        folder.mkdir()
        write_images(folder, arguments.images)
        for workers in arguments.workers:
            run(folder, Path(place) / f"{workers}.work", workers, arguments.reach)


if __name__ == "__main__":
    main()
