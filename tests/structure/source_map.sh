#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# src/README.md is a true map: source_map.sh ROOT. A section is about the first folder of src that it names (`detect/`, or a file
# there); the tables of the section name files of that folder, with or without their ends. Every file of every folder is named, and
# every name is a file. A folder that was left out of the checkout is passed over.
set -u
LC_ALL=C
export LC_ALL
cd "$1/src" || exit 1
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
folders=$(find . -mindepth 1 -maxdepth 1 -type d | sed 's|^\./||' | paste -sd '|' -)
awk -v folders="^(src|$folders)/" '/^## / { within = 1; folder = "" }
     within {
         text = $0
         while (match(text, /`[^`]+`/)) {
             name = substr(text, RSTART + 1, RLENGTH - 2)
             text = substr(text, RSTART + RLENGTH)
             if (name ~ folders && folder == "") {
                 folder = name
                 sub(/\/[^\/]*$/, "", folder)
             }
             if (/^\|/ && folder != "" && name ~ /^[a-z0-9_]+(\.(c|h|cpp))?$/) {
                 sub(/\..*/, "", name)
                 print folder "/" name
             }
         }
     }' README.md | sed 's|^src/||' | sort -u > "$work/all"
while IFS= read -r name; do # what is in folders that are here
    case $name in
    */*) [ ! -d "${name%/*}" ] || echo "$name" ;;
    *) echo "$name" ;;
    esac
done < "$work/all" > "$work/named"
find . -name '*.[ch]' -o -name '*.cpp' | sed 's|^\./||; s|\.[a-z]*$||' | sort -u > "$work/there"
comm -23 "$work/named" "$work/there" | sed 's/$/: named in src\/README.md, but not there/' > "$work/wrong"
comm -13 "$work/named" "$work/there" | sed 's/$/: not named in src\/README.md/' >> "$work/wrong"
cat "$work/wrong"
[ ! -s "$work/wrong" ] && [ "$(wc -l < "$work/named")" -gt 50 ] || exit 1
echo "$(wc -l < "$work/named") names"
