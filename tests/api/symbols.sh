#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The symbols that a shared library exports are exactly the functions that its headers declare.  symbols.sh LIBRARY HEADER...
set -u
command -v nm > /dev/null || { echo 'SKIPPED: no nm'; exit 77; }
library=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sh "$(dirname "$0")/functions.sh" "$@" > "$work/declared"
# what the linker, the run-time library or a sanitizer adds begins with an underscore
nm -D --defined-only "$library" | sed 's/^[0-9a-f]* *[A-Za-z] //; s/@.*//' | grep -v '^_' | sort -u > "$work/exported"
[ -s "$work/declared" ] || { echo 'no declarations found'; exit 1; }
diff "$work/declared" "$work/exported" || { echo '< declared and not exported, > exported and not declared'; exit 1; }
echo "$(wc -l < "$work/declared") functions"
