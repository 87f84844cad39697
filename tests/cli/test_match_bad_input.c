/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli match with wrong usage and with files that are no good: one line that names file, line and cause, and nothing written. */
#define _POSIX_C_SOURCE 200809L
#include "files.h"
#include "program.h"

#include <asj/match.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static int count_lines(const char *text)
{
    int lines = 0;
    for (; *text; text++)
        lines += *text == '\n';
    return lines;
}

static void help_names_every_option_of_the_library(void **state)
{
    (void)state;
    const outcome *result = run_cli("match", "--help", "--advanced", NULL);
    expect_code(result, 0);
    expect_empty(result, "standard error", result->err);
    assert_true(asj_match_option_count() > 0);
    for (size_t i = 0; i < asj_detect_option_count() + asj_match_option_count(); i++) {
        size_t m = i - asj_detect_option_count();
        char name[80];
        snprintf(name, sizeof name, "--%s ", i < asj_detect_option_count() ? asj_detect_option(i)->key : asj_match_option(m)->key);
        for (char *c = name; *c; c++)
            if (*c == '_')
                *c = '-';
        expect_in(result, result->out, name);
    }
    expect_in(result, result->out, " --match-max-move ");
    expect_in(result, result->out, " --match-minimum-opening ");
    assert_null(strstr(result->out, "--match-ratio"));
}

