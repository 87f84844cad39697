/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli match --plot: formats, sizes, and what is drawn where. */
#include "files.h"
#include "match_table.h"
#include "plot_pixels.h"
#include "program.h"

#include <asj/io.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static int is_near(const unsigned char *color, const int wanted[3])
{
    return abs(color[0] - wanted[0]) <= 3 && abs(color[1] - wanted[1]) <= 3 && abs(color[2] - wanted[2]) <= 3;
}

enum { SCALE = 8 };

/* Where x2, y2 of the second view stands in the plot: the last SCENE_WIDTH * SCALE columns. */
static const unsigned char *pixel_of(const asj_image_file *plot, int second, double x, double y)
{
    int left = second ? plot->image.width - SCALE * SCENE_WIDTH : 0;
    return plot_pixel(plot, left + (int)(SCALE * (x + 0.5)), (int)(SCALE * (y + 0.5)));
}

/* Reads places of the first match of a CSV file: columns x1 .. by2. */
static void read_first(const char *path, double places[12])
{
    size_t size = 0;
    char *text = read_bytes(path, &size), *at;
    assert_non_null(text);
    at = strchr(text, '\n');
    for (int skipped = 0; skipped < 2; skipped++) {
        assert_non_null(at);
        at = strchr(at + 1, ',');
    }
    for (int i = 0; i < 12; i++) {
        assert_non_null(at);
        places[i] = strtod(at + 1, &at);
        assert_int_equal(*at, ',');
    }
    free(text);
}

/* The best match lies on top: its dots have the same dark colour in both views, and its branches are coloured up to their ends. */
static void a_match_has_one_colour_in_both_views(void **state)
{
    (void)state;
    double p[12];
    expect_code(run_cli("match", "-q", "-o", "m.csv", "--plot", "white.png", "--plot-background", "white", "--plot-scale", "8",
                        "--plot-layout", "beside", "first.png", "second.png", NULL), 0);
    read_first("m.csv", p);
    asj_image_file *plot = read_plot("white.png");
    assert_in_range(plot->image.width, 2 * SCALE * SCENE_WIDTH + 1, 2 * SCALE * SCENE_WIDTH + 200);
    assert_in_range(plot->image.height, SCALE * SCENE_HEIGHT, SCALE * SCENE_HEIGHT + 200);
    const unsigned char *dot = pixel_of(plot, 0, p[0], p[1]);
    const int wanted[3] = {dot[0], dot[1], dot[2]};
    assert_true(is_colored(dot));
    assert_true(is_near(pixel_of(plot, 1, p[6], p[7]), wanted));
    for (int view = 0; view < 2; view++)
        for (int branch = 0; branch < 2; branch++) {
            const double *start = p + 6 * view, *end = start + 2 + 2 * branch;
            for (double part = 0.3; part < 1; part += 0.3) {
                double x = start[0] + part * (end[0] - start[0]), y = start[1] + part * (end[1] - start[1]);
                assert_true(is_colored(pixel_of(plot, view, x, y)));
            }
        }
    asj_image_file_free(&plot);
}

static void views_stand_beside_or_below(void **state)
{
    (void)state;
    static const struct {
        int width, height;
        const char *layout;
        int beside;
    } cases[] = {{60, 50, "auto", 1}, {60, 50, "below", 0}, {60, 20, "auto", 0}, {60, 20, "beside", 1}, {20, 60, "auto", 1}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        int width = cases[i].width * (cases[i].beside ? 2 : 1), height = cases[i].height * (cases[i].beside ? 1 : 2);
        write_constant("flat.png", cases[i].width, cases[i].height);
        expect_code(run_cli("match", "-q", "--plot", "flat.plot.png", "--plot-scale", "4", "--plot-layout", cases[i].layout,
                            "flat.png", "flat.png", NULL), 0);
        asj_image_file *plot = read_plot("flat.plot.png");
        assert_in_range(plot->image.width, 4 * width, 4 * width + 20);
        assert_in_range(plot->image.height, 4 * height, 4 * height + 60);
        asj_image_file_free(&plot);
    }
}

