# SPDX-License-Identifier: BSD-2-Clause
"""Anisotropic-scale junctions: corners of indoor images and the straight edges that meet there, found and matched.

>>> import asj, numpy as np
>>> image = np.full((90, 120), 60, np.uint8); image[41:, 51:] = 200
>>> features = asj.detect(image)
>>> features.xy.round(1).tolist()
[[50.5, 40.5]]
"""

from . import errors
from ._native import lib as _lib
from .context import Context, set_current
from .errors import (
    ArgumentError,
    Cancelled,
    DeviceError,
    Error,
    FormatError,
    ImageError,
    LimitError,
    OptionError,
    OutOfMemoryError,
)
from .features import Features, detect, load_features
from .geometry import Geometry
from .images import read as read_image
from .line_segments import Lines, lines
from .matches import Matches, match, match_images
from .options import detect_options, match_options
from .plot import plot, plot_matches
from .vanishing import VanishingPoints, vanishing_points

__version__ = errors.text(_lib.asj_version_string())

__all__ = [
    "ArgumentError", "Cancelled", "Context", "DeviceError", "Error", "Features", "FormatError", "Geometry", "ImageError",
    "LimitError", "Lines", "Matches", "OptionError", "OutOfMemoryError", "VanishingPoints", "detect", "detect_options", "lines",
    "load_features", "match", "match_images", "match_options", "plot", "plot_matches", "read_image", "set_current", "vanishing_points",
]  # fmt: skip
