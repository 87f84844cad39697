/* SPDX-License-Identifier: BSD-2-Clause */
/* What the harnesses share: bytes of the input, taken one after the other, and an input as a file. */
#ifndef ASJ_TESTS_FUZZ_H
#define ASJ_TESTS_FUZZ_H

#include <asj/asj.h>

#include <stddef.h>
#include <stdint.h>

/* What libFuzzer calls, and replay.c; a harness defines it. Returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct fuzz_bytes {
    const uint8_t *next;
    size_t left;
} fuzz_bytes;

/* The next byte, or 0 at the end. */
unsigned fuzz_byte(fuzz_bytes *bytes);

/* A number of 0 .. 65535, or 0. */
unsigned fuzz_pair(fuzz_bytes *bytes);

/* Ends the process with a message unless `truth`: a finding. */
void fuzz_check(int truth, const char *what);

/* The path of a file with these bytes; the next call replaces it. */
const char *fuzz_file(const uint8_t *data, size_t size);

/* A context of one thread on the processor, made once. */
asj_context *fuzz_context(void);

/* A few options at places of their ranges that the bytes name. */
typedef asj_status fuzz_set(void *options, const char *key, const char *text);
void fuzz_options(fuzz_bytes *bytes, size_t count, const asj_option_info *(*row)(size_t), fuzz_set *set, void *options);

/* Options of the two-view geometry from all over their ranges, and a little beyond: cameras, sizes, directions and deviations at
 * their limits. What bytes do not name stays; at the end of the input all of it does. */
void fuzz_geometry_options(fuzz_bytes *bytes, asj_geometry_options *options);

/* Checks a geometry that was told: a status that there is, numbers that are finite, a matrix of norm 1 where it is accepted. */
void fuzz_check_geometry(const asj_geometry *geometry);

/* An image of at most `most` x `most` pixels in any format: shapes and noise. The caller frees image->data. */
void fuzz_image(fuzz_bytes *bytes, unsigned most, asj_image *image);
size_t fuzz_pixel_bytes(int32_t format);

#endif
