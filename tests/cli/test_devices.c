/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli and OpenCL: devices, where it computes, the cache of compiled kernels. What needs a device is skipped where there is
 * none, or fails there when ASJ_REQUIRE_OPENCL is 1 in the environment. */
#define _GNU_SOURCE /* dladdr() */
#include "files.h"
#include "program.h"

#include <asj/device.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <dirent.h>
#include <dlfcn.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

static const char cache[] = "cache/asj";

static int has_device(void)
{
    asj_device_list *list = NULL;
    int usable = 0;
    assert_int_equal(asj_device_list_create(NULL, &list), ASJ_OK);
    for (uint32_t i = 0; i < list->count; i++)
        usable |= list->devices[i].usable;
    asj_device_list_free(&list);
    return usable;
}

static void need_device(void)
{
    const char *required = getenv("ASJ_REQUIRE_OPENCL");
    if (has_device())
        return;
    if (required && strcmp(required, "1") == 0)
        fail_msg("there is no OpenCL device, and ASJ_REQUIRE_OPENCL is 1");
    print_message("there is no OpenCL device\n");
    skip();
}

static int prepare(void **state)
{
    (void)state;
    char folder[PATH_MAX];
    write_views("scene.png", "other.png");
    if (!getcwd(folder, sizeof folder - 32))
        return -1;
    strcat(folder, "/cache");
    if (setenv("XDG_CACHE_HOME", folder, 1) != 0)
        return -1;
    strcat(folder, "/pocl"); /* PoCL has a cache of its own, and wants it */
    return setenv("POCL_CACHE_DIR", folder, 0);
}

/* The matches or junctions that the CPU finds, to be freed. */
static char *on_the_cpu(size_t *size)
{
    expect_code(run_cli("detect", "-q", "--backend", "cpu", "-f", "csv", "-o", "cpu.csv", "scene.png", NULL), 0);
    char *text = read_bytes("cpu.csv", size);
    assert_non_null(text);
    assert_true(*size > 500);
    return text;
}

static void expect_same_on_opencl(void)
{
    size_t size, expected_size;
    char *expected = on_the_cpu(&expected_size);
    expect_code(run_cli("detect", "-q", "--backend", "opencl", "-f", "csv", "-o", "device.csv", "scene.png", NULL), 0);
    char *text = read_bytes("device.csv", &size);
    assert_non_null(text);
    assert_int_equal(size, expected_size);
    assert_memory_equal(text, expected, size);
    free(text);
    free(expected);
}

/* --- without a device ------------------------------------------------------------------------------------------------------- */

static void devices_says_what_would_run(void **state)
{
    (void)state;
    const outcome *result = run_cli("devices", NULL);
    expect_code(result, 0);
    expect_in(result, result->out, "--backend auto ");
    expect_in(result, result->out, "--backend cpu    the CPU without OpenCL, ");
    expect_empty(result, "standard error", result->err);
    expect_code(run_cli("devices", "--help", NULL), 0);
    result = run_cli("devices", "everything", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "'everything'");
}

/* An ICD loader without drivers, or no loader at all. */
static void without_drivers_only_an_explicit_wish_fails(void **state)
{
    (void)state;
    assert_int_equal(mkdir("no-vendors", 0777), 0);
    assert_int_equal(setenv("OCL_ICD_VENDORS", "no-vendors", 1), 0);
    const outcome *result = run_cli("devices", NULL);
    expect_code(result, 0);
    expect_in(result, result->out, "no OpenCL devices: ");
    expect_in(result, result->out, "--backend opencl nothing");
    result = run_cli("detect", "-q", "--backend", "auto", "-f", "json", "-o", "auto.json", "scene.png", NULL);
    expect_code(result, 0);
    expect_empty(result, "standard error", result->err);
    result = run_cli("detect", "--backend", "opencl", "scene.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "OpenCL");
    expect_empty(result, "standard output", result->out);
    unsetenv("OCL_ICD_VENDORS");
    size_t size;
    char *json = read_bytes("auto.json", &size);
    assert_non_null(json);
    assert_non_null(strstr(json, "\"backend\": \"cpu\""));
    free(json);
}

static void a_device_excludes_the_cpu(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "--backend", "cpu", "--device", "0", "scene.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--device");
    expect_code(run_cli("match", "--device", "0", "--backend", "cpu", "scene.png", "other.png", NULL), 2);
}

/* --- with one --------------------------------------------------------------------------------------------------------------- */

static void devices_lists_it(void **state)
{
    (void)state;
    need_device();
    const outcome *result = run_cli("devices", NULL);
    expect_code(result, 0);
    expect_in(result, result->out, " 0  ");
    expect_in(result, result->out, "    can be used");
}

