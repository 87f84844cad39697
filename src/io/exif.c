/* SPDX-License-Identifier: BSD-2-Clause */
/* EXIF 2.3 section 4.6.2 (TIFF structure) and 4.6.4 A (Orientation). */
#include "exif.h"

#include <string.h>

#define TAG_ORIENTATION 0x0112u
#define TYPE_SHORT 3u
#define TYPE_LONG 4u
#define ENTRY_SIZE 12u

typedef struct tiff_bytes {
    const unsigned char *bytes;
    size_t size;
    int big_endian;
} tiff_bytes;

static uint32_t get16(const tiff_bytes *tiff, size_t at)
{
    const unsigned char *b = tiff->bytes + at;
    return tiff->big_endian ? (uint32_t)b[0] << 8 | b[1] : (uint32_t)b[1] << 8 | b[0];
}

static uint32_t get32(const tiff_bytes *tiff, size_t at)
{
    return tiff->big_endian ? get16(tiff, at) << 16 | get16(tiff, at + 2) : get16(tiff, at + 2) << 16 | get16(tiff, at);
}

/* Where the value of a tag stands in the first directory, if it is one number that fits there; 0 when it is not there. */
static size_t find_value(const tiff_bytes *tiff, unsigned tag, uint32_t *type)
{
    size_t directory, count, i;

    if (tiff->size < 8 || get16(tiff, 2) != 42)
        return 0;
    directory = get32(tiff, 4);
    if (directory > tiff->size - 2)
        return 0;
    count = get16(tiff, directory);
    for (i = 0; i < count; i++) {
        size_t entry = directory + 2 + i * ENTRY_SIZE;
        if (entry + ENTRY_SIZE > tiff->size)
            return 0;
        *type = get16(tiff, entry + 2);
        if (get16(tiff, entry) == tag && get32(tiff, entry + 4) == 1 && (*type == TYPE_SHORT || *type == TYPE_LONG))
            return entry + 8;
    }
    return 0;
}

static tiff_bytes open_tiff(const unsigned char *block, size_t size)
{
    tiff_bytes tiff = {block, size, 0};
    if (size >= 2 && !memcmp(block, "MM", 2))
        tiff.big_endian = 1;
    else if (size < 2 || memcmp(block, "II", 2))
        tiff.size = 0;
    return tiff;
}

int32_t asj_tiff_value(const unsigned char *block, size_t size, unsigned tag, uint32_t *value)
{
    tiff_bytes tiff = open_tiff(block, size);
    uint32_t type;
    size_t at = find_value(&tiff, tag, &type);

    if (at)
        *value = type == TYPE_SHORT ? get16(&tiff, at) : get32(&tiff, at);
    return at > 0;
}

void asj_tiff_set_upright(unsigned char *block, size_t size)
{
    tiff_bytes tiff = open_tiff(block, size);
    uint32_t type;
    size_t at = find_value(&tiff, TAG_ORIENTATION, &type), width;

    if (!at)
        return;
    width = type == TYPE_SHORT ? 2 : 4;
    memset(block + at, 0, width);
    block[tiff.big_endian ? at + width - 1 : at] = 1;
}

int32_t asj_exif_orientation(const unsigned char *block, size_t size)
{
    uint32_t value;
    return asj_tiff_value(block, size, TAG_ORIENTATION, &value) && value >= 1 && value <= 8 ? (int32_t)value : 1;
}

void asj_turn_upright(unsigned char *copy, const unsigned char *pixels, ptrdiff_t stride, int32_t width, int32_t height,
                      size_t pixel_size, int32_t orientation)
{
    /* The upright pixel (x, y) is the stored pixel `first + x across + y down`. Which corner of the stored image is the upright
     * one's top left, and whether rows become columns: */
    static const unsigned char from_right[9] = {0, 0, 1, 1, 0, 0, 0, 1, 1};
    static const unsigned char from_bottom[9] = {0, 0, 0, 1, 1, 0, 1, 1, 0};
    int transposed = orientation >= 5;
    ptrdiff_t step = (ptrdiff_t)pixel_size;
    const unsigned char *first = pixels;
    ptrdiff_t along_row = step, along_column = stride, across, down, x, y;
    ptrdiff_t upright_width = transposed ? height : width, upright_height = transposed ? width : height;

    if (from_right[orientation]) {
        first += (width - 1) * step;
        along_row = -step;
    }
    if (from_bottom[orientation]) {
        first += (height - 1) * stride;
        along_column = -stride;
    }
    across = transposed ? along_column : along_row;
    down = transposed ? along_row : along_column;
    for (y = 0; y < upright_height; y++)
        for (x = 0; x < upright_width; x++, copy += pixel_size)
            memcpy(copy, first + x * across + y * down, pixel_size);
}
