#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""The shared library from another language: plain structs and calls through ctypes.  test_ctypes.py LIBRARY"""
import ctypes as c
import math
import sys


class Image(c.Structure):
    _fields_ = [("data", c.c_void_p), ("format", c.c_int32), ("width", c.c_int32), ("height", c.c_int32),
                ("white", c.c_float), ("stride", c.c_ssize_t)]


class Branch(c.Structure):
    _fields_ = [(name, c.c_float) for name in ("angle", "length", "strength", "log10_nfa", "angle_sd", "width", "length_sd")] + \
               [("end", c.c_int32)]


class Junction(c.Structure):
    _fields_ = [(name, c.c_float) for name in ("x", "y", "scale", "log10_nfa", "location_sd")] + \
               [("branch_count", c.c_int32), ("octave", c.c_int32), ("branches", Branch * 5)]


class Detection(c.Structure):
    _fields_ = [("junctions", c.POINTER(Junction)), ("l_junctions", c.c_void_p), ("junction_count", c.c_uint32),
                ("l_junction_count", c.c_uint32), ("width", c.c_int32), ("height", c.c_int32)]  # and more, not read here


def main():
    asj = c.CDLL(sys.argv[1])
    asj.asj_version_string.restype = c.c_char_p
    asj.asj_status_string.restype = c.c_char_p
    asj.asj_context_message.restype = c.c_char_p
    asj.asj_context_message.argtypes = [c.c_void_p]
    assert asj.asj_version_string().count(b".") == 2
    assert asj.asj_status_string(0) == b"success"

    context = c.c_void_p()
    assert asj.asj_context_create(None, c.byref(context)) == 0
    width, height = 120, 90
    pixels = bytes(200 if x > 50 and y > 40 else 60 for y in range(height) for x in range(width))
    image = Image(c.cast(c.c_char_p(pixels), c.c_void_p), 1, width, height, 0.0, 0)
    found = c.POINTER(Detection)()
    assert asj.asj_detect(context, c.byref(image), None, c.byref(found)) == 0
    result = found.contents
    assert (result.width, result.height) == (width, height)
    assert result.junction_count == 1 and result.l_junction_count == 1, result.junction_count
    junction = result.junctions[0]
    assert abs(junction.x - 50.5) < 0.3 and abs(junction.y - 40.5) < 0.3, (junction.x, junction.y)
    angles = [junction.branches[i].angle for i in range(junction.branch_count)]
    assert len(angles) == 2, angles
    for wanted in (0, math.pi / 2):  # to the right and down
        assert any(abs(math.remainder(angle - wanted, 2 * math.pi)) < 0.02 for angle in angles), angles
    asj.asj_detection_free(c.byref(found))
    assert not found

    image.width = 0
    assert asj.asj_detect(context, c.byref(image), None, c.byref(found)) == -3
    assert b"0 x 90" in asj.asj_context_message(context)
    asj.asj_context_free(c.byref(context))
    assert not context
    print("ctypes:", asj.asj_version_string().decode())


main()
