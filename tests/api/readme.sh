#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The README keeps its word: its first C program builds, runs and prints the corners of the square, the lines that match and those
# that read a file fit the interface, what it links to is there, and every knob that it names is an option.
# readme.sh README INCLUDE_DIRECTORY STATIC_LIBRARY C COMPILER...
set -u
readme=$1 include=$2 library=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# block N: the N-th block of C
block() {
    awk -v n="$1" '/^```c$/ { b++; inside = b == n; next } /^```$/ { inside = 0 } inside' "$readme"
}
if block 1 | grep -q 'int main'; then program=1 match=2; else program=2 match=1; fi
block $program > "$work/first.c"
{
    printf '#include <asj/asj.h>\n#include <stdio.h>\nvoid match(asj_context *context, asj_image image1, asj_image image2, '
    printf 'asj_detection *found1, asj_detection *found2);\n'
    printf 'void match(asj_context *context, asj_image image1, asj_image image2, asj_detection *found1, asj_detection *found2)\n{\n'
    block $match
    printf '}\n'
} > "$work/match.c"
{
    printf '#include <asj/io.h>\nvoid read_file(asj_context *context, asj_detection *found);\n'
    printf 'void read_file(asj_context *context, asj_detection *found)\n{\n'
    block 3
    printf '}\n'
} > "$work/read.c"
grep -q asj_image_file_read "$work/read.c" || { echo 'no image file is read'; exit 1; }
"$@" -std=c99 -Wall -Wextra -Wpedantic -Werror -I"$include" -c "$work/read.c" -o "$work/read.o" || exit 1
"$@" -std=c99 -Wall -Wextra -Wpedantic -Werror -I"$include" -c "$work/match.c" -o "$work/match.o" || exit 1
"$@" -std=c99 -Wall -Wextra -Wpedantic -Werror -I"$include" "$work/first.c" "$library" -pthread -lm -ldl -o "$work/first" ||
    "$@" -std=c99 -I"$include" "$work/first.c" "$library" -lm -ldl -o "$work/first" || exit 1
"$work/first" > "$work/corners" || exit 1
cat "$work/corners"
awk 'function near(v, w) { return v > w - 0.3 && v < w + 0.3 }
     near($1, 59.5) && near($2, 59.5) { a++ } near($1, 139.5) && near($2, 59.5) { b++ }
     near($1, 59.5) && near($2, 139.5) { c++ } near($1, 139.5) && near($2, 139.5) { d++ }
     END { exit !(NR == 4 && a * b * c * d == 1) }' "$work/corners" || { echo 'those are not the four corners'; exit 1; }

# it is short, and everything that it links to is there
[ "$(wc -c < "$readme")" -le 12288 ] || { echo 'over 12 kB'; exit 1; }
grep -oE '\]\([^)#]+\)' "$readme" | tr -d '])(' > "$work/links"
[ -s "$work/links" ] || exit 1
while IFS= read -r link; do
    [ -e "$(dirname "$readme")/$link" ] || { echo "no $link"; exit 1; }
done < "$work/links"

# every knob of the README's table is an option
cat > "$work/options.c" << 'END'
#include <asj/asj.h>
#include <stdio.h>
int main(void)
{
    for (size_t i = 0; i < asj_detect_option_count(); i++)
        puts(asj_detect_option(i)->key);
    for (size_t i = 0; i < asj_match_option_count(); i++)
        puts(asj_match_option(i)->key);
    return 0;
}
END
"$@" -std=c99 -I"$include" "$work/options.c" "$library" -pthread -lm -ldl -o "$work/options" ||
    "$@" -std=c99 -I"$include" "$work/options.c" "$library" -lm -ldl -o "$work/options" || exit 1
"$work/options" > "$work/keys"
awk '/^\| goal \| option \|$/ { on = 1; next } !/^\|/ { on = 0 } on' "$readme" | grep -oE '`[a-z_]+` [0-9]' | tr -d '` 0-9' |
    sort -u > "$work/knobs"
[ "$(wc -l < "$work/knobs")" -ge 5 ] || { echo 'no table of knobs'; exit 1; }
grep -vxFf "$work/keys" "$work/knobs" && { echo 'those are no options'; exit 1; }
echo "$(wc -l < "$work/knobs") knobs"
