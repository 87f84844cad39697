/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli detect --plot: formats, sizes, and what is drawn where. */
#include "files.h"
#include "plot_pixels.h"
#include "program.h"

#include <asj/io.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <math.h>
#include <sys/stat.h>

static int is_gray(const unsigned char *color, int value)
{
    return abs(color[0] - value) <= 1 && abs(color[1] - value) <= 1 && abs(color[2] - value) <= 1;
}

enum { SCALE = 6 };

/* A side of the rectangle: coloured to its end, white beside and beyond. Lengths in pixels of the image. */
static void expect_branch(const asj_image_file *plot, const asj_junction *junction, const asj_branch *branch)
{
    const double length = (double)branch->length, cosine = cos((double)branch->angle), sine = sin((double)branch->angle);
    const struct {
        double along, beside;
        int colored;
    } places[] = {{length / 2, 0, 1}, {length - 3, 0, 1}, {length / 2, 2, 0}, {length / 2, -2, 0}, {length + 3, 0, 0}};
    assert_true(length > 100);
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        double x = (double)junction->x + places[i].along * cosine - places[i].beside * sine;
        double y = (double)junction->y + places[i].along * sine + places[i].beside * cosine;
        const unsigned char *color = plot_pixel(plot, (int)(SCALE * (x + 0.5)), (int)(SCALE * (y + 0.5)));
        assert_true(places[i].colored ? is_colored(color) : is_gray(color, 255));
    }
}

static void junctions_are_drawn_where_they_are(void **state)
{
    (void)state;
    expect_code(run_cli("detect", "-q", "-o", "scene.json", "--plot", "white.png", "--plot-background", "white",
                        "--plot-scale", "6", "scene.png", NULL), 0);
    asj_junction_file *found = NULL;
    assert_int_equal(asj_junctions_read("scene.json", &found, NULL, 0), ASJ_OK);
    asj_image_file *plot = read_plot("white.png");
    assert_int_equal(plot->image.width, SCALE * SCENE_WIDTH);
    assert_in_range(plot->image.height, SCALE * SCENE_HEIGHT, SCALE * SCENE_HEIGHT + 100);
    assert_int_equal(found->junction_count, 4);
    for (uint32_t i = 0; i < found->junction_count; i++) {
        const asj_junction *junction = &found->junctions[i];
        double x = (double)junction->x + 0.5, y = (double)junction->y + 0.5;
        assert_true(is_gray(plot_pixel(plot, (int)(SCALE * x), (int)(SCALE * y)), 26)); /* the dot */
        assert_int_equal(junction->branch_count, 2);
        for (int32_t b = 0; b < junction->branch_count; b++)
            expect_branch(plot, junction, &junction->branches[b]);
    }
    asj_image_file_free(&plot);
    asj_junction_file_free(&found);
}

static void expect_text(const char *path, const char *beginning, const char *within, const char *without)
{
    size_t size = 0;
    char *bytes = read_bytes(path, &size);
    assert_non_null(bytes);
    if (strncmp(bytes, beginning, strlen(beginning)) != 0)
        fail_msg("%s does not begin with '%s'", path, beginning);
    for (size_t i = 0; i < size; i++)
        if (!bytes[i])
            bytes[i] = ' ';
    if (within && !strstr(bytes, within))
        fail_msg("%s: no '%s'", path, within);
    if (without && strstr(bytes, without))
        fail_msg("%s: '%s'", path, without);
    free(bytes);
}

