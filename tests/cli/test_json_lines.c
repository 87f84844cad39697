/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli detect -f jsonl: a line of JSON for each image, in their order, in one file or on standard output. */
#define _XOPEN_SOURCE 700
#include "files.h"
#include "program.h"

#include <asj/io.h>

#include <jansson.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

static char *scene; /* the bytes of scene.png */
static size_t scene_size;

static int make_files(void **state)
{
    (void)state;
    write_scene("scene.png");
    write_crossing("crossing.png");
    write_bytes("text.png", "This is not an image.\n", 22);
    write_bytes("caf\xe9 \"1\".png", "nor this", 8);
    scene = read_bytes("scene.png", &scene_size);
    return 0;
}

static int free_files(void **state)
{
    (void)state;
    free(scene);
    return 0;
}

static char *text_of(const char *path)
{
    size_t size;
    char *text = read_bytes(path, &size);
    assert_non_null(text);
    return text;
}

/* The next line as a value. */
static json_t *next_line(const char **at)
{
    const char *end = strchr(*at, '\n');
    json_t *line;
    assert_non_null(end);
    line = json_loadb(*at, (size_t)(end - *at), JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(line);
    *at = end + 1;
    return line;
}

/* The line of an image is the JSON file that it has with these options, without what repeats. */
static void expect_line(const char **at, const char *image, const char *option)
{
    json_t *line = next_line(at), *file;
    expect_code(run_cli("detect", "-q", "-o", "one.json", image, option, NULL), 0);
    file = json_load_file("one.json", 0, NULL);
    assert_int_equal(json_object_del(file, "options"), 0);
    assert_int_equal(json_object_del(file, "timing"), 0);
    assert_true(json_equal(line, file));
    assert_true(json_array_size(json_object_get(line, "junctions")) > 0);
    json_decref(line);
    json_decref(file);
}

static void expect_failure(const char **at, const char *image, const char *error)
{
    json_t *line = next_line(at), *name = json_object_get(json_object_get(line, "image"), "name");
    assert_int_equal(json_object_size(line), 3);
    assert_string_equal(json_string_value(json_object_get(line, "schema")), "asj-junctions-1");
    assert_string_equal(json_string_value(name), image);
    if (!strstr(json_string_value(json_object_get(line, "error")), error))
        fail_msg("not so: %s", json_string_value(json_object_get(line, "error")));
    json_decref(line);
}

static void three_images_of_which_one_fails(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "-o", "all.jsonl", "scene.png", "text.png", "crossing.png", NULL);
    expect_code(result, 1);
    expect_empty(result, "standard output", result->out);
    expect_in(result, result->err, "asj-cli: text.png: not an image");
    expect_in(result, result->err, "2 images done, 1 failed -> all.jsonl\n");
    char *text = text_of("all.jsonl");
    const char *at = text;
    expect_line(&at, "scene.png", NULL);
    expect_failure(&at, "text.png", "text.png: not an image: ");
    expect_line(&at, "crossing.png", NULL);
    assert_string_equal(at, "");
    free(text);
}

/* Names that are no UTF-8, folders, and an image that a mask does not fit, each with its cause; where all fail there is a file. */
static void every_failure_has_its_line(void **state)
{
    (void)state;
    expect_code(run_cli("detect", "-q", "-f", "jsonl", "-o", "bad", "missing.png", "caf\xe9 \"1\".png", ".", NULL), 1);
    char *text = text_of("bad");
    const char *at = text;
    expect_failure(&at, "missing.png", "missing.png: cannot open: No such file");
    expect_failure(&at, "caf? \"1\".png", "caf? \"1\".png: not an image");
    expect_failure(&at, ".", ".: is a directory; ");
    assert_string_equal(at, "");
    free(text);
    write_constant("mask.png", 9, 9);
    const outcome *result = run_cli("detect", "-q", "-f", "jsonl", "--mask", "mask.png", "scene.png", NULL);
    expect_code(result, 1);
    at = result->out;
    expect_failure(&at, "scene.png", "mask.png: this mask has another size than an image of 320 x 240 pixels");
    assert_string_equal(at, "");
}

