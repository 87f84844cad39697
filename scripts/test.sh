#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Builds the library and passes its tests: sh scripts/test.sh [--all]
set -u
root=$(cd "$(dirname "$0")/.." && pwd) || exit 1
. "$root/scripts/common.sh"
. "$root/scripts/aarch64.sh"
. "$root/scripts/sanitizers.sh"

usage() {
    cat << 'END'
usage: sh scripts/test.sh [--all]

Installs what is missing (apt-get), builds everything in build-test/ and runs all tests.
--all, or CI=true in the environment, takes warnings as errors, and also checks the style of the sources, runs the tests in a build
by clang under the address and undefined-behaviour sanitizers and in builds with fewer parts, a few programs under the thread and
the memory sanitizer, ten seconds of each fuzzer, runs the tests of the core for 64-bit ARM under emulation, compares
results with those of other machines, and uses an installed library from other programs.
Exit code: 0 everything passed, 1 something failed, 2 wrong usage, 3 packages are missing and cannot be installed here.
END
}

passed=0
failed=0
skipped=0
broken= # names of the steps that failed
bad_ends= # what the tests that failed have printed last
patience=1 # how many times longer than alone a test may take

# step NAME COMMAND...: goes on when the command fails, and remembers.
step() {
    this_step=$1
    shift
    step_start=$(date +%s)
    if "$@"; then
        say "$this_step: done in $(($(date +%s) - step_start)) s"
    else
        say "$this_step: FAILED after $(($(date +%s) - step_start)) s"
        broken="$broken $this_step"
    fi
}

results() {
    grep -cE "\"result\": \"($2)\"" "$1"
}

# what_failed RECORD: the tests that failed, and the ends of what they have printed.
what_failed() {
    python3 - "$1" << 'END'
import json, sys

for line in open(sys.argv[1], encoding="utf-8", errors="replace"):
    test = json.loads(line)
    if test["result"] not in ("OK", "EXPECTEDFAIL", "SKIP"):
        print("%s: %s after %.0f s, exit code %s" % (test["name"], test["result"], test["duration"], test["returncode"]))
        for stream in ("stdout", "stderr"):
            print(*("    " + text for text in test.get(stream, "").splitlines()[-40:]), sep="\n")
END
}

# run_tests FOLDER [ARGUMENT...]: meson's tests; adds what meson has recorded of them, a line of JSON each, to the sums.
run_tests() {
    folder=$root/$1
    record=$folder/meson-logs/testlog.json
    shift
    rm -f "$record"
    meson test -C "$folder" --no-rebuild --print-errorlogs --timeout-multiplier "$patience" "$@" < /dev/null
    state=$?
    [ -e "$record" ] || return 1
    all=$(grep -c '' "$record")
    good=$(results "$record" 'OK|EXPECTEDFAIL')
    left_out=$(results "$record" 'SKIP')
    passed=$((passed + good))
    skipped=$((skipped + left_out))
    failed=$((failed + all - good - left_out))
    ends=$(what_failed "$record")
    [ -z "$ends" ] || bad_ends="$bad_ends
In $folder/:
$ends"
    # and the reason that the test has printed
    sed -n 's/^{"name": "\([^"]*\)".*"result": "SKIP".*/skipped: \1&/p' "$record" |
        sed 's/{"name".*SKIPPED: \([^"\\]*\).*/: \1/; s/{"name".*//'
    [ "$state" = 0 ] && [ "$good" -gt 0 ] && [ "$all" = "$((good + left_out))" ]
}

# build FOLDER OPTION...
build() {
    say
    say "Building in $1/"
    configure "$@" && logged "build-$name" meson compile -C "$folder"
}

# build_and_test FOLDER "ARGUMENT..." OPTION...: the arguments are those of meson test.
build_and_test() {
    tests_wanted=$2
    folder_wanted=$1
    shift 2
    build "$folder_wanted" "$@" && run_tests "$folder_wanted" $tests_wanted
}

# programs_of FOLDER [--no-suite SUITE]...: what is installed, and what the tests of the other suites are built of, as ninja names
# it.
programs_of() {
    python3 - "$@" << 'END'
import json, os, sys

folder, left_out = sys.argv[1], {"asj:" + suite for suite in sys.argv[3::2]}
tests, targets = (json.load(open("%s/meson-info/intro-%s.json" % (folder, what))) for what in ("tests", "targets"))
wanted = {target for test in tests if not left_out & set(test["suite"]) for target in test["depends"]}
wanted |= {target["id"] for target in targets if target["installed"]}  # a test installs it
print(*(os.path.relpath(file, folder) for target in targets if target["id"] in wanted for file in target["filename"]))
END
}