/* Each line of arguments, and what standard error must contain. */
static const struct {
    const char *arguments[12];
    const char *message;
} wrong[] = {
    {{"match"}, "which images?"},
    {{"match", "first.png"}, "two images, not 1"},
    {{"match", "first.png", "first.png", "first.png"}, "two images, not 3"},
    {{"match", "first.png", "-"}, "standard input"},
    {{"match", "--junctions1", "-", "first.png", "first.png"}, "standard input"},
    {{"match", "--no-such", "first.png", "first.png"}, "no option '--no-such'"},
    {{"match", "--out-dir", ".", "first.png", "first.png"}, "no option '--out-dir': it is one of asj-cli detect\n"},
    {{"match", "--line", "first.png", "first.png"}, "'--line' could be --lines or --line-ends\n"},
    {{"match", "--camera=1,1,0,0", "first.png", "first.png"}, "'--camera=1,1,0,0' could be --camera1 or --camera2\n"},
    {{"match", "--ratio", "one", "first.png", "first.png"}, "--ratio: 'one' is not a number"},
    {{"match", "--ratio", "0.5", "first.png", "first.png"}, "--ratio: 0.5 is outside"},
    {{"match", "--geometry", "affine", "first.png", "first.png"}, "--geometry: 'affine' is not auto"},
    {{"match", "--geometry", "essential", "first.png", "first.png"}, "--geometry essential needs --camera1 and --camera2"},
    {{"match", "--focal", "600", "first.png", "first.png"}, "a camera or a focal length changes nothing without --geometry"},
    {{"match", "-p", "x.png", "--plot-epipolar", "yes", "first.png", "first.png"}, "--plot-epipolar changes nothing without"},
    {{"match", "--geometry", "auto", "--focal", "0", "first.png", "first.png"}, "--focal: '0' is not a length"},
    {{"match", "--geometry", "homography", "--focal", "estimate", "first.png", "first.png"}, "changes nothing with this geometry"},
    {{"match", "--geometry", "auto", "--focal", "estimate", "--camera1", "600,600,320,240", "first.png", "first.png"},
     "--camera1 gives it"},
    {{"match", "--focal-sd", "0.05", "first.png", "first.png"}, "--focal-sd changes nothing without --geometry auto or essential"},
    {{"match", "--geometry", "homography", "--focal-sd", "0.05", "first.png", "first.png"}, "--focal-sd changes nothing"},
    {{"match", "--geometry", "auto", "--focal", "estimate", "--focal-sd", "0.05", "first.png", "first.png"},
     "--focal-sd changes nothing with --focal estimate, which takes none as known\n"},
    {{"match", "--geometry", "auto", "--focal", "600", "--focal-sd", "0.3", "first.png", "first.png"}, "--focal-sd: '0.3' is not"},
    {{"match", "--geometry", "auto", "--focal", "600", "--focal-sd", "nan", "first.png", "first.png"}, "--focal-sd: 'nan' is not"},
    {{"match", "--geometry", "auto", "--focal", "nan", "first.png", "first.png"}, "--focal: 'nan' is not a length"},
    {{"match", "--geometry", "auto", "--camera1", "600,600,320,240", "first.png", "first.png"}, "--camera2 is missing"},
    {{"match", "--geometry", "auto", "--camera1", "600,600,320", "first.png", "first.png"}, "is not FX,FY,CX,CY"},
    {{"match", "--geometry", "auto", "--camera2", "-600,600,320,240", "first.png", "first.png"}, "is not FX,FY,CX,CY"},
    {{"match", "--geometry", "auto", "--camera2", "600,600,320,240,1", "first.png", "first.png"}, "is not FX,FY,CX,CY"},
    {{"match", "--epsilon", "-1", "first.png", "first.png"}, "--epsilon: -1 is outside"},
    {{"match", "--match-max-move", "21", "first.png", "first.png"}, "asj-cli match: --match-max-move: 21 is outside 0.5 .. 20"},
    {{"match", "--max-move", "21", "first.png", "first.png"}, "asj-cli match: --max-move: 21 is outside 0.5 .. 10"},
    {{"match", "--match-ratio", "2", "first.png", "first.png"}, "no option '--match-ratio'"},
    {{"match", "--patch-size", "18", "first.png", "first.png"}, "--patch-size: 18"},
    {{"match", "--descriptor", "orb", "first.png", "first.png"}, "--descriptor: 'orb'"},
    {{"match", "--preset", "best", "first.png", "first.png"}, "--preset: 'best'"},
    {{"match", "--match-preset", "best", "first.png", "first.png"}, "--match-preset: 'best'"},
    {{"match", "--detect-preset", "best", "first.png", "first.png"}, "--detect-preset: 'best'"},
    {{"match", "--format", "asj", "first.png", "first.png"}, "--format: 'asj'"},
    {{"match", "--line-ends", "all", "first.png", "first.png"}, "--line-ends: 'all'"},
    {{"match", "--line-ends", "cut", "first.png", "first.png"}, "--line-ends changes nothing without --lines"},
    {{"match", "--join-lines", "first.png", "first.png"}, "--join-lines changes nothing without --lines"},
    {{"match", "--plot-layout", "below", "first.png", "first.png"}, "--plot-layout changes nothing without --plot"},
    {{"match", "--plot-lines", "no", "first.png", "first.png"}, "--plot-lines changes nothing without --plot"},
    {{"match", "--plot", "picture.jpg", "first.png", "first.png"}, "--plot"},
    {{"match", "--plot-layout", "left", "first.png", "first.png"}, "--plot-layout: 'left'"},
    {{"match", "--plot-lines", "red", "first.png", "first.png"}, "--plot-lines: 'red'"},
    {{"match", "--plot-background", "red", "first.png", "first.png"}, "--plot-background: 'red'"},
    {{"match", "--plot-scale", "0", "first.png", "first.png"}, "--plot-scale: '0'"},
    {{"match", "-f", "csv", "-o", "./first.png", "first.png", "second.png"}, "first.png: is an input file"},
    {{"match", "--junctions1", "good.asj", "-f", "csv", "-o", "good.asj", "first.png", "second.png"}, "good.asj: is an input file"},
    {{"match", "-o", "new.asj", "first.png", "second.png"}, "new.asj: matches are written as csv or json"},
    {{"match", "-o", "new.png", "first.png", "second.png"}, "(a picture: --plot)"},
    {{"match", "--junctions1", "good.asj", "--junctions2", "good.asj", "--epsilon", "2", "first.png", "second.png"},
     "epsilon changes nothing"},
    {{"match", "--junctions1", "good.asj", "--junctions2", "good.asj", "--detect-preset", "paper", "first.png", "second.png"},
     "--detect-preset changes nothing"},
};

static void wrong_usage_ends_with_2_and_says_why(void **state)
{
    (void)state;
    int files = count_files(".");
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const outcome *result = run_cli_list(wrong[i].arguments);
        if (result->code != 2)
            print_error("in case %zu, %s\n", i, wrong[i].message);
        expect_code(result, 2);
        expect_in(result, result->err, wrong[i].message);
        expect_in(result, result->err, "--help");
        expect_empty(result, "standard output", result->out);
    }
    assert_int_equal(count_files("."), files);
}