/* Standard output is the default; names come from a file; lines and directions are as in JSON. */
static void standard_output_and_lists(void **state)
{
    static const char *const options[] = {"--lines", "--vanishing-points"};
    (void)state;
    write_bytes("list.txt", "crossing.png\nscene.png\n", 23);
    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++) {
        const outcome *result = run_cli("detect", "-q", "-f", "jsonl", options[i], "--files-from", "list.txt", NULL);
        expect_code(result, 0);
        char *text = strdup(result->out);
        const char *at = text;
        expect_line(&at, "crossing.png", options[i]);
        expect_line(&at, "scene.png", options[i]);
        assert_string_equal(at, "");
        free(text);
    }
    const outcome *result = run_cli("detect", "-q", "-f", "jsonl", "-o", "-", "scene.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->out, "{\"schema\":\"asj-junctions-1\",");
    assert_ptr_equal(strchr(result->out, '\n'), result->out + result->out_size - 1);
    expect_in(result, run_cli("detect", "-f", "jsonl", "scene.png", "crossing.png", NULL)->err, "\n2 images done\n");
}

/* A pipe that stands for an image: the program waits at it, having done the image before. Returns the end to write to. */
static int wait_at_pipe(const char *name)
{
    const int file = open(name, O_WRONLY); /* until the program reads */
    assert_true(file >= 0);
    return file;
}

static void feed_and_close(int file)
{
    assert_int_equal(write(file, scene, scene_size), (ssize_t)scene_size);
    close(file);
}

static void expect_old(void)
{
    char *text = text_of("whole/all.jsonl");
    assert_string_equal(text, "old");
    free(text);
}

static void a_line_is_there_before_the_next_image(void **state)
{
    static const char *const arguments[] = {"detect", "-q", "-f", "jsonl", "scene.png", "later.png", NULL};
    char byte = 0;
    int ends[2];
    (void)state;
    assert_int_equal(mkfifo("later.png", 0666), 0);
    assert_int_equal(pipe(ends), 0);
    const pid_t process = start_cli(ends[1], CAPTURED, arguments);
    close(ends[1]);
    const int file = wait_at_pipe("later.png");
    while (byte != '\n')
        assert_int_equal(read(ends[0], &byte, 1), 1);
    feed_and_close(file);
    expect_code(finish_cli(process), 0);
    assert_int_equal(read(ends[0], &byte, 1), 1);
    assert_int_equal(byte, '{');
    close(ends[0]);
    unlink("later.png");
}

/* What was there before stays until the last image is done, and where the run is interrupted for good. */
static void the_file_appears_whole_or_not_at_all(void **state)
{
    static const char *const arguments[] = {"detect", "-q", "-o", "whole/all.jsonl", "scene.png", "later.png", NULL};
    (void)state;
    assert_int_equal(mkdir("whole", 0777), 0);
    write_bytes("whole/all.jsonl", "old", 3);
    assert_int_equal(mkfifo("later.png", 0666), 0);
    for (int interrupted = 1; interrupted >= 0; interrupted--) {
        const pid_t process = start_cli(CAPTURED, CAPTURED, arguments);
        const int file = wait_at_pipe("later.png");
        expect_old();
        if (interrupted)
            kill(process, SIGINT);
        feed_and_close(file);
        expect_code(finish_cli(process), interrupted ? 130 : 0);
        if (interrupted)
            expect_old();
        assert_int_equal(count_files("whole"), 1);
    }
    unlink("later.png");
    char *text = text_of("whole/all.jsonl");
    const char *at = text;
    expect_line(&at, "scene.png", NULL);
    json_decref(next_line(&at));
    assert_string_equal(at, "");
    free(text);
}

