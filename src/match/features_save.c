/* SPDX-License-Identifier: BSD-2-Clause */
/* Features to bytes: features_bytes.h. */
#include "core/bytes.h"
#include "features_bytes.h"
#include "upsampled.h"
#include "kept_features.h"

#include <stdio.h>
#include <string.h>

/* Writes the options' text when `to` is not NULL; returns its length. */
static size_t put_options(const asj_match_options *options, uint8_t *to)
{
    char line[ASJ_FEATURES_LONGEST_LINE], value[ASJ_FEATURES_LONGEST_LINE / 2];
    size_t size = 0;
    for (size_t n = 0; n < asj_match_option_count(); n++) {
        const char *key = asj_match_option(n)->key;
        asj_match_options_get(options, key, value, sizeof value);
        const int length = snprintf(line, sizeof line, "%s=%s\n", key, value);
        if (to)
            memcpy(to + size, line, (size_t)length);
        size += (size_t)length;
    }
    return size;
}

static uint8_t *put_floats(uint8_t *to, const float *values, size_t count)
{
    for (size_t n = 0; n < count; n++, to += 4)
        asj_put_float(to, values[n]);
    return to;
}

static uint8_t *put_junction(uint8_t *to, const asj_junction *j)
{
    const float head[] = {j->x, j->y, j->scale, j->log10_nfa, j->location_sd};
    to = put_floats(to, head, 5);
    asj_put_u32(to, (uint32_t)j->branch_count);
    asj_put_u32(to + 4, (uint32_t)j->octave);
    to += 8;
    for (int32_t b = 0; b < j->branch_count; b++) {
        const asj_branch *branch = &j->branches[b];
        const float values[] = {branch->angle,     branch->length,   branch->strength,
                                branch->log10_nfa, branch->angle_sd, branch->width, branch->length_sd};
        to = put_floats(to, values, 7);
        asj_put_u32(to, (uint32_t)branch->end);
        to += 4;
    }
    return to;
}

static uint8_t *put_plane(uint8_t *to, const asj_features *features)
{
    const asj_pyramid *pyramid = &features->of_image.pyramid;
    const size_t width = (size_t)pyramid->width[0], stride = features->has_upsampled ? width : width + 1;
    const uint16_t *plane = features->has_upsampled ? features->gray : pyramid->plane[0];
    for (size_t y = 0; y < (size_t)pyramid->height[0]; y++)
        for (size_t x = 0; x < width; x++, to += 2)
            asj_put_u16(to, plane[y * stride + x]);
    return to;
}

static uint8_t *put_colours(uint8_t *to, const asj_image_features *of_image)
{
    for (uint32_t n = 0; of_image->colours && n < of_image->l_junctions.count; n++)
        for (int32_t k = 0; k < 3 * ASJ_COLOUR_REGIONS; k++, to += 2)
            asj_put_u16(to, of_image->colours[n].level[k / 3][k % 3]);
    return to;
}

static size_t colour_bytes(const asj_image_features *of_image)
{
    return of_image->colours ? ASJ_FEATURES_COLOUR_BYTES * (size_t)of_image->l_junctions.count : 0;
}

static uint32_t version_of(const asj_features *features)
{
    uint32_t version = ASJ_FEATURES_VERSION;
    version += features->of_image.colours ? ASJ_FEATURES_COLOURS : 0;
    version += features->has_upsampled ? ASJ_FEATURES_UPSAMPLED : 0;
    version += features->of_image.picture.level ? ASJ_FEATURES_PICTURE : 0;
    return version + (features->upsampled.colours ? ASJ_FEATURES_UPSAMPLED_COLOURS : 0);
}

size_t asj_features_save(const asj_features *features, void *bytes, size_t capacity)
{
    if (!features)
        return 0;
    const asj_pyramid *pyramid = &features->of_image.pyramid;
    const asj_small_picture *picture = &features->of_image.picture;
    const size_t text = put_options(&features->options, NULL), pixels = (size_t)pyramid->width[0] * (size_t)pyramid->height[0];
    const size_t small = picture->level ? asj_small_picture_bytes(picture) : 0;
    size_t size = ASJ_FEATURES_HEADER + text + ASJ_FEATURES_JUNCTION_BYTES * (size_t)features->junction_count + 2 * pixels;
    for (uint32_t n = 0; n < features->junction_count; n++)
        size += ASJ_FEATURES_BRANCH_BYTES * (size_t)features->junctions[n].branch_count;
    size += colour_bytes(&features->of_image) + colour_bytes(&features->upsampled) + small;
    if (!bytes || capacity < size)
        return size;
    uint8_t *start = bytes, *to = start + ASJ_FEATURES_HEADER + text;
    memcpy(start, ASJ_FEATURES_MAGIC, ASJ_FEATURES_MAGIC_SIZE);
    asj_put_u32(start + 8, version_of(features));
    asj_put_u64(start + 16, size);
    asj_put_u32(start + 24, (uint32_t)pyramid->width[0]);
    asj_put_u32(start + 28, (uint32_t)pyramid->height[0]);
    asj_put_u32(start + 32, (uint32_t)text);
    asj_put_u32(start + 36, features->junction_count);
    put_options(&features->options, start + ASJ_FEATURES_HEADER);
    for (uint32_t n = 0; n < features->junction_count; n++)
        to = put_junction(to, &features->junctions[n]);
    to = put_plane(to, features);
    to = put_colours(to, &features->of_image);
    to = put_colours(to, &features->upsampled);
    if (small > 0)
        memcpy(to, picture->level, small);
    asj_put_u32(start + 12, asj_crc32(start + ASJ_FEATURES_CHECKED, size - ASJ_FEATURES_CHECKED));
    return size;
}
