#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The same bits on other machines? Builds the core with tests/machines/machine.c by cross compilers, runs it under emulation, and
# compares what it prints with what it prints here: machines.sh [--all]. What is missing here is left out, and said.
# Without --all a big-endian machine, a 32-bit one, another C library, and Windows. Exit code 1 when one that should agree does not.
#
# Debian: gcc-s390x-linux-gnu libc6-dev-s390x-cross gcc-i686-linux-gnu libc6-dev-i386-cross gcc-arm-linux-gnueabihf
# libc6-dev-armhf-cross gcc-aarch64-linux-gnu libc6-dev-arm64-cross musl-tools gcc-mingw-w64-x86-64 qemu-user wine
set -u
root=$(cd "$(dirname "$0")/.." && pwd)
all=${1-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root" || exit 1
failed=0
machines=

# The tables of the null model, as src/detect/meson.build makes them: by the machine that builds.
cc -std=c99 -O2 -ffp-contract=off -Iinclude -Isrc src/detect/nfa_store.c src/detect/nfa_fill_*.c src/detect/nfa_gauss.c \
    -o "$work/nfa-store" -lm && "$work/nfa-store" > "$work/nfa_stored.c" || exit 1
detect=$(find "$root/src/detect" -name '*.c' ! -name 'nfa_store.c' ! -name 'nfa_fill_*.c' ! -name 'nfa_gauss.c')
core=$(ls "$root"/src/*.c "$root"/src/core/*.c "$root"/src/geometry/*.c "$root"/src/match/*.c)
sources="$detect $core $work/nfa_stored.c $root/tests/machines/machine.c"

includes="-I$root/include -I$root/src -I$root/src/detect"

# All is built and run by one file for ninja, on all processors.
cat > "$work/build.ninja" << END
rule compile
  command = \$compiler -std=c99 -O2 -ffp-contract=off -Wno-unknown-pragmas \$flags $includes -c \$in -o \$out
rule link
  command = \$compiler \$flags \$in -o \$out -lm
rule run
  command = \$runner ./\$in > \$out
END

# machine NAME FORM COMPILER RUNNER FLAG...: one more machine, with operations in that form (reference or vectors); what it prints
# will stand in $work/NAME.txt.
machine() {
    name=$1 form=$2 compiler=$3 runner=$4
    shift 4
    if ! command -v "$compiler" > /dev/null || ! command -v "${runner%% *}" > /dev/null; then
        echo "$name: skipped (no $compiler, or no ${runner%% *})"
        return
    fi
    objects= vectors=
    if [ "$form" = vectors ]; then
        vectors=$root/src/simd/gnu/vectors.c
        set -- "$@" -DASJ_HAVE_VECTORS
    fi
    for source in $sources $vectors; do
        object=$name/$(echo "${source#"$root"/}" | tr '/' '_').o
        objects="$objects $object"
        flags=$*
        [ "$source" != "$vectors" ] || flags="$* -O3 -fno-math-errno -Wno-psabi" # as src/simd/meson.build gives
        printf 'build %s: compile %s\n  compiler = %s\n  flags = %s\n' "$object" "$source" "$compiler" "$flags"
    done >> "$work/build.ninja"
    printf 'build %s/machine: link %s\n  compiler = %s\n  flags = %s\nbuild %s.txt: run %s/machine\n  runner = %s\n' \
        "$name" "$objects" "$compiler" "$*" "$name" "$name" "$runner" >> "$work/build.ninja"
    machines="$machines $name"
}

# Windows: the library as a DLL, as the project builds it, with vector instructions and threads; what it exports are the functions
# of the headers. Under Wine, where that is there.
try_windows() {
    if ! command -v x86_64-w64-mingw32-gcc > /dev/null; then
        echo 'windows: skipped (no x86_64-w64-mingw32-gcc)'
        return
    fi
    folder=$work/windows
    if ! { meson setup "$folder" "$root" --cross-file "$root/scripts/mingw-w64.ini" --werror -Dauto_features=disabled \
        -Dthreads=enabled -Dsimd=enabled && ninja -C "$folder" &&
        x86_64-w64-mingw32-gcc -std=c99 -O2 -Iinclude tests/machines/machine.c "$folder/src/libasj.dll.a" \
            -o "$folder/src/machine.exe"; } > "$work/windows.log" 2>&1; then
        tail -n 30 "$work/windows.log"
        echo 'windows: does not build'
        failed=1
        return
    fi
    sh tests/api/functions.sh $(ls include/asj/*.h | grep -v '/io\.h$') > "$work/declared"
    x86_64-w64-mingw32-objdump -p "$folder/src/libasj-0.dll" |
        sed -n '/^\[Ordinal\/Name Pointer\]/,$ s/^[ \t]*\[[ 0-9]*\]\( +base\[[ 0-9]*\] *[0-9a-f]*\)\{0,1\} \([A-Za-z_]*\)/\2/p' |
        sort > "$work/exported"
    if ! diff "$work/declared" "$work/exported"; then
        echo 'windows: < declared and not exported, > exported and not declared'
        failed=1
    fi
    echo "windows: builds, exports $(grep -c '' "$work/exported") functions"
    wine=$(command -v wine wine64 | head -n 1)
    if [ -n "$wine" ]; then
        env WINEDEBUG=-all "WINEPREFIX=$work/wine" "$wine" "$folder/src/machine.exe" < /dev/null 2> "$work/wine.log" | tr -d '\r' \
            > "$work/windows.txt"
        machines="$machines windows"
    else
        echo 'windows: not run (no wine)'
    fi
}

machine here reference cc env
machine s390x vectors s390x-linux-gnu-gcc 'qemu-s390x -L /usr/s390x-linux-gnu' -fexcess-precision=fast
machine i686 reference i686-linux-gnu-gcc 'qemu-i386 -L /usr/i686-linux-gnu' -msse2 -mfpmath=sse
machine musl vectors musl-gcc env -static
if [ "$all" = --all ]; then
    machine armhf vectors arm-linux-gnueabihf-gcc 'qemu-arm -L /usr/arm-linux-gnueabihf'
    machine aarch64 vectors aarch64-linux-gnu-gcc 'qemu-aarch64 -L /usr/aarch64-linux-gnu'
    machine i686-vectors vectors i686-linux-gnu-gcc 'qemu-i386 -L /usr/i686-linux-gnu' -msse2 -mfpmath=sse
    machine s390x-reference reference s390x-linux-gnu-gcc 'qemu-s390x -L /usr/s390x-linux-gnu' -fexcess-precision=fast
    # without the options that meson.build gives there: said, and no fault
    machine i686-other reference i686-linux-gnu-gcc 'qemu-i386 -L /usr/i686-linux-gnu'
    machine s390x-other reference s390x-linux-gnu-gcc 'qemu-s390x -L /usr/s390x-linux-gnu'
fi
if ! ninja -C "$work" -k 0 > "$work/log" 2>&1; then
    grep -vE '^\[[0-9]' "$work/log" | tail -n 40
    failed=1
fi
[ -s "$work/here.txt" ] || exit 1
cat "$work/here.txt"
try_windows

for name in $machines; do
    same=$(grep -cxFf "$work/here.txt" "$work/$name.txt")
    echo "$name: $same of $(grep -c '' "$work/here.txt") results are the same"
    case $name in
    *-other) ;;
    *) cmp -s "$work/here.txt" "$work/$name.txt" || failed=1 ;;
    esac
done
exit $failed
