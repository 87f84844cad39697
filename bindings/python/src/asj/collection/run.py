# SPDX-License-Identifier: BSD-2-Clause
"""Does the waiting work of a collection, in processes of this machine or on Dask, and writes what comes back."""

from __future__ import annotations

import concurrent.futures
import dataclasses
import multiprocessing
import os
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from ..features import Features
from . import tasks
from .plan import Plan
from .store import Store
from .tasks import Detected, Matched

Report = Callable[[str, int, int, float], None]  # what, done, of how many, seconds left


@dataclass(frozen=True)
class Summary:
    """How a collection ended."""

    images: int
    failed_images: int
    pairs: int
    failed_pairs: int
    skipped_pairs: int
    seconds: float
    failures: list[tuple[str, str]]

    def __str__(self) -> str:
        text = f"{self.images} images, {self.pairs} pairs in {self.seconds:.1f} s"
        if self.failed_images or self.failed_pairs:
            text += f"; failed: {self.failed_images} images, {self.failed_pairs} pairs; {self.skipped_pairs} pairs of failed images left out"
        return text + "".join(f"\n  {name}: {why}" for name, why in self.failures)


class Workers(Protocol):
    """Who does the work. Results come in any order, each once."""

    portion: int  # images that are looked at before their pairs are matched

    def close(self) -> None:
        """The work is done, or will not be."""

    def detect(self, plan: Plan, images: list[tuple[int, str]]) -> Iterator[tuple[int, Detected]]:
        """Results of images by number."""

    def match(self, plan: Plan, store: Store, pairs: list[tuple[int, int, int]]) -> Iterator[tuple[int, Matched]]:
        """Results of pairs by number."""


def collect(plan: Plan, store: Store, workers: Workers, report: Report | None = None) -> Summary:
    """Does what is waiting in the store. A call that was killed is gone on with by the next one."""
    begin = time.monotonic()
    images = store.waiting_images()
    of_images, of_pairs = _Progress("images", report, len(images)), _Progress("pairs", report, 0)
    try:
        for first in range(0, max(1, len(images)), workers.portion):
            for number, detected in of_images.over(workers.detect(plan, images[first : first + workers.portion])):
                store.save_image(number, detected)
            of_pairs.total = of_pairs.done + store.pairs_to_do()
            for number, matched in of_pairs.over(workers.match(plan, store, store.waiting_pairs())):
                store.save_pair(number, matched)
    finally:
        workers.close()
    all_images, all_pairs = store.counts("images"), store.counts("pairs")
    return Summary(
        sum(all_images.values()), all_images.get("failed", 0), sum(all_pairs.values()), all_pairs.get("failed", 0),
        all_pairs.get("waiting", 0), time.monotonic() - begin, store.failures(),
    )  # fmt: skip


class _Progress:
    """Tells how far one kind of work is, which comes in portions."""

    def __init__(self, what: str, report: Report | None, total: int) -> None:
        self.what, self.report, self.total, self.done, self.seconds = what, report, total, 0, 0.0

    def over(self, results: Iterable[Any]) -> Iterator[Any]:
        """The same results, each told of when it has been taken."""
        begin = time.monotonic()
        for result in results:
            yield result
            self.done += 1
            self.seconds, begin = self.seconds + time.monotonic() - begin, time.monotonic()
            if self.report:
                self.report(self.what, self.done, self.total, self.seconds / self.done * (self.total - self.done))


_PORTION = 32  # images for each process or thread of a worker: few are done at the end of a portion while the others wait

# ---- processes of this machine ----

_kept = tasks.Kept()
_store: Store | None = None


def _begin_process(threads: int) -> None:
    threading.Thread(target=_end_with_parent, daemon=True).start()
    tasks.start(threads)