static void what_is_there_is_listed_when_another_is_wanted(void **state)
{
    (void)state;
    need_device();
    asj_device_list *list = NULL;
    assert_int_equal(asj_device_list_create(NULL, &list), ASJ_OK);
    const outcome *result = run_cli("detect", "--device", "no such device", "scene.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "'no such device'");
    for (uint32_t i = 0; i < list->count; i++)
        expect_in(result, result->err, *list->devices[i].name ? list->devices[i].name : "no device");
    asj_device_list_free(&list);
}

static void the_back_end_is_recorded(void **state)
{
    (void)state;
    size_t size;
    need_device();
    expect_code(run_cli("detect", "-q", "--device", "0", "-o", "device.json", "scene.png", NULL), 0);
    char *json = read_bytes("device.json", &size);
    assert_non_null(json);
    assert_non_null(strstr(json, "\"backend\": \"opencl\""));
    free(json);
    const outcome *result = run_cli("detect", "--backend", "opencl", "--time", "-o", "device.json", "scene.png", NULL);
    expect_code(result, 0);
    assert_null(strstr(result->err, ", CPU\n"));
}

static void matches_are_those_of_the_cpu(void **state)
{
    (void)state;
    size_t size, expected_size;
    need_device();
    expect_code(run_cli("match", "-q", "--backend", "cpu", "-o", "cpu.csv", "scene.png", "other.png", NULL), 0);
    expect_code(run_cli("match", "-q", "--backend", "opencl", "-o", "device.csv", "scene.png", "other.png", NULL), 0);
    char *expected = read_bytes("cpu.csv", &expected_size), *text = read_bytes("device.csv", &size);
    assert_true(expected && text && expected_size > 1000);
    assert_int_equal(size, expected_size);
    assert_memory_equal(text, expected, size);
    free(text);
    free(expected);
}

/* --- the cache of kernels --------------------------------------------------------------------------------------------------- */

static char libraries[PATH_MAX]; /* where they were looked for before */

/* PoCL is not asked for what it compiles. So these tests go through a library that passes everything on to the real one, under
 * another name (tests/opencl/stub.c): ASJ_STUB_OPENCL in the environment. 0 = there is none. */
static int go_through_stub(void)
{
    const char *old = getenv("LD_LIBRARY_PATH");
    const char *stub = getenv("ASJ_STUB_OPENCL"), *folder = getenv("XDG_CACHE_HOME");
    void *library = dlopen("libOpenCL.so.1", RTLD_NOW), *symbol = library ? dlsym(library, "clGetPlatformIDs") : NULL;
    char path[PATH_MAX], all[2 * PATH_MAX];
    Dl_info found;
    if (!stub || !folder || !symbol || !dladdr(symbol, &found))
        return 0;
    mkdir(folder, 0777);
    snprintf(path, sizeof path, "%.4000s/driver", folder);
    mkdir(path, 0777);
    snprintf(all, sizeof all, "%s%s%.4000s", path, old ? ":" : "", old ? old : "");
    snprintf(libraries, sizeof libraries, "%.4000s", old ? old : "");
    assert_int_equal(setenv("STUB_OPENCL", found.dli_fname, 1), 0);
    assert_int_equal(setenv("LD_LIBRARY_PATH", all, 1), 0);
    strcat(path, "/libOpenCL.so.1");
    return access(path, F_OK) == 0 || symlink(stub, path) == 0;
}

static void need_store(void)
{
    need_device();
    if (!go_through_stub()) {
        print_message("there is no library to go through\n");
        skip();
    }
}

static int back_to_the_real_library(void **state)
{
    (void)state;
    return libraries[0] ? setenv("LD_LIBRARY_PATH", libraries, 1) : unsetenv("LD_LIBRARY_PATH");
}

/* Calls `change` for every file of the cache; returns how many there are. */
static int each_entry(void (*change)(const char *path))
{
    int count = 0;
    DIR *folder = opendir(cache);
    assert_non_null(folder);
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        char path[PATH_MAX];
        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/%s", cache, entry->d_name);
        change(path);
        count++;
    }
    closedir(folder);
    return count;
}

static void remove_entry(const char *path)
{
    assert_int_equal(unlink(path), 0);
}

static void damage_middle(const char *path)
{
    size_t size;
    char *bytes = read_bytes(path, &size);
    assert_non_null(bytes);
    bytes[size / 2] = (char)~bytes[size / 2];
    write_bytes(path, bytes, size);
    free(bytes);
}

static void cut(const char *path)
{
    size_t size;
    char *bytes = read_bytes(path, &size);
    assert_non_null(bytes);
    write_bytes(path, bytes, size / 2);
    free(bytes);
}

static void empty(const char *path)
{
    write_bytes(path, "", 0);
}

static void fill_with_text(const char *path)
{
    write_bytes(path, "no kernel", 9);
}

static void make_folder(const char *path)
{
    assert_int_equal(unlink(path), 0);
    assert_int_equal(mkdir(path, 0777), 0);
}

static void make_pipe(const char *path)
{
    assert_int_equal(rmdir(path), 0);
    assert_int_equal(mkfifo(path, 0666), 0);
}

