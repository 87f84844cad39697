/* SPDX-License-Identifier: BSD-2-Clause */
/* Which files asj-cli writes, and which it had better not. */
#define _XOPEN_SOURCE 700
#include "files.h"
#include "program.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static int make_files(void **state)
{
    (void)state;
    write_scene("scene.png");
    write_views("first.png", "second.png");
    return 0;
}

/* A process that python or nohup has started may have the signal ignored: the program has to cope with the default. */
static void a_limit_of_file_size_is_an_error(void **state)
{
    struct rlimit before, small;
    const int files = count_files(".");
    (void)state;
    signal(SIGXFSZ, SIG_DFL);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 1024;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const outcome *result = run_cli("detect", "-f", "json", "-o", "large.json", "scene.png", NULL);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    expect_code(result, 1);
    expect_in(result, result->err, "large.json");
    assert_int_equal(count_files("."), files);
}

/* An output without an ending is a link to what the plot is called, in several spellings; nothing of that exists before. */
static void two_spellings_of_one_output(void **state)
{
    static const char *const plots[] = {"both.svg", "./both.svg", "folder/../both.svg", "folder/link.svg", NULL};
    char absolute[4096];
    (void)state;
    mkdir("folder", 0777);
    assert_int_equal(symlink("both.svg", "same"), 0);
    assert_int_equal(symlink("../both.svg", "folder/link.svg"), 0);
    for (size_t i = 0; plots[i] && !without_cairo; i++) {
        const outcome *result = run_cli("detect", "-o", "same", "--plot", plots[i], "scene.png", NULL);
        expect_code(result, 2);
        expect_in(result, result->err, "written twice");
        assert_false(exists("both.svg"));
    }
    const outcome *twice = run_cli("detect", "--out-dir", "unmade", "scene.png", "./scene.png", NULL);
    expect_code(twice, 2);
    expect_in(twice, twice->err, "written twice");
    assert_false(exists("unmade"));
    assert_non_null(getcwd(absolute, sizeof absolute - 16));
    strcat(absolute, "/both.svg");
    expect_code(run_cli("match", "-o", "same", "--plot", absolute, "first.png", "second.png", NULL), 2);
    assert_false(exists("both.svg"));
    unlink("same");
    unlink("folder/link.svg");
    rmdir("folder");
}

