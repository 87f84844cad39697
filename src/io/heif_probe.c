/* SPDX-License-Identifier: BSD-2-Clause */
/* The structure of a HEIF or AVIF file (ISO/IEC 23008-12 on the boxes of ISO/IEC 14496-12): its brands, and the size of its
 * largest image. An image's size stands in a property (ispe) that items share; the largest is what the file shows, the others are
 * its tiles, thumbnails and depth maps. Films of the same container are told by their brands. */
#include "bytes.h"
#include "probe.h"

#include <string.h>

/* A box of `bytes`: what is inside is `size` bytes at `content`. */
typedef struct box {
    char type[4];
    const unsigned char *content;
    size_t size;
} box;

/* The box at `at`, which is moved behind it; 0 when there is none, -1 when it does not end within the size. */
static int next_box(const unsigned char *bytes, size_t size, size_t *at, box *b)
{
    const unsigned char *start = bytes + *at;
    const size_t left = size - *at;
    uint64_t length, head = 8;

    if (left < 8)
        return 0;
    length = asj_big32(start);
    memcpy(b->type, start + 4, 4);
    if (length == 1 && left >= 16) {
        length = (uint64_t)asj_big32(start + 8) << 32 | asj_big32(start + 12);
        head = 16;
    } else if (length == 0) { /* to the end */
        length = left;
    }
    if (length < head || length > left)
        return -1;
    b->content = start + head;
    b->size = (size_t)(length - head);
    *at += (size_t)length;
    return 1;
}

static int is_type(const box *b, const char *type)
{
    return memcmp(b->type, type, 4) == 0;
}

/* Image sizes of the properties: after 4 bytes of version and flags, width and height. */
static void read_properties(const box *container, asj_image_probe *probe)
{
    size_t at = 0;
    box b;
    while (next_box(container->content, container->size, &at, &b) == 1) {
        if (!is_type(&b, "ispe") || b.size < 12)
            continue;
        const uint64_t width = asj_big32(b.content + 4), height = asj_big32(b.content + 8);
        if (!probe->has_size || width * height > probe->width * probe->height) {
            probe->width = width;
            probe->height = height;
            probe->has_size = 1;
        }
    }
}

/* The properties' container within iprp within meta; meta has 4 bytes of version and flags first. */
static void read_meta(const box *meta, asj_image_probe *probe)
{
    size_t at = 4, inner;
    box b, c;
    while (meta->size > at && next_box(meta->content, meta->size, &at, &b) == 1)
        if (is_type(&b, "iprp"))
            for (inner = 0; next_box(b.content, b.size, &inner, &c) == 1;)
                if (is_type(&c, "ipco"))
                    read_properties(&c, probe);
}

/* By the brands: the major one, its version, then those that are compatible with it. */
static void read_brands(const box *ftyp, asj_image_probe *probe)
{
    static const char heif[][5] = {"mif1", "mif2", "heic", "heix", "heim", "heis", "hevc", "hevx"};
    size_t at, i;

    probe->kind = ASJ_KIND_OTHER;
    probe->name = "an ISO media file, as films are, and no still image";
    for (at = 0; at + 4 <= ftyp->size; at += at ? 4 : 8) {
        const unsigned char *brand = ftyp->content + at;
        if (!memcmp(brand, "avif", 4) || !memcmp(brand, "avis", 4)) {
            probe->kind = ASJ_KIND_HEIF;
            probe->name = "AVIF";
            return;
        }
        for (i = 0; i < sizeof heif / sizeof heif[0]; i++)
            if (!memcmp(brand, heif[i], 4)) {
                probe->kind = ASJ_KIND_HEIF;
                probe->name = "HEIF";
            }
    }
}

void asj_probe_heif(const asj_input *input, asj_image_probe *probe)
{
    size_t at = 0;
    int state;
    box b;

    for (state = next_box(input->bytes, input->size, &at, &b); state == 1; state = next_box(input->bytes, input->size, &at, &b)) {
        if (is_type(&b, "ftyp"))
            read_brands(&b, probe);
        else if (is_type(&b, "meta"))
            read_meta(&b, probe);
    }
    if (probe->kind == ASJ_KIND_HEIF && (state < 0 || at < input->size))
        probe->is_truncated = 1;
}
