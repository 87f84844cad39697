/* SPDX-License-Identifier: BSD-2-Clause */
/* Reading when memory runs out: allocation after allocation fails, one in each run, in libasj-io and in the decoders behind it. A
 * file is then read as ever, by a decoder that does without, or ASJ_ERROR_MEMORY says why not: a good file is never called damaged,
 * so that nobody throws it away. Others' code behind it does not always keep to that, and such files are left out: libtiff 4.5
 * crashes when it closes one, OpenJPEG 2.5 hands over an image without its parts, libwebp 1.2 calls lossless ones damaged, and
 * Jansson loses bytes of words. The functions here stand before the C library's (glibc: __libc_malloc() and its like). */
#include "io_test.h"

#include <dirent.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

enum { MOST = 20000 };

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);

static pthread_t watched;
static long calls, fails_at; /* of the thread that is watched; 0 = nothing fails */

static int fails(void)
{
    if (fails_at == 0 || !pthread_equal(watched, pthread_self()))
        return 0;
    return ++calls == fails_at;
}

__attribute__((visibility("default"))) void *malloc(size_t size)
{
    return fails() ? NULL : __libc_malloc(size);
}

__attribute__((visibility("default"))) void *calloc(size_t count, size_t size)
{
    return fails() ? NULL : __libc_calloc(count, size);
}

__attribute__((visibility("default"))) void *realloc(void *block, size_t size)
{
    return fails() ? NULL : __libc_realloc(block, size);
}

typedef asj_status (*reader)(const char *path, char *message, size_t size);

static asj_status read_image(const char *path, char *message, size_t size)
{
    asj_image_file *file = NULL;
    const asj_status status = asj_image_file_read(path, 0, &file, message, size);
    assert_true((status == ASJ_OK) == (file != NULL));
    asj_image_file_free(&file);
    return status;
}

static asj_status read_junctions(const char *path, char *message, size_t size)
{
    asj_junction_file *file = NULL;
    const asj_status status = asj_junctions_read(path, &file, message, size);
    assert_true((status == ASJ_OK) == (file != NULL));
    asj_junction_file_free(&file);
    return status;
}

/* Until a run asks for fewer allocations than would have to come before the one that fails. Returns how many failures were told. */
static long fail_in_turn(reader read, const char *path)
{
    char message[512] = "";
    long failures = 0, reached = 1;
    if (read(path, message, sizeof message) != ASJ_OK)
        return -1; /* the corpus has damaged files, too, and those of parts that are not built in */
    for (long n = 1; n < MOST && reached; n++) {
        watched = pthread_self();
        calls = 0;
        fails_at = n;
        const asj_status status = read(path, message, sizeof message);
        fails_at = 0;
        reached = calls >= n;
        if (status != ASJ_OK && status != ASJ_ERROR_MEMORY)
            fail_msg("%s, allocation %ld: status %d, %s", path, n, (int)status, message);
        failures += status != ASJ_OK;
    }
    assert_int_equal(reached, 0);
    return failures;
}

static int does_not_tell(const char *name)
{
    return strstr(name, ".tif") || strstr(name, ".jp2") || strstr(name, "lossless.webp") || strstr(name, ".json");
}

static void read_folder(reader read, const char *folder, int least)
{
    int files = 0;
    DIR *entries = opendir(folder);
    assert_non_null(entries);
    for (const struct dirent *entry = readdir(entries); entry; entry = readdir(entries)) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] == '.' || does_not_tell(entry->d_name))
            continue;
        const long failures = fail_in_turn(read, path);
        assert_true(failures != 0); /* each needs memory */
        files += failures > 0;
    }
    closedir(entries);
    print_message("%s: %d files\n", folder, files);
    assert_true(files >= least);
}

static void images(void **state)
{
    (void)state;
    read_folder(read_image, ASJ_CORPUS "/image", 5);
    read_folder(read_image, ASJ_CORPUS "/probe", 1);
}

static void junctions(void **state)
{
    (void)state;
    read_folder(read_junctions, ASJ_CORPUS "/junctions", 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(images), cmocka_unit_test(junctions)};
    return cmocka_run_group_tests_name("io: memory runs out", tests, NULL, NULL);
}