/* From corner to corner, once: in the plot's colours, and each by its number in SVG. */
static void lines_take_the_place_of_branches(void **state)
{
    static const double middles[4][2] = {{(SCENE_LEFT + SCENE_RIGHT) / 2.0, SCENE_TOP},
                                         {(SCENE_LEFT + SCENE_RIGHT) / 2.0, SCENE_BOTTOM},
                                         {SCENE_LEFT, (SCENE_TOP + SCENE_BOTTOM) / 2.0},
                                         {SCENE_RIGHT, (SCENE_TOP + SCENE_BOTTOM) / 2.0}};
    (void)state;
    expect_code(run_cli("detect", "-q", "--lines", "--plot", "lines.png", "--plot-background", "white", "--plot-scale", "6",
                        "scene.png", NULL), 0);
    asj_image_file *plot = read_plot("lines.png");
    for (int k = 0; k < 4; k++) {
        assert_true(is_colored(plot_pixel(plot, (int)(SCALE * middles[k][0]), (int)(SCALE * middles[k][1]))));
        assert_true(is_gray(plot_pixel(plot, (int)(SCALE * (middles[k][0] + 4)), (int)(SCALE * (middles[k][1] + 4))), 255));
    }
    asj_image_file_free(&plot);
    expect_code(run_cli("detect", "-q", "--lines", "--plot", "lines.svg", "scene.png", NULL), 0);
    expect_text("lines.svg", "<?xml", "<g id=\"line-4\"><title>line 4: 12", "branch-1");
    expect_text("lines.svg", "<?xml", "<g id=\"junction-4\"", "line-5");
    const outcome *result = run_cli("detect", "--lines", "--plot", "x.png", "--plot-color", "edge", "scene.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--plot-color: with --lines it takes nfa or direction");
}

/* Squares in rows and columns: what is upright has one direction, what is level the other. */
static void directions_have_colors(void **state)
{
    enum { WIDE = 320, HIGH = 240, SIDE = 40, STEP = 70 };
    static unsigned char pixels[WIDE * HIGH];
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, WIDE, HIGH, 0, 0};
    (void)state;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            pixels[y * WIDE + x] = x % STEP >= 20 && x % STEP < 20 + SIDE && y % STEP >= 20 && y % STEP < 20 + SIDE ? 200 : 80;
    assert_int_equal(asj_png_write("squares.png", &image, NULL, 0), ASJ_OK);
    const outcome *result = run_cli("detect", "--vanishing-points", "--plot", "d.png", "--plot-background", "white", "--plot-scale",
                                    "4", "squares.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "2 directions -> d.png");
    asj_image_file *plot = read_plot("d.png");
    unsigned char level[3], upright[3];
    memcpy(level, plot_pixel(plot, 4 * 40, 4 * 20), 3);   /* the middle of the first square's upper side, .. */
    memcpy(upright, plot_pixel(plot, 4 * 20, 4 * 40), 3); /* .. and of its left one */
    assert_true(is_colored(level) && is_colored(upright));
    assert_true(abs(level[0] - upright[0]) > 100);
    assert_memory_equal(plot_pixel(plot, 4 * 110, 4 * 90), level, 3);
    assert_memory_equal(plot_pixel(plot, 4 * 90, 4 * 110), upright, 3);
    asj_image_file_free(&plot);
    expect_code(run_cli("detect", "-q", "--lines", "--vanishing-points", "--plot", "d.svg", "squares.png", NULL), 0);
    expect_text("d.svg", "<?xml", ", direction 2</title>", "branch-1");
    expect_code(run_cli("detect", "-q", "--vanishing-points", "--plot", "d.svg", "--plot-color", "nfa", "-o", "d.json",
                        "squares.png", NULL), 0);
    expect_text("d.svg", "<?xml", "branch 2: ", "direction");
    result = run_cli("detect", "--vanishing-points", "--plot", "d.svg", "--plot-color", "nfa", "squares.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--vanishing-points go into JSON, or a plot");
    result = run_cli("detect", "--plot", "d.svg", "--plot-color", "direction", "squares.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--plot-color direction takes --vanishing-points");
}