/* Nobody reads, or there is no room: the run ends there. */
static void lines_that_cannot_be_written_end_the_run(void **state)
{
    int ends[2];
    (void)state;
    assert_int_equal(pipe(ends), 0);
    close(ends[0]);
    const outcome *result = run_cli_to(ends[1], "detect", "-f", "jsonl", "scene.png", "text.png", "crossing.png", NULL);
    close(ends[1]);
    expect_code(result, 1);
    expect_empty(result, "standard error", result->err);
    if (access("/dev/full", W_OK))
        return;
    result = run_cli("detect", "-f", "jsonl", "-o", "/dev/full", "text.png", "scene.png", "crossing.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: /dev/full: cannot write: No space left");
    assert_null(strstr(result->err, "scene.png")); /* the line of the first did not get there */
    result = run_cli("detect", "-f", "jsonl", "-o", "nowhere/all.jsonl", "scene.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "nowhere/all.jsonl: cannot create");
}

static const struct {
    const char *arguments[8];
    const char *message;
} refused[] = {
    {{"-f", "jsonl", "-d", "folder", "scene.png"}, "jsonl is one file of all images: --output FILE in place of --out-dir DIR\n"},
    {{"-o", "a.jsonl", "-p", "a.svg", "scene.png", "crossing.png"}, "the plots of 2 images need --out-dir DIR, and jsonl goes"},
    {{"-o", "a.jsonl", "--skip-existing", "scene.png"}, "--skip-existing changes nothing without --out-dir\n"},
    {{"-o", "a.jsonl", "--keep-folders", "scene.png"}, "--keep-folders changes nothing without --out-dir\n"},
    {{"-o", "a.json", "scene.png", "crossing.png"}, "2 images need --out-dir DIR for their results (or --format jsonl,"},
    {{"-f", "csv", "-o", "a.csv", "scene.png", "crossing.png"}, "2 images need --out-dir DIR"},
    {{"-f", "jsonl", "-o", "scene.png", "crossing.png", "scene.png"}, "scene.png: is an input file, and would be overwritten\n"},
    {{"-f", "jsonl", "-o", "a.svg", "-p", "./a.svg", "scene.png"}, "would be written twice, for "},
    {{"-f", "jsonl", "-p", "a.svg", "scene.png"}, "--format changes nothing: with --plot alone no junctions are written"},
    {{"-f", "jsonl"}, "which image?"},
};

static void no_file_takes_the_place_of_a_closed_stream(void **state)
{
    (void)state;
    static const char *const arguments[] = {"detect", "-o", "closed.jsonl", "scene.png", "crossing.png", NULL};
    static const char *const to_output[] = {"detect", "-f", "jsonl", "scene.png", NULL};
    for (int c = 0; c < 3; c++) {
        expect_code(finish_cli(start_cli(c == 1 ? CAPTURED : CLOSED, c == 0 ? CAPTURED : CLOSED, arguments)), 0);
        char *text = text_of("closed.jsonl");
        const char *at = text;
        for (int line = 0; line < 2; line++)
            json_decref(next_line(&at));
        assert_string_equal(at, ""); /* what the program says to people has gone nowhere */
        free(text);
    }
    const outcome *result = finish_cli(start_cli(CLOSED, CAPTURED, to_output));
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: standard output: ");
}

static void what_makes_no_sense_is_refused(void **state)
{
    const int files = count_files(".");
    (void)state;
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        const char *arguments[10] = {"detect"};
        memcpy(arguments + 1, refused[i].arguments, sizeof refused[i].arguments);
        if (without_cairo && strstr(refused[i].message, "twice"))
            continue;
        const outcome *result = run_cli_list(arguments);
        expect_code(result, 2);
        expect_in(result, result->err, refused[i].message);
        expect_empty(result, "standard output", result->out);
    }
    assert_int_equal(count_files("."), files);
}

/* One image may have a plot beside its line. Where that fails, the line has been written, and no other comes. */
static void a_plot_beside_one_line(void **state)
{
    (void)state;
    if (without_cairo)
        skip();
    expect_code(run_cli("detect", "-q", "-o", "one.jsonl", "-p", "one.svg", "scene.png", NULL), 0);
    assert_true(exists("one.jsonl") && exists("one.svg"));
    if (access("/dev/full", W_OK))
        return;
    assert_int_equal(symlink("/dev/full", "full.svg"), 0);
    const outcome *result = run_cli("detect", "-q", "-f", "jsonl", "-o", "-", "-p", "full.svg", "scene.png", NULL);
    expect_code(result, 1);
    assert_ptr_equal(strchr(result->out, '\n'), result->out + result->out_size - 1);
    assert_null(strstr(result->out, "\"error\""));
    unlink("full.svg");
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_images_of_which_one_fails),
        cmocka_unit_test(every_failure_has_its_line),
        cmocka_unit_test(standard_output_and_lists),
        cmocka_unit_test(a_line_is_there_before_the_next_image),
        cmocka_unit_test(the_file_appears_whole_or_not_at_all),
        cmocka_unit_test(lines_that_cannot_be_written_end_the_run),
        cmocka_unit_test(no_file_takes_the_place_of_a_closed_stream),
        cmocka_unit_test(what_makes_no_sense_is_refused),
        cmocka_unit_test(a_plot_beside_one_line),
    };
    program_start(argc, argv);
    return program_end(cmocka_run_group_tests(tests, make_files, free_files));
}
