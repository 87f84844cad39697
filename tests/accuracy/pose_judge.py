# SPDX-License-Identifier: BSD-2-Clause
"""How far poses and matches of two views are from the truth, for ingredients.py and furnished/score.py."""

import numpy as np


def camera_options(truth):
    """Of asj-cli match: the cameras K1 and K2 (3 x 3) of a pair's truth."""
    return [f"--camera{k}={m[0][0]},{m[1][1]},{m[0][2]},{m[1][2]}" for k, m in ((1, truth["K1"]), (2, truth["K2"]))]


def degrees(cosine):
    return float(np.degrees(np.arccos(np.clip(cosine, -1, 1))))


def errors(rotation, translation, truth):
    """Of the rotation and of the translation's direction, either way, degrees. `truth`: 3 x 4, [R | t]."""
    direction = abs(translation @ truth[:, 3]) / np.linalg.norm(translation) / np.linalg.norm(truth[:, 3])
    return degrees((np.trace(rotation.T @ truth[:, :3]) - 1) / 2), degrees(direction)


def area(all_errors, limit):
    """Percent: mean recall up to `limit` degrees; the recall rises linearly from error to error."""
    sorted_errors = np.r_[0, np.sort(all_errors)]
    recall = np.arange(len(sorted_errors)) / len(all_errors)
    below = np.searchsorted(sorted_errors, limit)
    x, y = np.r_[sorted_errors[:below], limit], np.r_[recall[:below], recall[below - 1]]
    return 100 * float(((x[1:] - x[:-1]) * (y[1:] + y[:-1]) / 2).sum()) / limit


def count_right(xy1, xy2, fundamental, limit):
    """Matches within `limit` px of both epipolar lines."""
    if len(xy1) == 0:
        return 0
    points = [np.c_[xy, np.ones(len(xy))] for xy in (xy1.astype(float), xy2.astype(float))]
    lines = [points[1] @ fundamental, points[0] @ fundamental.T]
    off = np.abs((lines[1] * points[1]).sum(axis=1))
    return int((off / np.minimum(*(np.hypot(line[:, 0], line[:, 1]) for line in lines)) < limit).sum())
