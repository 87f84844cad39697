# SPDX-License-Identifier: BSD-2-Clause
"""Two-view geometry: what relates the two images of a match."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._native import lib
from .errors import ArgumentError, OptionError, text

Camera = Union[float, Sequence[float], NDArray[Any]]
MODELS = {
    "none": lib.ASJ_GEOMETRY_NONE,
    "auto": lib.ASJ_GEOMETRY_AUTO,
    "essential": lib.ASJ_GEOMETRY_ESSENTIAL,
    "fundamental": lib.ASJ_GEOMETRY_FUNDAMENTAL,
    "homography": lib.ASJ_GEOMETRY_HOMOGRAPHY,
}


@dataclass(frozen=True)
class Geometry:
    """The geometry of two views. Only with status "accepted" do the other fields hold an answer."""

    #: "accepted", "chance", "too few", "ambiguous", "degenerate"
    status: str
    #: "essential", "fundamental", "homography"
    model: str
    #: (3, 3) homography from image 1 to image 2, or fundamental matrix F with x2' F x1 = 0; pixels, norm 1
    matrix: NDArray[np.float64]
    #: (3, 3) and (3,) with x2 ~ R x1 + t in camera coordinates, |t| = 1; None where they are not known to 10 degrees
    rotation: NDArray[np.float64] | None
    translation: NDArray[np.float64] | None
    #: (6, 6) of w (rad), the true rotation being exp([w]x) times this one, and of the translation; from what the candidates allow,
    #: before the pose was finished from where the matches lie: errors are smaller as a rule, but 1.7 times as large in the median of
    #: thirteen calibrated stereo pairs with some hundred matches each. None as above
    covariance: NDArray[np.float64] | None
    #: (3, 3) rotation of a camera that, as far as matches tell, only turns, and (3, 3) the covariance of w. None: it moves, or nobody knows
    turn: NDArray[np.float64] | None
    turn_covariance: NDArray[np.float64] | None
    #: (2, 4) fx, fy, cx and cy of both cameras, px, given or found; None when they are not known
    cameras: NDArray[np.float64] | None
    #: standard deviation of the log of the focal length, where it was found; else 0
    focal_sd: float
    #: log10 of how often chance brings such a geometry
    log10_nfa: float
    #: sum of the probabilities of the candidates
    inliers: float
    #: how well the images agree between the matches, of what they could: about 1 as well as possible, 0.6 where they know nothing (bare
    #: walls, no plane), 0.3 and less where only corners are alike. None: nobody has looked (model "fundamental")
    picture_agreement: float | None
    #: of the best other geometry, whose matches are others: with status "ambiguous" either may be right. None: there is none
    rival_log10_nfa: float | None
    #: its motion; None where it has none
    rival_rotation: NDArray[np.float64] | None
    rival_translation: NDArray[np.float64] | None

    @property
    def focal(self) -> tuple[float, float]:
        """fx of both cameras, px; 0 when they are not known."""
        return (0.0, 0.0) if self.cameras is None else (float(self.cameras[0, 0]), float(self.cameras[1, 0]))

    def __bool__(self) -> bool:
        return self.status == "accepted"

    def __repr__(self) -> str:
        posed = ", with a pose" if self.rotation is not None else ", the camera only turns" if self.turn is not None else ""
        return f"<asj.Geometry: {self.status}{f', {self.model}, log10 NFA {self.log10_nfa:.1f}{posed}' if self else ''}>"


def fill(
    options: Any, model: str, cameras: Sequence[Camera | None], sizes: Sequence[tuple[int, int]], find_focal: bool, focal_sd: float = 0,
) -> None:  # fmt: skip
    """Sets the geometry of an asj_match_options."""
    if model not in MODELS:
        raise OptionError(f"geometry is {model!r}: one of {', '.join(MODELS)}")
    if model == "none" and any(camera is not None for camera in cameras):
        raise OptionError('a camera changes nothing without geometry="auto" (or another)')
    if find_focal and model not in ("auto", "essential"):
        raise OptionError(f'find_focal needs geometry="auto" or "essential", not {model!r}')
    if cameras[0] is None and cameras[1] is not None:
        raise OptionError("camera2 without camera1")
    if focal_sd and (cameras[0] is None or model not in ("auto", "essential")):
        raise OptionError('focal_sd changes nothing without camera1 and geometry="auto" or "essential"')
    options.geometry.model = MODELS[model]
    options.geometry.find_focal = int(find_focal)
    options.geometry.focal_sd = focal_sd
    for place, camera, (width, height) in zip(options.geometry.cameras, cameras, sizes):
        if camera is not None:
            place.fx, place.fy, place.cx, place.cy = numbers(camera, width, height)


LARGEST_SKEW = 1e-3  # of the focal length: less is no half pixel at the border
LARGEST_LAST = 1e-9  # of what is 0 in the last row: rounding
FARTHEST_CENTRE = 0.25  # of a side, from the middle to the principal point: beyond it few pictures are, but some cut ones
SQUAREST = 1.1  # one focal length over the other: swapped numbers have the ratio of the sides here


def doubt(camera: Sequence[float], width: int, height: int) -> tuple[bool, str]:
    """Whether (fx, fy, cx, cy) cannot be the camera of an image of that size, and what to say about it; nothing where it may be.

    >>> doubt((500, 500, 320, 240), 640, 480), doubt((320, 240, 700, 700), 640, 480)[0], doubt((500, 500, -20, 240), 640, 480)[0]
    ((False, ''), True, False)
    """
    fx, fy, cx, cy = camera

    def is_central(x: float, y: float) -> bool:
        return abs(x - width / 2) <= FARTHEST_CENTRE * width + 0.5 and abs(y - height / 2) <= FARTHEST_CENTRE * height + 0.5

    def is_inside(x: float, y: float) -> bool:
        return -0.5 <= x <= width and -0.5 <= y <= height

    inside, central = is_inside(cx, cy), is_central(cx, cy)
    oblong = max(fx, fy) > SQUAREST * min(fx, fy)
    likely = oblong and is_central(fx, fy) if inside else is_inside(fx, fy)
    swapped = cx > 0 and cy > 0 and likely  # the other order would be a camera, and this one is hardly one
    if central and not swapped:
        return False, ""
    what = (
        "the focal lengths differ"
        if central
        else f"the principal point is {'far from the middle of' if inside else 'outside of'} the image"
    )
    why = "the order is fx,fy,cx,cy - is this cx,cy,fx,fy?" if swapped else "the camera of another size, or before the image was cut?"
    return swapped and not inside, f"{what}: {why} ({fx:g},{fy:g},{cx:g},{cy:g}, image {width} x {height})"


def numbers(camera: ArrayLike, width: int, height: int, stacklevel: int = 4) -> tuple[float, float, float, float]:
    """Focal lengths and principal point of a matrix K of any scale, of (fx, fy, cx, cy), or of a focal length alone. `stacklevel`:
    of a warning about a principal point, so that it names the line of the user."""
    values = np.asarray(camera, np.float64)
    if not np.isfinite(values).all():
        raise ArgumentError("a camera must have finite numbers")
    if values.shape == (3, 3):
        values = values / values[2, 2] if values[2, 2] else values
        if not np.allclose(values[2], (0, 0, 1), rtol=0, atol=LARGEST_LAST):
            raise ArgumentError(
                f"the last row of a matrix K is (0, 0, 1), not ({', '.join(f'{number:g}' for number in values[2])}): is it transposed?"
            )
        if abs(values[1, 0]) > LARGEST_SKEW * abs(values[1, 1]):
            raise ArgumentError(f"a matrix K has 0 in the first column of its second row, not {values[1, 0]:g}")
        if abs(values[0, 1]) > LARGEST_SKEW * abs(values[0, 0]):
            raise ArgumentError("a camera with skew: undistort the image, or leave the skew out")
        numbers = [values[0, 0], values[1, 1], values[0, 2], values[1, 2]]
    elif values.shape == (4,):
        numbers = values.tolist()
    elif values.shape == ():
        numbers = [float(values), float(values), (width - 1) / 2, (height - 1) / 2]
    else:
        raise ArgumentError(f"a camera of shape {values.shape}: a matrix K (3, 3), (fx, fy, cx, cy), or a focal length in pixels")
    if numbers[0] <= 0 or numbers[1] <= 0:
        raise ArgumentError("a camera must have focal lengths above 0")
    cannot_be, why = doubt([float(number) for number in numbers], width, height)
    if cannot_be:
        raise ArgumentError(why)
    if why:
        warnings.warn(why, stacklevel=stacklevel)
    return float(numbers[0]), float(numbers[1]), float(numbers[2]), float(numbers[3])


def read(record: Any) -> Geometry | None:
    """An asj_geometry; None when none was asked for."""
    if record.status == lib.ASJ_GEOMETRY_NOT_ASKED:
        return None

    def array(field: Any, *shape: int) -> NDArray[np.float64]:
        return np.array(list(field), np.float64).reshape(shape)

    posed, turns = bool(record.has_pose), bool(record.only_turns)
    cameras = np.array([(one.fx, one.fy, one.cx, one.cy) for one in record.cameras], np.float64)
    rival_posed = any(record.rival_translation)
    return Geometry(
        text(lib.asj_geometry_status_name(record.status)), text(lib.asj_geometry_model_name(record.model)), array(record.matrix, 3, 3),
        array(record.rotation, 3, 3) if posed else None, array(record.translation, 3) if posed else None,
        array(record.covariance, 6, 6) if posed else None, array(record.rotation, 3, 3) if turns else None,
        array(record.covariance, 6, 6)[:3, :3] if turns else None, cameras if cameras[0, 0] > 0 else None, record.focal_sd,
        record.log10_nfa, record.inliers, record.picture_agreement or None, record.rival_log10_nfa if record.has_rival else None,
        array(record.rival_rotation, 3, 3) if rival_posed else None, array(record.rival_translation, 3) if rival_posed else None,
    )  # fmt: skip
