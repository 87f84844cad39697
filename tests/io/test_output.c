/* SPDX-License-Identifier: BSD-2-Clause */
/* Output files appear whole or not at all. */
#define _XOPEN_SOURCE 700
#include "io_test.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char message[512];

static void assert_content(const char *path, const char *text)
{
    static test_bytes found;
    read_bytes(path, &found);
    assert_int_equal(found.size, strlen(text));
    assert_memory_equal(found.bytes, text, found.size);
}

static void assert_names(const char *path, const char *cause)
{
    if (strncmp(message, path, strlen(path)) || !strstr(message, cause))
        fail_msg("'%s' does not name '%s' and '%s'", message, path, cause);
}

static asj_output *begin(const char *path)
{
    asj_output *output = NULL;
    if (asj_output_begin(path, &output, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    return output;
}

static void assert_cannot_begin(const char *path, asj_status status, const char *cause)
{
    asj_output *output = (asj_output *)(size_t)16;
    int files = count_files();
    assert_int_equal(asj_output_begin(path, &output, message, sizeof message), status);
    assert_null(output);
    assert_names(path, cause);
    assert_int_equal(count_files(), files);
}

static void nothing_before_the_end(void **state)
{
    const char *path = in_folder("new");
    asj_output *output = begin(path);
    (void)state;
    assert_int_equal(asj_output_text(output, "one "), ASJ_OK);
    assert_int_equal(asj_output_write(output, "two", 3), ASJ_OK);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_OK);
    assert_null(output);
    assert_content(path, "one two");
    assert_int_equal(count_files(), 1);
}

static void an_old_file_stays_until_the_end(void **state)
{
    const char *path = write_bytes("old", "before", 6);
    int files = count_files();
    asj_output *output = begin(path);
    (void)state;
    asj_output_text(output, "after");
    assert_content(path, "before");
    asj_output_abort(&output);
    assert_null(output);
    assert_content(path, "before");
    assert_int_equal(count_files(), files);
    output = begin(path);
    asj_output_text(output, "after");
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_OK);
    assert_content(path, "after");
    assert_int_equal(count_files(), files);
    asj_output_abort(NULL);
    asj_output_abort(&output);
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_output_write(NULL, "x", 1), ASJ_ERROR_ARGUMENT);
}

/* What a full disk does, by a limit on the length of files. */
static void limit_files(rlim_t bytes)
{
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = bytes;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

static void full_disk(void **state)
{
    static char large[200000];
    const char *path = write_bytes("kept", "before", 6);
    int files = count_files(), size;
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    for (size = 5000; size <= 200000; size += 195000) { /* fails when closed; when written */
        asj_output *output = begin(path);
        limit_files(4096);
        asj_output_write(output, large, (size_t)size);
        assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_ERROR_FILE);
        limit_files(RLIM_INFINITY);
        assert_names(path, "cannot write");
        assert_content(path, "before");
        assert_int_equal(count_files(), files);
    }
}

static void full_disk_under_every_writer(void **state)
{
    static unsigned char pixels[200 * 200];
    static asj_junction junctions[100];
    static const asj_detection_report none = {0};
    asj_image view = {pixels, ASJ_FORMAT_GRAY8, 200, 200, 0, 0};
    asj_detection detection = {0};
    asj_detection_report report = none;
    const char *path = write_bytes("whole", "before", 6);
    int files = count_files();
    int32_t format, i;
    (void)state;
    for (i = 0; i < 200 * 200; i++)
        pixels[i] = (unsigned char)picture_sample(i % 200, i / 200, 0, 8);
    for (i = 0; i < 100; i++)
        junctions[i].branch_count = 3;
    detection.junctions = junctions;
    detection.junction_count = 100;
    detection.width = detection.height = 10;
    report.detection = &detection;
    signal(SIGXFSZ, SIG_IGN);
    for (format = ASJ_FILE_ASJ_WHOLE; format <= ASJ_FILE_CSV + 1; format++) {
        asj_status status;
        limit_files(2000);
        status = format <= ASJ_FILE_CSV ? asj_junctions_write(path, format, &report, message, sizeof message)
                                        : asj_png_write(path, &view, message, sizeof message);
        limit_files(RLIM_INFINITY);
        assert_int_equal(status, ASJ_ERROR_FILE);
        assert_names(path, "File too large");
        assert_content(path, "before");
        assert_int_equal(count_files(), files);
    }
}

static void devices_are_written_directly(void **state)
{
    asj_output *output;
    struct stat info;
    (void)state;
    output = begin("/dev/null");
    asj_output_text(output, "gone");
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_OK);
    assert_int_equal(stat("/dev/null", &info), 0);
    assert_true(S_ISCHR(info.st_mode));
    if (access("/dev/full", W_OK)) {
        print_message("SKIPPED: no /dev/full\n");
        skip();
    }
    output = begin("/dev/full");
    asj_output_text(output, "no room");
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_ERROR_FILE);
    assert_names("/dev/full", "No space left");
}

