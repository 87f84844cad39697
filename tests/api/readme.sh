#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The README keeps its word: its first C program builds, runs and prints the corners of the square, the lines that match fit the
# interface, and its option tables say what the library says.
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
"$@" -std=c99 -Wall -Wextra -Wpedantic -Werror -I"$include" -c "$work/match.c" -o "$work/match.o" || exit 1
"$@" -std=c99 -Wall -Wextra -Wpedantic -Werror -I"$include" "$work/first.c" "$library" -fopenmp -lm -ldl -o "$work/first" ||
    "$@" -std=c99 -I"$include" "$work/first.c" "$library" -lm -ldl -o "$work/first" || exit 1
"$work/first" > "$work/corners" || exit 1
cat "$work/corners"
awk 'function near(v, w) { return v > w - 0.3 && v < w + 0.3 }
     near($1, 59.5) && near($2, 59.5) { a++ } near($1, 139.5) && near($2, 59.5) { b++ }
     near($1, 59.5) && near($2, 139.5) { c++ } near($1, 139.5) && near($2, 139.5) { d++ }
     END { exit !(NR == 4 && a * b * c * d == 1) }' "$work/corners" || { echo 'those are not the four corners'; exit 1; }

cat > "$work/options.c" << 'END'
#include <asj/asj.h>
#include <stdio.h>
static void row(const asj_option_info *o, const char *standard, const char *paper)
{
    if (o->type == ASJ_OPTION_SWITCH || o->type == ASJ_OPTION_CHOICE)
        printf("| `%s` | %s | %s | %s |\n", o->key, standard, paper, o->help);
    else
        printf("| `%s` | %g .. %g%s%s | %s | %s | %s |\n", o->key, o->minimum, o->maximum, *o->unit ? " " : "", o->unit,
               standard, paper, o->help);
}
int main(void)
{
    char a[64], b[64];
    asj_detect_options d, e;
    asj_match_options m, n;
    asj_detect_options_preset(&d, ASJ_PRESET_DEFAULT);
    asj_detect_options_preset(&e, ASJ_PRESET_PAPER);
    asj_match_options_preset(&m, ASJ_PRESET_DEFAULT);
    asj_match_options_preset(&n, ASJ_PRESET_PAPER);
    for (size_t i = 0; i < asj_detect_option_count(); i++) {
        const asj_option_info *o = asj_detect_option(i);
        asj_detect_options_get(&d, o->key, a, sizeof a);
        asj_detect_options_get(&e, o->key, b, sizeof b);
        row(o, a, b);
    }
    for (size_t i = 0; i < asj_match_option_count(); i++) {
        const asj_option_info *o = asj_match_option(i);
        asj_match_options_get(&m, o->key, a, sizeof a);
        asj_match_options_get(&n, o->key, b, sizeof b);
        row(o, a, b);
    }
    return 0;
}
END
"$@" -std=c99 -I"$include" "$work/options.c" "$library" -fopenmp -lm -ldl -o "$work/options" ||
    "$@" -std=c99 -I"$include" "$work/options.c" "$library" -lm -ldl -o "$work/options" || exit 1
"$work/options" > "$work/rows"
# switches and choices have their words as range in the README: compared without that column
sed -E 's/^(\| `[a-z_]+` \|) (yes, no|[a-z_]+, [a-z_, ]+) \|/\1/' "$readme" > "$work/readme"
bad=0
while IFS= read -r line; do
    grep -qF -- "$line" "$work/readme" || { echo "not in the README: $line"; bad=1; }
done < "$work/rows"
echo "$(wc -l < "$work/rows") options"
exit $bad
