# SPDX-License-Identifier: BSD-2-Clause
"""Junctions of many images and matches of their pairs: resumable, in parallel processes or on Dask, for a reconstruction."""

from .plan import Plan, all_pairs, find_images, read_pairs, sequential_pairs
from .run import Dask, Processes, Summary, Workers, collect
from .store import Store, StoreError
from .tasks import Detected, Matched

__all__ = [
    "Dask", "Detected", "Matched", "Plan", "Processes", "Store", "StoreError", "Summary", "Workers", "all_pairs", "collect",
    "find_images", "read_pairs", "sequential_pairs",
]  # fmt: skip
