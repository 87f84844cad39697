#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""The table of operations in the documentation is what the build says: list.py PARITY README. Forms that this build or this
processor lacks ("?") are left to builds that have them."""
import os
import shlex
import subprocess
import sys


def rows(lines):
    return [line.split() for line in lines if line.strip()]


def documented(path):
    """The block of text whose first line starts with "operation"."""
    with open(path, encoding="ascii") as file:
        lines = file.read().split("\n")
    first = next(i for i, line in enumerate(lines) if line.startswith("operation "))
    return rows(lines[first:lines.index("```", first)])


def main(parity, readme):
    emulator = shlex.split(os.environ.get("MESON_EXE_WRAPPER", ""))  # a build for another machine
    found = rows(subprocess.run(emulator + [parity, "--list"], capture_output=True, text=True, check=True).stdout.split("\n"))
    shown = documented(readme)
    if len(found) < 2 or len(found) != len(shown):
        print(f"{len(found)} lines of parity --list, {len(shown)} in {readme}")
        return 1
    faults = 0
    for is_row, should_row in zip(found, shown):
        equal = len(is_row) == len(should_row) and all(a in (b, "?") for a, b in zip(is_row, should_row))
        if not equal or "?" in should_row:
            faults += 1
            print("is:    " + " ".join(is_row) + "\nshows: " + " ".join(should_row))
    print(f"{len(shown)} lines, {faults} stale")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
