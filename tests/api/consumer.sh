#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The ten lines on top of asj.h, as a program built against the installed library through pkg-config, shared and static.
# consumer.sh BUILD_DIRECTORY PREFIX "C COMPILER" MESON...     (meson install of that build goes to a folder of its own)
set -u
build=$1 prefix=$2 compiler=$3
shift 3
command -v pkg-config > /dev/null || { echo 'SKIPPED: no pkg-config'; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$@" install -C "$build" --no-rebuild --destdir "$work" > "$work/log" 2>&1 || { cat "$work/log"; exit 1; }
pc=$(find "$work" -name asj.pc)
[ -n "$pc" ] || { echo 'no asj.pc installed'; exit 1; }
PKG_CONFIG_LIBDIR=$(dirname "$pc")
PKG_CONFIG_SYSROOT_DIR=$work
export PKG_CONFIG_LIBDIR PKG_CONFIG_SYSROOT_DIR
libraries=$(pkg-config --variable=libdir asj)
case $libraries in "$work"*) ;; *) libraries=$work$libraries ;; esac

# the example: the lines of the header's first comment that are indented by four blanks more
{
    printf '#include <asj/asj.h>\n#include <stdio.h>\nint main(void)\n{\n'
    printf '    static unsigned char pixels[120 * 100];\n    const int width = 120, height = 100;\n'
    printf '    for (int i = 0; i < 120 * 100; i++)\n        pixels[i] = i %% 120 > 40 && i / 120 > 30 ? 200 : 60;\n'
    sed -n '/^ \*\//q; s/^ \*     //p' "$work$prefix/include/asj/asj.h"
    printf '    return 0;\n}\n'
} > "$work/example.c"
grep -q asj_detect "$work/example.c" || { echo 'no example found in asj.h'; exit 1; }

run() { # NAME LINKER_OPTIONS
    name=$1
    shift
    $compiler -std=c99 -Wall -Wextra -Wpedantic -Werror $(pkg-config --cflags asj) "$work/example.c" -o "$work/$name" "$@" ||
        { echo "$name: does not build"; cat "$work/example.c"; exit 1; }
    "$work/$name" > "$work/$name.txt" || { echo "$name: does not run"; exit 1; }
    # one junction, the corner between the pixels 40 and 41, 30 and 31
    awk '{ n++; ok = $1 > 40 && $1 < 41 && $2 > 30 && $2 < 31 } END { exit !(n == 1 && ok) }' "$work/$name.txt" ||
        { echo "$name prints:"; cat "$work/$name.txt"; exit 1; }
    echo "$name: $(cat "$work/$name.txt")"
}
run shared $(pkg-config --libs asj) -Wl,-rpath,"$libraries"
if [ -e "$libraries/libasj.a" ]; then
    more=$(pkg-config --static --libs asj | grep -oE -e '-pthread|-ldl' | sort -u)
    run static "$libraries/libasj.a" $more -lm
    if ldd "$work/static" 2> /dev/null | grep -q libasj; then echo 'the static program needs libasj.so'; exit 1; fi
else
    echo 'no static library in this build'
fi