/* One line on standard error that begins like this, no output, no file. */
static void expect_refusal(const outcome *result, const char *beginning, const char *cause)
{
    expect_code(result, 1);
    expect_empty(result, "standard output", result->out);
    expect_in(result, result->err, cause);
    if (count_lines(result->err) != 1 || strncmp(result->err, beginning, strlen(beginning)) != 0)
        fail_msg("not one line that begins with '%s':\n%s", beginning, result->err);
    assert_false(exists("never.csv"));
}

/* Text of a junction file, and the line and cause that must be named. The images have 320 x 240 pixels. */
static const struct {
    const char *text, *line, *cause;
} bad[] = {
    {"", "", "empty"},
    {"junctions\n", "line 1: ", ""},
    {"1\n", "line 1: ", "x y"},
    {"2\n50 50\n2 7 7 -3\n0 5 30\n1.5 5 30\n", "line 5: ", "ends"},
    {"0\n50 50\n", "line 2: ", "after the last"},
    {"1\n50 50\n1 7 7 -3\n0 5 30\n", "line 3: ", "number of branches"},
    {"1\n50 50\n6 7 7 -3\n0 5 30\n", "line 3: ", "number of branches"},
    {"1\n50 50\n3 7 7 -3\n0 5 30\n1.5 5 30\n", "line 5: ", "ends"},
    {"1\n50 nan\n2 7 7 -3\n0 5 30\n1.5 5 30\n", "line 2: ", "nan"},
    {"1\n50 inf\n2 7 7 -3\n0 5 30\n1.5 5 30\n", "line 2: ", "inf"},
    {"1\n50 50\n2 7 7 -3\nnan 5 30\n1.5 5 30\n", "line 4: ", "nan"},
    {"1\n50 50\n2 7 7 -3\n0 5 30\n1.5 5 -30\n", "line 5: ", "negative length"},
    {"1\n50 50\n2 -7 7 -3\n0 5 30\n1.5 5 30\n", "line 3: ", "negative scale"},
    {"2\n50 50\n2 7 7 -3\n0 5 30\n1.5 5 30\n331 50\n2 7 7 -3\n0 5 30\n1.5 5 30\n", "line 6: ", "outside first.png"},
    {"1\n50 -11\n2 7 7 -3\n0 5 30\n1.5 5 30\n", "line 2: ", "outside first.png"},
};

static void bad_junction_files_are_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char beginning[64];
        write_bytes("bad.asj", bad[i].text, strlen(bad[i].text));
        snprintf(beginning, sizeof beginning, "asj-cli: bad.asj: %s", bad[i].line);
        expect_refusal(run_cli("match", "-o", "never.csv", "--junctions1", "bad.asj", "first.png", "second.png", NULL),
                       beginning, bad[i].cause);
        if (!strstr(bad[i].cause, "outside"))
            expect_refusal(run_cli("match", "-o", "never.csv", "--junctions2", "bad.asj", "first.png", "second.png", NULL),
                           beginning, bad[i].cause);
    }
}

/* Where branches meet may lie a little outside. */
static void junctions_beside_the_image_are_taken(void **state)
{
    (void)state;
    static const char text[] = "1\n328 -9\n2 7 7 -3\n1.6 5 30\n3 5 30\n";
    write_bytes("beside.asj", text, strlen(text));
    expect_code(run_cli("match", "-q", "--junctions1", "beside.asj", "first.png", "second.png", NULL), 0);
}

