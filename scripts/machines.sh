#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The same bits on other machines? Builds the core with tests/machines/machine.c by cross compilers, runs it under emulation, and
# compares what it prints with what it prints here: machines.sh [--all]. What is missing here is left out, and said.
# Without --all one big-endian and one 32-bit machine. Exit code 1 when a machine that should agree does not.
#
# Debian: gcc-s390x-linux-gnu libc6-dev-s390x-cross gcc-i686-linux-gnu libc6-dev-i386-cross gcc-arm-linux-gnueabihf
# libc6-dev-armhf-cross gcc-aarch64-linux-gnu libc6-dev-arm64-cross musl-tools gcc-mingw-w64-x86-64 qemu-user
set -u
root=$(cd "$(dirname "$0")/.." && pwd)
all=${1-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root" || exit 1
failed=0

# The tables of the null model, as src/detect/meson.build makes them: by the machine that builds.
cc -std=c99 -O2 -ffp-contract=off -Iinclude -Isrc src/detect/nfa_store.c src/detect/nfa_fill_*.c src/detect/nfa_gauss.c \
    -o "$work/nfa-store" -lm && "$work/nfa-store" > "$work/nfa_stored.c" || exit 1
detect=$(find src/detect -name '*.c' ! -name 'nfa_store.c' ! -name 'nfa_fill_*.c' ! -name 'nfa_gauss.c')
sources="src/*.c src/core/*.c $detect $work/nfa_stored.c src/geometry/*.c src/match/*.c tests/machines/machine.c"

# try NAME EXPECTATION COMPILER RUNNER FLAG...: expectation same, other or builds.
try() {
    name=$1 expected=$2 compiler=$3 runner=$4
    shift 4
    if ! command -v "$compiler" > /dev/null || ! command -v "${runner%% *}" > /dev/null; then
        echo "$name: skipped (no $compiler, or no ${runner%% *})"
        return
    fi
    if ! "$compiler" -std=c99 -O2 -ffp-contract=off -Wno-unknown-pragmas -Iinclude -Isrc "$@" $sources -o "$work/$name" -lm \
        2> "$work/log"; then
        cat "$work/log"
        echo "$name: does not build"
        failed=1
        return
    fi
    if [ "$expected" = builds ]; then
        echo "$name: builds"
        return
    fi
    if ! $runner "$work/$name" > "$work/$name.txt" 2>&1; then
        cat "$work/$name.txt"
        echo "$name: does not run"
        failed=1
        return
    fi
    differ=$(diff "$work/here.txt" "$work/$name.txt" | grep -c '^>')
    echo "$name: $differ of $(grep -c '' "$work/$name.txt") results differ"
    [ "$expected" = other ] || [ "$differ" = 0 ] || failed=1
}

try here other cc env 2> /dev/null > /dev/null
[ -s "$work/here.txt" ] || { echo 'it does not run here'; exit 1; }
cat "$work/here.txt"
try s390x same s390x-linux-gnu-gcc 'qemu-s390x -L /usr/s390x-linux-gnu' -fexcess-precision=fast
try i686-sse2 same i686-linux-gnu-gcc 'qemu-i386 -L /usr/i686-linux-gnu' -msse2 -mfpmath=sse
if [ "$all" = --all ]; then
    try armhf same arm-linux-gnueabihf-gcc 'qemu-arm -L /usr/arm-linux-gnueabihf'
    try aarch64 same aarch64-linux-gnu-gcc 'qemu-aarch64 -L /usr/aarch64-linux-gnu'
    try musl same musl-gcc env -static
    try i686-x87 other i686-linux-gnu-gcc 'qemu-i386 -L /usr/i686-linux-gnu'
    try mingw builds x86_64-w64-mingw32-gcc env
fi
exit $failed