static void views_of_any_size_are_drawn(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {1, 300}, {2000, 3}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        write_constant("flat.png", sizes[i][0], sizes[i][1]);
        expect_code(run_cli("match", "-q", "--plot", "any.png", "flat.png", "first.png", NULL), 0);
        asj_image_file *plot = read_plot("any.png");
        asj_image_file_free(&plot);
    }
    write_constant("long.png", 40000, 1);
    expect_code(run_cli("match", "-q", "--plot", "any.png", "--plot-layout", "beside", "long.png", "first.png", NULL), 0);
    const outcome *result = run_cli("match", "-q", "--plot", "too.png", "--plot-scale", "1", "long.png", "first.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: too.png: ");
    expect_in(result, result->err, "--plot-scale");
    assert_false(exists("too.png"));
}

static char *read_text(const char *path, size_t *size)
{
    char *bytes = read_bytes(path, size);
    assert_non_null(bytes);
    for (size_t i = 0; i < *size; i++)
        if (!bytes[i])
            bytes[i] = ' ';
    return bytes;
}

static void expect_text(const char *path, const char *beginning, const char *within, const char *without)
{
    size_t size = 0;
    char *bytes = read_text(path, &size);
    if (strncmp(bytes, beginning, strlen(beginning)) != 0 || (within && !strstr(bytes, within)) ||
        (without && strstr(bytes, without)))
        fail_msg("%s: does not begin with '%s', or no '%s', or '%s'", path, beginning, within, without ? without : "");
    free(bytes);
}

static void svg_and_pdf_hold_the_photographs(void **state)
{
    (void)state;
    static const char *const names[] = {"p.svg", "p.pdf", "P.PNG"};
    for (size_t i = 0; i < 3; i++)
        expect_code(run_cli("match", "-q", "--plot", names[i], "first.png", "second.png", NULL), 0);
    expect_code(run_cli("match", "-q", "--plot", "w.svg", "--plot-background", "white", "first.png", "second.png", NULL), 0);
    expect_text("p.svg", "<?xml", "data:image/png;base64,", NULL);
    expect_text("w.svg", "<?xml", "</svg>", "data:image/png");
    expect_text("w.svg", "<?xml", "<g id=\"match-1\"><title>match 1: ", NULL);
    size_t sizes[2];
    expect_code(run_cli("match", "-q", "--plot", "n.svg", "--plot-lines", "no", "--plot-background", "white", "first.png",
                        "second.png", NULL), 0);
    char *with = read_text("w.svg", &sizes[0]), *without = read_text("n.svg", &sizes[1]);
    assert_true(sizes[1] < sizes[0]);
    free(with);
    free(without);
    expect_text("p.pdf", "%PDF-", "/Subtype /Image", NULL);
    expect_text("P.PNG", "\x89PNG\r\n", "IEND", NULL);
}

/* The same twice; lines look different from junctions. */
static void plots_are_repeatable(void **state)
{
    (void)state;
    size_t sizes[3] = {0};
    char *bytes[3];
    for (size_t i = 0; i < 3; i++) {
        if (i < 2)
            expect_code(run_cli("match", "-q", "--plot", "r.svg", "first.png", "second.png", NULL), 0);
        else
            expect_code(run_cli("match", "-q", "--lines", "--plot", "r.svg", "first.png", "second.png", NULL), 0);
        bytes[i] = read_text("r.svg", &sizes[i]);
    }
    assert_string_equal(bytes[0], bytes[1]);
    assert_string_not_equal(bytes[0], bytes[2]);
    for (size_t i = 0; i < 3; i++)
        free(bytes[i]);
}