static void junctions_of_another_image_are_refused(void **state)
{
    (void)state;
    write_constant("small.png", 60, 40);
    expect_code(run_cli("detect", "-q", "-o", "small.json", "small.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "-o", "large.json", "first.png", NULL), 0);
    expect_refusal(run_cli("match", "-o", "never.csv", "--junctions1", "small.json", "first.png", "second.png", NULL),
                   "asj-cli: small.json: ", "60 x 40");
    write_constant("higher.png", 60, 50);
    write_constant("wider.png", 70, 40);
    expect_refusal(run_cli("match", "-o", "never.csv", "--junctions1", "small.json", "higher.png", "second.png", NULL),
                   "asj-cli: small.json: ", "60 x 40");
    expect_refusal(run_cli("match", "-o", "never.csv", "--junctions1", "small.json", "wider.png", "second.png", NULL),
                   "asj-cli: small.json: ", "60 x 40");
    expect_refusal(run_cli("match", "-o", "never.csv", "--junctions1", "large.json", "small.png", "second.png", NULL),
                   "asj-cli: large.json: line ", "outside small.png");
}

static void swapped_junctions_are_doubted(void **state)
{
    (void)state;
    static const char *const cases[][4] = { /* of image 1, of image 2, image 1, image 2 */
        {"b.json", "a.json", "first.png", "second.png"},
        {"a.json", "a.json", "first.png", "second.png"},
        {"a.json", "b.json", "first.png", "second.png"},
        {"a.json", "c.json", "first.png", "fo\"l\\der/first.png"},
        {"c.json", "a.json", "first.png", "fo\"l\\der/first.png"},
        {"a.json", "a.json", "./first.png", "first.png"},
        {"b.json", "good.asj", "other/first.png", "other/second.png"},
    };
    static const int warned[][2] = {{1, 1}, {0, 1}, {0, 0}, {0, 0}, {1, 1}, {0, 0}, {1, 0}};
    mkdir("fo\"l\\der", 0777);
    mkdir("other", 0777);
    write_views("fo\"l\\der/first.png", "fo\"l\\der/second.png");
    write_views("other/first.png", "other/second.png");
    expect_code(run_cli("detect", "-q", "-o", "a.json", "first.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "-o", "b.json", "second.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "-o", "c.json", "fo\"l\\der/first.png", NULL), 0);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const outcome *result = run_cli("match", "--junctions1", cases[i][0], "--junctions2", cases[i][1], cases[i][2], cases[i][3],
                                        NULL);
        expect_code(result, 0);
        if (i == 0)
            expect_in(result, result->err, "warning: --junctions1: b.json has the junctions of second.png, which is IMAGE2: are "
                                           "they swapped?\n");
        assert_int_equal(strstr(result->err, "--junctions1: ") != NULL, warned[i][0]);
        assert_int_equal(strstr(result->err, "--junctions2: ") != NULL, warned[i][1]);
    }
}

static void cameras_of_other_images_are_refused(void **state)
{
    (void)state;
    expect_refusal(run_cli("match", "-o", "never.csv", "--geometry", "auto", "--camera1", "300,300,160,120", "--camera2",
                           "160,120,300,300", "first.png", "second.png", NULL),
                   "asj-cli: second.png: --camera2: the principal point is outside of the image; FX,FY,CX,CY: is this "
                   "CX,CY,FX,FY?", "image 320 x 240)\n");
    const outcome *result = run_cli("match", "--stretch", "1", "--geometry", "auto", "--camera1", "300,300,79,60", "--camera2",
                                    "300,300,160,120", "first.png", "second.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "asj-cli match: warning: first.png: --camera1: the principal point is far from the middle");
    assert_null(strstr(result->err, "--camera2"));
}

static void bad_images_are_refused(void **state)
{
    (void)state;
    size_t size = 0;
    free(read_bytes("first.png", &size));
    write_bytes("text.png", "This is not an image.\n", 22);
    write_part("cut.png", "first.png", size / 2);
    write_png_header("bomb.png", 65000, 65000);
    static const char *const images[] = {"missing.png", "text.png", "cut.png", "bomb.png", "."};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++) {
        char beginning[64];
        snprintf(beginning, sizeof beginning, "asj-cli: %s: ", images[i]);
        expect_refusal(run_cli("match", "-o", "never.csv", images[i], "second.png", NULL), beginning, "");
        expect_refusal(run_cli("match", "-o", "never.csv", "first.png", images[i], NULL), beginning, "");
    }
    const outcome *result = run_cli("match", "-o", "never.csv", "missing.png", "text.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: missing.png: ");
    expect_in(result, result->err, "asj-cli: text.png: ");
    expect_refusal(run_cli("match", "--junctions2", "missing.asj", "first.png", "second.png", NULL), "asj-cli: missing.asj: ", "");
}

/* match with a pipe that has what a file has: `match <(cat file) second.png`. */
static const outcome *run_with_pipe(const char *path)
{
    size_t size = 0;
    char *bytes = read_bytes(path, &size);
    assert_non_null(bytes);
    assert_int_equal(mkfifo("pipe.asjf", 0666), 0);
    const pid_t writer = fork();
    assert_true(writer >= 0);
    if (writer == 0) {
        const int file = open("pipe.asjf", O_WRONLY);
        _exit(write(file, bytes, size) < 0); /* the reader need not want all of it: what comes of that does not count */
    }
    const outcome *result = run_cli("match", "-o", "never.csv", "pipe.asjf", "second.png", NULL);
    waitpid(writer, NULL, 0);
    unlink("pipe.asjf");
    free(bytes);
    return result;
}

static void bad_features_are_refused(void **state)
{
    (void)state;
    size_t size = 0;
    expect_code(run_cli("detect", "-q", "-o", "good.asjf", "first.png", NULL), 0);
    free(read_bytes("good.asjf", &size));
    assert_true(size > 1000);
    write_part("cut.asjf", "good.asjf", size - 1);
    write_part("head.asjf", "good.asjf", 20);
    write_damaged("damaged.asjf", "good.asjf", size / 2);
    write_damaged("later.asjf", "good.asjf", 8);
    static const char *const files[][2] = {{"cut.asjf", "where there should be"}, {"head.asjf", "truncated"},
                                           {"damaged.asjf", "checksum"}, {"later.asjf", "version"}};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char beginning[64];
        snprintf(beginning, sizeof beginning, "asj-cli: %s: ", files[i][0]);
        expect_refusal(run_cli("match", "-o", "never.csv", files[i][0], "second.png", NULL), beginning, files[i][1]);
        expect_refusal(run_cli("match", "-o", "never.csv", "good.asjf", files[i][0], NULL), beginning, files[i][1]);
    }
    expect_refusal(run_cli("match", "-o", "never.csv", "--descriptor", "sift", "good.asjf", "second.png", NULL),
                   "asj-cli: good.asjf, second.png: ", "the features of image 1 were made with descriptor raw, not sift");
    expect_refusal(run_cli("detect", "-o", "never.json", "good.asjf", NULL), "asj-cli: good.asjf: ", "a file of features");
    expect_refusal(run_with_pipe("good.asjf"), "asj-cli: pipe.asjf: ", "takes them from a file");
    const outcome *result = run_cli("match", "-o", "never.csv", "--junctions1", "good.asj", "good.asjf", "second.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--junctions1 good.asj changes nothing: good.asjf is a file of features");
    static const char *const useless[][3] = {{"--mask1", "nowhere.png", "--mask1 changes nothing: the junctions of that image"},
                                             {"--region2", "0,0,5,5", "--region2 changes nothing: the junctions of that image"},
                                             {"--epsilon", "5", "--epsilon changes nothing: the junctions of both images"},
                                             {"--detect-preset", "paper", "--detect-preset changes nothing"}};
    for (size_t i = 0; i < sizeof useless / sizeof useless[0]; i++) {
        result = run_cli("match", "-o", "never.csv", useless[i][0], useless[i][1], "good.asjf", "good.asjf", NULL);
        expect_code(result, 2);
        expect_in(result, result->err, useless[i][2]);
    }
}