static void the_photograph_is_pale_and_gray(void **state)
{
    (void)state;
    expect_code(run_cli("detect", "-q", "--plot", "photo.png", "--plot-scale", "1", "scene.png", NULL), 0);
    asj_image_file *plot = read_plot("photo.png");
    assert_int_equal(plot->image.width, SCENE_WIDTH);
    const unsigned char *outside = plot_pixel(plot, 10, 10), *inside = plot_pixel(plot, SCENE_WIDTH / 2, SCENE_HEIGHT / 2);
    assert_true(is_gray(outside, outside[0]));
    assert_true(is_gray(inside, inside[0]));
    assert_true(outside[0] > 80 + 50 && inside[0] > outside[0] + 30);
    asj_image_file_free(&plot);
}

static void the_photograph_keeps_its_colors_on_request(void **state)
{
    (void)state;
    enum { SIDE = 40 };
    static unsigned char red[SIDE * SIDE * 3];
    for (int i = 0; i < SIDE * SIDE; i++)
        red[3 * i] = 200;
    asj_image image = {red, ASJ_FORMAT_RGB8, SIDE, SIDE, 0, 0};
    assert_int_equal(asj_png_write("red.png", &image, NULL, 0), ASJ_OK);
    expect_code(run_cli("detect", "-q", "--plot", "c.png", "--plot-background", "color", "--plot-scale", "1", "red.png", NULL), 0);
    asj_image_file *plot = read_plot("c.png");
    const unsigned char *color = plot_pixel(plot, 20, 20);
    assert_true(color[0] > 200 && color[1] < 160 && color[2] == color[1]);
    asj_image_file_free(&plot);
}

static void small_images_are_upsampled(void **state)
{
    (void)state;
    static const int sizes[][3] = {{320, 240, 960}, {600, 20, 1200}, {20, 667, 20}, {1, 1, 8}, {1100, 4, 1100}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        write_constant("flat.png", sizes[i][0], sizes[i][1]);
        expect_code(run_cli("detect", "-q", "--plot", "flat.plot.png", "flat.png", NULL), 0);
        asj_image_file *plot = read_plot("flat.plot.png");
        assert_int_equal(plot->image.width, sizes[i][2]);
        asj_image_file_free(&plot);
    }
}

static void the_colors_follow_the_option(void **state)
{
    (void)state;
    static const char *const colors[3] = {"nfa", "branch", "edge"};
    char *plots[3];
    size_t sizes[3] = {0};
    for (int i = 0; i < 3; i++) {
        expect_code(run_cli("detect", "-q", "--plot", "color.png", "--plot-color", colors[i], "scene.png", NULL), 0);
        plots[i] = read_bytes("color.png", &sizes[i]);
        assert_non_null(plots[i]);
        for (int k = 0; k < i; k++)
            assert_false(sizes[i] == sizes[k] && memcmp(plots[i], plots[k], sizes[i]) == 0);
    }
    for (int i = 0; i < 3; i++)
        free(plots[i]);
}

static void svg_and_pdf_hold_the_photograph(void **state)
{
    (void)state;
    expect_code(run_cli("detect", "-q", "--plot", "photo.svg", "--plot-scale", "2", "scene.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "--plot", "white.SVG", "--plot-background", "white", "scene.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "--plot", "photo.pdf", "--plot-scale", "2", "scene.png", NULL), 0);
    expect_text("white.SVG", "<?xml", "<g id=\"junction-4\"><title>junction 4: ", NULL);
    expect_text("white.SVG", "<?xml", "<title>junction 1, branch 2: ", "junction-5");
    expect_text("white.SVG", "<?xml", "</g>\n</g>\n</svg>\n", NULL);
    expect_code(run_cli("detect", "-q", "--plot", "white.pdf", "--plot-background", "white", "scene.png", NULL), 0);
    expect_text("photo.svg", "<?xml", "width=\"640", NULL);
    expect_text("photo.svg", "<?xml", "data:image/png;base64,", NULL);
    expect_text("photo.svg", "<?xml", "</svg>", NULL);
    expect_text("white.SVG", "<?xml", "</svg>", "data:image/png");
    expect_text("photo.pdf", "%PDF-", "/Subtype /Image", NULL);
    expect_text("photo.pdf", "%PDF-", "%%EOF", NULL);
    expect_text("white.pdf", "%PDF-", "%%EOF", "/Subtype /Image");
}

