# SPDX-License-Identifier: BSD-2-Clause
"""Reconstructs rendered rooms with COLMAP, from key points and matches of asj and from COLMAP's own SIFT, and compares both with the
truth: reconstruct.py [--rooms N] [--views N] [--picture FILE]   (needs pycolmap; the picture matplotlib)
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pycolmap
import room
from numpy.typing import NDArray
from PIL import Image

from asj.__main__ import main as asj_main


@dataclass(frozen=True)
class Score:
    """How a reconstruction compares with the truth."""

    views: int
    points: int
    track: float  # mean number of views of a point
    reprojection: float  # px
    centres: float  # mm: root mean square distance of the camera centres, after the similarity that fits them best
    model: Any


def similarity(source: NDArray[np.float64], target: NDArray[np.float64]) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """What moves, turns and scales `source` to fit `target` best (Umeyama 1991)."""
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    u, s, vt = np.linalg.svd(b.T @ a)
    sign = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    scale = np.trace(np.diag(s) @ sign) / (a**2).sum()
    return lambda points: scale * (points - source.mean(axis=0)) @ (u @ sign @ vt).T + target.mean(axis=0)


def score(database: Path, pictures: Path, views: list[room.View], work: Path) -> Score:
    """Incremental mapping with known cameras; the largest model."""
    work.mkdir()
    options = pycolmap.IncrementalPipelineOptions()
    options.ba_refine_focal_length = options.ba_refine_extra_params = False
    options.min_model_size = 3
    options.random_seed = 1
    options.num_threads = 1
    models = pycolmap.incremental_mapping(database, pictures, work, options)
    if not models:
        return Score(0, 0, 0, 0, float("nan"), None)
    best = max(models.values(), key=lambda model: model.num_reg_images())
    images = [image for image in best.images.values() if image.has_pose]
    found = np.array([image.projection_center() for image in images])
    true = np.array([views[int(Path(image.name).stem)].position for image in images])
    apart = np.linalg.norm(similarity(found, true)(found) - true, axis=1)
    return Score(
        len(images), best.num_points3D(), best.compute_mean_track_length(), best.compute_mean_reprojection_error(),
        1000 * float(np.sqrt((apart**2).mean())), best,
    )  # fmt: skip


def set_cameras(path: Path, view: room.View) -> None:
    """The true camera: both methods start from the same."""
    database = pycolmap.Database.open(path)
    for camera in database.read_all_cameras():
        camera.model = pycolmap.CameraModelId.SIMPLE_PINHOLE
        camera.params = [view.focal, view.width / 2, view.height / 2]
        camera.has_prior_focal_length = True
        database.update_camera(camera)
    database.close()


def with_asj(pictures: Path, folder: Path, view: room.View) -> Path:
    """The database of `python -m asj collect`, verified with the true cameras."""
    path = folder / "asj.db"
    if asj_main(["collect", str(pictures), "--colmap", str(path), "--jobs", "1", "--no-verify", "--quiet"]) != 0:
        raise SystemExit("the collection failed")
    set_cameras(path, view)
    pycolmap.geometric_verification(path)
    return path


def with_sift(pictures: Path, folder: Path, view: room.View) -> Path:
    """COLMAP's own way."""
    path = folder / "sift.db"
    reader = pycolmap.ImageReaderOptions(camera_model="SIMPLE_PINHOLE")
    pycolmap.extract_features(path, pictures, reader_options=reader, device=pycolmap.Device.cpu)
    set_cameras(path, view)
    pycolmap.match_exhaustive(path, device=pycolmap.Device.cpu)
    return path


def compare(seed: int, count: int, folder: Path) -> tuple[Score, Score]:
    """One room, both ways."""
    pictures = folder / "pictures"
    pictures.mkdir(parents=True)
    views, things = room.walk(count), room.make(seed)
    for number, view in enumerate(views):
        Image.fromarray(room.render(things, view, seed=100 * seed + number)).save(pictures / f"{number}.png")
    return tuple(  # type: ignore[return-value]
        score(database(pictures, folder, views[0]), pictures, views, folder / f"model-{name}")
        for name, database in (("asj", with_asj), ("sift", with_sift))
    )


def draw(model: Any, views: list[room.View], path: Path) -> None:
    """The sparse model in the room's metres, from above and from the front."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    images = [image for image in model.images.values() if image.has_pose]
    fit = similarity(
        np.array([image.projection_center() for image in images]), np.array([views[int(Path(image.name).stem)].position for image in images])
    )
    points = fit(np.array([point.xyz for point in model.points3D.values() if point.track.length() >= 3]))
    centres = fit(np.array([image.projection_center() for image in images]))
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), dpi=80)
    for axis, (x, y), title in zip(axes, ((0, 2), (0, 1)), ("from above", "from the cameras")):
        axis.scatter(points[:, x], points[:, y], s=4, c=points[:, 2], cmap="viridis")
        axis.plot(centres[:, x], centres[:, y], "r^", markersize=6)
        axis.set(title=title, aspect="equal", xlim=(-2.8, 2.8), ylim=(-1.2, 4.3) if y == 2 else (0.2, -2.9))
    figure.tight_layout()
    figure.savefig(path)


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rooms", type=int, default=5)
    parser.add_argument("--views", type=int, default=7)
    parser.add_argument("--picture", type=Path)
    arguments = parser.parse_args()
    print("| room | method | views | points | track length | reprojection, px | centres, mm |\n| --- | --- | --- | --- | --- | --- | --- |")
    for seed in range(1, arguments.rooms + 1):
        with tempfile.TemporaryDirectory() as folder:
            for method, s in zip(("asj", "SIFT"), compare(seed, arguments.views, Path(folder))):
                print(f"| {seed} | {method} | {s.views} of {arguments.views} | {s.points} | {s.track:.2f} | {s.reprojection:.2f} | {s.centres:.1f} |", flush=True)
                if arguments.picture and seed == 1 and method == "asj":
                    draw(s.model, room.walk(arguments.views), arguments.picture)


if __name__ == "__main__":
    main()
