# SPDX-License-Identifier: BSD-2-Clause
"""A furnished room seen by a pin-hole camera, painted with Pillow: pictures with exact truth, and no photographs needed.

World: metres, x right, y down (the floor is y = 0, heights are negative), z away from the viewer. A point p has camera coordinates
R (p - position), and pixel f X / Z + (width - 1) / 2, f Y / Z + (height - 1) / 2.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


@dataclass
class Surface:
    """A rectangle in space: origin, two sides at right angles, and what is painted on it in parts of the sides: u0, v0, u1, v1, grey."""

    origin: Vector
    along: Vector
    up: Vector
    grey: float
    box: int = 0  # 0 = the room itself
    paint: list[tuple[float, float, float, float, float]] = field(default_factory=list)

    def corners(self, u0: float = 0, v0: float = 0, u1: float = 1, v1: float = 1) -> NDArray[np.float64]:
        """(4, 3) corners of a part."""
        return np.array([self.origin + u * self.along + v * self.up for u, v in ((u0, v0), (u1, v0), (u1, v1), (u0, v1))])


@dataclass(frozen=True)
class View:
    """A camera."""

    rotation: NDArray[np.float64]
    position: Vector
    focal: float
    width: int
    height: int

    def project(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, 3) points to (N, 2) pixels."""
        seen = (points - self.position) @ self.rotation.T
        return self.focal * seen[:, :2] / seen[:, 2:] + ((self.width - 1) / 2, (self.height - 1) / 2)


def look(position: Any, target: Any, focal: float = 520, width: int = 640, height: int = 480) -> View:
    """A camera at `position` that looks at `target`, upright."""
    position = np.asarray(position, float)
    forward = np.asarray(target, float) - position
    forward /= np.linalg.norm(forward)
    right = np.cross((0.0, 1.0, 0.0), forward)
    right /= np.linalg.norm(right)
    return View(np.stack([right, np.cross(forward, right), forward]), position, focal, width, height)


def make(seed: int = 1) -> list[Surface]:
    """A room of 5 x 4 x 2.7 m with pictures, shelves and boxes; another one for every seed."""
    random = np.random.default_rng(seed)

    def surface(origin: Any, along: Any, up: Any, grey: float, panels: int, box: int = 0) -> Surface:
        made = Surface(*(np.asarray(v, float) for v in (origin, along, up)), grey, box)
        for _ in range(panels):
            u, v = random.uniform(0.03, 0.75, 2)
            made.paint.append((u, v, u + random.uniform(0.06, 0.2), v + random.uniform(0.08, 0.22), random.uniform(35, 225)))
        return made

    room = [
        surface((-2.5, 0, 4), (5, 0, 0), (0, -2.7, 0), 170, 22),  # the wall in front
        surface((-2.5, 0, -1), (0, 0, 5), (0, -2.7, 0), 135, 14),
        surface((2.5, 0, 4), (0, 0, -5), (0, -2.7, 0), 150, 14),
        surface((-2.5, 0, -1), (5, 0, 0), (0, 0, 5), 95, 8),  # the floor
        surface((-2.5, -2.7, 4), (5, 0, 0), (0, 0, -5), 205, 5),
    ]
    for box in range(1, 6):
        x, z = -2.7 + 0.85 * box + random.uniform(0, 0.2), random.uniform(1.9, 3.1)
        wide, deep, high = random.uniform(0.3, 0.6, 3)
        grey = random.uniform(50, 210)
        room += [
            surface((x, 0, z), (wide, 0, 0), (0, -high, 0), grey, 3, box),
            surface((x, 0, z + deep), (0, 0, -deep), (0, -high, 0), 0.75 * grey, 2, box),
            surface((x + wide, 0, z), (0, 0, deep), (0, -high, 0), 0.85 * grey, 2, box),
            surface((x, -high, z), (wide, 0, 0), (0, 0, deep), min(1.15 * grey, 235), 1, box),
        ]
    return room


def _outline(view: View, corners: NDArray[np.float64], near: float = 0.05) -> list[tuple[float, float]]:
    """A polygon in the picture, without what lies behind the camera."""
    seen = (corners - view.position) @ view.rotation.T
    kept: list[NDArray[np.float64]] = []
    for one, two in zip(seen, np.roll(seen, -1, axis=0)):
        if one[2] >= near:
            kept.append(one)
        if (one[2] >= near) != (two[2] >= near):
            kept.append(one + (near - one[2]) / (two[2] - one[2]) * (two - one))
    return [(view.focal * x / z + (view.width - 1) / 2, view.focal * y / z + (view.height - 1) / 2) for x, y, z in kept]


def render(room: list[Surface], view: View, samples: int = 6, noise: float = 1.5, seed: int = 0) -> NDArray[np.uint8]:
    """The picture: samples x samples points a pixel, the farthest things first, and noise."""
    from PIL import Image, ImageDraw

    fine = Image.new("L", (samples * view.width, samples * view.height))
    draw = ImageDraw.Draw(fine)

    def fill(corners: NDArray[np.float64], grey: float) -> None:
        outline = [((x + 0.5) * samples - 0.5, (y + 0.5) * samples - 0.5) for x, y in _outline(view, corners)]
        if len(outline) > 2:
            draw.polygon([(round(x), round(y)) for x, y in outline], fill=round(grey))

    def far(s: Surface) -> float:
        middle = np.mean([other.corners().mean(axis=0) for other in room if other.box == s.box], axis=0)
        return float("inf") if s.box == 0 else float(np.linalg.norm(middle - view.position))

    for s in sorted(room, key=far, reverse=True):
        if s.box and np.cross(s.along, s.up) @ (view.position - s.origin) < 0:
            continue  # the back of a side
        fill(s.corners(), s.grey)
        for *part, grey in s.paint:
            fill(s.corners(*part), grey)
    picture = np.asarray(fine.reduce(samples), np.float64)
    picture = picture + np.random.default_rng(seed).normal(0, noise, picture.shape)
    return np.clip(np.rint(picture), 0, 255).astype(np.uint8)


def walk(count: int) -> list[View]:
    """Views on a curve through the room."""
    t = np.linspace(-1, 1, count)
    return [look((1.3 * s, -1.5 + 0.15 * np.cos(5 * s), -0.6 + 0.5 * np.cos(1.5 * s)), (0.35 * s, -1.0, 3.2)) for s in t]
