/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of asj-cli: help, version, wrong usage. */
#include "files.h"
#include "program.h"

#include <asj/options.h>
#include <asj/version.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void general_help_and_version(void **state)
{
    (void)state;
    const outcome *result = run_cli("--help", NULL);
    expect_code(result, 0);
    expect_in(result, result->out, "asj-cli detect");
    expect_empty(result, "standard error", result->err);
    result = run_cli("--version", NULL);
    expect_code(result, 0);
    expect_in(result, result->out, asj_version_string());
}

/* The advanced options are shown or not. */
static void expect_help(const outcome *result, int advanced)
{
    size_t shown = 0;
    expect_code(result, 0);
    expect_empty(result, "standard error", result->err);
    assert_true(asj_detect_option_count() > 0);
    for (size_t i = 0; i < asj_detect_option_count(); i++) {
        const asj_option_info *row = asj_detect_option(i);
        char name[80];
        snprintf(name, sizeof name, "--%s ", row->key);
        for (char *c = name; *c; c++)
            if (*c == '_')
                *c = '-';
        if (advanced || !row->advanced)
            expect_in(result, result->out, name);
        else
            assert_null(strstr(result->out, name));
        shown += advanced || !row->advanced;
    }
    assert_true(advanced ? shown == asj_detect_option_count() : shown >= 5 && shown <= 12);
}

static void help_names_the_options_of_the_library(void **state)
{
    (void)state;
    expect_help(run_cli("detect", "--help", NULL), 0);
    const outcome *result = run_cli("detect", "--help", NULL);
    expect_in(result, result->out, "options more with --help --advanced");
    expect_help(run_cli("detect", "--help", "--advanced", NULL), 1);
    expect_help(run_cli("detect", "--advanced", "-h", NULL), 1);
    expect_help(run_cli("detect", "--help", "--ad", NULL), 1);
    expect_help(run_cli("detect", "--adv", "--hel", NULL), 1);
    expect_help(run_cli("detect", "--help", "--a", NULL), 0); /* --arc-half-width, too */
}

static void expect_same_help(const char *const *one, const char *const *other)
{
    char *text = NULL;
    const outcome *result = run_cli_list(one);
    expect_code(result, 0);
    assert_non_null(text = malloc(result->out_size + 1));
    strcpy(text, result->out);
    result = run_cli_list(other);
    expect_code(result, 0);
    assert_string_equal(result->out, text);
    free(text);
}

static void help_has_the_help_of_a_command(void **state)
{
    (void)state;
    static const char *const pairs[][2][5] = {
        {{"help", "detect"}, {"detect", "--help"}},
        {{"help", "match", "--advanced"}, {"match", "--help", "--advanced"}},
        {{"--help", "devices"}, {"devices", "--help"}},
        {{"help"}, {"--help"}},
        {{"-h", "--advanced"}, {"--help"}},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++)
        expect_same_help(pairs[i][0], pairs[i][1]);
}

static void help_of_detect_wins_over_what_follows(void **state)
{
    (void)state;
    expect_code(run_cli("detect", "-h", "--no-such-option", NULL), 0);
}