/* Images of one name in several folders: each result below the folders of its path, but for the root, . and .. */
static void folders_of_images_are_kept(void **state)
{
    static const char *const wanted[] = {"scene", "kitchen/scene", "kitchen/kitchen/wall/scene"};
    char absolute[4000], path[4096];
    (void)state;
    mkdir("kitchen", 0777);
    mkdir("kitchen/wall", 0777);
    assert_int_equal(link("scene.png", "kitchen/scene.png"), 0);
    assert_int_equal(link("scene.png", "kitchen/wall/scene.png"), 0);
    assert_non_null(getcwd(absolute, sizeof absolute - 16));
    strcat(absolute, "/scene");
    snprintf(path, sizeof path, "%s.png", absolute);
    expect_code(run_cli("detect", "-q", "--keep-folders", "--out-dir", "kept/results", "scene.png", ".//kitchen/scene.png",
                        "kitchen/../kitchen/wall/scene.png", path, NULL), 0);
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        snprintf(path, sizeof path, "kept/results/%s.asj", wanted[i]);
        assert_true(exists(path));
    }
    snprintf(path, sizeof path, "kept/results%s.asj", absolute);
    assert_true(exists(path));
    const outcome *result = run_cli("detect", "--keep-folders", "--out-dir", "more", "scene.png", "./scene.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "written twice, for scene.png and for ./scene.png\n");
    result = run_cli("detect", "--out-dir", "more", "scene.png", "kitchen/scene.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "(--keep-folders tells folders apart)\n");
    result = run_cli("detect", "--out-dir", "more", "kitchen/scene.png", "kitchen/.//scene.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "for kitchen/.//scene.png\n"); /* it would not help */
    assert_false(exists("more"));
}

static void a_link_to_nothing_yet_is_followed(void **state)
{
    struct stat facts;
    (void)state;
    mkdir("folder", 0777);
    assert_int_equal(symlink("target.asj", "folder/second.asj"), 0);
    assert_int_equal(symlink("folder/second.asj", "first.asj"), 0);
    expect_code(run_cli("detect", "-q", "-o", "first.asj", "scene.png", NULL), 0);
    assert_int_equal(lstat("first.asj", &facts), 0);
    assert_true(S_ISLNK(facts.st_mode));
    assert_int_equal(lstat("folder/target.asj", &facts), 0);
    assert_true(S_ISREG(facts.st_mode));
    assert_int_equal(symlink("loop.asj", "loop.asj"), 0);
    expect_code(run_cli("detect", "-q", "-o", "loop.asj", "scene.png", NULL), 1);
    unlink("folder/target.asj");
    unlink("folder/second.asj");
    rmdir("folder");
}

static void names_that_promise_another_format(void **state)
{
    static const char *const bad[] = {"result.png", "result.PNG", "result.db", "result.svg", "result.what", NULL};
    (void)state;
    for (size_t i = 0; bad[i]; i++) {
        expect_code(run_cli("detect", "-o", bad[i], "scene.png", NULL), 2);
        const outcome *result = run_cli("match", "-o", bad[i], "first.png", "second.png", NULL);
        expect_code(result, 2);
        expect_in(result, result->err, "are written as");
        assert_false(exists(bad[i]));
    }
    expect_code(run_cli("match", "-o", "result.asj", "first.png", "second.png", NULL), 2);
    expect_code(run_cli("detect", "-q", "-f", "json", "-o", "result.what", "scene.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "-o", "result.txt", "scene.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "-o", "result", "scene.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "-o", "/dev/null", "scene.png", NULL), 0);
}

/* What a name does not say, or says wrongly, is told. */
static void other_formats_than_names_tell(void **state)
{
    static const struct {
        const char *command, *name, *format, *warning; /* NULL: none */
    } cases[] = {
        {"detect", "e.json", "csv", "asj-cli detect: warning: e.json is written as csv, whatever its name ends in\n"},
        {"detect", "e.png", "json", "e.png is written as json"}, {"match", "e.asj", "json", "e.asj is written as json"},
        {"detect", "e.txt", NULL, "e.txt is written as asj: --format asks for others\n"},
        {"match", "e.txt", NULL, "asj-cli match: warning: e.txt is written as csv"}, {"match", "e.txt", "csv", NULL},
        {"detect", "e.JSON", "json", NULL}, {"detect", "e.json", NULL, NULL}, {"match", "e", NULL, NULL},
        {"detect", "e.what", "csv", NULL}, {"match", "/dev/null", "json", NULL},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *arguments[] = {cases[i].command, "-o", cases[i].name, "scene.png", "scene.png", "-f", cases[i].format, NULL};
        if (*cases[i].command == 'd')
            arguments[4] = "--threads=1";
        if (!cases[i].format)
            arguments[5] = NULL;
        const outcome *result = run_cli_list(arguments);
        expect_code(result, 0);
        if (cases[i].warning)
            expect_in(result, result->err, cases[i].warning);
        else
            assert_null(strstr(result->err, "warning"));
    }
}

static void expect_beginning(const char *path, const char *beginning)
{
    char text[16] = "";
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fread(text, 1, strlen(beginning), file), strlen(beginning));
    fclose(file);
    assert_string_equal(text, beginning);
}

/* An ending counts in capitals, too: the check and the choice agree. */
static void endings_in_capitals(void **state)
{
    (void)state;
    expect_code(run_cli("detect", "-q", "-o", "r.JSON", "scene.png", NULL), 0);
    expect_beginning("r.JSON", "{");
    expect_code(run_cli("detect", "-q", "-o", "r.Csv", "scene.png", NULL), 0);
    expect_beginning("r.Csv", "junction,x,y,");
    expect_code(run_cli("match", "-q", "-o", "m.JSON", "first.png", "second.png", NULL), 0);
    expect_beginning("m.JSON", "{");
}

static void more_images_from_a_file(void **state)
{
    (void)state;
    write_bytes("list.txt", "scene.png\r\n\nfirst.png\n./second.png", 34);
    const outcome *result = run_cli("detect", "-d", "listed", "--files-from", "list.txt", NULL);
    expect_code(result, 0);
    assert_true(exists("listed/scene.asj") && exists("listed/first.asj") && exists("listed/second.asj"));
    assert_int_equal(count_files("listed"), 3);
    /* names with line breaks, as find -print0 writes them, after those of the command line */
    assert_int_equal(link("first.png", "two\nlines.png"), 0);
    write_bytes("list.zero", "two\nlines.png\0second.png", 24);
    expect_code(run_cli("detect", "-q", "-d", "zero", "--files-from", "list.zero", "scene.png", NULL), 0);
    assert_true(exists("zero/scene.asj") && exists("zero/two\nlines.asj") && exists("zero/second.asj"));
    unlink("two\nlines.png");
    /* no comments */
    assert_int_equal(link("first.png", "# first.png"), 0);
    write_bytes("list.hash", "# first.png\n", 12);
    expect_code(run_cli("detect", "-q", "-d", "hash", "--files-from", "list.hash", NULL), 0);
    assert_true(exists("hash/# first.asj"));
    write_bytes("list.mark", "\xef\xbb\xbf" "first.png\r\n", 14);
    expect_code(run_cli("detect", "-q", "-d", "mark", "--files-from", "list.mark", NULL), 0);
    assert_true(exists("mark/first.asj"));
    /* what is there is left alone, and said */
    unlink("listed/first.asj");
    write_bytes("listed/scene.asj", "mine", 4);
    result = run_cli("detect", "-d", "listed", "--skip-existing", "--files-from", "list.txt", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "2 of 3 images had their results in listed already");
    expect_beginning("listed/scene.asj", "mine");
    assert_true(exists("listed/first.asj"));
    write_bytes("list.none", "\n\r\n", 3);
    result = run_cli("detect", "-d", "listed", "--files-from", "list.none", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "list.none names no image");
    result = run_cli("detect", "-d", "listed", "--files-from", "nowhere.txt", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "nowhere.txt: No such file");
    result = run_cli("detect", "--skip-existing", "scene.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "changes nothing without --out-dir");
    expect_code(run_cli("detect", "-d", "listed", "--files-from", ".", NULL), 1);
    result = run_cli("detect", "-d", "listed", "--files-from", "/dev/zero", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "/dev/zero: not a list of names: 65536 bytes without one");
}

/* Names as long as may be, and a list longer than what is read at once. */
static void long_lists_and_names(void **state)
{
    enum { SIZE = 200000, NAME = 65535 };
    char *list = malloc(SIZE);
    (void)state;
    assert_non_null(list);
    memset(list, '\n', SIZE);
    for (int i = 0; i + 2 < SIZE; i += 100)
        list[i] = 'x';
    write_bytes("list.long", list, SIZE);
    const outcome *result = run_cli("detect", "-d", "listed", "--files-from", "list.long", NULL);
    expect_in(result, result->err, "x.asj"); /* two thousand times the same name */
    memset(list, 'x', SIZE);
    list[NAME] = '\n';
    write_bytes("list.long", list, NAME + 1);
    expect_in(result, run_cli("detect", "-d", "listed", "--files-from", "list.long", NULL)->err, "File name too long");
    write_bytes("list.long", list + NAME + 1, NAME + 1);
    expect_in(result, run_cli("detect", "-d", "listed", "--files-from", "list.long", NULL)->err, "not a list of names");
    free(list);
}

/* Nothing takes the place of the list itself, in whatever spelling. */
static void a_list_of_images_is_not_overwritten(void **state)
{
    (void)state;
    mkdir("lists", 0777);
    write_bytes("lists/scene.csv", "scene.png\n", 10);
    const outcome *result = run_cli("detect", "--files-from", "lists/scene.csv", "-o", "./lists/scene.csv", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "lists/scene.csv: is an input file, and would be overwritten");
    expect_code(run_cli("detect", "-f", "csv", "--files-from", "lists/scene.csv", "-d", "lists", NULL), 2);
    expect_beginning("lists/scene.csv", "scene.png\n");
    expect_code(run_cli("detect", "-q", "-f", "json", "--files-from", "lists/scene.csv", "-d", "lists", NULL), 0);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_limit_of_file_size_is_an_error), cmocka_unit_test(two_spellings_of_one_output),
        cmocka_unit_test(folders_of_images_are_kept),
        cmocka_unit_test(a_link_to_nothing_yet_is_followed), cmocka_unit_test(names_that_promise_another_format),
        cmocka_unit_test(other_formats_than_names_tell),
        cmocka_unit_test(endings_in_capitals), cmocka_unit_test(more_images_from_a_file),
        cmocka_unit_test(long_lists_and_names),
        cmocka_unit_test(a_list_of_images_is_not_overwritten),
    };
    program_start(argc, argv);
    return program_end(cmocka_run_group_tests(tests, make_files, NULL));
}
