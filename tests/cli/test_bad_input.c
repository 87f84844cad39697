/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli detect with files that cannot be read and results that cannot be written: one line each, and the rest is done. */
#define _POSIX_C_SOURCE 200809L
#include "files.h"
#include "program.h"

#include <asj/io.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static size_t good_size; /* of good.png */

static int count_lines(const char *text)
{
    int lines = 0;
    for (; *text; text++)
        lines += *text == '\n';
    return lines;
}

static int make_files(void **state)
{
    (void)state;
    static const unsigned char jpeg[] = {0xff, 0xd8, 0xff, 0xe0, 0, 16, 'J', 'F', 'I', 'F', 0, 1, 1, 0, 0, 1, 0, 1, 0, 0,
                                         0xff, 0xc0, 0, 11, 8, 0, 64, 0, 64, 1, 1, 0x11, 0};
    write_scene("good.png");
    free(read_bytes("good.png", &good_size));
    assert_int_equal(mkdir("folder.png", 0777), 0);
    write_bytes("empty.png", "", 0);
    write_bytes("text.png", "This is not an image.\n", 22);
    write_bytes("two\nlines.png", "This is not an image.\n", 22);
    write_part("truncated.png", "good.png", good_size / 2);
    write_part("header.png", "good.png", 20);
    write_part("unended.png", "good.png", good_size - 12);
    write_damaged("checksum.png", "good.png", good_size - 16); /* of the last chunk of pixels */
    write_damaged("pixels.png", "good.png", good_size / 2);
    write_png_header("bomb.png", 65000, 65000);
    write_png_header("zero.png", 0, 10);
    write_bytes("truncated.jpg", jpeg, sizeof jpeg);
    return 0;
}

static const char *const bad[] = {"missing.png", "folder.png", "empty.png", "text.png", "truncated.png", "header.png",
                                  "unended.png", "checksum.png", "pixels.png", "bomb.png", "zero.png", "truncated.jpg"};
enum { BAD = sizeof bad / sizeof bad[0] };

static void each_bad_file_has_one_line(void **state)
{
    (void)state;
    for (size_t i = 0; i < BAD; i++) {
        char beginning[64];
        snprintf(beginning, sizeof beginning, "asj-cli: %s: ", bad[i]);
        const outcome *result = run_cli("detect", "-o", "never.asj", bad[i], NULL);
        expect_code(result, 1);
        expect_in(result, result->err, beginning);
        expect_empty(result, "standard output", result->out);
        if (count_lines(result->err) != 1 || strncmp(result->err, beginning, strlen(beginning)) != 0 ||
            strlen(result->err) < strlen(beginning) + 5)
            fail_msg("not one clear line:\n%s", result->err);
        if (exists("never.asj"))
            fail_msg("%s: a result was written", bad[i]);
    }
}

/* What is given in place of images, and what to do instead. */
static void results_and_folders_in_place_of_images(void **state)
{
    (void)state;
    static const char *const files[] = {"j.json", "j.asj", "lines.json"};
    expect_code(run_cli("detect", "-q", "-o", "j.json", "good.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "-o", "j.asj", "good.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "--lines", "-o", "lines.json", "good.png", NULL), 0);
    expect_code(run_cli("match", "-q", "-o", "m.json", "good.png", "good.png", NULL), 0);
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        const outcome *result = run_cli("match", files[i], "good.png", NULL);
        expect_code(result, 1);
        expect_in(result, result->err, ": junctions, not an image: 'asj-cli match' takes them with --junctions1 FILE --junctions2");
        assert_int_equal(count_lines(result->err), 1);
    }
    const outcome *result = run_cli("detect", "m.json", NULL);
    expect_in(result, result->err, "asj-cli: m.json: matches, not an image\n");
    result = run_cli("detect", "folder.png//", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: folder.png//: is a directory; its images are \"folder.png\"/*.jpg, or: find "
                                   "\"folder.png\" -name '*.jpg' | asj-cli detect --files-from - -d DIR\n");
}

/* Nor is its name told twice where it cannot be told as it is. */
static void a_name_with_a_newline_is_told_once(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "-o", "never.asj", "two\nlines.png", NULL);
    expect_code(result, 1);
    if (strncmp(result->err, "asj-cli: two?lines.png: not an image", 36) != 0)
        fail_msg("not so: %s", result->err);
}

static void bad_files_do_not_stop_the_others(void **state)
{
    (void)state;
    const char *arguments[BAD + 8] = {"detect", "-q", "--out-dir", "results", "good.png"};
    for (size_t i = 0; i < BAD; i++)
        arguments[5 + i] = bad[i];
    arguments[5 + BAD] = "other.png";
    write_scene("other.png");
    assert_int_equal(mkdir("results", 0777), 0);
    /* truncated.png and truncated.jpg would share a name, so that one is left out */
    arguments[4 + BAD] = "third.png";
    write_scene("third.png");
    const outcome *result = run_cli_list(arguments);
    expect_code(result, 1);
    assert_int_equal(count_lines(result->err), BAD - 1);
    assert_true(exists("results/good.asj"));
    assert_true(exists("results/other.asj"));
    assert_true(exists("results/third.asj"));
    assert_int_equal(count_files("results"), 3);
}