/* With a geometry. Lines are drawn where they are asked for, on both sides; a word that is neither yes nor no is refused. */
static void epipolar_lines_are_drawn_on_demand(void **state)
{
    size_t with = 0, without = 0;
    (void)state;
    expect_code(run_cli("match", "-q", "--geometry", "fundamental", "-p", "with.svg", "--plot-epipolar", "yes", "first.png",
                        "second.png", NULL), 0);
    expect_code(run_cli("match", "-q", "--geometry", "fundamental", "-p", "without.svg", "--plot-epipolar", "no", "first.png",
                        "second.png", NULL), 0);
    free(read_bytes("with.svg", &with));
    free(read_bytes("without.svg", &without));
    assert_true(with > without + 2000);
    const outcome *result = run_cli("match", "-p", "with.svg", "--plot-epipolar", "1", "first.png", "second.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--plot-epipolar: '1' is not yes or no");
}

/* Behind the next opacity of a stroke in an SVG file that is this one; NULL = there is none. */
static char *find_stroke(char *text, const char *opacity)
{
    static const char key[] = "stroke-opacity";
    const size_t length = strlen(opacity);
    for (char *at = text; (at = strstr(at, key)) != NULL;) {
        at += sizeof key - 1;
        at += strspn(at, ":=\""); /* as a property, or as an attribute: versions of cairo differ */
        if (strncmp(at, opacity, length) == 0 && !strchr("0123456789", at[length]))
            return at;
    }
    return NULL;
}

static int count_strokes(const char *path, const char *opacity)
{
    int count = 0;
    size_t size = 0;
    char *text = read_text(path, &size);
    for (char *at = text; (at = find_stroke(at, opacity)) != NULL;)
        count++;
    free(text);
    return count;
}

/* Where the first stroke of this opacity begins and ends. */
static void read_stroke(const char *path, const char *opacity, double ends[4])
{
    size_t size = 0;
    char *text = read_text(path, &size), *at = find_stroke(text, opacity), *end;
    assert_non_null(at);
    while (at > text && strncmp(at, "<path", 5) != 0)
        at--;
    at = strstr(at, " d=\"M ");
    assert_non_null(at);
    at += strlen(" d=\"M ");
    for (int k = 0; k < 4; k++) {
        at += strcspn(at, "-.0123456789");
        ends[k] = strtod(at, &end);
        assert_true(end > at);
        at = end;
    }
    free(text);
}

/* Of line segments the ends correspond, not their middles: the line of the best one goes through its first end. */
static void epipolar_lines_go_through_ends_of_segments(void **state)
{
    static table lines;
    double line[4];
    (void)state;
    expect_code(run_cli("match", "-q", "--geometry", "fundamental", "--lines", "-o", "lines.csv", "-p", "lines.svg", "--plot-scale",
                        "8", "--plot-layout", "beside", "--plot-epipolar", "yes", "first.png", "second.png", NULL), 0);
    read_csv("lines.csv", &lines);
    assert_true(lines.count > 0);
    const double *row = &lines.rows[0][AX1];
    read_stroke("lines.svg", "0.55", line);
    const double length = hypot(line[2] - line[0], line[3] - line[1]);
    const double nx = -(line[3] - line[1]) / length, ny = (line[2] - line[0]) / length;
    double away[2]; /* of the first end and of the middle, in px of the image */
    for (int k = 0; k < 2; k++) {
        const double x = k ? 0.5 * (row[0] + row[2]) : row[0], y = k ? 0.5 * (row[1] + row[3]) : row[1];
        away[k] = fabs(nx * (x + 0.5 - line[0] / SCALE) + ny * (y + 0.5 - line[1] / SCALE));
    }
    assert_true(away[0] < 1.5);
    assert_true(away[1] > 3);
}

/* More would hide the photographs. */
static void of_many_matches_some_have_epipolar_lines(void **state)
{
    (void)state;
    write_tiled_views("many1.png", "many2.png");
    const outcome *result = run_cli("match", "--geometry", "fundamental", "-p", "many.svg", "--plot-epipolar", "yes", "many1.png",
                                    "many2.png", NULL);
    expect_code(result, 0);
    const char *count = strstr(result->err, "png: ");
    assert_non_null(count);
    assert_true(strtol(count + strlen("png: "), NULL, 10) > 60);
    assert_int_equal(count_strokes("many.svg", "0.55"), 2 * 60);
    expect_code(run_cli("match", "-q", "--geometry", "fundamental", "-p", "again.svg", "--plot-epipolar", "yes", "many1.png",
                        "many2.png", NULL), 0);
    size_t sizes[2];
    char *one = read_text("many.svg", &sizes[0]), *other = read_text("again.svg", &sizes[1]);
    assert_string_equal(one, other);
    free(one);
    free(other);
}

