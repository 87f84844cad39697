# SPDX-License-Identifier: BSD-2-Clause
"""python -m asj collect: junctions of many images and matches of their pairs, for a reconstruction."""

from __future__ import annotations

import argparse
import contextlib
import signal
import sqlite3
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from . import __version__, collection, errors, geometry, images, output
from .collection import plan as plans
from .collection.colmap import CAMERA_MODES
from .collection.run import Dask, Processes
from .options import DETECTOR, MATCHER


def _path(word: str) -> Path:
    """A path, which an empty word is none of: pathlib takes it for this folder."""
    if not word:
        raise argparse.ArgumentTypeError("an empty path names nothing (. is this folder)")
    return Path(word)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m asj", description=__doc__)
    parser.add_argument("--version", action="version", version=f"asj {__version__}")
    commands = parser.add_subparsers(dest="command", required=True)
    collect = commands.add_parser("collect", help="detect in all images of a folder, match pairs, write files for a reconstruction")
    collect.add_argument("folder", type=_path, help="images, also in folders below it")
    which = collect.add_mutually_exclusive_group()
    which.add_argument("--all-pairs", action="store_true", help="every pair of images (default)")
    which.add_argument("--sequential", type=int, metavar="N", help="each image with the N images after it, by name")
    which.add_argument("--pairs", type=_path, metavar="FILE", help="pairs from a file: two names a line, with blanks in double quotes")
    which.add_argument("--no-pairs", action="store_true", help="junctions alone: no pair is matched")
    outputs = collect.add_argument_group("outputs, at least one")
    outputs.add_argument("--colmap", type=_path, metavar="FILE.db", help="COLMAP database (needs pycolmap)")
    outputs.add_argument(
        "--camera-mode", choices=CAMERA_MODES, default="auto",
        help="COLMAP: which images have one camera, refined as one. auto (default): those whose EXIF data tell the same make, model, focal "
        "length and size, any other image has its own; single: all; per-folder: those of a folder; per-image: none",
    )  # fmt: skip
    outputs.add_argument("--hdf5", type=_path, metavar="FOLDER", help="features.h5 and matches.h5 as hloc reads them (needs h5py)")
    outputs.add_argument(
        "--limap", type=_path, metavar="FOLDER", help="line segments and their matches as LIMAP reads them, matches also as text"
    )
    work = collect.add_argument_group("work")
    work.add_argument("--store", type=_path, metavar="FILE", help="what has been done so far (default: beside the first output)")
    again = work.add_mutually_exclusive_group()
    again.add_argument("--resume", action="store_true", help="go on with the store of a run that ended early")
    again.add_argument(
        "--update", action="store_true", help="the same for images or pairs that have become others since: what is new or changed is done, "
        "what is gone is forgotten, and the rest stays",
    )  # fmt: skip
    work.add_argument("--jobs", type=int, default=2, metavar="N", help="worker processes (default 2)")
    work.add_argument("--dask", metavar="ADDRESS", help="a Dask scheduler, for instance tcp://host:8786, instead of processes here")
    work.add_argument("--no-verify", action="store_true", help="COLMAP: no two-view geometries")
    work.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", dest="detector", help="an option of the detector")
    work.add_argument("--match-set", action="append", default=[], metavar="NAME=VALUE", dest="matcher", help="an option of the matcher")
    work.add_argument(
        "--geometry", choices=list(geometry.MODELS), default="none",
        help="estimate what relates the images of a pair, and let it decide which matches hold",
    )  # fmt: skip
    work.add_argument(
        "--focal", default="exif", metavar="F|exif|estimate|none",
        help="focal lengths for the geometry: of the EXIF data where both images have them, made better with the motion (default), one "
        "that is found for each pair, none, or a number of pixels",
    )  # fmt: skip
    work.add_argument(
        "--camera", metavar="FX,FY,CX,CY",
        help="the camera of all images, upright, px: focal lengths and principal point, pixel centres at integers (COLMAP's CX and CY less "
        "0.5), instead of --focal",
    )  # fmt: skip
    work.add_argument(
        "--overwrite", action="store_true", help="outputs replace files that something else, or another collection, has written"
    )
    work.add_argument("--quiet", action="store_true", help="no progress")
    return parser


def _options(words: Sequence[str], table: Any, preset: str) -> dict[str, str]:
    options = {"preset": preset}
    for word in words:
        key, equal, value = word.partition("=")
        if not equal:
            raise errors.OptionError(f"{word}: NAME=VALUE is expected")
        options[key.strip().replace("-", "_")] = value
    table.fill(options["preset"], {key: value for key, value in options.items() if key != "preset"})
    return options


