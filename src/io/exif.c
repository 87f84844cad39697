/* SPDX-License-Identifier: BSD-2-Clause */
/* EXIF 2.3 section 4.6.2 (TIFF structure) and 4.6.4 A (Orientation); CIPA DC-007 section 5.2 (index of multi-picture files). */
#include "exif.h"

#include <string.h>

#define TAG_ORIENTATION 0x0112u
#define TAG_MPF_ENTRIES 0xb002u
#define TYPE_SHORT 3u
#define TYPE_LONG 4u
#define TYPE_LONG8 16u

typedef struct tiff_bytes {
    const unsigned char *bytes;
    size_t size;
    int big_endian;
    int is_big; /* BigTIFF: offsets and counts of 64 bits */
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

static uint64_t get64(const tiff_bytes *tiff, size_t at)
{
    uint64_t first = get32(tiff, at), second = get32(tiff, at + 4);
    return tiff->big_endian ? first << 32 | second : second << 32 | first;
}

/* An offset or a count as wide as the kind of file has it. */
static uint64_t get_word(const tiff_bytes *tiff, size_t at)
{
    return tiff->is_big ? get64(tiff, at) : get32(tiff, at);
}

/* A value that is one number and stands in the entry; 0 when it is of another type, or too large. */
static int32_t read_entry(const tiff_bytes *tiff, size_t entry, uint32_t *value)
{
    size_t word = tiff->is_big ? 8 : 4, at = entry + 4 + word;
    uint32_t type = get16(tiff, entry + 2);

    if (get_word(tiff, entry + 4) != 1)
        return 0;
    if (type == TYPE_SHORT) {
        *value = get16(tiff, at);
        return 1;
    }
    if (type == TYPE_LONG) {
        *value = get32(tiff, at);
        return 1;
    }
    if (type == TYPE_LONG8 && tiff->is_big && get64(tiff, at) <= UINT32_MAX) {
        *value = (uint32_t)get64(tiff, at);
        return 1;
    }
    return 0;
}

/* Where a tag's first entry in the first directory stands; 0 when there is none. */
static size_t find_entry(const tiff_bytes *tiff, unsigned tag)
{
    size_t word = tiff->is_big ? 8 : 4, head = tiff->is_big ? 8 : 2, entry_size = 4 + 2 * word, entry;
    uint64_t directory, count, i;

    if (!tiff->size)
        return 0;
    directory = get_word(tiff, tiff->is_big ? 8 : 4);
    if (directory > tiff->size - head)
        return 0;
    count = tiff->is_big ? get64(tiff, (size_t)directory) : get16(tiff, (size_t)directory);
    for (i = 0, entry = (size_t)directory + head; i < count && entry_size <= tiff->size - entry; i++, entry += entry_size)
        if (get16(tiff, entry) == tag)
            return entry;
    return 0;
}

static tiff_bytes open_tiff(const unsigned char *block, size_t size)
{
    tiff_bytes tiff = {block, size, 0, 0};
    if (size >= 2 && !memcmp(block, "MM", 2))
        tiff.big_endian = 1;
    else if (size < 2 || memcmp(block, "II", 2))
        tiff.size = 0;
    if (tiff.size < 16 || (get16(&tiff, 2) != 42 && get16(&tiff, 2) != 43))
        tiff.size = 0;
    else
        tiff.is_big = get16(&tiff, 2) == 43;
    return tiff;
}

int32_t asj_tiff_value(const unsigned char *block, size_t size, unsigned tag, uint32_t *value)
{
    const tiff_bytes tiff = open_tiff(block, size);
    const size_t entry = find_entry(&tiff, tag);
    return entry && read_entry(&tiff, entry, value);
}

int32_t asj_exif_orientation(const unsigned char *block, size_t size)
{
    uint32_t value;
    return asj_tiff_value(block, size, TAG_ORIENTATION, &value) && value >= 1 && value <= 8 ? (int32_t)value : 1;
}

int32_t asj_mpf_has_views(const unsigned char *block, size_t size)
{
    /* bytes of a picture's entry, which begins with its kind. "Undefined" (0) is none of the views: so telephones call gain maps */
    enum { ENTRY = 16, KIND = 0xff0000, VIEWS = 0x020000 };
    const tiff_bytes tiff = open_tiff(block, size);
    const size_t entry = find_entry(&tiff, TAG_MPF_ENTRIES);
    if (!entry || tiff.is_big)
        return 0;
    const size_t bytes = get32(&tiff, entry + 4), first = get32(&tiff, entry + 8);
    for (size_t at = ENTRY; at + ENTRY <= bytes && first <= size && at + ENTRY <= size - first; at += ENTRY)
        if ((get32(&tiff, first + at) & KIND) == VIEWS)
            return 1;
    return 0;
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
