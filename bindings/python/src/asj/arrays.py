# SPDX-License-Identifier: BSD-2-Clause
"""Arrays of C structs as numpy arrays: the same memory, no copies. The fields come from the library's own headers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._native import ffi

_NUMBERS = {
    "float": "f4", "double": "f8", "int32_t": "i4", "uint32_t": "u4", "uint16_t": "u2", "int16_t": "i2", "uint8_t": "u1",
    "uint64_t": "u8", "int64_t": "i8",
}  # fmt: skip


def struct_type(name: str) -> np.dtype[Any]:
    """The numpy type of a C struct, for instance "asj_branch"."""
    return _type_of(ffi.typeof(name))


def _type_of(ctype: Any) -> np.dtype[Any]:
    if ctype.kind == "primitive":
        return np.dtype(_NUMBERS[ctype.cname])
    if ctype.kind == "array":
        return np.dtype((_type_of(ctype.item), (ctype.length,)))
    return np.dtype({
        "names": [name for name, _ in ctype.fields],
        "formats": [_type_of(field.type) for _, field in ctype.fields],
        "offsets": [field.offset for _, field in ctype.fields],
        "itemsize": ffi.sizeof(ctype),
    })


class _Memory:
    """Memory of the library with the object that owns it: numpy keeps this object, and so the owner, as the base of the array."""

    def __init__(self, pointer: Any, shape: tuple[int, ...], dtype: np.dtype[Any], owner: object) -> None:
        self.owner = owner
        self.__array_interface__ = {
            "version": 3,
            "shape": shape,
            "typestr": dtype.str,
            "descr": dtype.descr if dtype.names is None else [("", f"|V{dtype.itemsize}")],
            "data": (int(ffi.cast("uintptr_t", pointer)), True),
        }


def view(pointer: Any, count: int, name: str, owner: object) -> NDArray[Any]:
    """`count` structs of type `name` from `pointer` on, read-only. They stay valid as long as the array does."""
    dtype = struct_type(name)
    if count == 0:
        return np.zeros(0, dtype)
    raw = np.asarray(_Memory(pointer, (count,), np.dtype(f"V{dtype.itemsize}"), owner))
    return raw.view(dtype)


def pointer(records: NDArray[Any], name: str) -> Any:
    """The structs of an array as C sees them; NULL when there are none. Valid as long as the array is."""
    if len(records) == 0:
        return ffi.NULL
    return ffi.cast(f"{name} *", records.ctypes.data)


def columns(records: NDArray[Any], first: str, shape: tuple[int, ...], dtype: str = "f4") -> NDArray[Any]:
    """Neighbouring fields of equal type as one plain array, field `first` and those behind it: (N, *shape). No copy."""
    element = np.dtype(dtype)
    offset = 0 if records.dtype.fields is None else int(records.dtype.fields[first][1])
    strides = [int(records.strides[0])]
    inner: list[int] = []
    step = element.itemsize
    for size in reversed(shape):
        inner.insert(0, step)
        step *= size
    if len(records) == 0:
        return np.zeros((0, *shape), element)
    plain = np.lib.stride_tricks.as_strided(
        records.view(np.dtype(f"V{records.dtype.itemsize}")).view("u1"), shape=(len(records) * records.dtype.itemsize,), strides=(1,),
        writeable=False,
    )
    result: NDArray[Any] = np.ndarray((len(records), *shape), element, plain, offset, (*strides, *inner))
    result.flags.writeable = False
    return result
