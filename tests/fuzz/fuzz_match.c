/* SPDX-License-Identifier: BSD-2-Clause */
/* The matcher: two images of up to 96 x 96 pixels, often one and a part of it, any options, junctions of any kind, bad ones too, or
 * those of the detector; often with a geometry. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

enum { MOST = 64, MOST_MADE = 24 };

static asj_status set(void *options, const char *key, const char *text)
{
    return asj_match_options_set(options, key, text, NULL, 0);
}

static size_t make_junctions(fuzz_bytes *bytes, const asj_image *image, asj_junction *junctions)
{
    size_t count = fuzz_byte(bytes) % (MOST_MADE + 1), i;
    memset(junctions, 0, MOST * sizeof *junctions);
    for (i = 0; i < count; i++) {
        asj_junction *junction = &junctions[i];
        int32_t b;
        junction->x = (float)fuzz_byte(bytes) / 255.0f * (float)image->width;
        junction->y = (float)fuzz_byte(bytes) / 255.0f * (float)image->height;
        junction->scale = (float)(3 + fuzz_byte(bytes) % 12);
        const unsigned branches = fuzz_byte(bytes);
        junction->branch_count = (int32_t)(branches < 250 ? branches % 6 : 6); /* which is refused */
        for (b = 0; b < junction->branch_count && b < ASJ_MAX_BRANCHES; b++) {
            junction->branches[b].angle = (float)(fuzz_pair(bytes) % 62832) / 10000.0f;
            junction->branches[b].length = (float)fuzz_byte(bytes);
            junction->branches[b].strength = 3;
        }
    }
    return count;
}

/* The second image: the first one without some columns and rows. */
static void show_part(unsigned where, asj_image images[2])
{
    const int32_t dx = (int32_t)(where % 8), dy = (int32_t)(where / 8 % 8);
    const size_t pixel = fuzz_pixel_bytes(images[0].format), row = pixel * (size_t)images[0].width;
    if (images[0].width <= dx || images[0].height <= dy)
        return;
    images[1] = images[0];
    images[1].data = (const uint8_t *)images[0].data + (size_t)dy * row + (size_t)dx * pixel;
    images[1].width -= dx;
    images[1].height -= dy;
    images[1].stride = (ptrdiff_t)row;
}

/* Up to MOST junctions of the detector in place of those that the bytes make. */
static void detect(const asj_image *image, asj_junction *junctions, size_t *count)
{
    asj_detect_options options;
    asj_detection *found = NULL;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    if (asj_detect(fuzz_context(), image, &options, &found) != ASJ_OK) /* NaN */
        return;
    *count = found->junction_count < MOST ? found->junction_count : MOST;
    if (*count > 0)
        memcpy(junctions, found->junctions, *count * sizeof *junctions);
    asj_detection_free(&found);
}

static void make_geometry(fuzz_bytes *bytes, asj_geometry_options *geometry)
{
    const unsigned what = fuzz_byte(bytes);
    if (what < 64)
        return;
    geometry->model = (int32_t)(what % 6); /* 0: none; 5 is refused */
    geometry->samples = 1 + (int32_t)(fuzz_byte(bytes) % 64);
    fuzz_geometry_options(bytes, geometry);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes bytes = {data, size};
    asj_junction junctions[2][MOST];
    asj_segment_match segments[4];
    asj_match_result *result = NULL;
    asj_match_options options;
    asj_image images[2];
    void *pixels_of[2];
    size_t counts[2], v;
    unsigned how;
    asj_status status;

    asj_match_options_preset(&options, fuzz_byte(&bytes) % 4 == 3 ? ASJ_PRESET_PAPER : ASJ_PRESET_DEFAULT);
    fuzz_options(&bytes, asj_match_option_count(), asj_match_option, set, &options);
    for (v = 0; v < 2; v++) {
        fuzz_bytes pixels = {bytes.next, bytes.left < 80 ? bytes.left : 80}; /* both images have what to draw from */
        fuzz_image(&pixels, 96, &images[v]);
        bytes.next = pixels.next;
        bytes.left -= (bytes.left < 80 ? bytes.left : 80) - pixels.left;
    }
    for (v = 0; v < 2; v++)
        pixels_of[v] = (void *)(size_t)images[v].data;
    how = fuzz_byte(&bytes);
    if (how & 1)
        show_part(how / 4, images);
    for (v = 0; v < 2; v++) {
        counts[v] = make_junctions(&bytes, &images[v], junctions[v]);
        if (how & 2)
            detect(&images[v], junctions[v], &counts[v]);
    }
    make_geometry(&bytes, &options.geometry);
    status = asj_match(fuzz_context(), &images[0], junctions[0], counts[0], &images[1], junctions[1], counts[1], &options, &result);
    fuzz_check((status == ASJ_OK) == (result != NULL), "a status and a result that do not fit");
    if (result) {
        uint32_t i;
        fuzz_check_geometry(&result->geometry);
        fuzz_check(options.geometry.model != ASJ_GEOMETRY_NONE || result->geometry.status == ASJ_GEOMETRY_NOT_ASKED,
                   "a geometry that nobody asked for");
        for (i = 0; i < result->rejected_count; i++)
            fuzz_check(result->rejected[i].l1 < result->l_junction_count1 && result->rejected[i].l2 < result->l_junction_count2,
                       "a rejected match of nothing");
        for (i = 0; i < result->match_count; i++)
            fuzz_check(result->matches[i].l1 < result->l_junction_count1 && result->matches[i].l2 < result->l_junction_count2 &&
                       result->matches[i].distance == result->matches[i].distance, "a match of nothing");
        const size_t all = asj_match_segments(result, ASJ_END_CUT, segments, 4);
        fuzz_check(all <= (size_t)ASJ_MAX_BRANCHES * result->match_count, "more segments than promised");
        const size_t joined = asj_join_segment_matches(segments, all < 4 ? all : 4);
        fuzz_check(joined <= all && asj_join_segment_matches(segments, joined) == joined, "segments that join again");
    }
    asj_match_result_free(&result);
    for (v = 0; v < 2; v++)
        free(pixels_of[v]);
    return 0;
}
