#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The figures of README.md here.
set -eu

usage() {
    cat << 'END'
usage: sh tests/accuracy/tables.sh BUILD OUT [PAIRS [PART...]]

Runs the commands that stand above the tables of tests/accuracy/README.md and writes what they print into the folder OUT, a file for
each part; all of them take some hours. What is in OUT already stays as it is, so a run that was stopped
goes on. BUILD: a build folder with tests. PAIRS: a folder of pairs of photographs (tests/experiments/README.md); parts that need
some are left out without ("": none, to name parts). PYTHON in the environment names a Python with numpy, OpenCV and its contributed
modules, and, for the part ingredients, the asj package. Exit code: 1 when a part failed, 2 wrong usage.
END
}

wrong() {
    echo "tables.sh: $1" >&2
    exit 2
}

case ${1:--h} in
    -*) usage && exit 0 ;;
esac
[ $# -ge 2 ] || wrong "OUT is missing"
build=$1
out=$2
photographs=${3:-}
[ $# -gt 3 ] && shift 3 || set --
here=$(cd "$(dirname "$0")" && pwd)
python=${PYTHON:-python3}
tool=$build/tests/accuracy
cli=$build/cli/asj-cli
[ -x "$tool/accuracy" ] && [ -x "$cli" ] || wrong "$build is no build folder with tests"
[ -z "$photographs" ] || [ -d "$photographs" ] || wrong "$photographs is no folder"
case $photographs in *[[:space:]]*) wrong "a path with white space: $photographs" ;; esac
mkdir -p "$out"

# Results of two programs are not to stand side by side.
program=$(cksum "$cli" "$build"/src/libasj*.so.*.*.* 2> /dev/null || true)
if [ -e "$out/program" ] && [ "$(cat "$out/program")" != "$program" ]; then
    wrong "$out has results of another program"
fi
echo "$program" > "$out/program"

# The six indoor photographs that repeatability was worked on with, and the others.
some=
others=
for name in drawer textureless_corridor lowTexture occlusion glasscaseb scannet0758; do
    [ -e "$photographs/$name/1.png" ] && some="$some $photographs/$name/1.png"
done
for file in "$photographs"/*/[12].png; do
    case " $some " in *" $file "*) ;; *) [ -e "$file" ] && others="$others $file" ;; esac
done

wanted=$*
known=
failed=0

# part NAME COMMAND...: OUT/NAME.txt, unless it is there or parts were asked for and this is none of them.
part() {
    name=$1
    known="$known $name"
    shift
    case " $wanted " in "  " | *" $name "*) ;; *) return 0 ;; esac
    [ -e "$out/$name.txt" ] && return 0
    if "$@" > "$out/.$name" 2>&1; then
        mv "$out/.$name" "$out/$name.txt"
        echo "$name"
    else
        echo "$name: FAILED, see $out/.$name" >&2
        failed=1
    fi
}

# of_some and of_others NAME COMMAND...: the same for a command that ends with the names of such photographs, unless there are none.
of_some() {
    [ -z "$some" ] || part "$@" $some
}

of_others() {
    [ -z "$others" ] || part "$@" $others
}

# Ends the script; wrong when something asked for is no part of it, or none without PAIRS.
finish() {
    for name in $wanted; do
        case " $known " in *" $name "*) ;; *) wrong "$name is no part that can be made" ;; esac
    done
    exit $failed
}

# Detection, on what is rendered.
part corners "$tool/accuracy" --scenes 100
part corners-one-octave "$tool/accuracy" --scenes 100 octaves=1
part corners-half-octaves "$tool/accuracy" --scenes 100 half_octaves=1
part corners-complete "$tool/accuracy" --scenes 100 complete_junctions=1
part corners-finer "$tool/accuracy" --scenes 100 first_octave=-1
part noise-images "$tool/accuracy" --scenes 1000 --row noise
part noise-finer "$tool/accuracy" --scenes 1000 --row noise first_octave=-1
part noise "$tool/noise" --images 1000
part noise-paper "$tool/noise" --images 1000 --preset paper --ways scanned,detector,everywhere
part lines "$tool/lines"
part lines-complete "$tool/lines" complete_junctions=1
part lines-half-octaves "$tool/lines" half_octaves=1
part lines-finer "$tool/lines" first_octave=-1
part lines-one-octave "$tool/lines" octaves=1
part lines-noise "$tool/lines" --noise 5
part lines-blur "$tool/lines" --blur 2
part lines-peers "$python" "$here/line_peers.py" "$tool/lines"

# Matching of what is rendered.
part room "$tool/match_room"
part rooms "$tool/match_room" --rooms --last 40
part rooms-fresh "$tool/match_room" --rooms --first 101 --last 140
part rooms-finer "$tool/match_room" --rooms --first-octave -1 --last 48

# Two views far apart.
part far-as-they-are "$tool/wide_rooms" --poses --as-they-are --first 1000 --last 1399
part far "$tool/wide_rooms" --poses --first 1000 --last 1399
part far-no-colours "$tool/wide_rooms" --poses --colours no --first 1000 --last 1399
part far-fresh "$tool/wide_rooms" --poses --first 7100 --last 7299
part near "$tool/wide_rooms" --poses --near --first 3000 --last 3149
part turned "$tool/wide_rooms" --as-they-are --turned --first 0 --last 99
part turned-focal "$tool/wide_rooms" --as-they-are --turned --find-focal --first 0 --last 99
part find-focal "$tool/wide_rooms" --poses --find-focal --first 1000 --last 1199
for error in 0 0.03 -0.03; do
    part "focal-$error-exact" "$tool/wide_rooms" --poses --as-they-are --focal-error $error --first 1000 --last 1078
    part "focal-$error-about" "$tool/wide_rooms" --poses --as-they-are --focal-error $error --focal-sd 0.05 --first 1000 --last 1078
done
part directions "$tool/directions" --first 0 --last 99
part directions-fresh "$tool/directions" --first 7300 --last 7349
part unrelated-rooms "$tool/wide_rooms" --unrelated --colours no --first 1000 --last 1399
part stages "$tool/wide_stages" --first 0 --last 99
part facades "$python" "$here/facades.py" "$cli" --seeds 6 --stains 0,6,10,15

# Photographs.
[ -n "$photographs" ] || finish
of_some repeatability "$tool/repeatability"
of_others repeatability-others "$tool/repeatability"
of_some repeatability-surest "$tool/repeatability" epsilon=1e-15
of_others repeatability-others-surest "$tool/repeatability" epsilon=1e-15
of_some zoom "$python" "$here/zoom.py" "$cli"
of_others zoom-others "$python" "$here/zoom.py" "$cli"
[ -z "$some" ] || part zoom-half-octaves "$python" "$here/zoom.py" "$cli" $some -- --half-octaves yes
[ -z "$others" ] || part zoom-others-half-octaves "$python" "$here/zoom.py" "$cli" $others -- --half-octaves yes
[ -z "$others" ] || part zoom-others-surer "$python" "$here/zoom.py" "$cli" $others -- --epsilon 1e-10
[ -z "$others" ] || part zoom-others-surest "$python" "$here/zoom.py" "$cli" $others -- --epsilon 1e-15
[ -z "$some" ] || part zoom-finer "$python" "$here/zoom.py" "$cli" $some -- --first-octave -1
of_some losses "$tool/losses" octaves=16
of_some losses-every-pixel "$tool/losses" octaves=16 candidate_step=1
[ -z "$some$others" ] || part crossing-lines "$python" "$here/crossing_lines.py" "$cli" $some $others
part pairs-as-they-are "$python" "$here/pairs.py" "$cli" "$photographs" -- --stretch 1
part pairs "$python" "$here/pairs.py" "$cli" "$photographs"
part pairs-fewer-octaves "$python" "$here/pairs.py" "$cli" "$photographs" -- --upsampled-half-octaves no
part pairs-geometry "$python" "$here/pairs.py" "$cli" "$photographs" -- --geometry auto
part pairs-paper "$python" "$here/pairs.py" "$cli" "$photographs" -- --preset paper
part pairs-paper-sift "$python" "$here/pairs.py" "$cli" "$photographs" -- --preset paper --descriptor sift
for ends in both inner cut; do
    part "lines-$ends" "$python" "$here/pairs.py" "$cli" "$photographs" -- --lines --line-ends $ends
done
part lines-joined "$python" "$here/pairs.py" "$cli" "$photographs" -- --lines --join-lines
part frames "$python" "$here/pairs.py" "$cli" "$photographs" --cameras -- --geometry auto
part frames-cropped "$python" "$here/pairs.py" "$cli" "$photographs" --cameras --crops -- --geometry auto
part frames-as-they-are "$python" "$here/pairs.py" "$cli" "$photographs" --cameras -- --geometry auto --upsample-from 0
part unrelated "$python" "$here/unrelated.py" "$cli" "$photographs" --every 3
part unrelated-matches "$python" "$here/unrelated.py" "$cli" "$photographs" --every 3 --whole -- --geometry none
part ingredients "$python" "$here/ingredients.py" --seeds 2 "$photographs"
part agreement "$tool/agreement" --check --preset=paper "$photographs"
finish
