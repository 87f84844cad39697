#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# A program that was compiled against older headers works with this library (include/asj/version.h): older headers are made from
# these by giving the newest fields of structs back to `reserved`. Structs keep their size, and what the program finds is the same.
# older.sh INCLUDE_DIRECTORY LIBRARY C COMPILER...
set -u
include=$1 library=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/older"
cp -R "$include/asj" "$work/older"
cd "$work" || exit 99

# give_back HEADER FIELD BYTES: the line of the field becomes so many bytes of the same alignment, without its name
give_back() {
    sed "s/^    [a-z].* $2;/    unsigned char older_$3[$3];/" "older/asj/$1" > header
    cmp -s header "older/asj/$1" && { echo "$1 has no $2"; exit 1; }
    mv header "older/asj/$1"
}
give_back match.h 'end_tolerance' 8
give_back geometry.h 'scale_sd' 8
give_back detect.h 'x, y, width, height' 16
give_back options.h 'strip_test' 4

cat > program.c << 'END'
#include <asj/asj.h>
#include <stdio.h>
#include <string.h>

int main(void)
{
    static unsigned char pixels[200 * 200], mask[200 * 200];
    asj_context_options settings;
    asj_detect_options options;
    asj_match_options how;
    asj_region region;
    asj_context *context = NULL;
    asj_detection *found = NULL;
    asj_match_result *result = NULL;
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, 200, 200, 0, 0}, allowed = {mask, ASJ_FORMAT_GRAY8, 200, 200, 0, 0};
    for (int i = 0; i < 200 * 200; i++) {
        pixels[i] = i % 200 >= 60 && i % 200 < 140 && i / 200 >= 60 && i / 200 < 140 ? 210 : 40;
        mask[i] = i % 200 < 100;
    }
    asj_context_options_init(&settings);
    asj_detect_options_init(&options);
    asj_match_options_init(&how);
    memset(&region, 0, sizeof region);
    settings.backend = ASJ_BACKEND_CPU;
    options.epsilon = 0.5;
    how.ratio = 1;
    region.mask = &allowed;
    if (asj_context_create(&settings, &context) != ASJ_OK ||
        asj_detect_region(context, &image, &region, &options, &found) != ASJ_OK ||
        asj_match(context, &image, found->junctions, found->junction_count, &image, found->junctions, found->junction_count, &how,
                  &result) != ASJ_OK)
        return 1;
    printf("sizes %u %u %u %u\n", (unsigned)sizeof settings, (unsigned)sizeof options, (unsigned)sizeof how,
           (unsigned)sizeof region);
    for (unsigned i = 0; i < found->junction_count; i++)
        printf("%.9g %.9g %.9g\n", (double)found->junctions[i].x, (double)found->junctions[i].y,
               (double)found->junctions[i].branches[0].length);
    printf("%u matches\n", (unsigned)result->match_count);
    asj_match_result_free(&result);
    asj_detection_free(&found);
    asj_context_free(&context);
    return 0;
}
END
for version in older new; do
    headers=$include
    [ $version = new ] || headers=older
    "$@" -std=c99 -Wall -Wextra -I"$headers" program.c "$library" -Wl,-rpath,"$(dirname "$library")" -o program-$version || exit 1
    ./program-$version > $version.txt || { echo "$version: fails"; exit 1; }
done
cat new.txt
[ "$(wc -l < new.txt)" = 4 ] || { echo 'those are not the two corners that the mask leaves'; exit 1; }
cmp older.txt new.txt
