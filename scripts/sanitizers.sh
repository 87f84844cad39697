# SPDX-License-Identifier: BSD-2-Clause
# What other sanitizers see, in short: threads (contexts in threads, OpenCL that starts in many at once), memory that nobody has
# written (the core alone), and libFuzzer for each harness. Sourced by test.sh; needs clang.

# sanitized FOLDER "TARGET..." OPTION...: only these targets, by clang.
sanitized() {
    folder_wanted=$1
    targets=$2
    shift 2
    (CC=clang CXX=clang++ && export CC CXX && configure "$folder_wanted" -Dtests=enabled -Dio=disabled -Dcli=disabled \
        -Dopencv=disabled -Dcairo=disabled -Dsimd=disabled -Db_lundef=false --buildtype=debug --optimization=1 "$@" &&
        logged "build-$folder_wanted" ninja -C "$root/$folder_wanted" $targets)
}

with_thread_sanitizer() {
    sanitized build-tsan 'tests/soak/contexts tests/opencl/test_startup' -Db_sanitize=thread -Dthreads=enabled -Dopencl=enabled &&
        logged tsan-contexts "$root/build-tsan/tests/soak/contexts" 2 &&
        # drivers are no code of ours
        logged tsan-startup env TSAN_OPTIONS=ignore_noninstrumented_modules=1 "POCL_CACHE_DIR=$root/build-tsan/pocl-cache" \
            "$root/build-tsan/tests/opencl/test_startup" 3
}

with_memory_sanitizer() {
    sanitized build-msan "tests/soak/frames $(printf 'tests/fuzz/replay-%s ' detect match geometry vanishing)" \
        -Db_sanitize=memory -Dthreads=enabled -Dopencl=disabled || return 1
    logged msan-frames "$root/build-msan/tests/soak/frames" 40 || return 1
    for harness in detect:200 match:300 geometry:20 vanishing:500; do
        logged "msan-${harness%:*}" "$root/build-msan/tests/fuzz/replay-${harness%:*}" "$root/tests/fuzz/corpus/${harness%:*}" \
            "${harness#*:}" || return 1
    done
}

all_harnesses='arguments detect match geometry vanishing features image junctions probe'

# fuzz_one SECONDS HARNESS: leaves one line of what it did.
fuzz_one() {
    mkdir -p "$root/build-fuzz/found-$2"
    logged "fuzz-$2" "$root/build-fuzz/tests/fuzz/fuzz-$2" -max_total_time="$1" -max_len=4096 -timeout=300 \
        -rss_limit_mb=4096 -artifact_prefix="$root/build-fuzz/finding-$2-" "$root/build-fuzz/found-$2" \
        "$root/tests/fuzz/corpus/$2" || return 1
    sed -n "s/^Done \([0-9]*\) runs in \([0-9]*\).*/fuzz-$2: \1 executions in \2 s/p" "$logs/fuzz-$2.log"
}

# build_fuzzers HARNESS... Numbers that an integer has no room for are no part of clang's undefined-behaviour sanitizer.
build_fuzzers() {
    targets=
    for harness in "$@"; do
        targets="$targets tests/fuzz/fuzz-$harness"
    done
    sanitized build-fuzz "$targets" -Dfuzz=enabled -Db_sanitize=address,undefined -Dthreads=disabled -Dopencl=disabled \
        -Dio=enabled -Dc_args='-fsanitize=fuzzer-no-link,float-cast-overflow -fno-sanitize-recover=undefined,float-cast-overflow'
}

# with_fuzzer SECONDS [HARNESS...], for each harness, two at a time. What it finds is in build-fuzz/finding-*.
with_fuzzer() {
    seconds=$1
    shift
    harnesses=${*:-$all_harnesses}
    build_fuzzers $harnesses || return 1
    state_of_fuzzers=0
    set -- $harnesses
    while [ "$#" -gt 0 ]; do
        fuzz_one "$seconds" "$1" &
        first=$!
        shift
        if [ "$#" -gt 0 ]; then
            fuzz_one "$seconds" "$1" || state_of_fuzzers=1
            shift
        fi
        wait "$first" || state_of_fuzzers=1
    done
    return $state_of_fuzzers
}