# build_what_is_tested FOLDER "--no-suite SUITE..." OPTION...: these tests and what is installed, and nothing else.
build_what_is_tested() {
    folder_wanted=$1
    tests_wanted=$2
    shift 2
    say
    say "Building in $folder_wanted/"
    configure "$folder_wanted" "$@" && programs=$(programs_of "$folder" $tests_wanted) &&
        logged "build-$name" ninja -C "$folder" $programs && run_tests "$folder_wanted" $tests_wanted
}

# What builds for another purpose leave out: suites that take minutes and whose results the goldens stand for, and the README's
# commands, which do what other tests of the command line do.
quick_with_upsampled='--no-suite accuracy --no-suite experiments --no-suite long --no-suite benchmark --no-suite upsampled_images
--no-suite readme'
quick="$quick_with_upsampled --no-suite upsampled"

# The core alone: no library but libc and libm (the compiler's own run-time library may show up too). Without the accuracy suite:
# the goldens show that its results are those of the whole build. Of the unit tests those that threads make a difference to; other
# forms of operations than the portable one there are none.
core_alone() {
    build_what_is_tested build-core "$quick --no-suite unit --no-suite parity" -Dauto_features=disabled -Dtests=enabled --werror &&
        logged build-core-units ninja -C "$folder" tests/unit/test_threads tests/unit/test_context tests/unit/test_detect &&
        run_tests build-core threads context detect || return 1
    others=$(readelf -d "$folder/src/libasj.so" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | grep -vE '^lib(c|m|gcc_s)\.so|^ld-')
    [ -z "$others" ] || say "libasj.so needs $others"
    [ -z "$others" ]
}

# By clang, so that the results and the warnings of another compiler are seen, too.
# Without the accuracy suite, which takes ten minutes then; two scenes of each row visit the same code, beside the tests. Of
# upsampled images one test. Without the tests that must fail, which need no sanitizer, without what devices compute, and without
# the benchmarks. Numbers that an integer has no room for are no part of clang's undefined-behaviour sanitizer. Lines of the
# sources are all that reports need to know (-g1). On alternative signal stacks: LLVM, in PoCL, gives the thread that starts it one
# of its own where the sanitizer's is smaller, which depends on the processor, and when the thread ends the sanitizer unmaps that in
# place of its own and fails.
with_sanitizers() {
    ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}use_sigaltstack=0
    export ASAN_OPTIONS
    (CC=clang CXX=clang++ && export CC CXX && build build-sanitize -Dauto_features=enabled --buildtype=debugoptimized --werror \
        -Db_sanitize=address,undefined -Db_lundef=false \
        '-Dc_args=-fsanitize=float-cast-overflow -fno-sanitize-recover=undefined,float-cast-overflow -g1' \
        '-Dcpp_args=-fno-sanitize-recover=undefined -g1') || return 1
    folder=$root/build-sanitize
    logged sanitize-accuracy "$folder/tests/accuracy/accuracy" --scenes 2 &
    scenes=$!
    state_of_tests=0
    run_tests build-sanitize $quick_with_upsampled --no-suite fails --no-suite device-images --no-suite device-operations \
        --timeout-multiplier 12 || state_of_tests=1
    wait "$scenes" && [ "$state_of_tests" = 0 ]
}

# From a copy in which the folders that are only for OpenCL are missing. Vector forms are those of the whole build: no parity; and
# modules are tested one by one in the whole build, and without threads in the core alone: no unit tests.
fewer_parts() {
    whole=$root
    root=$whole/out/without-opencl
    rm -rf "$root/src" "$root/kernels" && mkdir -p "$root" &&
        (cd "$whole" &&
            cp -R -p README.md CHANGELOG.md LICENSE bindings cli include meson.build meson_options.txt scripts src tests "$root") &&
        rm -rf "$root/src/cl" && build_what_is_tested build-fewer "$quick --no-suite parity --no-suite unit --no-suite fails" \
        -Djpeg=disabled -Dtiff=disabled -Dwebp=disabled -Djpeg2000=disabled -Dheif=disabled -Dexif=disabled -Dopencv=disabled \
        -Dcairo=disabled -Dthreads=disabled -Dio=enabled -Dcli=enabled -Dtests=enabled --werror
    state_of_fewer=$?
    root=$whole
    return $state_of_fewer
}