static void a_plot_alone_prints_no_matches(void **state)
{
    (void)state;
    const outcome *result = run_cli("match", "--plot", "alone.png", "first.png", "second.png", NULL);
    expect_code(result, 0);
    expect_empty(result, "standard output", result->out);
    expect_in(result, result->err, " matches -> alone.png");
    result = run_cli("match", "-o", "before.csv", "--plot", "nowhere/plot.png", "first.png", "second.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: nowhere/plot.png: cannot create: No such file or directory");
    assert_false(exists("before.csv")); /* asked before the work */
    result = run_cli("match", "-o", ".", "--plot", "before.png", "first.png", "second.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: .: cannot create: Is a directory");
    assert_false(exists("before.png"));
    result = run_cli("match", "-o", "", "--plot", "before.png", "first.png", "second.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: cannot create a file without a name");
    assert_false(exists("before.png"));
}

/* The first junction of the first image is a grey dot. */
static void junctions_are_drawn_where_nothing_matches(void **state)
{
    static const int grey[3] = {102, 102, 102};
    (void)state;
    write_constant("flat.png", SCENE_WIDTH, SCENE_HEIGHT);
    expect_code(run_cli("detect", "-q", "--for", "matching", "-f", "asj", "-o", "first.asj", "first.png", NULL), 0);
    expect_code(run_cli("match", "-q", "-p", "none.png", "--plot-background", "white", "--plot-scale", "8", "--plot-layout",
                        "beside", "--junctions1", "first.asj", "first.png", "flat.png", NULL), 0);
    asj_image_file *plot = read_plot("none.png");
    asj_junction_file *file = NULL;
    char message[256];
    assert_int_equal(asj_junctions_read("first.asj", &file, message, sizeof message), ASJ_OK);
    assert_true(file->junction_count > 0);
    assert_true(is_near(pixel_of(plot, 0, (double)file->junctions[0].x, (double)file->junctions[0].y), grey));
    asj_junction_file_free(&file);
    asj_image_file_free(&plot);
}

static void plots_take_the_place_of_no_other_file(void **state)
{
    (void)state;
    int files = count_files(".");
    const outcome *result = run_cli("match", "--format", "csv", "-o", "a.png", "--plot", "a.png", "first.png",
                                    "second.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "a.png: would be written twice");
    result = run_cli("match", "--plot", "./second.png", "first.png", "second.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "second.png: is an input file");
    assert_int_equal(count_files("."), files);
}

static void a_build_without_cairo_says_so(void **state)
{
    (void)state;
    const outcome *result = run_cli("match", "--plot", "plot.png", "first.png", "second.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "cairo");
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_match_has_one_colour_in_both_views),
        cmocka_unit_test(views_stand_beside_or_below),
        cmocka_unit_test(views_of_any_size_are_drawn),
        cmocka_unit_test(svg_and_pdf_hold_the_photographs),
        cmocka_unit_test(plots_are_repeatable),
        cmocka_unit_test(epipolar_lines_are_drawn_on_demand),
        cmocka_unit_test(epipolar_lines_go_through_ends_of_segments),
        cmocka_unit_test(of_many_matches_some_have_epipolar_lines),
        cmocka_unit_test(a_plot_alone_prints_no_matches),
        cmocka_unit_test(junctions_are_drawn_where_nothing_matches),
        cmocka_unit_test(plots_take_the_place_of_no_other_file),
    };
    const struct CMUnitTest without[] = {cmocka_unit_test(a_build_without_cairo_says_so)};
    program_start(argc, argv);
    if (argc > 2 && strcmp(argv[2], "without-cairo") == 0)
        return program_end(cmocka_run_group_tests(without, make_views, NULL));
    return program_end(cmocka_run_group_tests(tests, make_views, NULL));
}