/* Standard output goes to a file that already has a line: it is added to, as the shell's >> asks for. */
static void standard_output(void **state)
{
    static const char *const names[] = {"-", "/dev/stdout", "/dev/fd/1"};
    size_t i;
    (void)state;
    for (i = 0; i < 3; i++) {
        const char *path = write_bytes("stdout", "first\n", 6);
        int file = open(path, O_WRONLY | O_APPEND), saved = dup(STDOUT_FILENO);
        asj_output *output;
        fflush(stdout);
        dup2(file, STDOUT_FILENO);
        output = begin(names[i]);
        asj_output_text(output, "second\n");
        assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_OK);
        assert_int_equal(write(STDOUT_FILENO, "third\n", 6), 6); /* it is still open */
        dup2(saved, STDOUT_FILENO);
        close(saved);
        close(file);
        assert_content(path, "first\nsecond\nthird\n");
    }
}

static void paths_that_cannot_be_written(void **state)
{
    asj_output *output;
    const char *locked;
    (void)state;
    assert_cannot_begin(in_folder("missing/x"), ASJ_ERROR_FILE, "No such file");
    assert_cannot_begin(in_folder("."), ASJ_ERROR_FILE, "directory");
    assert_cannot_begin(in_folder("./"), ASJ_ERROR_FILE, "directory");
    write_bytes("plain", "x", 1);
    assert_cannot_begin(in_folder("plain/x"), ASJ_ERROR_FILE, "Not a directory");
    assert_cannot_begin("", ASJ_ERROR_FILE, "empty path");
    output = (asj_output *)&output; /* anything: NULL afterwards */
    assert_int_equal(asj_output_begin(NULL, &output, message, sizeof message), ASJ_ERROR_ARGUMENT);
    assert_null(output);
    assert_int_equal(asj_output_begin("x", NULL, message, sizeof message), ASJ_ERROR_ARGUMENT);
    locked = in_folder("locked");
    assert_int_equal(mkdir(locked, 0555), 0);
    assert_int_equal(chmod(write_bytes("protected", "x", 1), 0444), 0);
    assert_int_equal(chmod(in_folder("."), 0777), 0); /* files could be replaced by others here */
    if (!become_ordinary()) {
        print_message("SKIPPED: cannot become an ordinary user\n");
        skip();
    }
    assert_cannot_begin(in_folder("locked/x"), ASJ_ERROR_FILE, "Permission denied");
    assert_cannot_begin(in_folder("protected"), ASJ_ERROR_FILE, "Permission denied");
    become_root();
}

static void links_and_permissions_stay(void **state)
{
    const char *target = write_bytes("target", "before", 6), *link = in_folder("link");
    asj_output *output;
    struct stat info;
    (void)state;
    assert_int_equal(symlink("target", link), 0);
    assert_int_equal(chmod(target, 0640), 0);
    assert_int_equal(stat(target, &info), 0);
    const uid_t owner = geteuid() == 0 && chown(target, 12345, 12345) == 0 ? 12345 : info.st_uid; /* only root gives files away */
    output = begin(link);
    asj_output_text(output, "after");
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_OK);
    assert_content(target, "after");
    assert_int_equal(lstat(link, &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(stat(target, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    assert_int_equal(info.st_uid, owner);
}

static void new_files_follow_the_umask(void **state)
{
    mode_t before = umask(027);
    asj_output *output = begin(in_folder("masked"));
    struct stat info;
    (void)state;
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_OK);
    umask(before);
    assert_int_equal(stat(in_folder("masked"), &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    assert_int_equal(info.st_size, 0);
}

/* Too little room leaves what was there. */
static void targets_need_room(void **state)
{
    char target[4096] = "", again[4096] = "kept";
    (void)state;
    assert_int_equal(asj_output_target(in_folder("./named"), target, sizeof target), ASJ_OK);
    const size_t size = strlen(target) + 1;
    for (size_t room = 0; room < size; room++)
        assert_int_equal(asj_output_target(in_folder("named"), again, room), ASJ_ERROR_FILE);
    assert_string_equal(again, "kept");
    assert_int_equal(asj_output_target(in_folder("named"), again, size), ASJ_OK);
    assert_string_equal(again, target);
    assert_int_equal(asj_output_target("/named", again, sizeof "/named" - 1), ASJ_ERROR_FILE);
    assert_int_equal(asj_output_target("/named", again, sizeof "/named"), ASJ_OK);
    assert_string_equal(again, "/named");
    assert_int_equal(asj_output_target(in_folder("missing/x"), again, sizeof again), ASJ_ERROR_FILE);
    assert_int_equal(asj_output_target(NULL, again, sizeof again), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_output_target("x", NULL, 0), ASJ_ERROR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_before_the_end),       cmocka_unit_test(an_old_file_stays_until_the_end),
        cmocka_unit_test(full_disk),                    cmocka_unit_test(full_disk_under_every_writer),
        cmocka_unit_test(devices_are_written_directly), cmocka_unit_test(standard_output),
        cmocka_unit_test(paths_that_cannot_be_written), cmocka_unit_test(links_and_permissions_stay),
        cmocka_unit_test(new_files_follow_the_umask),   cmocka_unit_test(targets_need_room),
    };
    return cmocka_run_group_tests_name("io: output", tests, make_folder, remove_folder);
}
