# SPDX-License-Identifier: BSD-2-Clause
"""The pictures that detectors are asked to work on: photographs in grey, zoomed, blurred, noisy, compressed, brightened."""
import os
import threading
from dataclasses import dataclass

import cv2
import numpy as np

from . import criteria

FACTORS = (1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3)


def read_gray(path):
    """Luma as the library computes it from 8-bit colour."""
    b, g, r = cv2.split(cv2.imread(path, cv2.IMREAD_COLOR).astype(np.int32))
    return ((77 * r + 150 * g + 29 * b + 128) >> 8).astype(np.uint8)


def _averages(values, count):
    """Rows averaged into `count`: areas as tests/synth/resample.c weighs them."""
    n = len(values)
    scale = n / count
    low, high = np.arange(count) * scale, (np.arange(count) + 1) * scale
    k = np.arange(n)
    weights = np.maximum(np.minimum(high[:, None], k + 1.0) - np.maximum(low[:, None], k), 0)
    return weights @ values / scale


def zoom(gray, factor):
    """(scaled copy, its Zoom)"""
    h, w = gray.shape
    new_w, new_h = int(np.floor(factor * w + 0.5)), int(np.floor(factor * h + 0.5))
    if factor == 1.0:
        return gray, criteria.Zoom()
    wide = _averages(gray.astype(float).T, new_w).T
    return np.floor(_averages(wide, new_h) + 0.5).astype(np.uint8), criteria.Zoom(new_w / w, new_h / h)


def blur(gray, sigma):
    return cv2.GaussianBlur(gray, (0, 0), sigma, borderType=cv2.BORDER_REPLICATE)


def noise(gray, sd):
    return to_bytes(gray + sd * np.random.default_rng(1).standard_normal(gray.shape))


def jpeg(gray, quality):
    return cv2.imdecode(cv2.imencode(".jpg", gray, [cv2.IMWRITE_JPEG_QUALITY, quality])[1], cv2.IMREAD_GRAYSCALE)


def gain(gray, factor):
    return to_bytes(gray * factor)


def to_bytes(values):
    return np.clip(np.floor(values + 0.5), 0, 255).astype(np.uint8)


# name of the change -> (its levels, what it does, unit)
CHANGES = {
    "blur": ((0.5, 1.0, 1.5, 2.0), blur, "px"),
    "noise": ((2, 5, 10, 20), noise, "grey levels"),
    "JPEG": ((90, 70, 50, 30), jpeg, "quality"),
    "gain": ((0.25, 0.5, 0.75, 1.25), gain, "factor"),
}


@dataclass
class Picture:
    """A photograph in grey and its changed copies, written as PNG: KEY.png, KEY.zoom-0.9.png, KEY.blur-1.0.png, ..."""
    key: str
    source: str
    folder: str

    def _write(self, name, pixels):
        path = os.path.join(self.folder, name + ".png")
        if not os.path.exists(path):
            os.makedirs(self.folder, exist_ok=True)
            mine = os.path.join(self.folder, "%s.%d.png" % (name, threading.get_ident()))
            cv2.imwrite(mine, pixels)
            os.replace(mine, path)   # whole, whoever else reads or writes it
        return path

    def original(self):
        path = os.path.join(self.folder, self.key + ".png")
        return path if os.path.exists(path) else self._write(self.key, read_gray(self.source))

    def zoomed(self, factor):
        """(path, Zoom)"""
        gray = cv2.imread(self.original(), cv2.IMREAD_GRAYSCALE)
        pixels, change = zoom(gray, factor)
        return (self.original() if factor == 1.0 else self._write("%s.zoom-%.1f" % (self.key, factor), pixels)), change

    def copies(self, kind):
        """All copies of one kind, "zoom" or one of CHANGES: (level, path, Zoom)"""
        if kind == "zoom":
            return [(f,) + self.zoomed(f) for f in FACTORS]
        return [(v,) + self.changed(kind, v) for v in CHANGES[kind][0]]

    def changed(self, kind, level):
        """(path, Zoom)"""
        path = os.path.join(self.folder, "%s.%s-%g.png" % (self.key, kind.lower(), level))
        if not os.path.exists(path):
            pixels = CHANGES[kind][1](cv2.imread(self.original(), cv2.IMREAD_GRAYSCALE), level)
            cv2.imwrite(path, pixels)
        return path, criteria.Zoom()
