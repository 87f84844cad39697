#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Builds asj-cli and shows what it does: sh scripts/demo.sh [IMAGE...]
set -u
root=$(cd "$(dirname "$0")/.." && pwd) || exit 1
. "$root/scripts/common.sh"

usage() {
    cat << 'END'
usage: sh scripts/demo.sh [IMAGE...]

Installs what is missing (apt-get), builds asj-cli in build/, and finds the junctions of the photographs given, or of a room that
it renders itself. Writes to out/: NAME.csv with the junctions and NAME.plot.png with the junctions drawn over the picture.
The room's two views are room-1.png and room-2.png. Without photographs it finds the corners that they have in common, too:
room-matches.csv, room-matches.png.
"Right" counts what is where the room's own geometry puts it, within 3 px.
Exit code: 0 done, 1 something failed, 2 wrong usage, 3 packages are missing and cannot be installed here.
END
}

photographs=$#
for image in "$@"; do
    shift
    case $image in
    -h | --help)
        usage
        exit 0
        ;;
    -*)
        usage >&2
        exit 2
        ;;
    /*) ;;
    *) image=$PWD/$image ;;
    esac
    set -- "$@" "$image"
done

# Where asj-cli puts the results of an image, without the ending.
result_of() {
    result=${1##*/}
    result=$out/${result%.*}
}

# A photograph has no truth; out/room-N.png is judged by out/room/N.csv.
report() {
    result_of "$1"
    if [ ! -s "$result.csv" ] || [ ! -s "$result.plot.png" ]; then
        say "$1: no result"
        return 1
    fi
    count=$(awk -F, 'FNR > 1 && !($1 in seen) { seen[$1]; n++ } END { print n + 0 }' "$result.csv")
    right=
    if [ "$photographs" = 0 ]; then
        right=$(LC_ALL=C awk -F, -f scripts/corners.awk "out/room/${result##*-}.csv" "$result.csv")
        [ "${right% *}" = "$count" ] || fail 'cannot compare with the true junctions'
        right=${right#* }
    fi
    say "$1: $count junctions${right:+, $right of them right}"
    say "    look at  $result.plot.png"
    say "    numbers  $result.csv"
    [ "$right" != 0 ]
}

# Matches the two views of the sample room, and checks them against out/room/.
match_rooms() {
    rm -f out/room-matches.csv out/room-matches.png
    say 'Running build/cli/asj-cli match -o out/room-matches.csv --plot out/room-matches.png out/room-1.png out/room-2.png'
    build/cli/asj-cli match --quiet -o out/room-matches.csv --plot out/room-matches.png out/room-1.png out/room-2.png || return 1
    set -- $(LC_ALL=C awk -F, -f scripts/matches.awk out/room/truth.json out/room-matches.csv)
    [ $# = 2 ] || fail 'cannot compare with the true geometry'
    say
    say "out/room-1.png and out/room-2.png: $1 matches, $2 of them right"
    say "    look at  $out/room-matches.png"
    say "    numbers  $out/room-matches.csv"
    [ "$2" -gt 0 ]
}

need
say 'Building asj-cli in build/'
configure build -Dio=enabled -Dcli=enabled -Dcairo=enabled -Dopencv=enabled -Dtests=auto || exit 1
out=out
[ "$PWD" = "$root" ] || out=$root/out
cd "$root" || exit 1
logged build meson compile -C build programs sample-room || exit 1
build/tests/synth/sample-room out/room || fail 'cannot render the sample room'
for view in 1 2; do
    cp "out/room/$view.png" "out/room-$view.png" || exit 1
done
[ "$photographs" != 0 ] || set -- out/room-1.png out/room-2.png

seen=
for image in "$@"; do
    result_of "$image"
    case $seen in
    *"|$result|"*) fail "$image: another image has its name, and so would its results in $out/" ;;
    esac
    seen="$seen|$result|"
    rm -f "$result.csv" "$result.plot.png"
done
say 'Running build/cli/asj-cli detect --out-dir out --format csv --plot png IMAGE...'
build/cli/asj-cli detect --quiet --out-dir out --format csv --plot png -- "$@"
status=$?
[ "$status" -le 1 ] || fail "asj-cli ended with exit code $status"
say
for image in "$@"; do
    report "$image" || status=1
done
if [ "$photographs" = 0 ]; then
    say
    match_rooms || status=1
fi
[ "$status" = 0 ] || fail 'something failed: see the messages above'
say
say "The program is ${out%out}build/cli/asj-cli; README.md goes on from here with \"The first minute\"."
