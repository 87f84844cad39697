/* SPDX-License-Identifier: BSD-2-Clause */
/* The marker structure of a JPEG file (ITU-T T.81, annex B). Decoders fill what is missing from a truncated file with gray; one
 * whose end marker is missing is told here, before it is decoded. */
#include "bytes.h"
#include "exif.h"
#include "probe.h"

#include <string.h>

enum { MARKER_TEM = 0x01, MARKER_DHT = 0xc4, MARKER_JPG = 0xc8, MARKER_DAC = 0xcc, MARKER_RST0 = 0xd0, MARKER_RST7 = 0xd7,
       MARKER_EOI = 0xd9, MARKER_SOS = 0xda, MARKER_APP1 = 0xe1, MARKER_APP2 = 0xe2 };

static int is_restart(int marker)
{
    return marker >= MARKER_RST0 && marker <= MARKER_RST7;
}

/* Frame headers: all of 0xc0 .. 0xcf but three. */
static int is_frame(int marker)
{
    return (marker & 0xf0) == 0xc0 && marker != MARKER_DHT && marker != MARKER_JPG && marker != MARKER_DAC;
}

/* Moves *at behind the next marker and returns it; -1 at the end of the file. Compressed data may stand before it: in them 0xff is
 * followed by 0, and restart markers belong to them. */
static int next_marker(const asj_input *input, size_t *at)
{
    size_t i;
    for (i = *at; i + 1 < input->size; i++) {
        int next = input->bytes[i + 1];
        if (input->bytes[i] != 0xff || next == 0 || next == 0xff || is_restart(next))
            continue;
        *at = i + 2;
        return next;
    }
    return -1;
}

static void read_segment(int marker, const unsigned char *content, size_t length, asj_image_probe *probe)
{
    if (is_frame(marker) && length >= 5 && !probe->has_size) {
        probe->height = asj_big16(content + 1);
        probe->width = asj_big16(content + 3);
        probe->has_size = 1;
    }
    if (marker == MARKER_APP1 && length > 6 && !memcmp(content, "Exif\0\0", 6) && !probe->exif) { /* the first counts */
        probe->exif = content + 6;
        probe->exif_size = length - 6;
        probe->orientation = asj_exif_orientation(probe->exif, probe->exif_size);
    }
    if (marker == MARKER_APP2 && length > 4 && !memcmp(content, "MPF\0", 4))
        probe->has_more |= asj_mpf_has_views(content + 4, length - 4);
}

void asj_probe_jpeg(const asj_input *input, asj_image_probe *probe)
{
    int seen_scan = 0;
    size_t at = 2;

    for (;;) {
        size_t length;
        int marker = next_marker(input, &at);
        if (marker == MARKER_EOI && seen_scan)
            return;
        if (marker == MARKER_TEM)
            continue;
        if (marker < 0 || marker == MARKER_EOI || input->size - at < 2)
            break;
        length = asj_big16(input->bytes + at);
        if (length < 2 || length > input->size - at)
            break;
        read_segment(marker, input->bytes + at + 2, length - 2, probe);
        seen_scan |= marker == MARKER_SOS;
        at += length;
    }
    probe->is_truncated = 1;
}