static void results_that_cannot_be_written_are_errors(void **state)
{
    (void)state;
    expect_refusal(run_cli("match", "-o", "nowhere/m.csv", "first.png", "second.png", NULL), "asj-cli: nowhere/m.csv: ", "");
    size_t size = 0;
    write_bytes("kept.csv", "old", 3);
    expect_code(run_cli("match", "-o", "kept.csv", "missing.png", "second.png", NULL), 1);
    char *bytes = read_bytes("kept.csv", &size);
    assert_non_null(bytes);
    assert_string_equal(bytes, "old");
    free(bytes);
}

static int make_files(void **state)
{
    (void)state;
    write_views("first.png", "second.png");
    write_bytes("good.asj", "0\n", 2);
    return 0;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_names_every_option_of_the_library),
        cmocka_unit_test(wrong_usage_ends_with_2_and_says_why),
        cmocka_unit_test(bad_junction_files_are_refused),
        cmocka_unit_test(junctions_beside_the_image_are_taken),
        cmocka_unit_test(junctions_of_another_image_are_refused),
        cmocka_unit_test(swapped_junctions_are_doubted),
        cmocka_unit_test(cameras_of_other_images_are_refused),
        cmocka_unit_test(bad_images_are_refused),
        cmocka_unit_test(bad_features_are_refused),
        cmocka_unit_test(results_that_cannot_be_written_are_errors),
    };
    program_start(argc, argv);
    return program_end(cmocka_run_group_tests(tests, make_files, NULL));
}
