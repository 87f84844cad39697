#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The fuzzers for longer than in CI, two at a time: sh scripts/fuzz.sh SECONDS [HARNESS...]. What they find is in
# build-fuzz/finding-*, what they have learnt in build-fuzz/found-*, from which the next run goes on. Needs clang.
set -u
root=$(cd "$(dirname "$0")/.." && pwd) || exit 1
. "$root/scripts/common.sh"
. "$root/scripts/sanitizers.sh"
case ${1-} in
'' | *[!0-9]*)
    sed -n 's/^.*: \(sh scripts.*\]\)\..*/usage: \1/p' "$0" >&2
    exit 2
    ;;
esac
mkdir -p "$logs"
with_fuzzer "$@"
