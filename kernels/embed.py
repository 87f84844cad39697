#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Kernels as C: the bytes of every program, its hash, and which kernel stands in which.

embed.py OUTPUT.c CONTRACT.h COMMON.clh PROGRAM.cl...

Arrays of bytes, since C99 promises string literals of 4095 characters only. #line directives make compilers name the files."""
import hashlib
import os
import re
import sys

KERNEL = re.compile(r"\b(?:__)?kernel\s+(?:__attribute__\s*\(\(.*?\)\)\s*)?void\s+(?:__attribute__\s*\(\(.*?\)\)\s*)?(\w+)\s*\(",
                    re.DOTALL)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def read(path):
    with open(path, encoding="ascii") as file:
        return f'#line 1 "{os.path.basename(path)}"\n' + file.read()


def array(name, text):
    data = text.encode("ascii")
    lines = [", ".join(str(byte) for byte in data[i:i + 32]) for i in range(0, len(data), 32)]
    return f"static const char {name}[] = {{\n    " + ",\n    ".join(lines) + "\n};\n"


def main(output, contract_path, common_path, *paths):
    common = read(contract_path) + read(common_path)
    parts = ['#include "cl/source.h"\n', array("common", common)]
    programs, kernels = [], []
    for index, path in enumerate(paths):
        text = read(path)
        name = os.path.splitext(os.path.basename(path))[0]
        found = KERNEL.findall(COMMENT.sub(" ", text))
        if not found:
            sys.exit(f"{path}: no kernel in it")
        digest = hashlib.sha256((common + text).encode("ascii")).hexdigest()
        parts.append(array(f"program_{name}", text))
        programs.append(f'    {{"{name}", {{common, program_{name}}}, {{sizeof common, sizeof program_{name}}},\n     "{digest}"}}')
        kernels += [(kernel, index) for kernel in found]
    names = [name for name, _ in kernels]
    for name in names:
        if names.count(name) > 1:
            sys.exit(f"two kernels are called {name}")
    entries = ",\n".join(f'    {{"{name}", {index}}}' for name, index in kernels)
    parts.append("const asj_cl_source asj_cl_sources[] = {\n" + ",\n".join(programs) + "\n};\n")
    parts.append(f"const int32_t asj_cl_source_count = {len(programs)};\n")
    parts.append("const asj_cl_kernel_name asj_cl_kernel_names[] = {\n" + entries + "\n};\n")
    parts.append(f"const int32_t asj_cl_kernel_count = {len(kernels)};\n")
    with open(output, "w", encoding="ascii") as file:
        file.write("/* SPDX-License-Identifier: BSD-2-Clause */\n/* Made by kernels/embed.py. */\n" + "\n".join(parts))


main(*sys.argv[1:])
