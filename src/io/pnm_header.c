/* SPDX-License-Identifier: BSD-2-Clause */
/* Headers are text: numbers between blanks and comments. The probe and the reader share this parser. */
#include "pnm_header.h"

#include "probe.h"

#include <string.h>

static int is_blank(unsigned char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* A comment lasts to the end of its line, which may be a carriage return. */
static void skip_blanks(const asj_input *input, size_t *at)
{
    const unsigned char *b = input->bytes;
    size_t i = *at;

    while (i < input->size && (b[i] == '#' || is_blank(b[i]))) {
        if (b[i] == '#')
            while (i < input->size && b[i] != '\n' && b[i] != '\r')
                i++;
        else
            i++;
    }
    *at = i;
}

int asj_pnm_number(const asj_input *input, size_t *at, uint64_t *number)
{
    const unsigned char *b = input->bytes;
    size_t first;

    skip_blanks(input, at);
    first = *at;
    for (*number = 0; *at < input->size && b[*at] >= '0' && b[*at] <= '9' && *at - first < 10; ++*at)
        *number = 10 * *number + (uint64_t)(b[*at] - '0');
    return *at > first && *at - first < 10;
}

/* PAM: lines of a word and a number, up to the line ENDHDR. */
static int read_pam(const asj_input *input, size_t at, asj_pnm_header *header)
{
    uint64_t width = 0, height = 0, samples = 0, most = 0;

    for (;;) {
        const unsigned char *word;
        size_t length = 0;
        skip_blanks(input, &at);
        word = input->bytes + at;
        while (at < input->size && !is_blank(input->bytes[at])) {
            at++;
            length++;
        }
        if (at == input->size)
            return 0;
        if (length == 6 && !memcmp(word, "ENDHDR", 6))
            break;
        if (length == 8 && !memcmp(word, "TUPLTYPE", 8)) {
            while (at < input->size && input->bytes[at] != '\n')
                at++;
        } else {
            uint64_t *value = length == 5 && !memcmp(word, "WIDTH", 5) ? &width
                              : length == 6 && !memcmp(word, "HEIGHT", 6) ? &height
                              : length == 5 && !memcmp(word, "DEPTH", 5) ? &samples
                              : length == 6 && !memcmp(word, "MAXVAL", 6) ? &most : NULL;
            if (!value || *value || !asj_pnm_number(input, &at, value))
                return 0;
        }
    }
    header->width = width;
    header->height = height;
    header->samples = samples <= 4 ? (uint32_t)samples : 0;
    header->most = (uint32_t)most;
    header->pixels = at + 1;
    return header->samples > 0 && most > 0;
}

/* PFM: the sign of a number is the order of bytes; its size is a unit of light that nobody needs here. */
static int read_byte_order(const asj_input *input, size_t *at, asj_pnm_header *header)
{
    size_t first;
    skip_blanks(input, at);
    header->is_little_endian = *at < input->size && input->bytes[*at] == '-';
    first = *at;
    while (*at < input->size && input->bytes[*at] && strchr("+-.0123456789eE", input->bytes[*at]))
        ++*at;
    return *at > first;
}

int asj_pnm_read_header(const asj_input *input, asj_pnm_header *header)
{
    static const asj_pnm_header none = {0};
    uint64_t most = 1;
    size_t at = 2;
    int is_float;

    *header = none;
    header->type = input->bytes[1];
    is_float = header->type == 'f' || header->type == 'F';
    if (header->type == '7')
        return read_pam(input, at, header) && header->most <= 65535;
    if (!asj_pnm_number(input, &at, &header->width) || !asj_pnm_number(input, &at, &header->height))
        return 0;
    if (is_float ? !read_byte_order(input, &at, header)
                 : header->type != '1' && header->type != '4' && !asj_pnm_number(input, &at, &most))
        return 0;
    if (most < 1 || most > 65535 || at >= input->size || !is_blank(input->bytes[at]))
        return 0;
    header->samples = header->type == '3' || header->type == '6' || header->type == 'F' ? 3 : 1;
    header->most = is_float ? 0 : (uint32_t)most;
    header->is_text = header->type >= '1' && header->type <= '3';
    header->pixels = at + 1;
    return 1;
}

/* Bytes that the pixels take; of text the fewest possible: a digit for each sample, and a blank between two. */
static uint64_t pixel_bytes(const asj_pnm_header *header)
{
    uint64_t count = header->width * header->height * header->samples;
    if (header->type == '4')
        return (header->width + 7) / 8 * header->height;
    if (header->is_text)
        return header->type == '1' ? count : 2 * count - 1; /* bits need no blanks between them */
    return header->most == 0 ? 4 * count : header->most > 255 ? 2 * count : count;
}

int asj_pnm_begins(const unsigned char *bytes, size_t size)
{
    return size >= 3 && bytes[0] == 'P' && bytes[1] && strchr("1234567fF", bytes[1]) && bytes[2] && strchr(" \t\r\n#", bytes[2]);
}

void asj_probe_pnm(const asj_input *input, asj_image_probe *probe)
{
    asj_pnm_header header;

    probe->has_size = asj_pnm_read_header(input, &header);
    probe->width = header.width;
    probe->height = header.height;
    if (!probe->has_size)
        probe->fault = "its header makes no sense";
    else if (header.width && header.height) {
        const uint64_t bytes = pixel_bytes(&header), left = input->size - header.pixels;
        probe->is_truncated = bytes > left;
        /* pictures may follow each other without anything in between, but not behind one in text */
        probe->has_more = !header.is_text && bytes < left &&
                          asj_pnm_begins(input->bytes + header.pixels + (size_t)bytes, (size_t)(left - bytes));
    }
}
