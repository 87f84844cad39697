/* SPDX-License-Identifier: BSD-2-Clause */
/* What the tests of libasj-io share: a folder that vanishes afterwards, files of given bytes, PNG files of every kind. */
#ifndef ASJ_TESTS_IO_TEST_H
#define ASJ_TESTS_IO_TEST_H

#include <asj/io.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <jansson.h>

/* Group fixtures: a new empty folder, and its end with everything in it. */
int make_folder(void **state);
int remove_folder(void **state);

/* Path of a file of that name in the folder. Valid until the eighth next call. */
const char *in_folder(const char *name);

/* Number of files in the folder, hidden ones included. */
int count_files(void);

typedef struct test_bytes {
    unsigned char bytes[65536];
    size_t size;
} test_bytes;

void append(test_bytes *to, const void *bytes, size_t size);
void append_big32(test_bytes *to, uint32_t value);
const char *write_bytes(const char *name, const void *bytes, size_t size);
void read_bytes(const char *path, test_bytes *bytes);

/* Adds a PNG chunk with its checksum. */
void append_chunk(test_bytes *png, const char type[5], const void *content, size_t size);

/* A sample of the test picture, `bits` wide. */
unsigned picture_sample(int32_t x, int32_t y, int channel, int bits);

/* A PNG file of the test picture: libpng's colour type and depth; palette entry i is (i, 255 - i, i / 2). */
typedef struct png_kind {
    int colour_type, depth, interlaced, with_trns;
} png_kind;
void make_png(test_bytes *png, const png_kind *kind, int32_t width, int32_t height);

/* An EXIF block with one tag, the orientation. */
void make_exif(test_bytes *exif, int big_endian, int orientation);

/* Where the upright pixel (x, y) stands in a stored image of width x height. */
void stored_place(int orientation, int32_t width, int32_t height, int32_t x, int32_t y, int32_t *stored_x, int32_t *stored_y);

/* Reads a file that must be refused with `status`, and a line that names it and holds `cause`. */
void assert_image_refused(const char *path, uint64_t max_pixels, asj_status status, const char *cause);

/* Sets a locale whose decimal separator is another: "comma", or "wide", which has one of several bytes. Makes sure that printf()
 * follows it; a locale is made in a folder of its own where none is installed but its sources are. 0 = none is available. */
int set_separator_locale(const char *kind);

/* Jansson's readers in the "C" locale, whatever that of the process is: jansson cannot do with a separator of several bytes. */
json_t *load_json_text(const char *text);
json_t *load_json_file(const char *path, size_t flags);

/* Becomes an ordinary user, for whom permissions count; 0 when that cannot be. become_root() undoes it. */
int become_ordinary(void);
void become_root(void);

#endif