static void a_failure_keeps_the_old_result(void **state)
{
    (void)state;
    size_t size = 0;
    write_bytes("kept.asj", "old", 3);
    expect_code(run_cli("detect", "-o", "kept.asj", "truncated.png", NULL), 1);
    char *bytes = read_bytes("kept.asj", &size);
    assert_non_null(bytes);
    assert_string_equal(bytes, "old");
    free(bytes);
}

static void an_unreadable_file_is_named(void **state)
{
    (void)state;
    write_scene("secret.png");
    assert_int_equal(chmod("secret.png", 0), 0);
    if (access("secret.png", R_OK) == 0) {
        print_message("[  NOTE    ] this user may read every file: not tested\n");
        skip();
    }
    const outcome *result = run_cli("detect", "secret.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: secret.png: ");
    expect_in(result, result->err, "ermission denied");
}

static void the_limit_on_pixels_can_be_moved(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "--max-megapixels", "0.05", "good.png", NULL); /* it has 0.0768 */
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: good.png: 320 x 240 pixels are more than the limit of 50000 (--max-megapixels 1)\n");
    result = run_cli("detect", "bomb.png", NULL);
    expect_in(result, result->err, " (--max-megapixels goes up to 536)\n");
    write_png_header("large.png", 20000, 15000);
    result = run_cli("match", "large.png", "good.png", NULL);
    expect_in(result, result->err, "large.png: 20000 x 15000 pixels are more than the limit of 268435456 (--max-megapixels 300)\n");
    expect_code(run_cli("detect", "--max-megapixels", "0.0768", "good.png", NULL), 0);
}

static void control_characters_stay_out_of_messages(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "two\nlines\033[31m.png", NULL);
    expect_code(result, 1);
    assert_int_equal(count_lines(result->err), 1);
    assert_null(strchr(result->err, '\033'));
}

/* C1 controls in UTF-8: CSI, which many terminals take for ESC [. Other characters stay. */
static void controls_in_utf_8_stay_out_of_messages(void **state)
{
    (void)state;
    write_bytes("c\302\2331.png", "This is not an image.\n", 22);
    static const char *const names[] = {"c\302\2331.png", "no\302\2331.png", "k\303\274che \302\240.png"};
    static const char *const told[] = {"c??1.png", "no??1.png", "k\303\274che \302\240.png"};
    for (size_t i = 0; i < 3; i++) {
        char beginning[64];
        snprintf(beginning, sizeof beginning, "asj-cli: %s: ", told[i]);
        const outcome *result = run_cli("detect", names[i], NULL);
        expect_code(result, 1);
        assert_int_equal(strncmp(result->err, beginning, strlen(beginning)), 0);
        assert_null(strstr(result->err + strlen(beginning), told[i]));
    }
    char message[512];
    asj_image_file *file = NULL;
    assert_int_equal(asj_image_file_read(names[1], 0, &file, message, sizeof message), ASJ_ERROR_FILE);
    assert_int_equal(strncmp(message, "no??1.png: cannot open", 22), 0);
}

/* The middle of a long name goes, not the cause. */
static void a_long_path_leaves_room_for_the_cause(void **state)
{
    (void)state;
    static char path[9001];
    char message[512];
    asj_image_file *file = NULL;
    const size_t lengths[] = {340, 351, 352, 1100, 3000, 9000};
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        for (size_t k = 0; k < lengths[i]; k++) /* two bytes each */
            path[k] = k % 2 ? '\274' : '\303';
        memcpy(path, "begin", 5);
        memcpy(path + lengths[i] - 3, "end", 4);
        const outcome *result = run_cli("detect", path, NULL);
        expect_code(result, 1);
        expect_in(result, result->err, "asj-cli: begin");
        expect_in(result, result->err, "end: cannot open: File name too long\n");
        assert_true(strstr(strstr(result->err, "begin") + 1, "begin") == NULL);
        result = run_cli("detect", "-o", path, "good.png", NULL);
        expect_code(result, 1);
        expect_in(result, result->err, "File name too long\n");
        assert_int_equal(asj_image_file_read(path, 0, &file, message, sizeof message), ASJ_ERROR_FILE);
        const char *cause = strstr(message, "end: cannot open: File name too long");
        assert_true(cause && strncmp(message, "begin", 5) == 0);
        assert_int_equal(strstr(message, "...") != NULL, lengths[i] > 350);
    }
    assert_int_equal(asj_image_file_read(path, 0, &file, message, 20), ASJ_ERROR_FILE);
    assert_string_equal(message, "be...nd: cannot ope");
}