# Only how many passed counts here; what failed is in the log.
python_package() {
    logged python sh "$root/scripts/python.sh" || return 1
    count=$(sed -n 's/^\([0-9][0-9]*\) passed.*/\1/p' "$logs/python.log")
    passed=$((passed + count))
    sed -n 's/.*is consistent with the following platform tag: /wheel: /p' "$logs/python.log"
}

machine_packages='gcc-s390x-linux-gnu libc6-dev-s390x-cross gcc-i686-linux-gnu libc6-dev-i386-cross musl-tools gcc-mingw-w64-x86-64
qemu-user'

machine_tools() {
    for tool in s390x-linux-gnu-gcc i686-linux-gnu-gcc musl-gcc x86_64-w64-mingw32-gcc qemu-s390x qemu-i386; do
        command -v "$tool" > /dev/null || return 1
    done
}

# Results of other machines, under emulation: machines.sh leaves out those whose tools are neither here nor to be installed.
on_machines() {
    machine_tools || (become_root && apt install -y --no-install-recommends $machine_packages) > /dev/null 2>&1
    logged machines sh "$root/scripts/machines.sh"
    state_of_machines=$?
    grep ': ' "$logs/machines.log"
    skipped=$((skipped + $(grep -c ': skipped' "$logs/machines.log")))
    passed=$((passed + $(grep -c 'results are the same' "$logs/machines.log")))
    return $state_of_machines
}

# What takes one processor as a rule, or waits; beside what takes all of them.
small_checks() {
    step python python_package
    step machines on_machines
    step install sh "$root/scripts/install_check.sh"
    step aarch64 on_aarch64
    step threads with_thread_sanitizer
    step memory with_memory_sanitizer
    step fuzzers with_fuzzer 10
}

start_small_checks() {
    : > "$logs/small-checks.ends"
    echo '0 0 0 small-checks' > "$logs/small-checks.sums"
    (
        trap - INT TERM
        passed=0 failed=0 skipped=0 broken= bad_ends=
        small_checks
        printf '%s' "$bad_ends" > "$logs/small-checks.ends"
        echo "$passed $failed $skipped $broken" > "$logs/small-checks.sums"
    ) > "$logs/small-checks.log" 2>&1 &
    small=$!
    trap 'kill "$small" 2> /dev/null; exit 130' INT TERM
}

# What those have said, and what they have counted.
finish_small_checks() {
    wait "$small"
    trap - INT TERM
    say
    cat "$logs/small-checks.log"
    read -r more_passed more_failed more_skipped more_broken < "$logs/small-checks.sums"
    passed=$((passed + more_passed)) failed=$((failed + more_failed)) skipped=$((skipped + more_skipped))
    broken="$broken${more_broken:+ }$more_broken"
    bad_ends="$bad_ends$(cat "$logs/small-checks.ends")"
}

all_checks() {
    step style sh "$root/scripts/style.sh"
    start_small_checks
    step tests build_and_test build-test '--no-suite faults' -Dauto_features=enabled --werror # faults: under the sanitizers
    step sanitizers with_sanitizers
    step fewer-parts fewer_parts
    step core core_alone
    finish_small_checks
}

everything=${CI-}
for argument in "$@"; do
    case $argument in
    --all) everything=true ;;
    -h | --help)
        usage
        exit 0
        ;;
    *)
        usage >&2
        exit 2
        ;;
    esac
done

start_of_all=$(date +%s)
ASJ_REQUIRE_OPENCL=1 # a test that finds no device fails: PoCL is there
export ASJ_REQUIRE_OPENCL
if [ "$everything" = true ]; then
    need cmocka clang mandoc venv opencl pocl oclgrind locale
    command -v ccache > /dev/null || (become_root && apt install -y --no-install-recommends ccache) > /dev/null 2>&1
    CCACHE_DIR=$root/out/ccache # builds with fewer parts compile much of the same
    export CCACHE_DIR
    patience=4
    all_checks
else
    need cmocka mandoc venv opencl pocl locale
    step tests build_and_test build-test '' -Dauto_features=enabled
fi

say
say "$(($(date +%s) - start_of_all)) s in all; logs are in out/log/ and build-test/meson-logs/"
say "$passed passed, $failed failed, $skipped skipped"
[ -z "$bad_ends" ] || say "$bad_ends" # once more: of a long output often only the end is kept
[ -z "$broken" ] || fail "FAILED:$broken"
say 'Everything passed.'
