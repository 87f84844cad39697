/* SPDX-License-Identifier: BSD-2-Clause */
/* Signatures and headers of image formats. The size is wanted before decoding, so that a small file cannot ask for a huge image. */
#include "image_probe.h"

#include "bytes.h"
#include "exif.h"

#include <string.h>

static uint32_t little(const unsigned char *b, int count)
{
    uint32_t value = 0;
    while (count--)
        value = value << 8 | b[count];
    return value;
}

static void set_size(asj_image_probe *probe, uint64_t width, uint64_t height)
{
    probe->width = width;
    probe->height = height;
    probe->has_size = 1;
}

static void probe_bmp(const asj_input *input, asj_image_probe *probe)
{
    const unsigned char *b = input->bytes;
    uint32_t height;

    if (input->size < 26)
        return;
    if (little(b + 14, 4) == 12) { /* OS/2 header: 16-bit sides */
        set_size(probe, little(b + 18, 2), little(b + 20, 2));
        return;
    }
    height = little(b + 22, 4);
    set_size(probe, little(b + 18, 4), height > 0x7fffffffu ? 0u - height : height); /* negative: rows from the top */
}

/* RIFF chunks: name, length, content, padded to even length. The orientation stands in a chunk of the extended format. */
static void probe_webp(const asj_input *input, asj_image_probe *probe)
{
    const unsigned char *b = input->bytes;
    size_t at = 12;

    if (input->size >= 30 && !memcmp(b + 12, "VP8X", 4))
        set_size(probe, little(b + 24, 3) + 1u, little(b + 27, 3) + 1u);
    else if (input->size >= 30 && !memcmp(b + 12, "VP8L", 4))
        set_size(probe, (little(b + 21, 4) & 0x3fff) + 1u, (little(b + 21, 4) >> 14 & 0x3fff) + 1u);
    else if (input->size >= 30 && !memcmp(b + 12, "VP8 ", 4))
        set_size(probe, little(b + 26, 2) & 0x3fff, little(b + 28, 2) & 0x3fff);
    while (input->size - at >= 8) {
        size_t length = little(b + at + 4, 4), left = input->size - at - 8;
        if (length > left)
            return;
        if (!memcmp(b + at, "EXIF", 4) && !probe->exif) {
            size_t skip = length >= 6 && !memcmp(b + at + 8, "Exif\0\0", 6) ? 6 : 0;
            probe->exif = b + at + 8 + skip;
            probe->exif_size = length - skip;
            probe->orientation = asj_exif_orientation(probe->exif, probe->exif_size);
        }
        if (length == left)
            return;
        at += 8 + length + (length & 1);
    }
}

static void probe_sun_raster(const asj_input *input, asj_image_probe *probe)
{
    if (input->size >= 12)
        set_size(probe, asj_big32(input->bytes + 4), asj_big32(input->bytes + 8));
}

static int read_number(const asj_input *input, size_t *at, uint64_t *number)
{
    size_t first = *at;
    for (*number = 0; *at < input->size && *at - first < 9 && input->bytes[*at] >= '0' && input->bytes[*at] <= '9'; ++*at)
        *number = 10 * *number + (uint64_t)(input->bytes[*at] - '0');
    return *at > first;
}

/* The header ends at an empty line; then comes the resolution, of which only the usual order is read: "-Y height +X width". */
static void probe_radiance(const asj_input *input, asj_image_probe *probe)
{
    uint64_t width, height;
    size_t at = 0;

    while (at + 1 < input->size && (input->bytes[at] != '\n' || input->bytes[at + 1] != '\n'))
        at++;
    at += 2;
    if (at >= input->size || input->size - at < 8 || memcmp(input->bytes + at, "-Y ", 3))
        return;
    at += 3;
    if (!read_number(input, &at, &height) || input->size - at < 5 || memcmp(input->bytes + at, " +X ", 4))
        return;
    at += 4;
    if (read_number(input, &at, &width))
        set_size(probe, width, height);
}

typedef struct signature {
    asj_image_kind kind;
    const char *name;
    size_t at, length;
    const char *bytes;
    void (*probe)(const asj_input *, asj_image_probe *);
} signature;

static const signature *find_signature(const asj_input *input)
{
    static const signature pnm = {ASJ_KIND_PNM, "PNM", 0, 3, "", asj_probe_pnm};
    static const signature signatures[] = {
        {ASJ_KIND_PNG, "PNG", 0, 4, "\x89PNG", NULL},
        {ASJ_KIND_JPEG, "JPEG", 0, 3, "\xff\xd8\xff", asj_probe_jpeg},
        {ASJ_KIND_TIFF, "TIFF", 0, 4, "II*\0", asj_probe_tiff},
        {ASJ_KIND_TIFF, "TIFF", 0, 4, "MM\0*", asj_probe_tiff},
        {ASJ_KIND_TIFF, "BigTIFF", 0, 4, "II+\0", asj_probe_tiff},
        {ASJ_KIND_TIFF, "BigTIFF", 0, 4, "MM\0+", asj_probe_tiff},
        {ASJ_KIND_BMP, "BMP", 0, 2, "BM", probe_bmp},
        {ASJ_KIND_WEBP, "WebP", 8, 4, "WEBP", probe_webp},
        {ASJ_KIND_JPEG2000, "JPEG 2000", 0, 4, "\xff\x4f\xff\x51", asj_probe_jpeg2000},
        {ASJ_KIND_JPEG2000, "JPEG 2000", 0, 12, "\0\0\0\x0cjP  \r\n\x87\n", asj_probe_jpeg2000},
        {ASJ_KIND_SUN_RASTER, "Sun raster", 0, 4, "\x59\xa6\x6a\x95", probe_sun_raster},
        {ASJ_KIND_RADIANCE, "Radiance HDR", 0, 7, "#?RGBE\n", probe_radiance},
        {ASJ_KIND_RADIANCE, "Radiance HDR", 0, 11, "#?RADIANCE\n", probe_radiance},
        {ASJ_KIND_OTHER, "OpenEXR", 0, 4, "\x76\x2f\x31\x01", NULL},
        {ASJ_KIND_OTHER, "GIF", 0, 4, "GIF8", NULL},
        {ASJ_KIND_HEIF, "HEIF", 4, 4, "ftyp", asj_probe_heif},
        {ASJ_KIND_OTHER, "JPEG XL", 0, 12, "\0\0\0\x0cJXL \r\n\x87\n", NULL},
        {ASJ_KIND_OTHER, "JPEG XL", 0, 2, "\xff\x0a", NULL},
        {ASJ_KIND_OTHER, "PDF", 0, 5, "%PDF-", NULL},
    };
    size_t i;

    if (asj_pnm_begins(input->bytes, input->size))
        return &pnm;
    for (i = 0; i < sizeof signatures / sizeof signatures[0]; i++) {
        const signature *s = &signatures[i];
        if (input->size >= s->at + s->length && !memcmp(input->bytes + s->at, s->bytes, s->length))
            return s;
    }
    return NULL;
}

asj_image_kind asj_probe_kind(const asj_input *input)
{
    const signature *found = find_signature(input);
    return found ? found->kind : ASJ_KIND_UNKNOWN;
}

void asj_probe_image(const asj_input *input, asj_image_probe *probe)
{
    static const asj_image_probe none = {0};
    const signature *found = find_signature(input);

    *probe = none;
    probe->orientation = 1;
    if (!found)
        return;
    probe->kind = found->kind;
    probe->name = found->name;
    if (found->probe)
        found->probe(input, probe);
}
