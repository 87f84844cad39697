/* SPDX-License-Identifier: BSD-2-Clause */
#define _XOPEN_SOURCE 700
#include "io_test.h"

#include <dirent.h>
#include <png.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[256];
static int was_root;

int make_folder(void **state)
{
    const char *place = getenv("TMPDIR");
    (void)state;
    snprintf(folder, sizeof folder, "%s/asj-io-XXXXXX", place ? place : "/tmp");
    return mkdtemp(folder) && !chmod(folder, 0755) ? 0 : -1;
}

int remove_folder(void **state)
{
    DIR *listing = opendir(folder);
    struct dirent *entry;
    (void)state;
    while (listing && (entry = readdir(listing)) != NULL)
        if (strcmp(entry->d_name, ".") && strcmp(entry->d_name, "..")) {
            const char *path = in_folder(entry->d_name);
            if (unlink(path))
                rmdir(path);
        }
    if (listing)
        closedir(listing);
    return rmdir(folder);
}

const char *in_folder(const char *name)
{
    static char paths[8][1024];
    static int next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

int count_files(void)
{
    DIR *listing = opendir(folder);
    int count = -2; /* "." and ".." */
    assert_non_null(listing);
    while (readdir(listing))
        count++;
    closedir(listing);
    return count;
}

void append(test_bytes *to, const void *bytes, size_t size)
{
    assert_true(size <= sizeof to->bytes - to->size);
    if (size)
        memcpy(to->bytes + to->size, bytes, size);
    to->size += size;
}

void append_big32(test_bytes *to, uint32_t value)
{
    const unsigned char bytes[4] = {(unsigned char)(value >> 24), (unsigned char)(value >> 16), (unsigned char)(value >> 8),
                                    (unsigned char)value};
    append(to, bytes, 4);
}

const char *write_bytes(const char *name, const void *bytes, size_t size)
{
    const char *path = in_folder(name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(size ? fwrite(bytes, 1, size, file) : 0, size);
    assert_int_equal(fclose(file), 0);
    return path;
}

void read_bytes(const char *path, test_bytes *bytes)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    bytes->size = fread(bytes->bytes, 1, sizeof bytes->bytes, file);
    assert_true(bytes->size < sizeof bytes->bytes);
    fclose(file);
}

/* ISO 15948, annex D: bit by bit. */
static uint32_t crc(const unsigned char *bytes, size_t size)
{
    uint32_t value = 0xffffffffu;
    size_t i;
    int bit;
    for (i = 0; i < size; i++)
        for (value ^= bytes[i], bit = 0; bit < 8; bit++)
            value = value & 1 ? 0xedb88320u ^ value >> 1 : value >> 1;
    return ~value;
}

void append_chunk(test_bytes *png, const char type[5], const void *content, size_t size)
{
    append_big32(png, (uint32_t)size);
    append(png, type, 4);
    append(png, content, size);
    append_big32(png, crc(png->bytes + png->size - size - 4, size + 4));
}

unsigned picture_sample(int32_t x, int32_t y, int channel, int bits)
{
    unsigned value = (unsigned)(x * 7919 + y * 104729 + channel * 1299709 + 12345) * 2654435761u;
    value = (value ^ value >> 15) * 2246822519u;
    return (value ^ value >> 13) >> 16 >> (16 - bits);
}

static void on_write(png_structp png, png_bytep bytes, size_t size)
{
    append(png_get_io_ptr(png), bytes, size);
}

static void on_flush(png_structp png)
{
    (void)png;
}

/* Packs the samples of one row, most significant bits first. */
static void pack_row(unsigned char *row, int32_t width, int32_t y, int channels, int bits)
{
    size_t at = 0;
    int32_t x;
    int c;
    memset(row, 0, 1024);
    for (x = 0; x < width; x++)
        for (c = 0; c < channels; c++, at += (size_t)bits) {
            unsigned sample = picture_sample(x, y, c, bits);
            if (bits == 16) {
                row[at / 8] = (unsigned char)(sample >> 8);
                row[at / 8 + 1] = (unsigned char)sample;
            } else {
                row[at / 8] |= (unsigned char)(sample << (8 - bits - (int)(at % 8)));
            }
        }
}

static void set_extras(png_structp png, png_infop info, const png_kind *kind)
{
    png_color palette[256];
    png_byte alpha[2] = {0, 128};
    png_color_16 colour = {0, 3, 3, 3, 1};
    int i, entries = 1 << kind->depth;

    if (kind->colour_type == PNG_COLOR_TYPE_PALETTE) {
        for (i = 0; i < entries; i++) {
            palette[i].red = (png_byte)i;
            palette[i].green = (png_byte)(255 - i);
            palette[i].blue = (png_byte)(i / 2);
        }
        png_set_PLTE(png, info, palette, entries);
    }
    if (kind->with_trns)
        png_set_tRNS(png, info, alpha, 2, &colour);
}

void make_png(test_bytes *png_file, const png_kind *kind, int32_t width, int32_t height)
{
    static unsigned char rows[64][1024];
    static const int channels[7] = {1, 0, 3, 1, 2, 0, 4};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    int32_t y;
    int pass, passes;

    assert_true(width * channels[kind->colour_type] * 2 <= 1024 && height <= 64);
    png_file->size = 0;
    png_set_write_fn(png, png_file, on_write, on_flush);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, kind->depth, kind->colour_type,
                 kind->interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    set_extras(png, info, kind);
    png_write_info(png, info);
    passes = png_set_interlace_handling(png);
    for (y = 0; y < height; y++)
        pack_row(rows[y], width, y, channels[kind->colour_type], kind->depth);
    for (pass = 0; pass < passes; pass++)
        for (y = 0; y < height; y++)
            png_write_row(png, rows[y]);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
}

void make_exif(test_bytes *exif, int big_endian, int orientation)
{
    static const unsigned char big[] = {'M', 'M', 0, 42, 0, 0, 0, 8, 0, 2, 1, 0x0f, 0, 2, 0, 0, 0, 2, 'A', 0, 0, 0,
                                        1, 0x12, 0, 3, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0};
    static const unsigned char little[] = {'I', 'I', 42, 0, 8, 0, 0, 0, 2, 0, 0x0f, 1, 2, 0, 2, 0, 0, 0, 'A', 0, 0, 0,
                                           0x12, 1, 3, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    exif->size = 0;
    append(exif, big_endian ? big : little, sizeof big);
    exif->bytes[big_endian ? 31 : 30] = (unsigned char)orientation;
}

void stored_place(int orientation, int32_t width, int32_t height, int32_t x, int32_t y, int32_t *stored_x, int32_t *stored_y)
{
    int32_t right = width - 1, bottom = height - 1;
    /* EXIF 2.3, Orientation: "the 0th row is at the visual ... of the image, the 0th column is the visual ..." */
    switch (orientation) {
    case 2: *stored_x = right - x, *stored_y = y; break;           /* top, right */
    case 3: *stored_x = right - x, *stored_y = bottom - y; break;  /* bottom, right */
    case 4: *stored_x = x, *stored_y = bottom - y; break;          /* bottom, left */
    case 5: *stored_x = y, *stored_y = x; break;                   /* left, top */
    case 6: *stored_x = y, *stored_y = bottom - x; break;          /* right, top */
    case 7: *stored_x = right - y, *stored_y = bottom - x; break;  /* right, bottom */
    case 8: *stored_x = right - y, *stored_y = x; break;           /* left, bottom */
    default: *stored_x = x, *stored_y = y; break;
    }
}

void assert_image_refused(const char *path, uint64_t max_pixels, asj_status status, const char *cause)
{
    asj_image_file *file = (asj_image_file *)(size_t)16;
    char message[512] = "old";
    asj_status got = asj_image_file_read(path, max_pixels, &file, message, sizeof message);

    if (got != status || strncmp(message, path, strlen(path)) || !strstr(message, cause))
        fail_msg("%s: status %d, wanted %d with '%s'; message '%s'", path, (int)got, (int)status, cause, message);
    assert_null(file);
    assert_null(strchr(message, '\n'));
}

int become_ordinary(void)
{
    was_root = geteuid() == 0;
    return !was_root || !seteuid(65534);
}

void become_root(void)
{
    if (was_root && seteuid(0))
        abort();
}

json_t *load_json_text(const char *text)
{
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0), before = uselocale(c);
    json_t *value = json_loads(text, JSON_DECODE_ANY, NULL);
    uselocale(before);
    freelocale(c);
    return value;
}

json_t *load_json_file(const char *path, size_t flags)
{
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0), before = uselocale(c);
    json_t *value = json_load_file(path, flags, NULL);
    uselocale(before);
    freelocale(c);
    return value;
}

