# SPDX-License-Identifier: BSD-2-Clause
"""Options as keywords, checked against the library's own table."""

from __future__ import annotations

import difflib
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from ._native import ffi, lib
from .errors import OptionError, as_bytes, error, text


_IMAGE_GROUPS = ("frames of L-junctions", "description")


@dataclass(frozen=True)
class OptionInfo:
    """One row of an option table."""

    key: str
    unit: str
    help: str
    minimum: float
    maximum: float
    choices: tuple[str, ...]
    group: str
    presets: Mapping[str, str] = field(hash=False)
    """Its value in each preset, as text: ``{"default": "0", ...}``."""


class _Table:
    """The options of the detector or of the matcher."""

    def __init__(self, what: str, struct: str, count: Any, row: Any, preset: Any, set_: Any, get: Any) -> None:
        self.what, self.struct = what, struct
        self._preset, self._set, self._get = preset, set_, get
        table = [row(i) for i in range(count())]
        self.keys = [text(info.key) for info in table]
        values = {name: self.values(self.fill(name, {})) for name in PRESETS}
        self.rows = [_info(info, MappingProxyType({name: of[text(info.key)] for name, of in values.items()})) for info in table]
        self._image_keys = [info.key for info in self.rows if info.group in _IMAGE_GROUPS or info.key in ("neighbours", "separation")]

    def fill(self, preset: str, values: Mapping[str, object], keywords: Sequence[str] = ()) -> Any:
        """A C struct with the preset's values and those given. keywords: what else the function takes, for the hint when a name is
        mistyped."""
        if preset not in PRESETS:
            raise OptionError(f"there is no preset {preset!r}{_like(str(preset), PRESETS)}: one of {', '.join(PRESETS)}")
        options = ffi.new(f"{self.struct} *")
        status = self._preset(options, PRESETS[preset])
        if status != lib.ASJ_OK:
            raise error(status, f"the {self.what} has no preset {preset!r}")
        for key, value in values.items():
            self._assign(options, key, value, keywords)
        return options

    def of_an_image(self, options: Any) -> tuple[str, ...]:
        """The values of the matcher's options that concern one image alone (asj_features_create())."""
        return tuple(self._value(options, key) for key in self._image_keys)

    def _assign(self, options: Any, key: str, value: object, keywords: Sequence[str]) -> None:
        message = ffi.new("char[512]")
        status = self._set(options, as_bytes(key, "an option"), as_bytes(_written(value), key), message, 512)
        said = text(message)
        if status != lib.ASJ_OK:
            hint = "" if key in self.keys else _elsewhere(self, key) or _like(key, [*self.keys, *keywords])
            raise error(status, (said or f"there is no option {key!r}") + hint)
        if said:
            warnings.warn(said, DeprecationWarning, stacklevel=5)

    def values(self, options: Any) -> dict[str, str]:
        """All options as text."""
        return {key: self._value(options, key) for key in self.keys}

    def _value(self, options: Any, key: str) -> str:
        room = ffi.new("char[256]")
        status = self._get(options, key.encode(), room, 256)
        if status != lib.ASJ_OK:
            raise error(status, f"{key}: no value")
        return text(room)


def _info(row: Any, presets: Mapping[str, str]) -> OptionInfo:
    choices = []
    if row.choices != ffi.NULL:
        i = 0
        while row.choices[i] != ffi.NULL:
            choices.append(text(row.choices[i]))
            i += 1
    group = text(row.group)
    return OptionInfo(text(row.key), text(row.unit), text(row.help), row.minimum, row.maximum, tuple(choices), group, presets)


def _written(value: object) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    if isinstance(value, str):
        return value
    if isinstance(value, (bytes, bytearray)):
        raise OptionError(f"{value!r} is no value of an option: text is str here")
    if isinstance(value, Iterable):
        return ",".join(str(radius) for radius in value)  # what is no whole number the library refuses by name
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    return str(value)


def _like(word: str, words: Iterable[str]) -> str:
    close = difflib.get_close_matches(word.replace("-", "_"), list(words), 2)
    return f"; did you mean {' or '.join(close)}?" if close else ""


def _elsewhere(table: _Table, key: str) -> str:
    """Where an option belongs that this table has not."""
    other, function = (MATCHER, "match") if table is DETECTOR else (DETECTOR, "detect")
    return f": it is one of asj.{function}()" if key in other.keys else ""


PRESETS: dict[str, int] = {
    name.removeprefix("ASJ_PRESET_").lower(): getattr(lib, name) for name in dir(lib) if name.startswith("ASJ_PRESET_")
}
DETECTOR = _Table("detector", "asj_detect_options", lib.asj_detect_option_count, lib.asj_detect_option,
                  lib.asj_detect_options_preset, lib.asj_detect_options_set, lib.asj_detect_options_get)  # fmt: skip
MATCHER = _Table("matcher", "asj_match_options", lib.asj_match_option_count, lib.asj_match_option,
                 lib.asj_match_options_preset, lib.asj_match_options_set, lib.asj_match_options_get)  # fmt: skip


def detect_options() -> list[OptionInfo]:
    """The options of :func:`asj.detect`, with their ranges and what they are in each preset.

    >>> next(o.unit for o in detect_options() if o.key == "minimum_length")
    'px'
    >>> next(o.presets["default"] for o in detect_options() if o.key == "octaves")
    '16'
    """
    return list(DETECTOR.rows)


def match_options() -> list[OptionInfo]:
    """The options of :func:`asj.match`, with their ranges and what they are in each preset."""
    return list(MATCHER.rows)