static void the_same_image_gives_the_same_plot(void **state)
{
    (void)state;
    static const char *const names[] = {"twice.png", "twice.svg", "twice.pdf"};
    for (size_t i = 0; i < 3; i++) {
        size_t sizes[2] = {0};
        expect_code(run_cli("detect", "-q", "--plot", names[i], "scene.png", NULL), 0);
        char *first = read_bytes(names[i], &sizes[0]);
        expect_code(run_cli("detect", "-q", "--plot", names[i], "scene.png", NULL), 0);
        char *second = read_bytes(names[i], &sizes[1]);
        assert_non_null(first);
        assert_non_null(second);
        assert_int_equal(sizes[0], sizes[1]);
        assert_memory_equal(first, second, sizes[0]);
        free(first);
        free(second);
    }
}

static void a_plot_alone_prints_no_junctions(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "--plot", "alone.png", "scene.png", NULL);
    expect_code(result, 0);
    expect_empty(result, "standard output", result->out);
    expect_in(result, result->err, "scene.png: 4 junctions -> alone.png");
    result = run_cli("detect", "-q", "-o", "-", "--plot", "alone.png", "scene.png", NULL);
    expect_code(result, 0);
    assert_int_equal(strncmp(result->out, "4\n", 2), 0);
}

static void plots_go_to_the_folder_too(void **state)
{
    (void)state;
    assert_int_equal(mkdir("plots", 0777), 0);
    expect_code(run_cli("detect", "-q", "--out-dir", "plots", "--plot", "svg", "scene.png", "flat.png", NULL), 0);
    assert_int_equal(count_files("plots"), 4);
    expect_text("plots/scene.plot.svg", "<?xml", "</svg>", NULL);
    expect_text("plots/flat.plot.svg", "<?xml", "</svg>", NULL);
}

static void plots_that_cannot_be_are_errors(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "--plot", "nowhere/plot.png", "scene.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: nowhere/plot.png: ");
    write_constant("long.png", 30000, 1);
    result = run_cli("detect", "--plot", "long.plot.png", "--plot-scale", "2", "long.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "asj-cli: long.plot.png: ");
    expect_in(result, result->err, "--plot-scale");
    assert_false(exists("long.plot.png"));
    write_constant("long.png", 65535, 1);
    expect_code(run_cli("detect", "--plot", "long.plot.png", "long.png", NULL), 0);
    expect_code(run_cli("detect", "--plot", "long.plot.svg", "--plot-scale", "1", "long.png", NULL), 0);
}

static int make_files(void **state)
{
    (void)state;
    write_scene("scene.png");
    return 0;
}

static void a_build_without_cairo_says_so(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "--plot", "plot.png", "scene.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "cairo");
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(junctions_are_drawn_where_they_are),
        cmocka_unit_test(lines_take_the_place_of_branches),
        cmocka_unit_test(directions_have_colors),
        cmocka_unit_test(the_photograph_is_pale_and_gray),
        cmocka_unit_test(the_photograph_keeps_its_colors_on_request),
        cmocka_unit_test(small_images_are_upsampled),
        cmocka_unit_test(the_colors_follow_the_option),
        cmocka_unit_test(svg_and_pdf_hold_the_photograph),
        cmocka_unit_test(the_same_image_gives_the_same_plot),
        cmocka_unit_test(a_plot_alone_prints_no_junctions),
        cmocka_unit_test(plots_go_to_the_folder_too),
        cmocka_unit_test(plots_that_cannot_be_are_errors),
    };
    const struct CMUnitTest without[] = {cmocka_unit_test(a_build_without_cairo_says_so)};
    program_start(argc, argv);
    if (argc > 2 && strcmp(argv[2], "without-cairo") == 0)
        return program_end(cmocka_run_group_tests(without, make_files, NULL));
    return program_end(cmocka_run_group_tests(tests, make_files, NULL));
}