def _focal(arguments: argparse.Namespace) -> str:
    word: str = arguments.focal
    if arguments.camera is not None:
        return _camera(arguments)
    if word not in ("exif", "estimate", "none"):
        try:
            good = 1 <= float(word) <= 1e7
        except ValueError:
            good = False
        if not good:
            raise ValueError(f"--focal: {word!r} is not a length in pixels, 1 and more, or exif, estimate or none")
    if word != "exif" and arguments.geometry not in ("auto", "essential"):
        raise ValueError("--focal changes nothing without --geometry auto or essential")
    if word == "none" and arguments.geometry == "essential":
        raise ValueError("--geometry essential needs focal lengths")
    return word


def _camera(arguments: argparse.Namespace) -> str:
    word: str = arguments.camera
    try:
        numbers = plans.camera_of(word)
    except ValueError:
        numbers = []
    if len(numbers) != 4 or not all(1 <= focal <= 1e7 for focal in numbers[:2]) or not all(abs(place) <= 1e7 for place in numbers[2:]):
        raise ValueError(f"--camera: {word!r} is not FX,FY,CX,CY in pixels, focal lengths of 1 and more")
    if arguments.focal != "exif":
        raise ValueError("--camera and --focal exclude each other")
    return word


def _check_camera(plan: plans.Plan) -> None:
    """Refuses a --camera whose numbers are in another order; says where it may be that of another image."""
    said = False
    checked: set[tuple[int, int] | None] = {None}
    for name in plan.images:
        size = images.size(plan.folder / name)
        if size is None or size in checked:
            continue
        checked.add(size)
        cannot_be, why = geometry.doubt(plan.camera, *size)
        if cannot_be:
            raise ValueError(f"--camera: {why} ({name})")
        if why and not said:
            print(f"python -m asj: warning: --camera: {why} ({name})", file=sys.stderr)
            said = True


def _plan(arguments: argparse.Namespace, found: plans.Found) -> plans.Plan:
    names = found.images
    if not names:
        raise ValueError("; ".join([f"{arguments.folder}: no images there", *map(str.strip, _left_out(found))]))
    if arguments.no_pairs:
        pairs = []
    elif arguments.pairs:
        pairs = plans.read_pairs(arguments.pairs, names)
    elif arguments.sequential is not None:
        if arguments.sequential < 1:
            raise ValueError("--sequential: 1 or more")
        pairs = plans.sequential_pairs(names, arguments.sequential)
    else:
        pairs = plans.all_pairs(names)
    return plans.Plan(
        arguments.folder, names, pairs, _options(arguments.detector, DETECTOR, "match"), _options(arguments.matcher, MATCHER, "default"),
        arguments.geometry, _focal(arguments),
    )  # fmt: skip


def _left_out(found: plans.Found) -> list[str]:
    """Lines about the files that are not looked at."""
    lines = [f"  {name}: its name is not UTF-8, as outputs want it: rename it" for name in found.misnamed]
    lines += [f"  {name}: a link to what is not there" for name in found.dangling]
    return [*lines, *filter(None, [found.left_out()])]


def _progress(what: str, done: int, total: int, left: float) -> None:
    end = "\n" if done == total else "\r"
    print(f"{what}: {done} of {total}, {left:.0f} s left   ", end=end, file=sys.stderr, flush=True)


@contextlib.contextmanager
def _named(path: Path) -> Iterator[None]:
    """SQLite tells what is wrong with a file, and not which one that is."""
    try:
        yield
    except sqlite3.Error as bad:
        raise collection.StoreError(f"{path}: {bad}") from bad


def _write(arguments: argparse.Namespace, store: collection.Store) -> None:
    if arguments.colmap:
        from .collection import colmap

        with _named(arguments.colmap):
            verify = not arguments.no_verify
            colmap.write(store, arguments.colmap, verify=verify, threads=arguments.jobs, camera_mode=arguments.camera_mode)
    if arguments.hdf5:
        from .collection import hdf5

        arguments.hdf5.mkdir(parents=True, exist_ok=True)
        hdf5.write_features(store, arguments.hdf5 / "features.h5")
        hdf5.write_matches(store, arguments.hdf5 / "matches.h5")
    if arguments.limap:
        from .collection import limap

        limap.write(store, arguments.limap)


def _check_outputs(arguments: argparse.Namespace) -> Path:
    """Refuses before the work what would fail after it; returns the place of the store."""
    outputs = [path for path in (arguments.colmap, arguments.hdf5, arguments.limap) if path]
    if not outputs:
        raise ValueError("no output: name --colmap, --hdf5 or --limap")
    if arguments.camera_mode != "auto" and not arguments.colmap:
        raise ValueError("--camera-mode changes nothing without --colmap")
    if arguments.camera_mode != "auto" and arguments.camera is not None:
        raise ValueError("--camera is one camera of all images: --camera-mode changes nothing")
    errors.extra("PIL.Image", "images")
    if arguments.colmap:
        errors.extra("pycolmap", "colmap")
    if arguments.hdf5:
        errors.extra("h5py", "hdf5")
    if arguments.dask:
        errors.extra("distributed", "dask")
    for path in outputs:
        if path.exists() and path.is_dir() == (path == arguments.colmap):
            raise FileExistsError(f"{path} is there, and is {'a folder' if path.is_dir() else 'no folder'}")
        if not path.absolute().parent.is_dir():
            raise FileNotFoundError(f"{path}: there is no folder {path.absolute().parent}")
    return arguments.store or _beside(outputs[0])