static long newest;
static void note_time(const char *path)
{
    struct stat facts;
    assert_int_equal(stat(path, &facts), 0);
    const long when = (long)facts.st_mtim.tv_sec * 1000 + facts.st_mtim.tv_nsec / 1000000;
    newest = when > newest ? when : newest;
}

/* When the last entry was written, ms. */
static long last_written(void)
{
    newest = 0;
    assert_true(each_entry(note_time) > 0);
    return newest;
}

static void kernels_are_kept_and_used(void **state)
{
    (void)state;
    need_store();
    expect_same_on_opencl();
    const long before = last_written();
    expect_same_on_opencl();
    assert_int_equal(last_written(), before); /* nothing was compiled and stored again */
}

/* Every entry in another way. */
static void damage(const char *path)
{
    static void (*const damages[])(const char *path) = {damage_middle, cut, empty, fill_with_text};
    static size_t next;
    damages[next++ % (sizeof damages / sizeof damages[0])](path);
}

static void damaged_kernels_are_made_anew(void **state)
{
    (void)state;
    need_store();
    expect_same_on_opencl();
    assert_true(each_entry(damage) >= 4);
    const long damaged = last_written();
    expect_same_on_opencl();
    const long mended = last_written();
    assert_true(mended > damaged);
    expect_same_on_opencl();
    assert_int_equal(last_written(), mended);
}

static void what_is_no_file_is_left_alone(void **state)
{
    (void)state;
    need_store();
    expect_same_on_opencl();
    assert_true(each_entry(make_folder) > 0);
    expect_same_on_opencl();
    assert_true(each_entry(make_pipe) > 0);
    expect_same_on_opencl(); /* and nobody waits for somebody to write */
    assert_true(each_entry(remove_entry) > 0);
}

static void programs_may_fill_it_at_the_same_time(void **state)
{
    (void)state;
    enum { PROGRAMS = 3 };
    size_t size, expected_size;
    pid_t processes[PROGRAMS];
    need_store();
    char *expected = on_the_cpu(&expected_size);
    expect_same_on_opencl();
    const int count = each_entry(remove_entry);
    for (int i = 0; i < PROGRAMS; i++) {
        char name[32];
        snprintf(name, sizeof name, "same-%d.csv", i);
        const char *const arguments[] = {"detect", "-q", "--backend", "opencl", "-o", name, "scene.png", NULL};
        processes[i] = start_cli(CAPTURED, CAPTURED, arguments);
    }
    for (int i = 0; i < PROGRAMS; i++)
        expect_code(finish_cli(processes[i]), 0);
    for (int i = 0; i < PROGRAMS; i++) {
        char name[32];
        snprintf(name, sizeof name, "same-%d.csv", i);
        char *text = read_bytes(name, &size);
        assert_non_null(text);
        assert_int_equal(size, expected_size);
        assert_memory_equal(text, expected, size);
        free(text);
    }
    assert_int_equal(count_files(cache), count); /* and no temporary file */
    free(expected);
}

static void a_folder_that_cannot_be_written_does_not_matter(void **state)
{
    (void)state;
    static const char *const places[] = {"/dev/null/cache", "relative"};
    char *old = getenv("HOME"), kept[PATH_MAX] = "";
    need_device();
    if (old)
        snprintf(kept, sizeof kept, "%s", old);
    assert_int_equal(setenv("HOME", "/dev/null", 1), 0);
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        assert_int_equal(setenv("XDG_CACHE_HOME", places[i], 1), 0);
        const outcome *result = run_cli("detect", "-q", "--backend", "opencl", "-o", "device.csv", "scene.png", NULL);
        expect_code(result, 0);
        expect_empty(result, "standard error", result->err);
    }
    assert_false(exists("relative"));
    assert_int_equal(setenv("HOME", kept, 1), 0);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(devices_says_what_would_run),
        cmocka_unit_test(without_drivers_only_an_explicit_wish_fails),
        cmocka_unit_test(a_device_excludes_the_cpu),
        cmocka_unit_test(devices_lists_it),
        cmocka_unit_test(what_is_there_is_listed_when_another_is_wanted),
        cmocka_unit_test(the_back_end_is_recorded),
        cmocka_unit_test(matches_are_those_of_the_cpu),
        cmocka_unit_test_teardown(kernels_are_kept_and_used, back_to_the_real_library),
        cmocka_unit_test_teardown(damaged_kernels_are_made_anew, back_to_the_real_library),
        cmocka_unit_test_teardown(what_is_no_file_is_left_alone, back_to_the_real_library),
        cmocka_unit_test_teardown(programs_may_fill_it_at_the_same_time, back_to_the_real_library),
        cmocka_unit_test(a_folder_that_cannot_be_written_does_not_matter),
    };
    program_start(argc, argv);
    return program_end(cmocka_run_group_tests(tests, prepare, NULL));
}
