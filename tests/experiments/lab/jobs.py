# SPDX-License-Identifier: BSD-2-Clause
"""Independent jobs on a few threads, in order of importance, until their time is used up. Jobs wait for programs or for OpenCV and
numpy, which let other threads run."""
import sys
import threading
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

from .library import Failure


OUT_OF_TIME = "not begun, the part's time was used up"


class Jobs:
    """Collects jobs of one part and runs them; their names are tuples. What was not begun in time, failed or was stopped is told
    in `cut`."""

    def __init__(self, title, processes, budget, programs_seconds):
        """programs_seconds(): processor time of the programs that the calling thread has run"""
        self.title, self.processes, self.budget, self.programs_seconds = title, processes, budget, programs_seconds
        self.cost = Counter()   # first part of a job's name -> seconds of processor time
        self.queue, self.missed, self.lock, self.done = [], [], threading.Lock(), 0

    def add(self, name, function, *arguments):
        """function(limit, *arguments); limit: seconds that it may still take, or None"""
        self.queue.append((name, function, arguments))

    def _spent(self):
        return time.thread_time() + self.programs_seconds()

    def _one(self, job, end, results):
        name, function, arguments = job
        before = self._spent()
        left = None if end is None else end - time.monotonic()
        try:
            if left is not None and left <= 0:
                raise Failure(OUT_OF_TIME)
            results[name] = function(left, *arguments)
        except Failure as reason:
            with self.lock:
                self.missed.append((name, str(reason)))
        with self.lock:
            self.cost[str(name[0])] += self._spent() - before
            self.done += 1
            self._show()

    @property
    def cut(self):
        """Lines of text: single jobs that failed, and how many were not begun, by the first parts of their names."""
        out = ["%s: %s" % (", ".join(map(str, name)), reason) for name, reason in self.missed if reason != OUT_OF_TIME]
        late = Counter(str(name[0]) for name, reason in self.missed if reason == OUT_OF_TIME)
        return out + ["%s: %d jobs %s" % (first, number, OUT_OF_TIME) for first, number in late.items()]

    def _show(self):
        """Progress: a line that changes on a terminal, elsewhere a line for every tenth."""
        if sys.stderr.isatty():
            print("\r%-14s %4d / %d" % (self.title, self.done, len(self.queue)), end="", file=sys.stderr, flush=True)
        elif self.done * 10 // len(self.queue) != (self.done - 1) * 10 // len(self.queue):
            print("%-14s %4d / %d" % (self.title, self.done, len(self.queue)), file=sys.stderr, flush=True)

    def run(self):
        """{name: what the job returned}"""
        results, start = {}, time.monotonic()
        end = None if self.budget is None else start + self.budget
        with ThreadPoolExecutor(self.processes) as pool:
            for future in [pool.submit(self._one, job, end, results) for job in self.queue]:
                future.result()
        end_of_line = "\r" if sys.stderr.isatty() else ""
        print("%s%-14s %d jobs in %.0f s" % (end_of_line, self.title, len(self.queue), time.monotonic() - start), file=sys.stderr)
        self.queue = []
        return results