def _beside(output: Path) -> Path:
    """Where the store is that nobody has named: of "." and ".." too, which are no names."""
    named = output if output.name not in ("", "..") else output.resolve()
    if not named.name:
        raise ValueError(f"{output}: nothing is beside it: name the --store")
    return named.with_name(named.name + ".work")


def _check_replaced(arguments: argparse.Namespace, store: Path, plan: plans.Plan) -> None:
    """Refuses to write over photographs and the store, and, unasked, over what something else or another collection has written."""
    files: list[tuple[Path, Callable[[Path], str | None]]] = []
    if arguments.colmap:
        from .collection import colmap

        files.append((arguments.colmap, colmap.written_from))
        colmap.refuse_logs(arguments.colmap)
    if arguments.hdf5:
        from .collection import hdf5

        files += [(arguments.hdf5 / name, hdf5.written_from) for name in ("features.h5", "matches.h5")]
    inputs = {(plan.folder / name).resolve() for name in plan.images}
    identity, highest = collection.Store.before_outputs(store, plan)
    for path, written_from in files:
        if path.resolve() in inputs:
            raise FileExistsError(f"{path} is a photograph of the collection")
        if path.resolve() == store.resolve():
            raise FileExistsError(f"{path} is the store of this run")
        output.refuse_protected(path)
        if path.exists() and not arguments.overwrite:
            _check_writer(path, written_from(path), store, identity)
    if arguments.limap and not arguments.overwrite:
        from .collection import limap

        for path in limap.foreign_files(arguments.limap, identity, highest):
            _check_writer(path, limap.written_from(arguments.limap) if path.parent == arguments.limap else None, store, identity)
    if store.resolve() in inputs:
        raise FileExistsError(f"{store}: the store would be a photograph of the collection")


def _check_writer(path: Path, writer: str | None, store: Path, identity: str | None) -> None:
    if writer is None:
        raise FileExistsError(f"{path} is there, and something else has written it; --overwrite replaces it")
    if writer != identity:
        another = f"another collection has written it, not that of {store}"
        raise FileExistsError(f"{path} is there, and {another}; --overwrite replaces it")


def _collect(arguments: argparse.Namespace) -> int:
    place = _check_outputs(arguments)
    found = plans.look_in(arguments.folder)
    plan = _plan(arguments, found)
    if arguments.camera is not None:
        _check_camera(plan)
    _check_replaced(arguments, place, plan)
    _stop_on_signals()  # here, since pycolmap has put its own in their places
    if arguments.hdf5:
        from .collection import hdf5

        hdf5.check_names(plan.images)
    progress = None if arguments.quiet or not sys.stderr.isatty() else _progress
    open_store = collection.Store.create
    if (arguments.resume or arguments.update) and collection.Store.is_there(place):
        open_store = collection.Store.update if arguments.update else collection.Store.resume
    with contextlib.ExitStack() as open_things:
        # workers that cannot be had leave no store behind
        workers: Processes | Dask
        if arguments.dask:
            workers = Dask(open_things.enter_context(errors.extra("distributed", "dask").Client(arguments.dask)))
        else:
            workers = Processes(arguments.jobs)
        with _named(place):
            store = open_things.enter_context(open_store(place, plan))
            summary = collection.collect(plan, store, workers, progress)
        _write(arguments, store)
    print("\n".join([str(summary), *_left_out(found)]))
    return 1 if summary.failed_images or summary.failed_pairs or found.misnamed or found.dangling else 0


class _Stopped(KeyboardInterrupt):
    """A signal that ends the run."""


def _stop_on_signals() -> None:
    def stop(number: int, _: Any) -> None:
        raise _Stopped(number)

    for name in ("SIGTERM", "SIGHUP"):  # not every system has the second one
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), stop)


def main(words: Sequence[str] | None = None) -> int:
    """Exit code 0: everything was done; 1: some inputs failed, the others are done; 2: wrong usage, or the work cannot be done; 128
    and the number of the signal that has ended it."""
    arguments = _parser().parse_args(words)
    _stop_on_signals()
    try:
        return _collect(arguments)
    except KeyboardInterrupt as stopped:
        print("interrupted; --resume goes on", file=sys.stderr)
        return 128 + (stopped.args[0] if isinstance(stopped, _Stopped) else signal.SIGINT)
    except (errors.Error, collection.StoreError, OSError, ValueError, ImportError, sqlite3.Error) as bad:
        print(f"python -m asj: {bad}".encode("utf-8", "backslashreplace").decode(), file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
