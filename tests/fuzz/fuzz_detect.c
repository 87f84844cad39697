/* SPDX-License-Identifier: BSD-2-Clause */
/* The detector: any image of up to 40 x 40 pixels, any options. Twice the same input, twice the same junctions. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 40 }; /* px: larger ones visit the same code, slowly */

static asj_status set(void *options, const char *key, const char *text)
{
    return asj_detect_options_set(options, key, text, NULL, 0);
}

static void check_detection(const asj_detection *found)
{
    uint32_t i;
    int32_t b;
    for (i = 0; i < found->junction_count; i++) {
        const asj_junction *junction = &found->junctions[i];
        fuzz_check(junction->branch_count >= 2 && junction->branch_count <= ASJ_MAX_BRANCHES, "a branch count out of range");
        fuzz_check(junction->x >= -64 && junction->y >= -64 && junction->x <= (float)found->width + 64 &&
                   junction->y <= (float)found->height + 64, "a junction far outside");
        fuzz_check(isfinite(junction->log10_nfa) && isfinite(junction->location_sd), "a junction that is not finite");
        for (b = 0; b < junction->branch_count; b++) {
            const asj_branch *branch = &junction->branches[b];
            fuzz_check(branch->angle >= 0 && branch->angle <= 6.2831855f && branch->length >= 0, "a branch out of range");
            fuzz_check(isfinite(branch->length + branch->strength + branch->log10_nfa + branch->angle_sd + branch->width +
                                branch->length_sd), "a branch that is not finite");
        }
    }
    for (i = 0; i < found->l_junction_count; i++)
        fuzz_check(found->l_junctions[i].junction < found->junction_count, "an L-junction of nothing");
}

/* Every branch with a length is a part of one straight edge. */
static void check_segments(const asj_detection *found)
{
    asj_segment_list *list = NULL;
    uint32_t parts = 0, i;
    fuzz_check(asj_find_segments(fuzz_context(), found->junctions, found->junction_count, found->edges, found->edge_count, &list) ==
               ASJ_OK, "no segments of a detection");
    for (i = 0; i < list->count; i++) {
        parts += list->segments[i].branch_count;
        fuzz_check(list->of_branches[list->segments[i].junction * ASJ_MAX_BRANCHES + list->segments[i].branch] == i,
                   "a segment that its branch is no part of");
    }
    for (i = 0; i < list->junction_count * ASJ_MAX_BRANCHES; i++)
        parts -= list->of_branches[i] < list->count;
    fuzz_check(parts == 0, "branches that count twice, or not");
    asj_segment_list_free(&list);
}

/* None, or a rectangle, which may leave the image; sometimes the image itself is the mask. */
static asj_region *make_region(fuzz_bytes *bytes, const asj_image *image, asj_region *region)
{
    unsigned kind = fuzz_byte(bytes);
    if (kind & 1) {
        region->x = (int32_t)fuzz_byte(bytes) - 4;
        region->y = (int32_t)fuzz_byte(bytes) - 4;
        region->width = (int32_t)fuzz_byte(bytes);
        region->height = (int32_t)fuzz_byte(bytes);
    }
    if (kind & 2)
        region->mask = image;
    return region;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes bytes = {data, size};
    asj_detection *first = NULL, *second = NULL;
    asj_detect_options options;
    asj_image image;
    asj_region region = {0};
    asj_status status;

    asj_detect_options_preset(&options, (int32_t)(fuzz_byte(&bytes) % 3));
    fuzz_options(&bytes, asj_detect_option_count(), asj_detect_option, set, &options);
    fuzz_image(&bytes, MOST, &image);
    status = asj_detect_region(fuzz_context(), &image, make_region(&bytes, &image, &region), &options, &first);
    fuzz_check((status == ASJ_OK) == (first != NULL), "a status and a result that do not fit");
    if (first) {
        check_detection(first);
        check_segments(first);
        fuzz_check(asj_detect_region(fuzz_context(), &image, &region, &options, &second) == ASJ_OK, "no result the second time");
        fuzz_check(second->junction_count == first->junction_count &&
                   (!first->junction_count ||
                    !memcmp(first->junctions, second->junctions, first->junction_count * sizeof *first->junctions)),
                   "another result the second time");
    }
    asj_detection_free(&first);
    asj_detection_free(&second);
    free((void *)(size_t)image.data);
    return 0;
}
