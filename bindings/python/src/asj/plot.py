# SPDX-License-Identifier: BSD-2-Clause
"""Pictures with matplotlib, which is only needed here."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import ArgumentError, ImageError, extra
from .features import Features, expect_features
from .images import as_array
from .matches import Matches

# The colours of asj-cli's plots: lightness falls all the way (cli/plot_color.c).
_RAMP = ("#f4b00c", "#fb8b09", "#f9653b", "#e44a65", "#c63983", "#a1309a", "#772ba7", "#4a27a8", "#08259b")
_SURE = 100  # -log10 NFA
_LEGEND = 1.7, 0.36  # inches
_CONTRAST = 0.45  # of a pale photograph, towards white: dark enough to see the room, light enough for the colours
_WHEEL = (
    "#e23439", "#c85d02", "#ab7302", "#928103", "#6c8e03", "#059a46", "#07957c", "#009298", "#098db2", "#0683df", "#616bfa", "#9657e8",
    "#bb46c3",
)  # fmt: skip
_TURN = 0.6180339887498949  # of the hues from one match to the next: the golden section keeps any few in a row apart


def _axes(axes: Any, width: float, height: float) -> Any:
    if axes is not None:
        return axes
    figure = extra("matplotlib.pyplot", "plot").figure(figsize=(width / 100, height / 100), dpi=100)
    return figure.add_axes((0, 0, 1, 1))  # a pixel of the image is one of the figure


def _show(axes: Any, image: ArrayLike) -> None:
    pixels = as_array(image)
    axes.imshow(pixels, cmap="gray" if pixels.ndim == 2 else None, interpolation="nearest")
    axes.set_axis_off()
    axes.set_autoscale_on(False)  # the picture's own frame, whatever is drawn


def _legend(axes: Any, colours: Any) -> None:
    """A bar of what the colours mean, in the lower left corner of the picture, where that has room for it."""
    width, height = np.array(_LEGEND) * axes.figure.dpi / axes.get_window_extent().size
    if width > 0.6 or height > 0.3:
        return
    box = axes.inset_axes((0.01, 0.01, width, height), zorder=9, xticks=[], yticks=[], facecolor=(1, 1, 1, 0.8))
    bar = box.inset_axes((0.06, 0.66, 0.88, 0.24))
    bar.imshow(np.linspace(0, 1, 256)[None], cmap=colours, aspect="auto", extent=(0, _SURE, 0, 1))
    bar.set(yticks=[], xticks=[0, _SURE / 2, _SURE], xticklabels=["0", f"-{_SURE // 2}", f"-{_SURE} and less"])
    bar.get_xticklabels()[-1].set_horizontalalignment("right")
    bar.tick_params(labelsize=6, length=2, pad=1)
    bar.set_xlabel("log10 NFA", fontsize=6, labelpad=0)


def plot(image: ArrayLike, features: Features, axes: Any = None, legend: bool = True, pale: bool = True) -> Any:
    """Junctions as dots and branches to their ends over the image, each from orange (barely) to dark blue (log10 NFA of -100 and less),
    which the `legend` says where there is room for it; the surest lie on top.

    The image is `pale` and grey, as in asj-cli's plots; otherwise in its own colours, on which dark ones of the branches may be hard to
    see. Returns matplotlib's axes.
    """
    expect_features(features, "asj.plot(image, asj.detect(image))")
    colours = extra("matplotlib.colors", "plot").LinearSegmentedColormap.from_list("asj", _RAMP)
    pixels = _pixels(image)
    axes = _axes(axes, pixels.shape[1], pixels.shape[0])
    _show(axes, _pale(pixels) if pale else _colour(pixels) if pixels.ndim == 3 else pixels)
    collection = extra("matplotlib.collections", "plot").LineCollection
    segments, sure = list(features.segments[::-1]), -features.branches["log10_nfa"][::-1]
    axes.add_collection(collection(segments, array=sure, cmap=colours, linewidths=1, clim=(0, _SURE)))
    x, y = features.xy[::-1].T
    axes.scatter(x, y, s=9, c=-features.log10_nfa[::-1], cmap=colours, vmin=0, vmax=_SURE)
    if legend:
        _legend(axes, colours)
    return axes


def plot_matches(image1: ArrayLike, image2: ArrayLike, matches: Matches, axes: Any = None) -> Any:
    """Both images side by side, their matched corners joined by a line and of one colour: the hues in turn, from left to right in the first
    image, so that neighbours differ.

    Returns matplotlib's axes.
    """
    if not isinstance(matches, Matches):
        raise ArgumentError(f"matches are wanted, not {type(matches).__name__}: asj.plot_matches(image1, image2, asj.match(f1, f2))")
    collection = extra("matplotlib.collections", "plot").LineCollection
    one, two = (_colour(image) for image in (image1, image2))
    canvas = np.full((max(len(one), len(two)), one.shape[1] + two.shape[1], 3), 255, np.uint8)
    canvas[: len(one), : one.shape[1]] = one
    canvas[: len(two), one.shape[1] :] = two
    axes = _axes(axes, canvas.shape[1], canvas.shape[0])
    _show(axes, canvas)
    colour = _hues(matches.matches["x1"])
    hues = extra("matplotlib.colors", "plot").LinearSegmentedColormap.from_list("asj-order", _WHEEL)
    shift = np.array([one.shape[1], 0])
    corners = [np.stack([matches.matches["x" + side], matches.matches["y" + side]], 1) for side in "12"]
    corners[1] = corners[1] + shift
    axes.add_collection(collection(list(np.stack(corners, 1)), array=colour, cmap=hues, clim=(0, 1), linewidths=0.5, alpha=0.4))
    for side, offset, centre in zip("12", (0 * shift, shift), corners):
        for end in "ab":
            tip = np.stack([matches.matches[f"{end}x{side}"], matches.matches[f"{end}y{side}"]], 1) + offset
            axes.add_collection(collection(list(np.stack([centre, tip], 1)), array=colour, cmap=hues, clim=(0, 1), linewidths=1.2))
        axes.scatter(centre[:, 0], centre[:, 1], s=9, c=colour, cmap=hues, vmin=0, vmax=1)
    return axes


def _hues(x: NDArray[Any]) -> NDArray[np.float64]:
    """Places among the hues, by rank.

    >>> _hues(np.array([30.0, 10.0, 20.0])).round(2).tolist()
    [0.24, 0.0, 0.62]
    """
    hues = np.empty(len(x))
    hues[np.argsort(x, kind="stable")] = np.arange(len(x)) * _TURN % 1
    return hues


def _pale(pixels: Any) -> Any:
    """Grey, BT.601, and nearer to white.

    >>> _pale(np.array([[[0, 0, 0], [255, 255, 255]]], np.uint8))[0].tolist()
    [[140, 140, 140], [255, 255, 255]]
    """
    grey = _colour(pixels).astype(float) @ (0.299, 0.587, 0.114)
    return np.repeat(np.rint(255 - _CONTRAST * (255 - grey)).astype(np.uint8)[:, :, None], 3, 2)


def _pixels(image: ArrayLike) -> Any:
    """Of the shapes that asj.detect() takes; HxWx1 as HxW."""
    pixels = as_array(image)
    if pixels.ndim == 3 and pixels.shape[2] == 1:
        pixels = pixels[:, :, 0]
    if pixels.dtype.kind not in "uifb" or pixels.ndim not in (2, 3) or pixels.shape[2:] not in ((), (3,), (4,)):
        raise ImageError(f"not an array of pixels: {image!r:.60}")
    if not pixels.size:
        raise ImageError(f"an image of {pixels.shape[1]} x {pixels.shape[0]} pixels")
    return pixels


def _colour(image: ArrayLike) -> Any:
    """Red, green and blue in bytes. Up to the brightest sample; floats up to 1, or to the brightest above it; of NaN and infinity nothing.

    >>> _colour(np.array([[0.5, np.nan, -1.0]]))[0, :, 0].tolist()
    [127, 0, 0]
    """
    pixels = _pixels(image)
    if pixels.dtype != np.uint8:
        levels = np.where(np.isfinite(pixels), pixels, 0).astype(float)
        top = float(levels.max())
        top = max(top, 1.0) if pixels.dtype.kind == "f" or top <= 0 else top
        pixels = np.clip(levels / top * 255, 0, 255).astype(np.uint8)
    return pixels[..., :3] if pixels.ndim == 3 else np.repeat(pixels[:, :, None], 3, 2)
