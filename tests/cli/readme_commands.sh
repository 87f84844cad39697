#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The commands of README.md work as they stand there: readme_commands.sh README CLI SAMPLE_ROOM. Runs every line that begins with
# build/cli/asj-cli, in a folder where that program and the pictures of scripts/demo.sh are, and nothing else.
set -u
readme=$(cd "$(dirname "$1")" && pwd)/${1##*/}
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/build/cli" "$work/out/room"
ln -s "$2" "$work/build/cli/asj-cli"
"$3" "$work/out/room" > /dev/null || exit 99
for view in 1 2; do
    cp "$work/out/room/$view.png" "$work/out/room-$view.png" || exit 99
done
cd "$work" || exit 99
XDG_CACHE_HOME=$work/cache
export XDG_CACHE_HOME
grep '^build/cli/asj-cli ' "$readme" > commands
count=0
while IFS= read -r command; do
    case $command in
    *--backend\ opencl*) [ "${ASJ_REQUIRE_OPENCL-}" = 1 ] || continue ;; # where there is a device for sure
    esac
    if ! sh -c "$command" > printed 2> said < /dev/null; then
        echo "failed: $command"
        cat said
        exit 1
    fi
    made=$(printf '%s\n' "$command" | sed 's/#.*//' | grep -oE '(-o|--plot) out/[a-z.]+' | sed 's/.* //')
    if [ -z "$made" ] && [ ! -s printed ] && [ "${command#*--out-dir}" = "$command" ]; then
        echo "nothing printed: $command"
        exit 1
    fi
    for file in $made; do
        [ -s "$file" ] || { echo "no $file: $command"; exit 1; }
    done
    count=$((count + 1))
done < commands
[ -s out/room-1.plot.svg ] && [ "$count" -ge 7 ] || { echo "only $count commands"; exit 1; }
echo "$count commands"
