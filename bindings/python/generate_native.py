# SPDX-License-Identifier: BSD-2-Clause
"""Writes the C source of asj._native from the library's public headers: generate_native.py OUTPUT HEADER_FOLDER

cffi's C parser understands neither the preprocessor nor attributes, so both are taken out; what is left are the headers as they
are. A struct or function that is added to them is there in Python without an edit here.
"""

import re
import sys
from pathlib import Path

import cffi

# In the order in which they include each other.
HEADERS = ["status", "version", "context", "image", "junction", "options", "detect", "field", "device", "geometry", "vanishing",
           "segments", "match", "features"]

CALLBACKS = """
extern "Python" int32_t asj_python_progress(void *user, int32_t stage, double done);
extern "Python" void asj_python_log(void *user, int32_t level, const char *message);
"""


def declarations(text: str) -> str:
    """What cffi needs of a header: no comments, no directives but plain numbers, no attributes."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    text = text.replace("\\\n", " ")
    text = re.sub(r"#ifdef __cplusplus.*?#endif", "", text, flags=re.S)
    kept = []
    for line in text.splitlines():
        number = re.match(r"#define (ASJ_\w+) (0x[0-9a-fA-F]+|-?\d+)\s*$", line)
        if number:
            kept.append(f"#define {number[1]} {number[2]}")
        elif not line.startswith("#"):
            kept.append(line)
    return "\n".join(kept).replace("ASJ_API ", "")


def main() -> None:
    output, folder = sys.argv[1], Path(sys.argv[2])
    present = [name for name in HEADERS if (folder / f"{name}.h").exists()]
    known = set(present) | {"asj", "io"}
    unknown = sorted(path.name for path in folder.glob("*.h") if path.stem not in known)
    if unknown:
        sys.exit(f"generate_native.py: new headers, name them in HEADERS: {', '.join(unknown)}")
    builder = cffi.FFI()
    for name in present:
        builder.cdef(declarations((folder / f"{name}.h").read_text(encoding="ascii")))
    builder.cdef(CALLBACKS)
    builder.set_source("asj._native", "#include <asj/asj.h>\n")
    builder.emit_c_code(output)


main()