static int separator_is_written(const char *separator)
{
    char text[32], wanted[32];
    snprintf(text, sizeof text, "%.1f", 0.5);
    snprintf(wanted, sizeof wanted, "0%s5", separator);
    return strcmp(text, wanted) == 0;
}

int set_separator_locale(const char *kind)
{
    static const char *const commas[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "ru_RU.UTF-8", "pt_BR.UTF-8", NULL};
    static const char *const wide[] = {"ps_AF.UTF-8", "ps_AF.utf8", "ps_AF", NULL};
    int is_wide = !strcmp(kind, "wide");
    const char *separator = is_wide ? "\xd9\xab" : ",", *source = is_wide ? "ps_AF" : "de_DE";
    const char *const *names = is_wide ? wide : commas;
    char command[2048], place[] = "/tmp/asj-locale-XXXXXX", name[32];
    int made;

    for (; *names; names++)
        if (setlocale(LC_ALL, *names))
            return separator_is_written(separator);
    if (!mkdtemp(place))
        return 0;
    setenv("LOCPATH", place, 1);
    snprintf(name, sizeof name, "%s.UTF-8", source);
    snprintf(command, sizeof command, "localedef -i %s -f UTF-8 %s/%s >/dev/null 2>&1", source, place, name);
    made = !system(command) && setlocale(LC_ALL, name) && separator_is_written(separator);
    snprintf(command, sizeof command, "rm -r %s", place);
    return !system(command) && made;
}
