#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# What .editorconfig asks for, checked: tabs, blanks at the end of a line, characters beyond ASCII, lines over 132 columns, files
# that do not end with a newline, files over 800 lines, two empty lines (but in Python); what only the sed of GNU knows; and
# vectors loaded as if an aligned float stood there, of whatever it is. Prints every offence; exit code 1 when there is one.
set -u
cd "$(dirname "$0")/.." || exit 1
export LC_ALL=C
files=$(find include src kernels cli tests scripts meson.build meson_options.txt -type f \( -name '*.[ch]' -o -name '*.cpp' \
    -o -name '*.cl' -o -name '*.clh' -o -name '*.py' -o -name '*.sh' -o -name '*.awk' -o -name 'meson*' \
    -o -name '*.[15]' \) 2> /dev/null)
[ -n "$files" ] || exit 1
{
    tab=$(printf '\t')
    grep -n "$tab" $files | sed 's/$/  <- tab/'
    grep -nE '[[:space:]]$' $files | sed 's/$/  <- blank at the end/'
    grep -n '[^ -~]' $files | grep -v "$tab" | sed 's/$/  <- not ASCII/'
    grep -nE '^.{133,}' $files | sed 's/$/  <- over 132 columns/'
    grep -nE '[s]ed .*[\][(].*[\][|]' $files | sed 's/$/  <- alternatives, which only the sed of GNU knows/'
    grep -nE '_mm_load1?_(s[sd]|p[sd]1?)[(]' $files | grep -v '^scripts/' | sed 's/$/  <- reads an aligned float: memcpy()/'
    awk 'FNR == 1 { empty = 0 }
         !/./ { if (empty && FILENAME !~ /[.]py$/) print FILENAME ":" FNR "  <- two empty lines"; empty = 1; next }
         { empty = 0 }
         /^ [*] [*]\/$/ { print FILENAME ":" FNR "  <- an empty end of a comment" }' $files
    for file in $files; do
        [ -z "$(tail -c 1 "$file")" ] || echo "$file: no newline at the end"
        [ "$(wc -l < "$file")" -le 800 ] || echo "$file: over 800 lines"
    done
} | awk '{ print } END { exit NR > 0 }'
