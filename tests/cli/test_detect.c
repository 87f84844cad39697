/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli detect: what it writes, where, and what it says. */
#define _XOPEN_SOURCE 700
#include "files.h"
#include "program.h"

#include <asj/context.h>
#include <asj/io.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static asj_junction_file *read_junctions(const char *path)
{
    char message[512] = "";
    asj_junction_file *file = NULL;
    if (asj_junctions_read(path, &file, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    return file;
}

/* The four corners of the scene, each once, within half a pixel, and nothing else. */
static void expect_scene(const char *path)
{
    static const int corners[4][2] = {
        {SCENE_LEFT, SCENE_TOP}, {SCENE_RIGHT, SCENE_TOP}, {SCENE_LEFT, SCENE_BOTTOM}, {SCENE_RIGHT, SCENE_BOTTOM}};
    asj_junction_file *file = read_junctions(path);
    assert_int_equal(file->junction_count, 4);
    for (size_t c = 0; c < 4; c++) {
        int found = 0;
        for (uint32_t i = 0; i < file->junction_count; i++)
            found += fabs((double)file->junctions[i].x - corners[c][0]) < 0.5 &&
                     fabs((double)file->junctions[i].y - corners[c][1]) < 0.5;
        assert_int_equal(found, 1);
    }
    asj_junction_file_free(&file);
}

static void expect_file(const char *path, const char *text)
{
    size_t size = 0;
    char *bytes = read_bytes(path, &size);
    assert_non_null(bytes);
    assert_string_equal(bytes, text);
    free(bytes);
}

static void results_go_to_standard_output_and_words_to_standard_error(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "scene.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "scene.png: 4 junctions");
    write_bytes("printed.asj", result->out, result->out_size);
    expect_scene("printed.asj");
    result = run_cli("detect", "-o", "-", "--quiet", "scene.png", NULL);
    expect_code(result, 0);
    expect_empty(result, "standard error", result->err);
    expect_file("printed.asj", result->out);
    result = run_cli("detect", "-q", "-o", "written.asj", "scene.png", NULL);
    expect_code(result, 0);
    expect_empty(result, "standard error", result->err);
    expect_empty(result, "standard output", result->out);
    expect_scene("written.asj");
}

static void the_name_or_the_option_chooses_the_format(void **state)
{
    (void)state;
    static const struct {
        const char *path, *format, *beginning;
    } cases[] = {
        {"a.asj", NULL, "4\n"}, {"a.json", NULL, "{"}, {"a.csv", NULL, "junction,x,y"}, {"a.txt", NULL, "4\n"},
        {"b.asj", "json", "{"}, {"b.json", "csv", "junction,x,y"}, {"b.csv", "asj", "4\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        size_t size = 0;
        if (cases[i].format)
            expect_code(run_cli("detect", "-o", cases[i].path, "scene.png", "--format", cases[i].format, NULL), 0);
        else
            expect_code(run_cli("detect", "-o", cases[i].path, "scene.png", NULL), 0);
        char *bytes = read_bytes(cases[i].path, &size);
        assert_non_null(bytes);
        bytes[strlen(cases[i].beginning)] = '\0';
        assert_string_equal(bytes, cases[i].beginning);
        free(bytes);
    }
    expect_scene("a.json");
}

/* Four branches at right angles: four pairs that are no straight lines. */
static void whole_junctions_are_written_on_request(void **state)
{
    (void)state;
    write_crossing("crossing.png");
    expect_code(run_cli("detect", "-q", "-o", "pairs.asj", "crossing.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "--whole", "-o", "whole.asj", "crossing.png", NULL), 0);
    asj_junction_file *pairs = read_junctions("pairs.asj"), *whole = read_junctions("whole.asj");
    assert_int_equal(whole->junction_count, 1);
    assert_int_equal(whole->junctions[0].branch_count, 4);
    assert_int_equal(pairs->junction_count, 4);
    for (uint32_t i = 0; i < pairs->junction_count; i++)
        assert_int_equal(pairs->junctions[i].branch_count, 2);
    asj_junction_file_free(&pairs);
    asj_junction_file_free(&whole);
}

/* The number behind "name" in JSON. */
static double json_number(const char *text, const char *name)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\"", name);
    const char *found = strstr(text, quoted);
    if (!found)
        fail_msg("no %s in %s", quoted, text);
    found += strlen(quoted);
    return strtod(found + strspn(found, " :\n"), NULL);
}

static void the_preset_comes_first_wherever_it_stands(void **state)
{
    (void)state;
    static const char *const lines[2][10] = {
        {"detect", "-f", "json", "--preset", "paper", "--epsilon", "0.5", "scene.png", NULL},
        {"detect", "--epsilon", "0.5", "scene.png", "--preset", "paper", "-f", "json", NULL},
    };
    for (size_t i = 0; i < 2; i++) {
        const outcome *result = run_cli_list(lines[i]);
        expect_code(result, 0);
        assert_true(json_number(result->out, "epsilon") == 0.5);
        assert_true(json_number(result->out, "minimum_length") == 0);
    }
    const outcome *result = run_cli("detect", "-f", "json", "--minimum-length", "3", "--minimum_length", "9", "scene.png", NULL);
    expect_code(result, 2); /* keys have dashes on the command line */
    result = run_cli("detect", "-f", "json", "--minimum-length=3", "--minimum-length", "9", "scene.png", NULL);
    expect_code(result, 0);
    assert_true(json_number(result->out, "minimum_length") == 9);
}

/* A scene of four corners has no directions; what there is to say stands in the file, and only where it was asked for. */
static void directions_are_written_on_request(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "-f", "json", "--vanishing-points", "--camera", "600,600,159.5,119.5", "scene.png",
                                    NULL);
    expect_code(result, 0);
    expect_in(result, result->out, "\"vanishing_points\": {\"focal_source\": \"given\", \"camera\": [600");
    expect_in(result, result->out, "\"points\": []");
    expect_in(result, result->err, "scene.png: 4 junctions, 0 directions\n");
    result = run_cli("detect", "-f", "json", "scene.png", NULL);
    assert_null(strstr(result->out, "vanishing_points"));
    assert_null(strstr(result->err, "direction"));
    result = run_cli("detect", "--vanishing-points", "scene.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--vanishing-points go into JSON, or a plot");
    result = run_cli("detect", "-f", "json", "--camera", "600,600,159.5,119.5", "scene.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "a camera changes nothing without --vanishing-points");
    result = run_cli("detect", "-f", "json", "--vanishing-points", "--camera", "0,600,320,240", "scene.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "is not FX,FY,CX,CY");
}

/* Numbers in another order are no camera; those of another size, or of a whole that this was cut from, are doubted. */
static void a_camera_of_another_image_is_refused(void **state)
{
    static const struct {
        const char *camera, *message;
        int code;
    } cases[] = {
        {"160,120,600,600", "asj-cli: scene.png: --camera: the principal point is outside of the image; FX,FY,CX,CY: is this "
                            "CX,CY,FX,FY? (160,120,600,600, image 320 x 240)\n", 1},
        {"1200,1200,500,120", "warning: scene.png: --camera: the principal point is outside of the image; is it the camera of the "
                              "picture at another size, or before it was cut? (1200,1200,500,120, image 320 x 240)\n", 0},
        {"300,300,-1,120", "the principal point is outside of the image; is it the camera of the picture at another size", 0},
        {"160,120,200,200", "warning: scene.png: --camera: the principal point is far from the middle; FX,FY,CX,CY: is this", 0},
        {"150,150,79,60", "the principal point is far from the middle; is it the camera of the picture at another size", 0},
        {"160,120,180,140", "the focal lengths differ; FX,FY,CX,CY: is this CX,CY,FX,FY?", 0},
    };
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        const outcome *result = run_cli("detect", "-f", "json", "--vanishing-points", "--camera", cases[k].camera, "scene.png",
                                        NULL);
        expect_code(result, cases[k].code);
        expect_in(result, result->err, cases[k].message);
        result = run_cli("detect", "-q", "-f", "json", "--vanishing-points", "--camera", cases[k].camera, "scene.png", NULL);
        assert_int_equal(*result->err != 0, cases[k].code != 0);
    }
    static const char *const good[] = {"300,300,160,120", "300,310,80,60", "300,300,240,180", "600,300,160,120"}; /* the last one:
                                                                                     * pixels that are no squares */
    for (size_t k = 0; k < sizeof good / sizeof good[0]; k++)
        assert_null(strstr(run_cli("detect", "-f", "json", "--vanishing-points", "--camera", good[k], "scene.png", NULL)->err,
                           "--camera"));
}

/* The square of the scene: eight branches, four edges. */
static void lines_come_each_once(void **state)
{
    static const char head[] = "x1,y1,x2,y2,sd1,sd2,end1,end2,junction1,junction2,log10_nfa,junction,branch,branches\n";
    (void)state;
    const outcome *result = run_cli("detect", "--lines", "scene.png", NULL);
    expect_code(result, 0);
    assert_memory_equal(result->out, head, sizeof head - 1);
    size_t lines = 0;
    for (const char *at = result->out; (at = strchr(at, '\n')); at++)
        lines++;
    assert_int_equal(lines, 1 + 4);
    expect_in(result, result->err, "4 junctions, 4 lines");
    result = run_cli("detect", "--lines", "-f", "json", "scene.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->out, "\"lines\": 4");
    expect_in(result, result->out, "\"junctions\": [\n{");
    static const char *const others[][2] = {{"-f", "asj"}, {"-f", "asjf"}, {"-o", "x.asj"}, {"-o", "x.asjf"}};
    for (size_t k = 0; k < sizeof others / sizeof others[0]; k++) {
        result = run_cli("detect", "--lines", others[k][0], others[k][1], "scene.png", NULL);
        expect_code(result, 2);
        expect_in(result, result->err, "--lines go into CSV or JSON");
    }
    result = run_cli("detect", "--lines", "--out-dir", "lines", "scene.png", NULL);
    expect_code(result, 0);
    assert_true(exists("lines/scene.csv"));
}

static void an_option_reaches_the_detector(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "--minimum-length", "500", "scene.png", NULL);
    expect_code(result, 0);
    assert_string_equal(result->out, "0\n");
    expect_in(result, result->err, "0 junctions");
}

static void times_are_printed_on_request(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "--time", "-q", "scene.png", NULL);
    expect_code(result, 0);
    for (int32_t stage = ASJ_STAGE_GRADIENT; stage <= ASJ_STAGE_DECOMPOSE; stage++)
        expect_in(result, result->err, asj_stage_name(stage));
    expect_in(result, result->err, "scene.png: 320 x 240");
    expect_in(result, result->err, "reading");
    assert_null(strstr(result->out, "reading"));
    assert_null(strstr(result->err, "  lines "));
    result = run_cli("detect", "--time", "-q", "--lines", "scene.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "  lines ");
}

static void no_progress_without_a_terminal(void **state)
{
    (void)state;
    const outcome *result = run_cli("detect", "scene.png", NULL);
    assert_null(strchr(result->err, '\r'));
    assert_null(strchr(result->err, '\033'));
}

static void threads_do_not_change_the_result(void **state)
{
    (void)state;
    expect_code(run_cli("detect", "-q", "--threads", "1", "-o", "one.asj", "scene.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "--threads", "3", "-o", "three.asj", "scene.png", NULL), 0);
    size_t size = 0;
    char *one = read_bytes("one.asj", &size);
    assert_non_null(one);
    expect_file("three.asj", one);
    free(one);
}

/* The best and the portable form are always there; of x86 and ARM one is not. */
static void forms_do_not_change_the_result(void **state)
{
    static const char *const forms[] = {"reference", "sse2", "avx2", "avx512", "neon"};
    int missing = 0;
    (void)state;
    expect_code(run_cli("detect", "-q", "--simd", "auto", "-o", "best.asj", "scene.png", NULL), 0);
    size_t size = 0;
    char *best = read_bytes("best.asj", &size);
    assert_non_null(best);
    for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++) {
        const outcome *result = run_cli("detect", "-q", "--simd", forms[i], "-o", "form.asj", "scene.png", NULL);
        if (i == 0 || result->code == 0) {
            expect_code(result, 0);
            expect_file("form.asj", best);
            continue;
        }
        missing++;
        expect_code(result, 1);
        expect_in(result, result->err, forms[i]);
        expect_in(result, result->err, " vector instructions: ");
    }
    assert_true(missing >= 1);
    free(best);
}

static void empty_images_give_no_junctions(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {1, 50}, {50, 1}, {2, 2}, {100, 80}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        write_constant("flat.png", sizes[i][0], sizes[i][1]);
        const outcome *result = run_cli("detect", "flat.png", NULL);
        expect_code(result, 0);
        assert_string_equal(result->out, "0\n");
    }
}

static void many_images_go_to_a_folder(void **state)
{
    (void)state;
    assert_int_equal(mkdir("many", 0777), 0);
    assert_int_equal(mkdir("in", 0777), 0);
    write_scene("in/first.png");
    write_scene("in/second.of.all.png");
    write_scene("in/.hidden");
    write_scene("-dash");
    const outcome *result = run_cli("detect", "-f", "json", "--out-dir", "many/", "in/first.png", "in/second.of.all.png",
                                    "in/.hidden", "--", "-dash", NULL);
    expect_code(result, 0);
    expect_empty(result, "standard output", result->out);
    expect_scene("many/first.json");
    expect_scene("many/second.of.all.json");
    expect_scene("many/.hidden.json");
    expect_scene("many/-dash.json");
    assert_int_equal(count_files("many"), 4);
}

static void existing_results_are_replaced(void **state)
{
    (void)state;
    write_bytes("old.asj", "old", 3);
    expect_code(run_cli("detect", "-q", "-o", "old.asj", "scene.png", NULL), 0);
    expect_scene("old.asj");
}

enum { IMAGES = 500 };

/* The same image under many names, with a new folder for the results. */
static void list_many_images(const char *folder, const char *arguments[IMAGES + 4])
{
    static char names[IMAGES][16];
    arguments[0] = "detect";
    arguments[1] = "--out-dir";
    arguments[2] = folder;
    arguments[3 + IMAGES] = NULL;
    assert_int_equal(mkdir(folder, 0777), 0);
    for (size_t i = 0; i < IMAGES; i++) {
        snprintf(names[i], sizeof names[i], "link%zu.png", i);
        if (!exists(names[i]))
            assert_int_equal(symlink("scene.png", names[i]), 0);
        arguments[3 + i] = names[i];
    }
}

static void an_interrupt_leaves_only_whole_results(void **state)
{
    (void)state;
    const char *arguments[IMAGES + 4];
    const struct timespec pause = {0, 1000000};
    list_many_images("stopped", arguments);
    pid_t process = start_cli(CAPTURED, CAPTURED, arguments);
    while (!exists("stopped/link0.asj") && kill(process, 0) == 0)
        nanosleep(&pause, NULL);
    assert_int_equal(kill(process, SIGINT), 0);
    const outcome *result = finish_cli(process);
    expect_code(result, 130);
    expect_in(result, result->err, "asj-cli: interrupted at link");
    int done = 0;
    for (size_t i = 0; i < IMAGES; i++) {
        char path[40];
        snprintf(path, sizeof path, "stopped/link%zu.asj", i);
        if (exists(path)) {
            expect_scene(path);
            done++;
        }
    }
    assert_in_range(done, 1, IMAGES - 1);
    assert_int_equal(count_files("stopped"), done); /* no file with another name */
}

/* A terminal: the end for the program, and the end to read from. 0 = there is none. */
static int open_terminal(int *inner, int *terminal)
{
    *terminal = posix_openpt(O_RDWR | O_NOCTTY);
    if (*terminal < 0 || grantpt(*terminal) != 0 || unlockpt(*terminal) != 0)
        return 0;
    *inner = open(ptsname(*terminal), O_RDWR | O_NOCTTY);
    return *inner >= 0;
}

/* Reads until a line of progress with `name` in it has come (1), or the end (0). */
static int sees_progress(int terminal, const char *name)
{
    char text[4096];
    size_t used = 0;
    ssize_t count;
    while (used < sizeof text - 1 && (count = read(terminal, text + used, sizeof text - 1 - used)) > 0) {
        used += (size_t)count;
        text[used] = '\0';
        const char *line = strstr(text, "\r\033[K");
        line = line ? strstr(line, name) : NULL;
        if (line && strstr(line, " %"))
            return 1;
        if (used > sizeof text / 2) {
            memmove(text, text + used - 200, 200);
            used = 200;
        }
    }
    return 0;
}

static void progress_is_shown_on_a_terminal(void **state)
{
    (void)state;
    const char *arguments[IMAGES + 4];
    int terminal, end = -1;
    if (!open_terminal(&end, &terminal)) {
        print_message("[  NOTE    ] there is no terminal: not tested\n");
        skip();
    }
    list_many_images("watched", arguments);
    pid_t process = start_cli(CAPTURED, end, arguments);
    close(end);
    int seen = sees_progress(terminal, "/500] link");
    kill(process, SIGTERM);
    close(terminal);
    const outcome *result = finish_cli(process);
    assert_int_equal(seen, 1);
    expect_code(result, 128 + SIGTERM);
}

/* The first line of progress comes from the middle of a detection. */
static void an_interrupt_stops_a_detection_in_the_middle(void **state)
{
    (void)state;
    static const char *const arguments[] = {"detect", "--threads", "1", "-o", "middle/large.asj", "large.png", NULL};
    int terminal, end = -1;
    if (!open_terminal(&end, &terminal)) {
        print_message("[  NOTE    ] there is no terminal: not tested\n");
        skip();
    }
    assert_int_equal(mkdir("middle", 0777), 0);
    write_constant("large.png", 4000, 3000);
    pid_t process = start_cli(CAPTURED, end, arguments);
    close(end);
    if (!sees_progress(terminal, "large.png: ")) {
        expect_code(finish_cli(process), 0);
        print_message("[  NOTE    ] this machine was too fast: not tested\n");
        skip();
    }
    kill(process, SIGINT);
    const outcome *result = finish_cli(process);
    close(terminal);
    expect_code(result, 130);
    assert_int_equal(count_files("middle"), 0);
}

/* The left half by either way, and nothing under a mask that is black. */
static void only_a_part_of_the_image_on_request(void **state)
{
    (void)state;
    enum { HALF = SCENE_WIDTH / 2 };
    char message[256];
    static unsigned char pixels[SCENE_WIDTH * SCENE_HEIGHT];
    for (int i = 0; i < SCENE_WIDTH * SCENE_HEIGHT; i++)
        pixels[i] = (unsigned char)(i % SCENE_WIDTH < HALF ? 9 : 0);
    asj_image mask = {pixels, ASJ_FORMAT_GRAY8, SCENE_WIDTH, SCENE_HEIGHT, 0, 0};
    assert_int_equal(asj_png_write("left.png", &mask, message, sizeof message), ASJ_OK);
    write_constant("small.png", 10, 10);
    const outcome *result = run_cli("detect", "-o", "part.asj", "--region", "0,0,160,240", "scene.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "scene.png: 2 junctions");
    result = run_cli("detect", "-o", "masked.asj", "--mask", "left.png", "scene.png", NULL);
    expect_code(result, 0);
    size_t size;
    char *text = read_bytes("part.asj", &size);
    assert_non_null(text);
    expect_file("masked.asj", text);
    free(text);
    result = run_cli("detect", "--out-dir", "masked", "--mask", "none.png", "scene.png", "left.png", NULL);
    expect_code(result, 1);
    const char *told = strstr(result->err, "none.png: cannot open");
    assert_true(told && !strstr(told + 1, "none.png") && !exists("masked")); /* once, and no folder */
    result = run_cli("detect", "--mask", "small.png", "scene.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "small.png: this mask has another size than an image of 320 x 240 pixels");
    result = run_cli("detect", "--region", "100,100,221,20", "scene.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "scene.png: the region 100,100,221,20 is not within the image of 320 x 240 pixels\n");
    write_deep_scene("deep_mask.png", 65535);
    result = run_cli("detect", "--mask", "deep_mask.png", "scene.png", NULL);
    expect_in(result, result->err, "deep_mask.png: a mask is an 8-bit gray image, and this one has 16 bits\n");
    write_bytes("colour.ppm", "P3 1 1 255 1 2 3\n", 17);
    result = run_cli("detect", "--mask", "colour.ppm", "scene.png", NULL);
    expect_in(result, result->err, "colour.ppm: a mask is an 8-bit gray image, and this one is in colour\n");
    memset(pixels, 0, sizeof pixels);
    assert_int_equal(asj_png_write("black.png", &mask, message, sizeof message), ASJ_OK);
    result = run_cli("match", "--region1", "0,0,160,240", "--mask2", "black.png", "-o", "m.csv", "scene.png", "scene.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, ": 0 matches");
}

/* Samples of 10 bits in 16: corners are far too weak, which is told, until white is. */
static void white_can_be_told(void **state)
{
    (void)state;
    write_deep_scene("deep.png", 1023);
    write_deep_scene("full.png", 65535);
    const outcome *result = run_cli("detect", "deep.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "deep.png: brightest pixel is 1.5 % of white: --white 1023?\n");
    assert_null(strstr(result->err, "weaker corners"));
    expect_code(run_cli("detect", "-o", "deep.asj", "--white", "1023", "deep.png", NULL), 0);
    expect_code(run_cli("detect", "-o", "full.asj", "full.png", NULL), 0);
    result = run_cli("detect", "--white", "1023", "deep.png", NULL);
    expect_in(result, result->err, "deep.png: 4 junctions\n");
    assert_null(strstr(result->err, "--white"));
    result = run_cli("detect", "--white", "255", "scene.png", NULL);
    expect_in(result, result->err, "scene.png: 4 junctions\n");
    static const char *const others[] = {"scene.png", "full.png"}; /* whose white is another: they stay as they are */
    for (size_t k = 0; k < sizeof others / sizeof others[0]; k++) {
        char *before = strdup(run_cli("detect", others[k], NULL)->out);
        assert_non_null(before);
        assert_string_equal(run_cli("detect", "--white", "4095", others[k], NULL)->out, before);
        free(before);
    }
    assert_null(strstr(run_cli("detect", "full.png", NULL)->err, "--white"));
    expect_empty(result, "standard error", run_cli("detect", "-q", "deep.png", NULL)->err);
    result = run_cli("match", "deep.png", "deep.png", NULL);
    expect_in(result, result->err, "deep.png: brightest pixel is 1.5 % of white: --white 1023?\n");
    assert_null(strstr(result->err, "hint"));
    assert_null(strstr(run_cli("match", "--white", "1023", "deep.png", "full.png", NULL)->err, "of white"));
    expect_code(run_cli("detect", "-q", "-o", "deep.asjf", "--white", "1023", "deep.png", NULL), 0);
    result = run_cli("match", "--white", "1023", "deep.asjf", "deep.asjf", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--white changes nothing: features have no pixels");
    result = run_cli("detect", "--white", "0", "deep.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--white: '0' is not a number in 1e-06 .. 1e+09");
}

/* Floats of 0 to 255, where white is 1: all is white, which is told, until white is. */
static void white_of_floats_can_be_told(void **state)
{
    (void)state;
    write_float_scene("unit.pfm", 1);
    write_float_scene("bytes.pfm", 255);
    write_float_scene("words.pfm", 65535);
    const outcome *result = run_cli("detect", "unit.pfm", NULL);
    expect_in(result, result->err, "unit.pfm: 4 junctions\n");
    assert_null(strstr(result->err, "--white"));
    result = run_cli("detect", "bytes.pfm", NULL);
    expect_in(result, result->err, "bytes.pfm: most pixels are brighter than white, 1 in floats: --white 255?\n");
    assert_null(strstr(result->err, "weaker corners"));
    result = run_cli("detect", "--white", "255", "bytes.pfm", NULL);
    expect_in(result, result->err, "bytes.pfm: 4 junctions\n");
    assert_null(strstr(result->err, "--white"));
    result = run_cli("detect", "-d", "floats", "unit.pfm", "bytes.pfm", "words.pfm", NULL);
    expect_in(result, result->err, "\n3 images done, 2 with most pixels brighter than white (--white 65535?)\n");
    result = run_cli("match", "bytes.pfm", "unit.pfm", NULL);
    expect_in(result, result->err, "bytes.pfm: most pixels are brighter than white");
    assert_null(strstr(result->err, "hint"));
    write_float_scene("huge.pfm", 1e38F); /* no white that the option takes */
    result = run_cli("detect", "huge.pfm", NULL);
    expect_in(result, result->err, "white, 1 in floats: up to 9.5e+37, and --white goes up to 1e+09\n");
    result = run_cli("detect", "-d", "floats", "huge.pfm", "unit.pfm", NULL);
    expect_in(result, result->err, "brighter than white (up to 9.5e+37, and --white goes up to 1e+09)\n");
}

/* Colours of 16 bits are read as grey levels: who asks for them is told, once. */
static void deep_images_have_no_colours(void **state)
{
    static const char warning[] = "warning: deep.png: --colours looks at 8-bit colours";
    (void)state;
    write_deep_scene("deep.png", 65535);
    write_deep_scene("full.png", 65535);
    const outcome *result = run_cli("detect", "--colours", "yes", "-d", "deep", "scene.png", "deep.png", "full.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, warning);
    assert_null(strstr(strstr(result->err, warning) + 1, "warning"));
    assert_null(strstr(run_cli("detect", "--colours", "yes", "scene.png", NULL)->err, "warning"));
    assert_null(strstr(run_cli("detect", "deep.png", NULL)->err, "warning"));
    assert_null(strstr(run_cli("detect", "-q", "--colours", "yes", "deep.png", NULL)->err, "warning"));
    result = run_cli("match", "--colours", "yes", "scene.png", "deep.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, warning);
}

/* The scene as an animated PNG of two frames: acTL behind IHDR. */
static void write_animated_scene(const char *path)
{
    static const char control[] = "\x00\x00\x00\x08" "acTL" "\x00\x00\x00\x02\x00\x00\x00\x00\xf3\x8d\x93\x70";
    const size_t added = sizeof control - 1, at = 8 + 25;
    size_t size;
    char *scene = read_bytes("scene.png", &size), *bytes = malloc(size + added);
    assert_non_null(scene);
    assert_non_null(bytes);
    memcpy(bytes, scene, at);
    memcpy(bytes + at, control, added);
    memcpy(bytes + at + added, scene + at, size - at);
    write_bytes(path, bytes, size + added);
    free(bytes);
    free(scene);
}

static void pictures_behind_the_first_are_told_once(void **state)
{
    static const char warning[] = "warning: moving.png holds several pictures, of which the first is read\n";
    (void)state;
    write_animated_scene("moving.png");
    write_animated_scene("again.png");
    const outcome *result = run_cli("detect", "-d", "moving", "scene.png", "moving.png", "again.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, warning);
    assert_null(strstr(strstr(result->err, warning) + 1, "warning"));
    assert_null(strstr(run_cli("detect", "-q", "moving.png", NULL)->err, "warning"));
    result = run_cli("match", "scene.png", "moving.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, warning);
}

/* One image has its hint at once; many have one line for all of them, at the end. */
static void many_images_have_one_line_of_hints(void **state)
{
    (void)state;
    write_nearly_constant("flat.png", 60, 40);
    write_nearly_constant("tiny.png", 15, 60);
    write_constant("black.png", 15, 60);
    write_deep_scene("dim.png", 1023);
    write_deep_scene("dimmer.png", 600);
    const outcome *result = run_cli("detect", "-d", "hinted", "flat.png", NULL);
    expect_in(result, result->err, "flat.png: weaker corners are found with --epsilon 100 --candidate-strength 2\n");
    assert_null(strstr(result->err, "done"));
    result = run_cli("detect", "-d", "hinted", "tiny.png", NULL);
    assert_null(strstr(result->err, "weaker"));
    expect_in(result, run_cli("detect", "-d", "hinted", "black.png", NULL)->err, "black.png: no contrast: all pixels are alike\n");
    result = run_cli("detect", "-d", "hinted", "flat.png", "tiny.png", "dim.png", "none.png", "dimmer.png", "scene.png",
                     "black.png", NULL);
    expect_code(result, 1);
    expect_in(result, result->err, "\n6 images done, 1 failed, 1 without contrast, 1 without a junction (weaker corners are "
                                   "found with --epsilon 100 --candidate-strength 2), 2 far darker than white (--white 1023?)\n");
    assert_null(strstr(result->err, "flat.png: weaker"));
    assert_null(strstr(result->err, "dim.png: brightest"));
    result = run_cli("detect", "-d", "hinted", "--epsilon", "100", "--candidate-strength", "2", "flat.png", "scene.png", NULL);
    expect_in(result, result->err, "\n2 images done, 1 without a junction\n");
    expect_in(result, run_cli("detect", "-d", "hinted", "none.png", "nor.png", NULL)->err, "\n0 images done, 2 failed\n");
    expect_empty(result, "standard error", run_cli("detect", "-q", "-d", "hinted", "flat.png", "scene.png", NULL)->err);
}

static int make_files(void **state)
{
    (void)state;
    write_scene("scene.png");
    return 0;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_go_to_standard_output_and_words_to_standard_error),
        cmocka_unit_test(the_name_or_the_option_chooses_the_format),
        cmocka_unit_test(whole_junctions_are_written_on_request),
        cmocka_unit_test(the_preset_comes_first_wherever_it_stands),
        cmocka_unit_test(directions_are_written_on_request),
        cmocka_unit_test(white_can_be_told),
        cmocka_unit_test(white_of_floats_can_be_told),
        cmocka_unit_test(deep_images_have_no_colours),
        cmocka_unit_test(pictures_behind_the_first_are_told_once),
        cmocka_unit_test(many_images_have_one_line_of_hints),
        cmocka_unit_test(a_camera_of_another_image_is_refused), cmocka_unit_test(lines_come_each_once),
        cmocka_unit_test(an_option_reaches_the_detector),
        cmocka_unit_test(times_are_printed_on_request),
        cmocka_unit_test(no_progress_without_a_terminal),
        cmocka_unit_test(threads_do_not_change_the_result),
        cmocka_unit_test(forms_do_not_change_the_result),
        cmocka_unit_test(empty_images_give_no_junctions),
        cmocka_unit_test(many_images_go_to_a_folder),
        cmocka_unit_test(existing_results_are_replaced),
        cmocka_unit_test(an_interrupt_leaves_only_whole_results),
        cmocka_unit_test(progress_is_shown_on_a_terminal),
        cmocka_unit_test(an_interrupt_stops_a_detection_in_the_middle),
        cmocka_unit_test(only_a_part_of_the_image_on_request),
    };
    program_start(argc, argv);
    return program_end(cmocka_run_group_tests(tests, make_files, NULL));
}
