#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The same bits on other machines? Builds the core with tests/machines/machine.c by cross compilers, runs it under emulation, and
# compares what it prints with what it prints here: machines.sh [--all]. What is missing here is left out, and said.
# Without --all a big-endian machine, a 32-bit one, another C library, and Windows; with it, more of them, and the command line for
# Windows. Exit code 1 when one that should agree does not. What is built stays in out/machines for the next time.
#
# Debian: gcc-s390x-linux-gnu libc6-dev-s390x-cross gcc-i686-linux-gnu libc6-dev-i386-cross gcc-arm-linux-gnueabihf
# libc6-dev-armhf-cross gcc-aarch64-linux-gnu libc6-dev-arm64-cross musl-tools gcc-mingw-w64-x86-64 qemu-user wine
# and for the command line under Windows also libz-mingw-w64-dev cmake
set -u
root=$(cd "$(dirname "$0")/.." && pwd)
all=${1-}
work=$root/out/machines
mkdir -p "$work" && cd "$root" || exit 1
failed=0
machines=
. "$root/scripts/windows.sh"

# Where there is a ccache it serves all checkouts: paths are told from the checkout on.
cache=$(command -v ccache)
CCACHE_BASEDIR=$root
export CCACHE_BASEDIR

# The tables of the null model, as src/detect/meson.build makes them: by the machine that builds.
cc -std=c99 -O2 -ffp-contract=off -Iinclude -Isrc src/detect/nfa_store.c src/detect/nfa_fill_*.c src/detect/nfa_gauss.c \
    src/detect/nfa_sector.c \
    -o "$work/nfa-store" -lm && "$work/nfa-store" > "$work/nfa_stored.new" || exit 1
cmp -s "$work/nfa_stored.new" "$work/nfa_stored.c" || mv "$work/nfa_stored.new" "$work/nfa_stored.c"
detect=$(find "$root/src/detect" -name '*.c' ! -name 'nfa_store.c' ! -name 'nfa_fill_*.c' ! -name 'nfa_gauss.c')
core=$(ls "$root"/src/*.c "$root"/src/core/*.c "$root"/src/segments/*.c "$root"/src/geometry/*.c "$root"/src/match/*.c)
sources="$detect $core $work/nfa_stored.c $root/tests/machines/machine.c"

options="-std=c99 -ffp-contract=off -Wno-unknown-pragmas -I$root/include -I$root/src -I$root/src/detect"

# All is built and run by one file for ninja, on all processors; the emulated ones, which take longest to run, begin first.
cat > "$work/build.ninja" << END
rule compile
  command = $cache \$compiler $options \$flags -MMD -MF \$out.d -c \$in -o \$out
  depfile = \$out.d
  deps = gcc
rule link
  command = \$compiler \$flags \$in -o \$out -lm
rule run
  command = \$runner ./\$in > \$out.new && mv \$out.new \$out
END

# machine NAME FORM COMPILER RUNNER FLAG...: one more machine, with operations in that form (reference or vectors); what it prints
# will stand in $work/NAME.txt.
machine() {
    name=$1 form=$2 compiler=$3 runner=$4
    shift 4
    rm -f "$work/$name.txt"
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
        [ "$source" != "$vectors" ] || flags="$* -fno-math-errno -Wno-psabi" # src/simd/meson.build also gives -O3: a minute
        printf 'build %s: compile %s\n  compiler = %s\n  flags = %s\n' "$object" "$source" "$compiler" "$flags"
    done >> "$work/build.ninja"
    printf 'build %s/machine: link %s\n  compiler = %s\n  flags = %s\nbuild %s.txt: run %s/machine\n  runner = %s\n' \
        "$name" "$objects" "$compiler" "$*" "$name" "$name" "$runner" >> "$work/build.ninja"
    machines="$machines $name"
}

# Optimized less where nothing is emulated: that is quicker to build, and must give the same, too.
machine s390x vectors s390x-linux-gnu-gcc 'qemu-s390x -L /usr/s390x-linux-gnu' -O2 -fexcess-precision=fast
machine i686 reference i686-linux-gnu-gcc 'qemu-i386 -L /usr/i686-linux-gnu' -O2 -msse2 -mfpmath=sse
machine musl vectors musl-gcc env -O1 -static
machine here reference cc env -O1
if [ "$all" = --all ]; then
    # as Meson compiles vectors.c: where there is no vector unit gcc makes other code of it at -O3
    machine armhf vectors arm-linux-gnueabihf-gcc 'qemu-arm -L /usr/arm-linux-gnueabihf' -O3
    machine armhf-neon vectors arm-linux-gnueabihf-gcc 'qemu-arm -L /usr/arm-linux-gnueabihf' -O3 -mfpu=neon
    machine aarch64 vectors aarch64-linux-gnu-gcc 'qemu-aarch64 -L /usr/aarch64-linux-gnu' -O2
    machine i686-vectors vectors i686-linux-gnu-gcc 'qemu-i386 -L /usr/i686-linux-gnu' -O2 -msse2 -mfpmath=sse
    machine s390x-reference reference s390x-linux-gnu-gcc 'qemu-s390x -L /usr/s390x-linux-gnu' -O2 -fexcess-precision=fast
    # without the options that meson.build gives there: said, and no fault
    machine i686-other reference i686-linux-gnu-gcc 'qemu-i386 -L /usr/i686-linux-gnu' -O2
    machine s390x-other reference s390x-linux-gnu-gcc 'qemu-s390x -L /usr/s390x-linux-gnu' -O2
fi
if ! ninja -C "$work" -k 0 > "$work/log" 2>&1; then
    grep -vE '^\[[0-9]' "$work/log" | tail -n 40
    failed=1
fi
[ -s "$work/here.txt" ] || exit 1
cat "$work/here.txt"
try_windows || failed=1
[ "$all" != --all ] || try_windows_program || failed=1

for name in $machines; do
    same=$(grep -cxFf "$work/here.txt" "$work/$name.txt")
    echo "$name: $same of $(grep -c '' "$work/here.txt") results are the same"
    case $name in
    *-other) ;;
    *) cmp -s "$work/here.txt" "$work/$name.txt" || failed=1 ;;
    esac
done
exit $failed
