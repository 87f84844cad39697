/* SPDX-License-Identifier: BSD-2-Clause */
/* Small files that ask for much: memory before they are refused (or read) is at most twice the file and 64 MB, time a second.
 * Each is read in a process of its own, against one that reads nothing. */
#define _DEFAULT_SOURCE
#include "io_test.h"

#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

enum { SPARE_KB = 64 * 1024, MOST_SECONDS = 1, NOTHING = 99 };

#ifdef ASJ_ADDRESS_SANITIZER
enum { IS_MEASURED = 0 };
#else
enum { IS_MEASURED = 1 };
#endif

typedef struct cost {
    asj_status status;
    long kilobytes;
    double seconds;
} cost;

typedef asj_status reader(const char *path);

static asj_status nothing(const char *path)
{
    (void)path;
    return (asj_status)NOTHING;
}

static asj_status image(const char *path)
{
    asj_image_file *file = NULL;
    asj_status status = asj_image_file_read(path, 0, &file, NULL, 0);
    asj_image_file_free(&file);
    return status;
}

static asj_status junctions(const char *path)
{
    asj_junction_file *file = NULL;
    asj_status status = asj_junctions_read(path, &file, NULL, 0);
    asj_junction_file_free(&file);
    return status;
}

static cost cost_of(reader *read_file, const char *path)
{
    struct rusage use;
    cost result;
    int state = 0;
    pid_t child = fork();

    assert_true(child >= 0);
    if (!child)
        _exit((int)read_file(path) & 0xff);
    while (wait4(child, &state, 0, &use) < 0)
        assert_int_equal(errno, EINTR);
    assert_true(WIFEXITED(state));
    result.status = (asj_status)(signed char)WEXITSTATUS(state);
    result.kilobytes = use.ru_maxrss;
    result.seconds = (double)use.ru_utime.tv_sec + (double)use.ru_stime.tv_sec +
                     1e-6 * ((double)use.ru_utime.tv_usec + (double)use.ru_stime.tv_usec);
    return result;
}

static void assert_cheap(reader *read_file, const char *path, asj_status status)
{
    cost idle = cost_of(nothing, NULL), got = cost_of(read_file, path);
    struct stat info;
    long file_kilobytes;

    assert_int_equal(stat(path, &info), 0);
    file_kilobytes = S_ISREG(info.st_mode) ? (long)(info.st_size / 1024) : 0;
    assert_int_equal(idle.status, (asj_status)NOTHING);
    assert_int_equal(got.status, status);
    if (IS_MEASURED && (got.kilobytes - idle.kilobytes > SPARE_KB + 2 * file_kilobytes || got.seconds > MOST_SECONDS))
        fail_msg("%s: %ld KB, %.2f s", path, got.kilobytes - idle.kilobytes, got.seconds);
}

/* One pixel, and as many texts as fit, 7 MB each: the same compressed chunk again and again. */
static void png_with_compressed_text(void **state)
{
    static test_bytes png, chunk, small;
    enum { LENGTH = 7000000, TEXTS = 60 };
    const png_kind gray = {PNG_COLOR_TYPE_GRAY, 8, 0, 0};
    uLongf size = sizeof chunk.bytes - 16;
    Bytef *text = malloc(LENGTH);
    FILE *file;
    const char *path = in_folder("text.png");
    int i;
    (void)state;
    assert_non_null(text);
    memset(text, 'a', LENGTH);
    memcpy(small.bytes, "Comment\0\0", 9);
    assert_int_equal(compress2(small.bytes + 9, &size, text, LENGTH, 9), Z_OK);
    free(text);
    append_chunk(&chunk, "zTXt", small.bytes, 9 + size);
    make_png(&png, &gray, 1, 1);
    file = fopen(path, "wb");
    assert_non_null(file);
    fwrite(png.bytes, 1, 33, file); /* signature and IHDR */
    for (i = 0; i < TEXTS; i++)
        fwrite(chunk.bytes, 1, chunk.size, file);
    fwrite(png.bytes + 33, 1, png.size - 33, file);
    fclose(file);
    assert_cheap(image, path, ASJ_OK);
}

/* An 8 x 8 image by its first SIZ segment, 20000 x 20000 by its second. */
static void jpeg2000_with_two_sizes(void **state)
{
    static const char siz[] = "\xff\x51\0\x29\0\0";
    static const unsigned sides[2] = {8, 16000};
    static test_bytes file;
    int i, k;
    (void)state;
    file.size = 0;
    append(&file, "\xff\x4f", 2);
    for (i = 0; i < 2; i++) {
        append(&file, siz, 6);
        for (k = 0; k < 8; k++)
            append_big32(&file, k / 2 % 2 ? 0 : sides[i]);
        append(&file, "\0\1\7\1\1", 5);
    }
    append(&file, "\xff\x52\0\x0c\0\0\0\1\0\5\4\4\0\0\xff\x5c\0\x13\x40", 19);
    append(&file, "\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40", 16);
    append(&file, "\xff\x90\0\x0a\0\0\0\0\0\0\0\1\xff\x93\xff\xd9", 16);
    assert_cheap(image, write_bytes("two.j2k", file.bytes, file.size), ASJ_ERROR_FORMAT);
}