/* Each line of arguments, and what standard error must contain. */
static const struct {
    const char *arguments[10];
    const char *message;
} wrong[] = {
    {{NULL}, "which command?"},
    {{"find", "scene.png"}, "no command 'find'"},
    {{"scene.png"}, "no command 'scene.png'; did you mean: asj-cli detect scene.png\n"},
    {{"missing.jpg", "-q"}, "did you mean: asj-cli detect missing.jpg ..."},
    {{"detcet", "scene.png"}, "no command 'detcet'; did you mean: asj-cli detect\n"},
    {{"mach", "scene.png", "scene.png"}, "did you mean: asj-cli match\n"},
    {{"-o", "a.asj", "scene.png"}, "did you mean: asj-cli detect -o ..."},
    {{"detect", "--epsilom", "3", "scene.png"}, "no option '--epsilom'; did you mean: --epsilon\n"},
    {{"detect", "--out-idr=a", "scene.png"}, "no option '--out-idr=a'; did you mean: --out-dir\n"},
    {{"match", "--plto", "a.png", "scene.png", "scene.png"}, "did you mean: --plot\n"},
    {{"--quiet"}, "no option '--quiet' before the command; did you mean: asj-cli detect --quiet\n"},
    {{"--ratio=2", "scene.png", "scene.png"}, "did you mean: asj-cli match --ratio=2 ...\n"},
    {{"--no-such", "scene.png"}, "asj-cli: there is no option '--no-such'\n"},
    {{"-V"}, "asj-cli: there is no option '-V'\n"},
    {{"-"}, "asj-cli: there is no option '-'\n"},
    {{"detect"}, "which image?"},
    {{"detect", "--"}, "which image?"},
    {{"detect", "--no-such", "scene.png"}, "no option '--no-such'"},
    {{"detect", "--no-such=3", "scene.png"}, "no option '--no-such=3'"},
    {{"detect", "-x", "scene.png"}, "no option '-x'"},
    {{"detect", "-qx", "scene.png"}, "no option '-x'"},
    {{"detect", "--strip", "3", "scene.png"}, "'--strip' could be --strip-"},
    {{"detect", "--ratio", "1.8", "scene.png"}, "no option '--ratio': it is one of asj-cli match\n"},
    {{"detect", "--region1=0,0,9,9", "scene.png"}, "it is one of asj-cli match; did you mean: --region\n"},
    {{"detect", "--plot-", "scene.png"}, "'--plot-' could be --plot-color, --plot-background or --plot-scale\n"},
    {{"detect", "--s", "scene.png"}, ", ...\n"},
    {{"detect", "--quiet=yes", "scene.png"}, "--quiet takes no value"},
    {{"detect", "scene.png", "-o"}, "-o needs a value"},
    {{"detect", "scene.png", "--epsilon"}, "--epsilon needs a value"},
    {{"detect", "--epsilon", "one", "scene.png"}, "--epsilon: 'one' is not a number"},
    {{"detect", "--epsilon", "nan", "scene.png"}, "--epsilon: 'nan' is not a number"},
    {{"detect", "--epsilon", "0x1", "scene.png"}, "--epsilon: '0x1' is not a number"},
    {{"detect", "--epsilon", "1,5", "scene.png"}, "--epsilon: '1,5' is not a number"},
    {{"detect", "--epsilon", "", "scene.png"}, "--epsilon: '' is not a number"},
    {{"detect", "--epsilon", "-1", "scene.png"}, "--epsilon: -1 is outside"},
    {{"detect", "--max-branches", "6", "scene.png"}, "--max-branches: 6 is outside"},
    {{"detect", "--max-branches", "2.5", "scene.png"}, "--max-branches: '2.5' is not a whole number"},
    {{"detect", "--field-radius", "4", "scene.png"}, "--field-radius"},
    {{"detect", "--field-radius", "6", "scene.png"}, "--field-radius: 6 is not one of 3, 5 .. 9"},
    {{"detect", "--preset", "best", "scene.png"}, "--preset: 'best'"},
    {{"detect", "--for", "fun", "scene.png"}, "--for: 'fun'"},
    {{"detect", "--format", "xml", "scene.png"}, "--format: 'xml'"},
    {{"detect", "--backend", "cuda", "scene.png"}, "--backend: 'cuda'"},
    {{"detect", "--threads", "-1", "scene.png"}, "--threads: '-1'"},
    {{"detect", "--threads", "257", "scene.png"}, "--threads: '257'"},
    {{"detect", "--threads", "257", "scene.png"}, "Try 'asj-cli detect --help'"},
    {{"match", "--max-megapixels", "0", "scene.png", "scene.png"}, "asj-cli match: --max-megapixels: '0'"},
    {{"help", "detcet"}, "no command 'detcet'; did you mean: asj-cli detect\n"},
    {{"detect", "--threads", "1e1", "scene.png"}, "--threads: '1e1'"},
    {{"detect", "--simd", "mmx", "scene.png"}, "--simd: 'mmx'"},
    {{"match", "--simd", "AVX2", "scene.png", "scene.png"}, "--simd: 'AVX2'"},
    {{"detect", "--max-megapixels", "0", "scene.png"}, "--max-megapixels: '0'"},
    {{"detect", "--max-megapixels", "nan", "scene.png"}, "--max-megapixels: 'nan'"},
    {{"detect", "--plot-color", "red", "scene.png"}, "--plot-color: 'red'"},
    {{"detect", "--plot-background", "red", "scene.png"}, "--plot-background: 'red'"},
    {{"detect", "--plot-scale", "0", "scene.png"}, "--plot-scale: '0'"},
    {{"detect", "--plot-scale", "2", "scene.png"}, "--plot-scale changes nothing without --plot"},
    {{"detect", "--plot-color", "edge", "-o", "a.asj", "scene.png"}, "--plot-color changes nothing without --plot"},
    {{"detect", "--whole", "-f", "json", "scene.png"}, "--whole changes nothing: it is for asj"},
    {{"detect", "--whole", "-o", "a.csv", "scene.png"}, "--whole changes nothing: it is for asj"},
    {{"detect", "--whole", "-p", "a.png", "scene.png"}, "--whole changes nothing: with --plot alone no junctions are written"},
    {{"detect", "-d", "", "scene.png"}, "--out-dir: an empty path"},
    {{"detect", "--plot", "picture", "scene.png"}, "--plot"},
    {{"detect", "--plot", ".png", "scene.png"}, "--plot"},
    {{"detect", "--plot", "picture.jpg", "scene.png"}, "--plot"},
    {{"detect", "--out-dir", ".", "--plot", "picture.png", "scene.png"}, "--plot"},
    {{"detect", "-o", "a", "--out-dir", ".", "scene.png"}, "exclude each other"},
    {{"detect", "-o", "a", "--keep-folders", "scene.png"}, "--keep-folders changes nothing without --out-dir"},
    {{"detect", "--plot", "a.png", "-f", "csv", "scene.png"}, "--format changes nothing: with --plot alone"},
    {{"match", "--plot", "a.png", "-f", "csv", "scene.png", "scene.png"}, "--format changes nothing: with --plot alone"},
    {{"detect", "scene.png", "scene.png"}, "--out-dir"},
    {{"detect", "-o", "both.asj", "scene.png", "scene.png"}, "--out-dir"},
    {{"detect", "--out-dir", ".", "scene.png", "folder/scene.png"}, "written twice, for scene.png and for folder/scene.png"},
    {{"detect", "--out-dir", ".", "scene.png", "scene.jpg"}, "./scene.asj: would be written twice"},
    {{"detect", "-f", "asj", "-o", "scene.png", "scene.png"}, "scene.png: is an input file"},
    {{"detect", "-f", "asj", "-o", "./scene.png", "scene.png"}, "scene.png: is an input file"},
    {{"detect", "-"}, "standard input"},
    {{"detect", "--region", "1,2,3", "scene.png"}, "--region: '1,2,3'"},
    {{"detect", "--isotropic-radii", "7", "--isotropic-persistence", "2", "scene.png"}, "finds nothing with 1 --isotropic-radii"},
    {{"detect", "--region", "1,2,3,0", "scene.png"}, "--region: '1,2,3,0' has no pixel"},
    {{"detect", "--region", "1,2,-3,4", "scene.png"}, "--region: '1,2,-3,4'"},
    {{"detect", "--region", "1,2,3,4,", "scene.png"}, "--region: '1,2,3,4,'"},
    {{"detect", "--region", "1,2,3,99999999999999999999", "scene.png"}, "' goes beyond 65535"},
    {{"match", "--region2", "", "scene.png", "scene.png"}, "--region2: ''"},
    {{"match", "--stretch", "0.4", "scene.png", "scene.png"}, "--stretch: '0.4'"},
    {{"match", "--stretch", "2,9", "scene.png", "scene.png"}, "--stretch: '2,9'"},
    {{"match", "--stretch", "2,", "scene.png", "scene.png"}, "--stretch: '2,'"},
    {{"match", "--stretch", "nan", "scene.png", "scene.png"}, "--stretch: 'nan'"},
    {{"match", "--junctions1", "scene.asj", "--mask1", "scene.png", "scene.png", "scene.png"}, "--mask1 changes nothing"},
    {{"detect", "--mask", "mask.png", "-f", "asj", "-o", "mask.png", "scene.png"}, "mask.png: is an input file"},
    {{"match", "--mask2", "mask.png", "-f", "csv", "-o", "mask.png", "scene.png", "scene.png"}, "mask.png: is an input file"},
    {{"match", "--camera1", "500,0,9,9", "--geometry", "auto", "scene.png", "scene.png"}, "--camera1: '500,0,9,9'"},
    {{"match", "--camera2", "0.5,500,9,9", "--geometry", "auto", "scene.png", "scene.png"}, "--camera2: '0.5,500,9,9'"},
};

static void wrong_usage_ends_with_2_and_says_why(void **state)
{
    (void)state;
    write_scene("scene.png");
    write_constant("mask.png", SCENE_WIDTH, SCENE_HEIGHT);
    int files = count_files(".");
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const outcome *result = run_cli_list(wrong[i].arguments);
        if (result->code != 2)
            print_error("in case %zu, %s\n", i, wrong[i].message);
        expect_code(result, 2);
        expect_in(result, result->err, wrong[i].message);
        expect_in(result, result->err, "--help");
        expect_empty(result, "standard output", result->out);
        assert_int_equal(strncmp(result->err, "asj-cli", 7), 0);
    }
    assert_int_equal(count_files("."), files);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(general_help_and_version),
        cmocka_unit_test(help_names_the_options_of_the_library),
        cmocka_unit_test(help_has_the_help_of_a_command),
        cmocka_unit_test(help_of_detect_wins_over_what_follows),
        cmocka_unit_test(wrong_usage_ends_with_2_and_says_why),
    };
    program_start(argc, argv);
    return program_end(cmocka_run_group_tests(tests, NULL, NULL));
}
