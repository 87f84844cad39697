/* SPDX-License-Identifier: BSD-2-Clause */
/* The structure of a JPEG 2000 file (ISO/IEC 15444-1): the boxes of JP2 (annex I) down to the codestream, whose main header (annex
 * A) is read up to the first tile. The decoder gets the codestream alone, so that it can find no other than this one. */
#include "bytes.h"
#include "probe.h"

#include <string.h>

enum { MARKER_SIZ = 0xff51, MARKER_SOT = 0xff90 };

/* OpenJPEG takes some kilobytes for each tile, and 1 kilobyte for each component of each tile, before it has seen any of them. */
enum { MOST_COMPONENTS = 5, MOST_TILES = 4096 };

/* What the boxes inside jp2h tell: the colours. */
static void read_header_boxes(const unsigned char *b, size_t size, asj_image_probe *probe)
{
    size_t at = 0;
    while (size - at >= 8) {
        size_t length = asj_big32(b + at);
        if (length < 8 || length > size - at)
            return;
        if (!memcmp(b + at + 4, "colr", 4) && length >= 15 && b[at + 8] == 1)
            probe->is_ycc = asj_big32(b + at + 11) == 18;
        if (!memcmp(b + at + 4, "pclr", 4))
            probe->fault = "colours from a palette are not read";
        at += length;
    }
}

/* Where the first contiguous codestream begins; 0 when there is none. */
static size_t find_codestream(const asj_input *input, asj_image_probe *probe)
{
    const unsigned char *b = input->bytes;
    size_t at = 0;

    while (input->size - at >= 8) {
        uint64_t length = asj_big32(b + at);
        size_t head = 8, left = input->size - at;
        if (length == 1 && left >= 16) {
            length = (uint64_t)asj_big32(b + at + 8) << 32 | asj_big32(b + at + 12);
            head = 16;
        }
        if (!memcmp(b + at + 4, "jp2c", 4))
            return at + head;
        if (length < head || length > left) /* 0 means "to the end": nothing can follow */
            return 0;
        if (!memcmp(b + at + 4, "jp2h", 4))
            read_header_boxes(b + at + head, (size_t)length - head, probe);
        at += (size_t)length;
    }
    return 0;
}

/* SIZ, A.5.1: sizes and offsets of the image and its tiles, then the number of components. */
static void read_siz(const unsigned char *b, size_t length, asj_image_probe *probe)
{
    uint64_t right, bottom, left, top, across, down;

    if (length < 36)
        return;
    right = asj_big32(b + 2), bottom = asj_big32(b + 6), left = asj_big32(b + 10), top = asj_big32(b + 14);
    if (!asj_big32(b + 18) || !asj_big32(b + 22) || right <= left || bottom <= top || asj_big32(b + 26) > left ||
        asj_big32(b + 30) > top) {
        probe->fault = "its sizes contradict each other";
        return;
    }
    across = (right - asj_big32(b + 26) + asj_big32(b + 18) - 1) / asj_big32(b + 18);
    down = (bottom - asj_big32(b + 30) + asj_big32(b + 22) - 1) / asj_big32(b + 22);
    if (asj_big16(b + 34) > MOST_COMPONENTS)
        probe->fault = "more than five components";
    else if (across > MOST_TILES || down > MOST_TILES || across * down > MOST_TILES)
        probe->fault = "more than 4096 tiles";
    probe->width = right - left;
    probe->height = bottom - top;
    probe->has_size = 1;
}

void asj_probe_jpeg2000(const asj_input *input, asj_image_probe *probe)
{
    const unsigned char *b = input->bytes;
    size_t at = 0;

    if (b[0] != 0xff)
        at = find_codestream(input, probe);
    probe->codestream = at;
    if (input->size - at < 4 || memcmp(b + at, "\xff\x4f\xff\x51", 4)) {
        probe->fault = "no codestream";
        return;
    }
    for (at += 2; input->size - at >= 4 && asj_big16(b + at) != MARKER_SOT; at += 2 + asj_big16(b + at + 2)) {
        size_t length = asj_big16(b + at + 2);
        if (length < 2 || length > input->size - at - 2)
            break;
        if (asj_big16(b + at) == MARKER_SIZ && (probe->has_size || probe->fault))
            probe->fault = probe->fault ? probe->fault : "it gives its size twice";
        else if (asj_big16(b + at) == MARKER_SIZ)
            read_siz(b + at + 4, length - 2, probe);
    }
    if (input->size - at < 4 || asj_big16(b + at) != MARKER_SOT)
        probe->is_truncated = 1;
}