/* Sizes of 64 bits in a TIFF of 32, and a BigTIFF that is too large. */
static void tiff_with_long_sizes(void **state)
{
    static const unsigned char big[] = {'I', 'I', 43, 0, 8, 0, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0,
                                        0, 1, 16, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0x30, 0x75, 0, 0, 0, 0, 0, 0,
                                        1, 1, 16, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0x30, 0x75, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    static const unsigned char small[] = {'I', 'I', 42, 0, 8, 0, 0, 0, 2, 0, 0, 1, 16, 0, 1, 0, 0, 0, 38, 0, 0, 0,
                                          1, 1, 16, 0, 1, 0, 0, 0, 38, 0, 0, 0, 0, 0, 0, 0, 0x30, 0x75, 0, 0, 0, 0, 0, 0};
    (void)state;
    assert_cheap(image, write_bytes("big.tif", big, sizeof big), ASJ_ERROR_LIMIT);
    assert_cheap(image, write_bytes("small.tif", small, sizeof small),
                 strstr(asj_io_image_formats(), "TIFF") ? ASJ_ERROR_FORMAT : ASJ_ERROR_UNSUPPORTED);
}

static void pnm_with_a_comment_that_ends_twice(void **state)
{
    static const char head[] = "P5\n#\r30000 30000 255 \n4 4 255\n0123456789abcdef";
    (void)state;
    assert_cheap(image, write_bytes("cr.pgm", head, sizeof head), ASJ_ERROR_LIMIT);
}

static void files_without_end(void **state)
{
    (void)state;
    assert_cheap(image, "/dev/zero", ASJ_ERROR_FORMAT);
    assert_cheap(junctions, "/dev/zero", ASJ_ERROR_FORMAT);
}

/* 8 MB of empty lists under a key that nobody needs, and under one that is needed. */
static void json_with_long_values(void **state)
{
    enum { LISTS = 2 * 1024 * 1024 };
    static const char *const keys[] = {"unknown", "image"};
    static const asj_status wanted[] = {ASJ_OK, ASJ_ERROR_FORMAT};
    int k, i;
    (void)state;
    for (k = 0; k < 2; k++) {
        const char *path = in_folder("long.json");
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        fprintf(file, "{\"schema\":\"asj-junctions-1\",\"junctions\":[],\"%s\":[[]", keys[k]);
        for (i = 0; i < LISTS; i++)
            fputs(",[] ", file);
        fputs("]}", file);
        fclose(file);
        assert_cheap(junctions, path, wanted[k]);
    }
}

/* Signatures of decoders that OpenCV has, or that it takes for such, on what another of its decoders reads as a medical image. */
static void signatures_in_front_of_dicom(void **state)
{
    static const struct {
        const char *bytes;
        size_t size;
    } heads[] = {{"\0\0\0\x0cjP  \r\n\x87\n", 12}, {"#?RX\n", 5}, {"RIFF\0\0\0\0WEBP", 12},
                 {"\x59\xa6\x6a\x95\0\0\0\4\0\0\0\4", 12},
                 {"BM\0\0\0\0\0\0\0\0\0\0\0\0\x28\0\0\0\4\0\0\0\4\0\0\0", 26}, {"#?RGBE\n\n-Y 4 +X 4\n", 18}, {"II+\0", 4}};
    unsigned char file[135];
    size_t i;
    (void)state;
    for (i = 0; i < sizeof heads / sizeof heads[0]; i++) {
        cost got;
        memset(file, 0, sizeof file);
        memcpy(file, heads[i].bytes, heads[i].size);
        memcpy(file + 128, "DICM", 4);
        got = cost_of(image, write_bytes("medical", file, sizeof file));
        assert_true(got.status == ASJ_ERROR_FORMAT || got.status == ASJ_ERROR_UNSUPPORTED);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(png_with_compressed_text), cmocka_unit_test(jpeg2000_with_two_sizes),
        cmocka_unit_test(tiff_with_long_sizes),     cmocka_unit_test(pnm_with_a_comment_that_ends_twice),
        cmocka_unit_test(files_without_end),        cmocka_unit_test(json_with_long_values),
        cmocka_unit_test(signatures_in_front_of_dicom),
    };
    return cmocka_run_group_tests_name("io: bombs", tests, make_folder, remove_folder);
}
