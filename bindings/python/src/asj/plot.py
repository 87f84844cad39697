# SPDX-License-Identifier: BSD-2-Clause
"""Pictures with matplotlib, which is only needed here."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .errors import ImageError, extra
from .features import Features
from .matches import Matches

# The colours of asj-cli's plots: lightness falls all the way (cli/plot_color.c).
_RAMP = ("#f4b00c", "#fb8b09", "#f9653b", "#e44a65", "#c63983", "#a1309a", "#772ba7", "#4a27a8", "#08259b")
_SURE = 100  # -log10 NFA


def _axes(axes: Any, width: float, height: float) -> Any:
    if axes is not None:
        return axes
    figure = extra("matplotlib.pyplot", "plot").figure(figsize=(width / 100, height / 100), dpi=100)
    return figure.add_axes((0, 0, 1, 1))  # a pixel of the image is one of the figure


def _show(axes: Any, image: ArrayLike) -> None:
    pixels = np.asarray(image)
    axes.imshow(pixels, cmap="gray" if pixels.ndim == 2 else None, interpolation="nearest")
    axes.set_axis_off()
    axes.set_autoscale_on(False)  # the picture's own frame, whatever is drawn


def plot(image: ArrayLike, features: Features, axes: Any = None) -> Any:
    """Junctions as dots and branches to their ends over the image, from orange (barely) to dark blue (log10 NFA of -100 and less).

    Returns matplotlib's axes.
    """
    colours = extra("matplotlib.colors", "plot").LinearSegmentedColormap.from_list("asj", _RAMP)
    pixels = _pixels(image)
    axes = _axes(axes, pixels.shape[1], pixels.shape[0])
    _show(axes, _colour(pixels) if pixels.ndim == 3 else pixels)
    sure = -features.log10_nfa
    collection = extra("matplotlib.collections", "plot").LineCollection
    axes.add_collection(
        collection(list(features.segments), array=sure[features.branches["junction"]], cmap=colours, linewidths=1, clim=(0, _SURE))
    )
    axes.scatter(features.xy[:, 0], features.xy[:, 1], s=9, c=sure, cmap=colours, vmin=0, vmax=_SURE)
    return axes


def plot_matches(image1: ArrayLike, image2: ArrayLike, matches: Matches, axes: Any = None) -> Any:
    """Both images side by side, their matched corners joined by a line and of one colour, by place in the first image.

    Returns matplotlib's axes.
    """
    collection = extra("matplotlib.collections", "plot").LineCollection
    one, two = (_colour(image) for image in (image1, image2))
    canvas = np.full((max(len(one), len(two)), one.shape[1] + two.shape[1], 3), 255, np.uint8)
    canvas[: len(one), : one.shape[1]] = one
    canvas[: len(two), one.shape[1] :] = two
    axes = _axes(axes, canvas.shape[1], canvas.shape[0])
    _show(axes, canvas)
    colour = 0.85 * matches.matches["x1"] / one.shape[1]  # of the circle of hues, so that left and right are not both red
    shift = np.array([one.shape[1], 0])
    corners = [np.stack([matches.matches["x" + side], matches.matches["y" + side]], 1) for side in "12"]
    corners[1] = corners[1] + shift
    axes.add_collection(collection(list(np.stack(corners, 1)), array=colour, cmap="hsv", clim=(0, 1), linewidths=0.5, alpha=0.4))
    for side, offset, centre in zip("12", (0 * shift, shift), corners):
        for end in "ab":
            tip = np.stack([matches.matches[f"{end}x{side}"], matches.matches[f"{end}y{side}"]], 1) + offset
            axes.add_collection(collection(list(np.stack([centre, tip], 1)), array=colour, cmap="hsv", clim=(0, 1), linewidths=1.2))
        axes.scatter(centre[:, 0], centre[:, 1], s=9, c=colour, cmap="hsv", vmin=0, vmax=1)
    return axes


def _pixels(image: ArrayLike) -> Any:
    pixels = np.asarray(image)
    if pixels.ndim not in (2, 3) or pixels.dtype.kind not in "uifb":
        raise ImageError(f"not an array of pixels: {image!r:.60}")
    return pixels


def _colour(image: ArrayLike) -> Any:
    pixels = _pixels(image)
    if pixels.dtype != np.uint8:
        top = float(pixels.max()) or 1.0
        pixels = (pixels / (top if pixels.dtype.kind != "f" else max(top, 1.0)) * 255).astype(np.uint8)
    return pixels[..., :3] if pixels.ndim == 3 else np.repeat(pixels[:, :, None], 3, 2)