static void an_output_folder_is_made_or_refused_before_any_work(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "--out-dir", "good.png/sub", "good.png", "missing.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: good.png/sub: Not a directory");
    assert_int_equal(count_lines(result->err), 1);
    expect_code(run_cli("detect", "-q", "--out-dir", "made/with//its parents/", "good.png", NULL), 0);
    assert_true(exists("made/with/its parents/good.asj"));
    result = run_cli("detect", "--out-dir", "good.png", "good.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: good.png: not a folder");
    result = run_cli("detect", "-o", "nowhere/good.asj", "good.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: nowhere/good.asj: ");
    expect_in(result, result->err, "No such file or directory");
    result = run_cli("detect", "-o", "folder.png", "good.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: folder.png: ");
}

static void a_full_device_is_reported(void **state)
{
    (void)state;
    int full = open("/dev/full", O_WRONLY);
    if (full < 0) {
        print_message("[  NOTE    ] there is no /dev/full: not tested\n");
        skip();
    }
    const outcome *result = run_cli_to(full, "detect", "-q", "good.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: standard output: ");
    assert_int_equal(count_lines(result->err), 1);
    result = run_cli_to(full, "--help", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: standard output: ");
    close(full);
    result = run_cli("detect", "-q", "-o", "/dev/full", "good.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: /dev/full: ");
    assert_true(exists("/dev/full"));
}

static void an_empty_name_is_seen(void **state)
{
    (void)state;
    static const char *const commands[][6] = {{"detect", ""},
                                              {"detect", "--files-from", ""},
                                              {"detect", "--mask", "", "good.png"},
                                              {"match", "good.png", ""},
                                              {"match", "--junctions2", "", "good.png", "good.png"}};
    for (size_t c = 0; c < sizeof commands / sizeof commands[0]; c++) {
        const char *const *a = commands[c];
        const outcome *result = run_cli(a[0], a[1], a[2], a[3], a[4], a[5], NULL);
        expect_code(result, 1);
        assert_int_equal(count_lines(result->err), 1);
        if (strncmp(result->err, "asj-cli: '': ", 13) != 0)
            fail_msg("not so: %s", result->err);
    }
    const outcome *result = run_cli("detect", "-q", "-f", "jsonl", "", NULL);
    expect_in(result, result->out, "\"error\":\"'': cannot open: ");
}

/* `| head` */
static void a_closed_pipe_fails_without_a_word(void **state)
{
    (void)state;
    static const char *const commands[][5] = {{"detect", "-q", "good.png"}, {"detect", "-q", "-f", "json", "good.png"}, {"--help"}};
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    close(ends[0]);
    for (size_t c = 0; c < sizeof commands / sizeof commands[0]; c++) {
        const char *const *a = commands[c];
        const outcome *result = run_cli_to(ends[1], a[0], a[1], a[2], a[3], a[4], NULL);
        expect_code(result, 1);
        expect_empty(result, "standard error", result->err);
    }
    close(ends[1]);
}

/* A limit on the size of files stands in for a full disk: in the middle of a result writing fails. */
static void a_result_that_does_not_fit_leaves_nothing(void **state)
{
    (void)state;
    struct rlimit old, tight;
    assert_int_equal(mkdir("full", 0777), 0);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    tight = old;
    tight.rlim_cur = 2048; /* more than a message, less than a result */
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &tight), 0);
    const outcome *result =
        without_cairo ? run_cli("detect", "-q", "-f", "json", "--out-dir", "full", "good.png", NULL)
                      : run_cli("detect", "-q", "-f", "json", "--out-dir", "full", "--plot", "png", "good.png", NULL);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
    signal(SIGXFSZ, SIG_DFL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: full/good.json: ");
    if (!without_cairo)
        expect_in(result, result->err, "asj-cli: full/good.plot.png: ");
    assert_int_equal(count_files("full"), 0);
}

static void an_opencl_device_that_is_not_there_is_an_error(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "--backend", "opencl", "--device", "no such device", "good.png", NULL);
    expect_code(result, 1);
    assert_int_equal(strncmp(result->err, "asj-cli: ", 9), 0);
    expect_empty(result, "standard output", result->out);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_bad_file_has_one_line),
        cmocka_unit_test(results_and_folders_in_place_of_images), cmocka_unit_test(a_name_with_a_newline_is_told_once),
        cmocka_unit_test(bad_files_do_not_stop_the_others),
        cmocka_unit_test(a_failure_keeps_the_old_result),
        cmocka_unit_test(an_unreadable_file_is_named),
        cmocka_unit_test(the_limit_on_pixels_can_be_moved),
        cmocka_unit_test(control_characters_stay_out_of_messages),
        cmocka_unit_test(controls_in_utf_8_stay_out_of_messages),
        cmocka_unit_test(a_long_path_leaves_room_for_the_cause),
        cmocka_unit_test(an_output_folder_is_made_or_refused_before_any_work),
        cmocka_unit_test(a_full_device_is_reported),
        cmocka_unit_test(an_empty_name_is_seen),
        cmocka_unit_test(a_closed_pipe_fails_without_a_word),
        cmocka_unit_test(a_result_that_does_not_fit_leaves_nothing),
        cmocka_unit_test(an_opencl_device_that_is_not_there_is_an_error),
    };
    program_start(argc, argv);
    return program_end(cmocka_run_group_tests(tests, make_files, NULL));
}
