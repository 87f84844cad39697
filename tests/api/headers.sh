#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Every public header alone, first in its file and twice: strict C99, without padding (asj.h) where pointers have 64 bits, and C++
# where there is a compiler.
# headers.sh INCLUDE_DIRECTORY "C COMPILER" ["C++ COMPILER"]
set -u
strict='-Wall -Wextra -Wpedantic -Wconversion -Wundef -Werror -fsyntax-only'
failed=0
count=0
check() { # COMPILER AND OPTIONS
    for header in "$include"/asj/*.h; do
        name=asj/$(basename "$header")
        printf '#include <%s>\n#include <%s>\nint user(void);\nint user(void) { return 0; }\n' "$name" "$name" |
            $1 $strict -I"$include" - || { echo "$name: not clean with $1"; failed=1; }
        count=$((count + 1))
    done
}
include=$1
padded=
[ "$(echo __SIZEOF_POINTER__ | $2 -x c -E -P -)" != 8 ] || padded=-Wpadded
check "$2 -x c -std=c99 $padded"
if [ $# -gt 2 ] && [ -n "$3" ]; then
    check "$3 -x c++ -std=c++11"
else
    echo 'no C++ compiler: headers not tried in C++'
fi
echo "$count headers tried"
[ $count -gt 8 ] && exit $failed
