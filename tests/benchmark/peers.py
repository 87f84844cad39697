# SPDX-License-Identifier: BSD-2-Clause
"""libasj beside OpenCV's detectors and matchers: time of the first image of a process and of later ones, alone and beside processes
that compute, with one thread and more. Every measurement is a process of its own, and all contestants take turns.

    pip install ./bindings/python matplotlib opencv-contrib-python-headless
    python tests/benchmark/peers.py --json peers.json --plot peers.svg [IMAGE or FOLDER with 1.png and 2.png]...
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
WIDTH, HEIGHT = 1052, 780


def akaze(cv2):
    """In OpenCV 5 it is one of the contributed features."""
    return cv2.AKAZE_create() if hasattr(cv2, "AKAZE_create") else cv2.xfeatures2d.AKAZE_create()


def detector(name: str, threads: int, cv2):
    """A function of an image that returns how many things it found; what it needs once is made here, before the clock runs."""
    if name.startswith("libasj"):
        import asj

        context = asj.Context(threads=threads)
        options = {} if name == "libasj" else {"octaves": 1}
        return lambda image: len(asj.detect(image, preset="default", context=context, **options).junctions)
    if name == "EDLines":
        drawing = cv2.ximgproc.createEdgeDrawing()

        def lines(image):
            drawing.detectEdges(image)
            found = drawing.detectLines()
            return 0 if found is None else len(found)

        return lines
    if name == "LSD":
        lsd = cv2.createLineSegmentDetector()
        return lambda image: len(lsd.detect(image)[0])
    made = cv2.ORB_create(2000) if name == "ORB" else cv2.SIFT_create() if name == "SIFT" else akaze(cv2)
    return lambda image: len(made.detectAndCompute(image, None)[0])


def matcher(name: str, threads: int, first, second, cv2):
    """A function that matches two images whose features are known."""
    if name == "libasj match":
        import asj

        context = asj.Context(threads=threads)
        views = [asj.detect(image, context=context) for image in (first, second)]
        return lambda: len(asj.match(*views, context=context).indices)
    maker, norm = (cv2.SIFT_create(), cv2.NORM_L2) if name == "SIFT match" else (cv2.ORB_create(2000), cv2.NORM_HAMMING)
    described = [maker.detectAndCompute(image, None)[1] for image in (first, second)]
    brute = cv2.BFMatcher(norm)
    return lambda: sum(len(p) == 2 and p[0].distance < 0.75 * p[1].distance for p in brute.knnMatch(*described, k=2))


def child(name: str, threads: int, runs: int, paths: list[str]) -> None:
    """One measurement: milliseconds of the first call and of the later ones, to standard output as JSON."""
    images = [np.load(path) for path in paths]
    cv2 = None
    if not name.startswith("libasj"):
        import cv2

        cv2.setNumThreads(threads)
    if name.endswith("match"):
        work = matcher(name, threads, *images, cv2)
    else:
        detect = detector(name, threads, cv2)
        work = lambda: detect(images[0])  # noqa: E731
    times, processor = [], []
    for _ in range(runs + 1):
        start, used = time.perf_counter(), time.process_time()
        found = work()
        times.append(1e3 * (time.perf_counter() - start))
        processor.append(1e3 * (time.process_time() - used))
    json.dump({"first": times[0], "later": times[1:], "cpu": processor[1:], "found": int(found)}, sys.stdout)


def measure(name: str, threads: int, runs: int, load: int, paths: list[str]) -> dict:
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(load)]
    try:
        command = [sys.executable, __file__, "--child", name, "--threads", str(threads), "--runs", str(runs), *paths]
        alone = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # numpy's threads look for work for a while once it is imported
        return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, env=alone).stdout)
    finally:
        for process in busy:
            process.send_signal(signal.SIGKILL)
            process.wait()


def read(path: Path, scale: bool) -> np.ndarray:
    import cv2

    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if image is None:
        sys.exit(f"{path} cannot be read")
    factor = (WIDTH * HEIGHT / image.size) ** 0.5
    how = cv2.INTER_AREA if factor < 1 else cv2.INTER_LINEAR
    return cv2.resize(image, None, fx=factor, fy=factor, interpolation=how) if scale else image


def pictures(arguments: list[str], scale: bool, quick: bool) -> dict[str, list[np.ndarray]]:
    """Names, and one image or two. Without arguments: two views of a room."""
    found = {}
    for argument in map(Path, arguments):
        files = [argument / "1.png", argument / "2.png"] if argument.is_dir() else [argument]
        name = argument.name if argument.is_dir() else f"{argument.absolute().parent.name}/{argument.name}"
        found[name] = [read(path, scale) for path in files]
    if not found:
        sys.path.insert(0, str(ROOT / "bindings/python/examples"))
        import room

        size = {"width": 320, "height": 240, "focal": 260} if quick else {"width": WIDTH, "height": HEIGHT, "focal": 860}
        views = [room.look((x, -1.5, 0.6), (0.3, -1.0, 4.0), **size) for x in (0.0, 0.5)]
        found["room"] = [room.render(room.make(1), view) for view in views]
    return found


def table(results: list[dict]) -> None:
    """libasj over each of the others: wall time in the same conditions, processor time, wall time over that of its one thread."""
    key = {(r["image"], r["name"], r["threads"], r["busy"]): r for r in results}
    print("image | threads | | ms | spread | first / later | cpu, ms | found | libasj / it | by cpu | libasj / its 1 thread")
    print("--- | --- | --- | --- | --- | --- | --- | --- | --- | --- | ---")
    for r in results:
        ours = "libasj match" if r["name"].endswith("match") else "libasj"
        us, one = key[r["image"], ours, r["threads"], r["busy"]], key[r["image"], r["name"], min(k[2] for k in key), r["busy"]]
        ratio = "| |" if r is us else f"{us['ms'] / r['ms']:.2f} | {us['cpu'] / r['cpu']:.2f} | {us['ms'] / one['ms']:.2f}"
        print(f"{r['image']} | {r['threads']}{' busy' if r['busy'] else ''} | {r['name']} | {r['ms']:.1f} | {r['low']:.1f} to "
              f"{r['high']:.1f} | {r['first'] / r['ms']:.2f} | {r['cpu']:.1f} | {r['found']} | {ratio}")


def plot(results: list[dict], path: str) -> None:
    """A panel for each image and kind: milliseconds of each contestant, bars by threads and load."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    images = list(dict.fromkeys(r["image"] for r in results))
    settings = list(dict.fromkeys((r["threads"], r["busy"]) for r in results))
    names = list(dict.fromkeys(r["name"] for r in results))
    figure, axes = plt.subplots(len(images), 1, figsize=(9, 3.2 * len(images)), squeeze=False, layout="constrained")
    for axis, image in zip(axes[:, 0], images):
        for i, (threads, busy) in enumerate(settings):
            rows = {r["name"]: r for r in results if (r["image"], r["threads"], r["busy"]) == (image, threads, busy)}
            width = 0.8 / len(settings)
            at = np.arange(len(names)) + (i - (len(settings) - 1) / 2) * width
            label = f"{threads} thread{'s' if threads > 1 else ''}{', busy' if busy else ''}"
            axis.bar(at, [rows[n]["ms"] if n in rows else np.nan for n in names], width, label=label)
            first = [rows[n]["first"] if n in rows else np.nan for n in names]
            axis.plot(at, first, "_", color="black", markersize=8, label=None if i else "first image")
        axis.set_yscale("log")
        axis.set_xticks(range(len(names)), names)
        axis.set_ylabel("ms")
        axis.set_title(image)
        axis.legend(fontsize="small", ncols=3)
    figure.savefig(path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("images", nargs="*")
    parser.add_argument("--threads", type=int, action="append", help="of every contestant (1 and 2)")
    parser.add_argument("--runs", type=int, default=7, help="images after the first one in each process")
    parser.add_argument("--rounds", type=int, default=3, help="processes of each contestant")
    parser.add_argument("--load", type=int, default=2, help="processes that compute, for the busy rows; 0 = no such rows")
    parser.add_argument("--scale", action="store_true", help=f"images are made as large as {WIDTH} x {HEIGHT}")
    parser.add_argument("--quick", action="store_true", help="a small room, one round of two runs")
    parser.add_argument("--only", action="append", help="contestants (all)")
    parser.add_argument("--json", help="file for the results")
    parser.add_argument("--plot", help="picture of the results")
    parser.add_argument("--child", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        return child(options.child, options.threads[0], options.runs, options.images)
    if options.quick:
        options.rounds, options.runs = 1, 2
    results = []
    with tempfile.TemporaryDirectory() as folder:
        for image, views in pictures(options.images, options.scale, options.quick).items():
            paths = [os.path.join(folder, f"{i}.npy") for i in range(len(views))]
            for path, view in zip(paths, views):
                np.save(path, view)
            names = ["libasj", "libasj, 1 octave", "EDLines", "LSD", "ORB", "SIFT", "AKAZE"]
            names += ["libasj match", "SIFT match", "ORB match"] if len(views) == 2 else []
            names = [n for n in names if not options.only or n in options.only or n in ("libasj", "libasj match")]
            settings = [(t, b) for t in options.threads or [1, 2] for b in ([False, True] if options.load else [False])]
            parts: dict = {(n, *s): [] for s in settings for n in names}
            for _ in range(options.rounds):
                for (name, threads, busy), list_ in parts.items():
                    list_.append(measure(name, threads, options.runs, options.load if busy else 0, paths))
            for (name, threads, busy), list_ in parts.items():
                medians = [statistics.median(p["later"]) for p in list_]
                results.append({
                    "image": image, "width": views[0].shape[1], "height": views[0].shape[0], "name": name, "threads": threads,
                    "busy": busy, "ms": statistics.median(medians), "low": min(medians), "high": max(medians),
                    "first": statistics.median(p["first"] for p in list_),
                    "cpu": statistics.median(c for p in list_ for c in p["cpu"]), "found": list_[0]["found"],
                })  # fmt: skip
    table(results)
    if options.json:
        Path(options.json).write_text(json.dumps(results, indent=1) + "\n")
    if options.plot:
        plot(results, options.plot)


if __name__ == "__main__":
    main()