def _end_with_parent() -> None:
    """A parent that is killed tells nobody: its workers would wait for work, and keep its pipes open, for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _detect(folder: Path, number: int, name: str, detector: dict[str, str], matcher: dict[str, str]) -> tuple[int, Detected]:
    detected, features = tasks.detect_image(folder / name, detector, matcher)
    if features is not None:
        _kept.put(folder / name, features)
    return number, detected


def _match(plan: Plan, number: int, records: list[tuple[str, bytes, float | None]]) -> tuple[int, Matched]:
    try:
        one, two = (_kept.get(plan.folder / name, data, plan.detector, plan.matcher) for name, data, _ in records)
    except Exception as bad:  # an image that was there for detection and is not any more
        return number, Matched(str(bad) or type(bad).__name__, None, None, None)
    return number, tasks.match_images(one, two, (records[0][2], records[1][2]), plan)


class Processes:
    """Worker processes of this machine, each with the features of the images that it used last."""

    def __init__(self, jobs: int, threads: int = 1) -> None:
        if jobs < 1:
            raise ValueError(f"jobs is {jobs}: 1 or more")
        self.jobs, self.threads, self.portion = jobs, threads, _PORTION * jobs
        self._executor: concurrent.futures.ProcessPoolExecutor | None = None

    def _pool(self) -> concurrent.futures.ProcessPoolExecutor:
        if self._executor is None:
            self._executor = concurrent.futures.ProcessPoolExecutor(
                self.jobs, multiprocessing.get_context("spawn"), initializer=_begin_process, initargs=(self.threads,)
            )
        return self._executor

    def close(self) -> None:
        """Ends the processes."""
        executor, self._executor = self._executor, None
        if executor is not None:
            executor.shutdown(cancel_futures=True)

    def detect(self, plan: Plan, images: list[tuple[int, str]]) -> Iterator[tuple[int, Detected]]:
        """One task an image."""
        work = ((_detect, plan.folder, number, name, plan.detector, plan.matcher) for number, name in images)
        yield from _bounded(self._pool, self.jobs, work)

    def match(self, plan: Plan, store: Store, pairs: list[tuple[int, int, int]]) -> Iterator[tuple[int, Matched]]:
        """One task a pair."""
        names = dict(store.images())
        without_lists = dataclasses.replace(plan, images=[], pairs=[])  # it goes along with every task

        def work() -> Iterator[tuple[Any, ...]]:
            for number, *both in pairs:
                images = [(names[image], store.features(image)) for image in both]
                yield _match, without_lists, number, [(name, image.features or b"", image.focal) for name, image in images]

        yield from _bounded(self._pool, self.jobs, work())


def _bounded(pool: Callable[[], concurrent.futures.Executor], jobs: int, work: Iterator[tuple[Any, ...]]) -> Iterator[Any]:
    """Results as they come; only a few tasks wait in the pool, whatever the length of the list."""
    waiting: set[concurrent.futures.Future[Any]] = set()
    try:
        for task in work:
            waiting.add(pool().submit(*task))
            if len(waiting) >= 4 * jobs:
                done, waiting = concurrent.futures.wait(waiting, return_when=concurrent.futures.FIRST_COMPLETED)
                for future in done:
                    yield future.result()
        for future in concurrent.futures.as_completed(waiting):
            yield future.result()
    except BaseException:
        for future in waiting:
            future.cancel()
        raise


# ---- Dask ----


def _dask_detect(path: Path, detector: dict[str, str], matcher: dict[str, str]) -> tuple[Detected, Features | None]:
    return tasks.detect_image(path, detector, matcher)


def _dask_summary(result: tuple[Detected, Features | None]) -> Detected:
    return result[0]


def _dask_match(one: tuple[Detected, Features | None], two: tuple[Detected, Features | None], plan: Plan) -> Matched:
    if one[1] is None or two[1] is None:
        return Matched("an image without junctions", None, None, None)
    return tasks.match_images(one[1], two[1], (one[0].focal, two[0].focal), plan)


class Dask:
    """Workers of a Dask cluster, which must see the images under the same paths. Features stay where they were made until the last
    pair of their image is done."""

    def __init__(self, client: Any) -> None:
        self.client = client
        self.portion = _PORTION * max(1, sum(client.nthreads().values()))
        self._features: dict[int, Any] = {}

    def close(self) -> None:
        """The features may go."""
        self._features.clear()

    def detect(self, plan: Plan, images: list[tuple[int, str]]) -> Iterator[tuple[int, Detected]]:
        """One task an image; a second one brings its junctions here."""
        yield from self._results(
            (number, self.client.submit(_dask_summary, self._feature(plan, number, name), pure=False)) for number, name in images
        )

    def match(self, plan: Plan, store: Store, pairs: list[tuple[int, int, int]]) -> Iterator[tuple[int, Matched]]:
        """One task a pair; an image whose features are on no worker any more is looked at once more."""
        names, later = dict(store.images()), store.images_wanted_later()
        last = {image: position for position, (_, *both) in enumerate(pairs) for image in both if image not in later}
        without_lists = dataclasses.replace(plan, images=[], pairs=[])

        def work() -> Iterator[tuple[int, Any]]:
            for position, (number, *both) in enumerate(pairs):
                one, two = (self._feature(plan, image, names[image]) for image in both)
                yield number, self.client.submit(_dask_match, one, two, without_lists, pure=False, retries=2)
                for image in both:
                    if last.get(image) == position:
                        del self._features[image]

        yield from self._results(work())
        self._features = {image: future for image, future in self._features.items() if image in later}

    def _feature(self, plan: Plan, number: int, name: str) -> Any:
        if number not in self._features:
            path = (plan.folder / name).absolute()
            self._features[number] = self.client.submit(_dask_detect, path, plan.detector, plan.matcher, pure=False, retries=2)
        return self._features[number]

    def _results(self, work: Iterable[tuple[int, Any]]) -> Iterator[tuple[int, Any]]:
        from distributed import as_completed

        numbers: dict[Any, int] = {}
        queue = as_completed()
        most = 8 * max(1, sum(self.client.nthreads().values()))
        for number, future in work:
            numbers[future] = number
            queue.add(future)
            while queue.count() >= most:
                yield self._one(next(queue), numbers)
        for future in queue:
            yield self._one(future, numbers)

    def _one(self, future: Any, numbers: dict[Any, int]) -> tuple[int, Any]:
        return numbers.pop(future), future.result()
