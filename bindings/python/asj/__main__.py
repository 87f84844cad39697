# SPDX-License-Identifier: BSD-2-Clause
"""python -m asj: junctions of many images and matches of their pairs, for a reconstruction."""

import sys


def main() -> int:
    """Runs the command line."""
    print("python -m asj: commands come with the collection")
    return 2


if __name__ == "__main__":
    sys.exit(main())
