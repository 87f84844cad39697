/* SPDX-License-Identifier: BSD-2-Clause */
/* Signatures and headers of the formats that OpenCV's imgcodecs reads. The size is wanted before decoding, so that a small file
 * cannot ask for a huge image. */
#include "image_probe.h"

#include "exif.h"

#include <string.h>

static uint32_t little(const unsigned char *b, int count)
{
    uint32_t value = 0;
    while (count--)
        value = value << 8 | b[count];
    return value;
}

static uint32_t big32(const unsigned char *b)
{
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
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

static void probe_tiff(const asj_input *input, asj_image_probe *probe)
{
    uint32_t width, height;
    if (asj_tiff_value(input->bytes, input->size, 256, &width) && asj_tiff_value(input->bytes, input->size, 257, &height))
        set_size(probe, width, height);
    probe->orientation = asj_exif_orientation(input->bytes, input->size);
    probe->is_tiff = 1;
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
        if (!memcmp(b + at, "EXIF", 4)) {
            size_t skip = length >= 6 && !memcmp(b + at + 8, "Exif\0\0", 6) ? 6 : 0;
            probe->orientation = asj_exif_orientation(b + at + 8 + skip, length - skip);
        }
        if (length == left)
            return;
        at += 8 + length + (length & 1);
    }
}

/* The next number of a PNM header, past white space and comments; 0 when there is none. */
static int next_number(const asj_input *input, size_t *at, uint64_t *number)
{
    const unsigned char *b = input->bytes;
    size_t i = *at, first;

    while (i < input->size && (b[i] == '#' || b[i] == ' ' || (b[i] >= '\t' && b[i] <= '\r'))) {
        if (b[i] == '#')
            while (i < input->size && b[i] != '\n')
                i++;
        else
            i++;
    }
    first = i;
    for (*number = 0; i < input->size && b[i] >= '0' && b[i] <= '9' && i - first < 18; i++)
        *number = 10 * *number + (uint64_t)(b[i] - '0');
    *at = i;
    return i > first;
}

/* P7 has lines "WIDTH 60" in any order. */
static int pam_value(const asj_input *input, const char *key, uint64_t *value)
{
    size_t length = strlen(key), end = input->size < 1024 ? input->size : 1024, i;
    for (i = 0; i + length < end; i++)
        if (input->bytes[i] == '\n' && !memcmp(input->bytes + i + 1, key, i + 1 + length < end ? length : end - i - 1)) {
            i += 1 + length;
            return next_number(input, &i, value);
        }
    return 0;
}

static void probe_pnm(const asj_input *input, asj_image_probe *probe)
{
    uint64_t width, height;
    size_t at = 2;

    if (input->bytes[1] == '7') {
        if (pam_value(input, "WIDTH", &width) && pam_value(input, "HEIGHT", &height))
            set_size(probe, width, height);
    } else if (next_number(input, &at, &width) && next_number(input, &at, &height)) {
        set_size(probe, width, height);
    }
}

/* The SIZ segment of the first codestream, bare or in a JP2 file: ISO 15444-1 A.5.1. */
static void probe_jpeg2000(const asj_input *input, asj_image_probe *probe)
{
    const unsigned char *b = input->bytes;
    size_t i;
    for (i = 0; i + 24 <= input->size; i++)
        if (b[i] == 0xff && !memcmp(b + i, "\xff\x4f\xff\x51", 4)) {
            uint64_t right = big32(b + i + 8), bottom = big32(b + i + 12), left = big32(b + i + 16), top = big32(b + i + 20);
            set_size(probe, right > left ? right - left : 0, bottom > top ? bottom - top : 0);
            return;
        }
}

static void probe_sun_raster(const asj_input *input, asj_image_probe *probe)
{
    if (input->size >= 12)
        set_size(probe, big32(input->bytes + 4), big32(input->bytes + 8));
}

typedef struct signature {
    const char *name;
    size_t at, length;
    const char *bytes;
    void (*probe)(const asj_input *, asj_image_probe *);
    int32_t is_uncommon, needs_path;
} signature;

void asj_probe_image(const asj_input *input, asj_image_probe *probe)
{
    static const signature signatures[] = {
        {"JPEG", 0, 3, "\xff\xd8\xff", asj_probe_jpeg, 0, 0},
        {"TIFF", 0, 4, "II*\0", probe_tiff, 0, 0},
        {"TIFF", 0, 4, "MM\0*", probe_tiff, 0, 0},
        {"BigTIFF", 0, 4, "II+\0", NULL, 0, 0},
        {"BigTIFF", 0, 4, "MM\0+", NULL, 0, 0},
        {"BMP", 0, 2, "BM", probe_bmp, 0, 0},
        {"WebP", 8, 4, "WEBP", probe_webp, 0, 0},
        {"JPEG 2000", 0, 4, "\xff\x4f\xff\x51", probe_jpeg2000, 0, 0},
        {"JPEG 2000", 0, 12, "\0\0\0\x0cjP  \r\n\x87\n", probe_jpeg2000, 0, 0},
        {"Sun raster", 0, 4, "\x59\xa6\x6a\x95", probe_sun_raster, 0, 1},
        {"Radiance HDR", 0, 3, "#?R", NULL, 0, 1},
        {"OpenEXR", 0, 4, "\x76\x2f\x31\x01", NULL, 1, 1},
        {"GIF", 0, 4, "GIF8", NULL, 1, 0},
        {"HEIF or AVIF", 4, 4, "ftyp", NULL, 1, 0},
        {"JPEG XL", 0, 12, "\0\0\0\x0cJXL \r\n\x87\n", NULL, 1, 0},
        {"JPEG XL", 0, 2, "\xff\x0a", NULL, 1, 0},
        {"PDF", 0, 5, "%PDF-", NULL, 1, 0},
    };
    static const asj_image_probe none = {0};
    size_t i;

    *probe = none;
    probe->orientation = 1;
    if (input->size >= 3 && input->bytes[0] == 'P' && strchr("1234567fF", input->bytes[1] ? input->bytes[1] : ' ') &&
        strchr(" \t\r\n#", input->bytes[2] ? input->bytes[2] : 'x')) {
        probe->name = "PNM";
        probe_pnm(input, probe);
        return;
    }
    for (i = 0; i < sizeof signatures / sizeof signatures[0]; i++) {
        const signature *s = &signatures[i];
        if (input->size < s->at + s->length || memcmp(input->bytes + s->at, s->bytes, s->length))
            continue;
        probe->name = s->name;
        probe->is_uncommon = s->is_uncommon;
        probe->needs_path = s->needs_path;
        if (s->probe)
            s->probe(input, probe);
        return;
    }
}
