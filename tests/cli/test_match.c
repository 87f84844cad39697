/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli match: what it writes, where, and what it says. */
#define _POSIX_C_SOURCE 200809L
#include "files.h"
#include "match_table.h"
#include "program.h"

#include <asj/context.h>
#include <asj/match.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <math.h>
#include <signal.h>
#include <time.h>

/* Location, both ends and the map agree with the views. */
static int is_true(const double *row)
{
    const double *h = row + H11;
    return transfer_error(row[X1], row[Y1], row[X2], row[Y2]) < 1 && transfer_error(row[AX1], row[AY1], row[AX2], row[AY2]) < 3 &&
           transfer_error(row[BX1], row[BY1], row[BX2], row[BY2]) < 3 &&
           fabs(h[0] * row[X1] + h[1] * row[Y1] + h[2] - row[X2]) < 0.01 &&
           fabs(h[3] * row[X1] + h[4] * row[Y1] + h[5] - row[Y2]) < 0.01 && fabs(h[0] - VIEW_SCALE) < 0.1 && fabs(h[1]) < 0.1 &&
           fabs(h[3]) < 0.1 && fabs(h[4] - VIEW_SCALE) < 0.1;
}

/* At least twenty of the wall's fifty-two corners, and nearly all of them right. */
static void expect_true(const table *t)
{
    size_t good = 0;
    for (size_t k = 0; k < t->count; k++)
        good += (size_t)is_true(t->rows[k]);
    if (t->count < 20 || good < t->count - t->count / 10)
        fail_msg("%zu of %zu matches are true", good, t->count);
    for (size_t k = 1; k < t->count; k++)
        assert_true(t->rows[k - 1][DISTANCE] <= t->rows[k][DISTANCE]);
}

static table found, other;

static void matches_go_to_standard_output_and_words_to_standard_error(void **state)
{
    (void)state;
    const outcome *result = run_cli("match", "--stretch", "1", "first.png", "second.png", NULL);
    expect_code(result, 0);
    parse_csv(result->out, &found);
    expect_true(&found);
    char words[80];
    snprintf(words, sizeof words, "first.png, second.png: %zu matches\n", found.count);
    assert_string_equal(result->err, words);
    result = run_cli("match", "-q", "--stretch", "1", "-o", "m.csv", "first.png", "second.png", NULL);
    expect_code(result, 0);
    expect_empty(result, "standard output", result->out);
    expect_empty(result, "standard error", result->err);
    read_csv("m.csv", &other);
    assert_int_equal(other.count, found.count);
    assert_memory_equal(other.rows, found.rows, found.count * sizeof found.rows[0]);
}

static void the_name_or_the_option_chooses_the_format(void **state)
{
    (void)state;
    static const struct {
        const char *path, *format, *beginning;
    } cases[] = {
        {"a.csv", NULL, MATCH_HEADER}, {"a.json", NULL, "{\n\"schema\": \"asj-matches-1\""}, {"a.txt", NULL, MATCH_HEADER},
        {"b.csv", "json", "{"}, {"b.json", "csv", MATCH_HEADER},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        size_t size = 0;
        if (cases[i].format)
            expect_code(run_cli("match", "--stretch", "1", "-o", cases[i].path, "first.png", "second.png", "--format",
                                cases[i].format, NULL), 0);
        else
            expect_code(run_cli("match", "--stretch", "1", "-o", cases[i].path, "first.png", "second.png", NULL), 0);
        char *bytes = read_bytes(cases[i].path, &size);
        assert_non_null(bytes);
        bytes[strlen(cases[i].beginning)] = '\0';
        assert_string_equal(bytes, cases[i].beginning);
        free(bytes);
    }
}

static const double *row_with(const table *t, double i, double j)
{
    for (size_t k = 0; k < t->count; k++)
        if (t->rows[k][I] == i && t->rows[k][J] == j)
            return t->rows[k];
    return NULL;
}

/* Locations that an alignment moved differ by what the two directions of the alignment differ. */
static void swapped_images_give_swapped_matches(void **state)
{
    (void)state;
    expect_code(run_cli("match", "-q", "-o", "there.csv", "first.png", "second.png", NULL), 0);
    expect_code(run_cli("match", "-q", "-o", "back.csv", "second.png", "first.png", NULL), 0);
    read_csv("there.csv", &found);
    read_csv("back.csv", &other);
    assert_true(found.count > 0);
    assert_int_equal(found.count, other.count);
    for (size_t k = 0; k < found.count; k++) {
        const double *row = found.rows[k], *back = row_with(&other, row[J], row[I]);
        assert_non_null(back);
        assert_true(hypot(row[X1] - back[X2], row[Y1] - back[Y2]) < 5);
        assert_true(hypot(row[X2] - back[X1], row[Y2] - back[Y1]) < 5);
    }
}

static void no_match_is_a_result(void **state)
{
    (void)state;
    write_constant("flat.png", 60, 40);
    write_constant("dot.png", 1, 1);
    const outcome *result = run_cli("match", "first.png", "flat.png", NULL);
    expect_code(result, 0);
    assert_string_equal(result->out, MATCH_HEADER);
    expect_in(result, result->err, "first.png, flat.png: 0 matches");
    expect_in(result, result->err, "hint: flat.png has no contrast: all its pixels are alike");
    result = run_cli("match", "--region2", "0,0,2,2", "first.png", "second.png", NULL);
    expect_in(result, result->err, "hint: second.png, in its region, has no corner that is surer than chance");
    write_bytes("none.asj", "0\n", 2);
    result = run_cli("match", "--junctions1", "none.asj", "first.png", "second.png", NULL);
    expect_in(result, result->err, "hint: none.asj has 0 corners");
    write_noise("small.png", 160, 120);
    write_noise("large.png", 650, 480);
    result = run_cli("match", "large.png", "small.png", NULL);
    expect_in(result, result->err, "hint: large.png is 4.0 times as large as small.png");
    expect_in(result, result->err, "after 'asj-cli detect --first-octave 2 -o x.asjf'");
    result = run_cli("match", "--minimum-support", "60", "first.png", "second.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "0 matches");
    expect_in(result, result->err, "for views far apart try --geometry auto");
    result = run_cli("match", "-q", "dot.png", "flat.png", NULL);
    expect_code(result, 0);
    assert_string_equal(result->out, MATCH_HEADER);
    result = run_cli("match", "-q", "--lines", "-f", "json", "dot.png", "flat.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->out, "\"matches\": [],\n\"lines\": [],\n\"l_junctions1\": []");
}

/* Runs detect with the options that match has, each by its name. */
static void detect_for_match(const char *image, const char *file)
{
    static char names[64][80], values[64][64];
    const char *arguments[MOST_ARGUMENTS + 1] = {"detect", "-q", "-o", file, image};
    asj_detect_options options;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    assert_true(asj_detect_option_count() <= 64);
    for (size_t i = 0; i < asj_detect_option_count(); i++) {
        const char *key = asj_detect_option(i)->key;
        assert_int_equal(asj_detect_options_get(&options, key, values[i], sizeof values[i]), ASJ_OK);
        snprintf(names[i], sizeof names[i], "--%s", key);
        for (char *c = names[i]; *c; c++)
            if (*c == '_')
                *c = '-';
        arguments[5 + 2 * i] = names[i];
        arguments[6 + 2 * i] = values[i];
    }
    expect_code(run_cli_list(arguments), 0);
}

/* Detecting first and matching then is the same as both at once, of the images as they are. */
static void junctions_come_from_files(void **state)
{
    (void)state;
    detect_for_match("first.png", "1.json");
    detect_for_match("second.png", "2.json");
    const outcome *result = run_cli("match", "-q", "--stretch", "1", "first.png", "second.png", NULL);
    expect_code(result, 0);
    parse_csv(result->out, &found);
    result = run_cli("match", "-q", "first.png", "second.png", "--junctions1", "1.json", "--junctions2", "2.json", NULL);
    expect_code(result, 0);
    parse_csv(result->out, &other);
    assert_int_equal(found.count, other.count);
    assert_memory_equal(found.rows, other.rows, found.count * sizeof found.rows[0]);
    expect_code(run_cli("detect", "-q", "-o", "2.asj", "second.png", NULL), 0);
    result = run_cli("match", "-q", "first.png", "second.png", "--junctions2", "2.asj", NULL);
    expect_code(result, 0);
    parse_csv(result->out, &other);
    expect_true(&other);
}

/* The preset match makes detect write what match would detect: the same matches, bit by bit through JSON. Through .asj, which knows
 * no octaves, so that the preset has one for it, and whose six decimals are fewer than a float has, the alignment of a few ends
 * elsewhere, by 0.11 px at most here. */
static void the_preset_match_detects_for_match(void **state)
{
    (void)state;
    detect_for_match("first.png", "1.json");
    expect_code(run_cli("detect", "-q", "--preset", "match", "-o", "1p.json", "first.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "--for", "matching", "-o", "1f.json", "first.png", NULL), 0);
    const outcome *result = run_cli("match", "-q", "--stretch", "1", "first.png", "second.png", NULL);
    expect_code(result, 0);
    parse_csv(result->out, &found);
    assert_true(found.count > 10);
    static const char *const files[] = {"1p.json", "1f.json"};
    for (size_t i = 0; i < 2; i++) {
        result = run_cli("match", "-q", "--junctions1", files[i], "first.png", "second.png", NULL);
        expect_code(result, 0);
        parse_csv(result->out, &other);
        assert_int_equal(found.count, other.count);
        assert_memory_equal(found.rows, other.rows, found.count * sizeof found.rows[0]);
    }
    result = run_cli("match", "-q", "--stretch", "1", "--octaves", "1", "first.png", "second.png", NULL);
    expect_code(result, 0);
    parse_csv(result->out, &found);
    expect_code(run_cli("detect", "-q", "--preset", "match", "-o", "1p.asj", "first.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "--preset", "match", "--octaves", "1", "-o", "2p.asj", "second.png", NULL), 0);
    result = run_cli("match", "-q", "--junctions1", "1p.asj", "--junctions2", "2p.asj", "first.png", "second.png", NULL);
    expect_code(result, 0);
    parse_csv(result->out, &other);
    assert_int_equal(found.count, other.count);
    for (size_t k = 0; k < found.count; k++) {
        size_t m = 0;
        while (m < other.count && (other.rows[m][I] != found.rows[k][I] || other.rows[m][J] != found.rows[k][J]))
            m++;
        assert_true(m < other.count);
        for (int c = X1; c <= BY2; c++)
            assert_true(fabs(found.rows[k][c] - other.rows[m][c]) < 0.25); /* px */
    }
}

/* Ten junctions, the weakest of them with this log10 NFA. */
static void write_junctions(const char *path, double weakest)
{
    char text[1024];
    int used = snprintf(text, sizeof text, "10\n");
    for (int i = 0; i < 10; i++)
        used += snprintf(text + used, sizeof text - (size_t)used, "%d 50\n2 7 7 %g\n0 5 30\n1.5 5 30\n", 40 + 20 * i,
                         weakest != 0 ? weakest - i : 0);
    write_bytes(path, text, (size_t)used);
}

/* A file with the surest junctions only, cut at an NFA of 1, is not for matching, and match says so: on photographs it gives few
 * matches. Files with weaker ones, files of clean pictures and files that know no NFA are no reason to, nor is matching by the
 * paper, which detects so itself. */
static void the_surest_junctions_give_a_warning(void **state)
{
    (void)state;
    static const struct {
        double weakest;
        const char *option, *value;
        int warns;
    } cases[] = {{-0.3, "--ratio", "1.5", 1}, {0.4, "--ratio", "1.5", 0}, {-5, "--ratio", "1.5", 0}, {0, "--ratio", "1.5", 0},
                 {-0.3, "--match-preset", "paper", 0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        write_junctions("sure.asj", cases[i].weakest);
        const outcome *result = run_cli("match", "first.png", "second.png", "--junctions1", "sure.asj", "--junctions2", "sure.asj",
                                        cases[i].option, cases[i].value, NULL);
        expect_code(result, 0);
        const char *first = strstr(result->err, "warning: sure.asj has only the surest junctions");
        assert_int_equal(first != NULL, cases[i].warns);
        assert_int_equal(first && strstr(first + 1, "warning: sure.asj"), cases[i].warns); /* of both images */
    }
    write_junctions("sure.asj", -0.3);
    const outcome *result = run_cli("match", "-q", "first.png", "second.png", "--junctions1", "sure.asj", NULL);
    expect_empty(result, "standard error", result->err);
}

static void expect_found_again(const outcome *result)
{
    expect_code(result, 0);
    parse_csv(result->out, &other);
    assert_int_equal(found.count, other.count);
    assert_memory_equal(found.rows, other.rows, found.count * sizeof found.rows[0]);
}

/* In pixels of the images as they are: junctions of both runs that lie at one place have their partners at one place. */
static void stretched_images_match_in_their_own_pixels(void **state)
{
    static const char *const stretches[] = {"2", "1,1.5"};
    (void)state;
    const outcome *result = run_cli("match", "-q", "first.png", "second.png", NULL);
    expect_code(result, 0);
    parse_csv(result->out, &found);
    for (size_t s = 0; s < 2; s++) {
        result = run_cli("match", "-q", "--stretch", stretches[s], "first.png", "second.png", NULL);
        expect_code(result, 0);
        parse_csv(result->out, &other);
        int common = 0;
        assert_true(other.count > 10);
        for (size_t k = 0; k < found.count; k++)
            for (size_t n = 0; n < other.count; n++) {
                const double *a = found.rows[k], *b = other.rows[n];
                if (hypot(a[X1] - b[X1], a[Y1] - b[Y1]) > 1)
                    continue;
                common++;
                assert_true(hypot(a[X2] - b[X2], a[Y2] - b[Y2]) < 2.5);
            }
        assert_true(common > 10);
    }
    expect_code(run_cli("match", "-q", "--stretch", "1,1.5", "-o", "s.json", "--lines", "first.png", "second.png", NULL), 0);
    size_t size = 0;
    char *text = read_bytes("s.json", &size);
    assert_non_null(text);
    assert_non_null(strstr(text, "\"stretch\": [1.0, 1.5]"));
    free(text);
}

/* As they are where that is enough, stretched where it is not; nobody has to ask for it. */
static void a_glancing_view_is_stretched_by_itself(void **state)
{
    (void)state;
    const outcome *result = run_cli("match", "-o", "auto.json", "--geometry", "auto", "first.png", "second.png", NULL);
    expect_code(result, 0);
    assert_null(strstr(result->err, "looked at stretched"));
    size_t size = 0;
    char *text = read_bytes("auto.json", &size);
    assert_non_null(strstr(text, "\"stretch\": [1.0, 1.0]"));
    free(text);
    write_flat_views("flat1.png", "flat2.png", 9);
    static const char *const models[] = {"none", "auto"};
    for (size_t m = 0; m < 2; m++) {
        result = run_cli("match", "-q", "--stretch", "1", "--geometry", models[m], "flat1.png", "flat2.png", NULL);
        expect_code(result, 0);
        parse_csv(result->out, &found);
        result = run_cli("match", "-o", "auto.csv", "--geometry", models[m], "flat1.png", "flat2.png", NULL);
        expect_code(result, 0);
        expect_in(result, result->err, "looked at stretched by 1,3");
        result = run_cli("match", "-q", "--geometry", models[m], "flat1.png", "flat2.png", NULL);
        parse_csv(result->out, &other);
        assert_true(other.count >= 16 && found.count < 16);
    }
    /* the paper has nothing of it */
    for (int k = 0; k < 2; k++) {
        result = run_cli("match", "--match-preset", "paper", "-o", k ? "as_it_is.csv" : "paper.csv", "flat1.png", "flat2.png",
                         k ? "--stretch" : NULL, "1", NULL);
        expect_code(result, 0);
        assert_null(strstr(result->err, "looked at stretched"));
    }
    size_t size2 = 0;
    char *paper = read_bytes("paper.csv", &size), *as_it_is = read_bytes("as_it_is.csv", &size2);
    assert_string_equal(paper, as_it_is);
    free(paper);
    free(as_it_is);
}

/* Colours of one luma are seen where a geometry is asked and the luma has none; the program says so. */
static void colours_are_looked_at_by_themselves(void **state)
{
    (void)state;
    write_coloured_views("c1.ppm", "c2.ppm");
    for (int k = 0; k < 2; k++) {
        const outcome *result =
            run_cli("match", "-o", "c.csv", "--geometry", "auto", "--look-at-colours", k ? "no" : "yes", "c1.ppm", "c2.ppm", NULL);
        expect_code(result, 0);
        read_csv("c.csv", &found);
        if (k == 0) {
            expect_in(result, result->err, "colours looked at, too");
            expect_in(result, result->err, "geometry: homography");
            assert_true(found.count >= 10);
            for (size_t n = 0; n < found.count; n++)
                assert_true(is_true(found.rows[n]));
        } else {
            assert_null(strstr(result->err, "colours looked at"));
            assert_true(found.count == 0);
            expect_in(result, result->err, "try --colours yes\n");
        }
    }
}

/* Where nothing matches and both images have colours that nobody has looked at, they are a thing to try. */
static void colours_are_hinted_at(void **state)
{
    static const struct {
        const char *second, *option, *value, *hint;
    } runs[] = {{"c2.ppm", "--geometry", "none", "alone, try --colours yes --geometry auto\n"},
                {"c2.ppm", "--colours", "yes", NULL},
                {"first.png", "--geometry", "none", NULL}};
    (void)state;
    write_coloured_views("c1.ppm", "c2.ppm");
    for (size_t k = 0; k < sizeof runs / sizeof runs[0]; k++) {
        const outcome *result = run_cli("match", "-o", "c.csv", runs[k].option, runs[k].value, "c1.ppm", runs[k].second, NULL);
        expect_code(result, 0);
        expect_in(result, result->err, ": 0 matches");
        if (runs[k].hint)
            expect_in(result, result->err, runs[k].hint);
        else
            assert_null(strstr(result->err, "try --colours"));
    }
    expect_code(run_cli("match", "-o", "c.csv", "--colours", "yes", "--geometry", "auto", "c1.ppm", "c2.ppm", NULL), 0);
    read_csv("c.csv", &found);
    assert_true(found.count >= 10);
}

/* One colour all over, or one that goes over into another from side to side, has no corners for --colours to find. */
static void smooth_colours_are_not_hinted_at(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        write_smooth_colours("smooth.ppm", k ? 60 : 0);
        const outcome *result = run_cli("match", "-o", "c.csv", "smooth.ppm", "smooth.ppm", NULL);
        expect_code(result, 0);
        expect_in(result, result->err, k ? "no corner that is surer than chance" : "no contrast");
        assert_null(strstr(result->err, "try --colours"));
    }
}

/* Where they have matches enough, whole images are looked at upsampled too: more matches, of the same places within what soft and
 * coarse edges are known to (3 px here), told in JSON. With --upsample-from it is left, or is not reached. */
static void whole_images_are_upsampled_by_themselves(void **state)
{
    (void)state;
    expect_code(run_cli("match", "-q", "--stretch", "1", "-o", "plain.csv", "first.png", "second.png", NULL), 0);
    read_csv("plain.csv", &other);
    for (int k = 0; k < 3; k++) {
        static const char *const from[] = {"20", "0", "1000"};
        size_t size = 0;
        expect_code(run_cli("match", "-q", "--upsample-from", from[k], "-o", "e.json", "first.png", "second.png", NULL), 0);
        char *text = read_bytes("e.json", &size);
        expect_code(run_cli("match", "-q", "--upsample-from", from[k], "-o", "e.csv", "first.png", "second.png", NULL), 0);
        read_csv("e.csv", &found);
        assert_non_null(strstr(text, k == 0 ? "\"upsampled\": true" : "\"upsampled\": false"));
        assert_non_null(strstr(text, "\"coloured\": false"));
        assert_true(k == 0 ? found.count > other.count : found.count == other.count);
        for (size_t n = 0; n < found.count; n++) {
            const double *row = found.rows[n];
            assert_true(transfer_error(row[X1], row[Y1], row[X2], row[Y2]) < 3);
        }
        free(text);
    }
    expect_code(run_cli("match", "-q", "-o", "e.csv", "first.png", "second.png", NULL), 0);
    read_csv("e.csv", &found);
    expect_code(run_cli("match", "-q", "--first-octave", "0", "-o", "named.csv", "first.png", "second.png", NULL), 0);
    read_csv("named.csv", &other);
    assert_true(found.count == other.count && memcmp(found.rows, other.rows, found.count * sizeof found.rows[0]) == 0);
    const outcome *result = run_cli("match", "--upsample-from", "9", "--stretch", "1", "first.png", "second.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--upsample-from changes nothing");
    expect_code(run_cli("match", "--upsample-from", "9", "--junctions1", "plain.csv", "first.png", "second.png", NULL), 2);
    static const char *const decided[][2] = {{"--first-octave", "-1"}, {"--first-octave", "1"}, {"--octaves", "1"}};
    for (size_t k = 0; k < sizeof decided / sizeof decided[0]; k++) {
        result = run_cli("match", "--upsample-from", "9", decided[k][0], decided[k][1], "first.png", "second.png", NULL);
        expect_code(result, 2);
        expect_in(result, result->err, "--upsample-from changes nothing");
    }
    static const char *const useless[][2] = {{"--first-octave", "-1"}, {"--octaves", "1"},    {"--stretch", "2"},
                                             {"--upsample-from", "0"},  {"--preset", "paper"}, {"--junctions1", "plain.csv"}};
    for (size_t k = 0; k < sizeof useless / sizeof useless[0]; k++) {
        result = run_cli("match", "--upsampled-half-octaves", "no", useless[k][0], useless[k][1], "first.png", "second.png", NULL);
        expect_code(result, 2);
        expect_in(result, result->err, k == 3 ? "--upsample-from 0" : "changes nothing");
    }
    result = run_cli("match", "--upsampled-max-junctions", "9", "--upsample-from", "0", "first.png", "second.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--upsampled-max-junctions changes nothing");
    expect_code(run_cli("match", "--upsampled-search-radius", "0", "--first-octave", "-1", "-q", "-o", "wide.csv", "first.png",
                        "second.png", NULL), 0);
    for (int k = 0; k < 2; k++) {
        result = run_cli("match", "--upsampled-shortlist", "2", k ? "--stretch" : "--upsampled-search-radius", k ? "2" : "0",
                         "first.png", "second.png", NULL);
        expect_code(result, 2);
        expect_in(result, result->err, "--upsampled-shortlist changes nothing");
    }
    result = run_cli("match", "--half-octaves", "yes", "--octaves", "1", "first.png", "second.png", NULL);
    expect_code(result, 2);
    expect_in(result, result->err, "--half-octaves changes nothing");
    for (int k = 0; k < 2; k++) {
        result = run_cli(k ? "match" : "detect", "--preset", "paper", "--complete-junctions", "yes", "first.png",
                         k ? "second.png" : NULL, NULL);
        expect_code(result, 2);
        expect_in(result, result->err, "--complete-junctions changes nothing");
    }
}

static void a_stretch_goes_with_images_alone(void **state)
{
    static const char *const wrong[][3] = {{"--junctions1", "x.asj", "junctions or features"}, {"--mask2", "x.png", "--mask2"},
                                           {"--region1", "0,0,9,9", "--region1"}};
    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
        const outcome *result = run_cli("match", "--stretch", "2", wrong[k][0], wrong[k][1], "first.png", "second.png", NULL);
        expect_code(result, 2);
        expect_in(result, result->err, "--stretch looks at");
        expect_in(result, result->err, wrong[k][2]);
    }
}

/* Features take the place of either image or of both, with the result of the images as they are; these may be gone. */
static void features_take_the_place_of_images(void **state)
{
    (void)state;
    const outcome *result = run_cli("match", "-q", "--stretch", "1", "first.png", "second.png", NULL);
    expect_code(result, 0);
    parse_csv(result->out, &found);
    assert_true(found.count > 10);
    expect_code(run_cli("detect", "-q", "-o", "1.asjf", "first.png", NULL), 0);
    expect_code(run_cli("detect", "-q", "-f", "asjf", "-d", ".", "second.png", NULL), 0);
    expect_found_again(run_cli("match", "-q", "1.asjf", "second.asjf", NULL));
    expect_found_again(run_cli("match", "-q", "1.asjf", "second.png", NULL));
    expect_found_again(run_cli("match", "-q", "first.png", "second.asjf", NULL));
    expect_code(run_cli("match", "-q", "-o", "f.json", "1.asjf", "second.asjf", NULL), 0);
    size_t size = 0;
    char *text = read_bytes("f.json", &size);
    assert_non_null(text);
    assert_non_null(strstr(text, "\"name\": \"1.asjf\""));
    assert_null(strstr(text, "detect_options"));
    free(text);
    if (!without_cairo)
        expect_code(run_cli("match", "-q", "-p", "f.png", "1.asjf", "second.png", NULL), 0);
    result = run_cli("detect", "-o", "1.asjf", "--preset", "default", "first.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "warning: features of --preset default");
    result = run_cli("match", "--geometry", "auto", "--focal", "300", "1.asjf", "second.asjf", NULL);
    expect_code(result, 0);
}

/* What came of the geometry stands on standard error, where one was asked for. */
static void what_the_geometry_is_is_told(void **state)
{
    (void)state;
    const outcome *result = run_cli("match", "--stretch", "1", "--geometry", "fundamental", "first.png", "second.png", NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "\ngeometry: ");
    result = run_cli("match", "--geometry", "essential", "--focal", "300", "first.png", "first.png", NULL);
    expect_in(result, result->err, "geometry: none (degenerate); what matches leaves the motion open");
    result = run_cli("match", "--stretch", "1", "--geometry", "homography", "first.png", "second.png", NULL);
    expect_in(result, result->err, "\ngeometry: homography, log10 NFA ");
    expect_in(result, result->err, " (matrix and probabilities: -o FILE.json)\n");
    result = run_cli("match", "-f", "json", "--stretch", "1", "--geometry", "homography", "first.png", "second.png", NULL);
    assert_null(strstr(result->err, "-o FILE.json"));
    result = run_cli("match", "-q", "--stretch", "1", "--geometry", "fundamental", "first.png", "second.png", NULL);
    assert_null(strstr(result->err, "geometry"));
    assert_null(strstr(run_cli("match", "--stretch", "1", "first.png", "second.png", NULL)->err, "geometry"));
}

/* A focal length that is none of these pixels is used as it is given, and doubted, also where doubling takes it out of range. */
static void views_that_no_camera_has_are_doubted(void **state)
{
    static const char *const focal[] = {"5", "9.9e6", "300"};
    (void)state;
    for (size_t k = 0; k < sizeof focal / sizeof *focal; k++) {
        const outcome *result = run_cli("match", "--stretch", "1", "--geometry", "auto", "--focal", focal[k], "first.png",
                                        "second.png", NULL);
        expect_code(result, 0);
        assert_int_equal(strstr(result->err, "is it in pixels of this image?") != NULL, k < 2);
        assert_null(strstr(result->err, "cannot be"));
        result = run_cli("match", "-q", "--stretch", "1", "--geometry", "auto", "--focal", focal[k], "first.png", "second.png",
                         NULL);
        expect_empty(result, "standard error", result->err);
    }
}

#ifdef ASJ_IMAGES
#define LENS ASJ_IMAGES "/lens.png" /* 30 px in its EXIF data */
#define NO_LENS ASJ_IMAGES "/gray.png"

static void focal_lengths_come_from_exif(void **state)
{
    static const char *const unsaid[][9] = {{"match", "--geometry", "auto", LENS, NO_LENS},
                                            {"match", "--geometry", "auto", NO_LENS, LENS},
                                            {"match", "--geometry", "auto", "--focal", "none", LENS, LENS},
                                            {"match", "--geometry", "auto", "--focal", "40", LENS, LENS},
                                            {"match", "--geometry", "homography", LENS, LENS},
                                            {"match", "-q", "--geometry", "auto", LENS, LENS},
                                            {"match", LENS, LENS}};
    static const struct {
        const char *arguments[10], *message;
    } missing[] = {
        {{"match", "--geometry", "auto", "--focal", "exif", LENS, NO_LENS}, "gray.png has no focal length"},
        {{"match", "--geometry", "essential", "--focal", "none", LENS, LENS}, "--geometry essential needs"},
        {{"match", "--geometry", "essential", NO_LENS, LENS}, "--camera1 is missing"},
        {{"match", "--geometry", "auto", "--camera1", "30,30,18,12", LENS, NO_LENS}, "--camera2 is missing"},
        {{"match", "--geometry", "auto", "--focal-sd", "0.1", LENS, NO_LENS}, "--focal-sd changes nothing: no focal"},
        {{"match", "--geometry", "auto", "--focal", "none", "--focal-sd", "0.1", LENS, LENS}, "changes nothing: no focal"},
    };
    size_t k;
    (void)state;
    const outcome *result = run_cli("match", "--geometry", "auto", LENS, LENS, NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "lens.png: focal length 30 px, from EXIF data, known to 5 %\n");
    result = run_cli("match", "--geometry", "auto", "--focal-sd", "0.02", LENS, LENS, NULL);
    expect_in(result, result->err, "lens.png: focal length 30 px, from EXIF data, known to 2 %\n");
    result = run_cli("match", "--geometry", "auto", "--focal-sd", "0", LENS, LENS, NULL);
    expect_in(result, result->err, "lens.png: focal length 30 px, from EXIF data\n");
    result = run_cli("match", "--geometry", "essential", "--camera2", "30,30,7.5,5.5", LENS, NO_LENS, NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "focal length 30 px");
    /* what is given counts more: 3 px are doubted */
    result = run_cli("match", "--geometry", "auto", "--camera1", "3,3,18,12", "--camera2", "30,30,18,12", LENS, LENS, NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "a focal length of 3 px means");
    for (k = 0; k < sizeof unsaid / sizeof unsaid[0]; k++) {
        result = run_cli_list(unsaid[k]);
        expect_code(result, 0);
        assert_null(strstr(result->err, "focal length"));
    }
    for (k = 0; k < sizeof missing / sizeof missing[0]; k++) {
        result = run_cli_list(missing[k].arguments);
        expect_code(result, 2);
        expect_in(result, result->err, missing[k].message);
    }
}
#endif

/* The number behind "name" in JSON, from where `within` begins. */
static double json_number(const char *text, const char *within, const char *name)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\"", name);
    const char *from = strstr(text, within), *place = from ? strstr(from, quoted) : NULL;
    if (!place)
        fail_msg("no %s after %s in %.2000s", quoted, within, text);
    place += strlen(quoted);
    return strtod(place + strspn(place, " :\n"), NULL);
}

#define MATCHER "\n\"options\""
#define DETECTOR "\n\"detect_options\""

/* Both tables have max_move: the plain name is the detector's. */
static void options_reach_detector_and_matcher(void **state)
{
    (void)state;
    const outcome *result = run_cli("match", "-q", "-f", "json", "--max-move", "3.25", "--match-max-move", "4.5", "--ratio", "2",
                                    "--epsilon", "7", "first.png", "second.png", NULL);
    expect_code(result, 0);
    assert_true(json_number(result->out, DETECTOR, "max_move") == 3.25);
    assert_true(json_number(result->out, MATCHER, "max_move") == 4.5);
    assert_true(json_number(result->out, MATCHER, "ratio") == 2);
    assert_true(json_number(result->out, DETECTOR, "epsilon") == 7);
    result = run_cli("match", "--ratio", "10", "--minimum-support", "64", "first.png", "second.png", NULL);
    expect_code(result, 0);
    assert_string_equal(result->out, MATCH_HEADER);
}

/* The former names of options work for one version, with a warning. */
static void former_names_are_taken_with_a_warning(void **state)
{
    (void)state;
    write_constant("flat.png", 60, 40);
    const outcome *result = run_cli("match", "-f", "json", "--minimum-agreement", "0.5", "--witnesses=3", "flat.png", "flat.png",
                                    NULL);
    expect_code(result, 0);
    expect_in(result, result->err, "warning: minimum_agreement is called verify_agreement");
    expect_in(result, result->err, "warning: witnesses is called verify_neighbours");
    assert_true(json_number(result->out, MATCHER, "verify_agreement") == 0.5);
    assert_true(json_number(result->out, MATCHER, "verify_neighbours") == 3);
    result = run_cli("match", "-q", "--minimum-agreement", "0.5", "flat.png", "flat.png", NULL);
    expect_code(result, 0);
    expect_empty(result, "standard error", result->err);
    result = run_cli("match", "--verify-agreement", "0.5", "flat.png", "flat.png", NULL);
    expect_code(result, 0);
    assert_null(strstr(result->err, "warning"));
}

static double preset_value(int32_t preset, const char *key, int detector)
{
    char text[64] = "";
    asj_match_options match;
    asj_detect_options detect;
    asj_match_options_preset(&match, preset);
    asj_detect_options_preset(&detect, preset);
    assert_int_equal(detector ? asj_detect_options_get(&detect, key, text, sizeof text)
                              : asj_match_options_get(&match, key, text, sizeof text), ASJ_OK);
    return strtod(text, NULL);
}

static void presets_are_for_both_or_for_one(void **state)
{
    (void)state;
    static const struct {
        const char *options[4];
        int32_t detector, matcher;
    } cases[] = {
        {{"--quiet"}, ASJ_PRESET_MATCH, ASJ_PRESET_MATCH},
        {{"--preset", "match"}, ASJ_PRESET_MATCH, ASJ_PRESET_MATCH},
        {{"--preset", "default"}, ASJ_PRESET_MATCH, ASJ_PRESET_DEFAULT}, /* what is recommended for this command */
        {{"--detect-preset", "default"}, ASJ_PRESET_DEFAULT, ASJ_PRESET_MATCH},
        {{"--preset", "paper"}, ASJ_PRESET_PAPER, ASJ_PRESET_PAPER},
        {{"--detect-preset", "paper"}, ASJ_PRESET_PAPER, ASJ_PRESET_MATCH},
        {{"--match-preset=default", "--preset", "paper"}, ASJ_PRESET_PAPER, ASJ_PRESET_DEFAULT},
        {{"--match-preset=paper", "--ratio=1.5"}, ASJ_PRESET_MATCH, ASJ_PRESET_PAPER},
    };
    write_constant("flat.png", 60, 40);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *arguments[12] = {"match", "-q", "-f", "json", "flat.png", "flat.png"};
        for (size_t k = 0; k < 4; k++)
            arguments[6 + k] = cases[i].options[k];
        const outcome *result = run_cli_list(arguments);
        expect_code(result, 0);
        assert_true(json_number(result->out, DETECTOR, "epsilon") == preset_value(cases[i].detector, "epsilon", 1));
        assert_true(json_number(result->out, MATCHER, "neighbours") == preset_value(cases[i].matcher, "neighbours", 0));
    }
    assert_true(preset_value(ASJ_PRESET_PAPER, "epsilon", 1) != preset_value(ASJ_PRESET_MATCH, "epsilon", 1));
    assert_true(preset_value(ASJ_PRESET_DEFAULT, "epsilon", 1) != preset_value(ASJ_PRESET_MATCH, "epsilon", 1));
    assert_true(preset_value(ASJ_PRESET_PAPER, "neighbours", 0) != preset_value(ASJ_PRESET_DEFAULT, "neighbours", 0));
}

static void threads_do_not_change_the_result(void **state)
{
    (void)state;
    expect_code(run_cli("match", "-q", "--threads", "1", "-o", "one.csv", "first.png", "second.png", NULL), 0);
    expect_code(run_cli("match", "-q", "--threads", "3", "-o", "three.csv", "first.png", "second.png", NULL), 0);
    size_t sizes[2] = {0};
    char *one = read_bytes("one.csv", &sizes[0]), *three = read_bytes("three.csv", &sizes[1]);
    assert_non_null(one);
    assert_non_null(three);
    assert_string_equal(one, three);
    free(one);
    free(three);
}

static void the_portable_form_gives_the_same(void **state)
{
    (void)state;
    expect_code(run_cli("match", "-q", "-o", "best.csv", "first.png", "second.png", NULL), 0);
    expect_code(run_cli("match", "-q", "--simd", "reference", "-o", "portable.csv", "first.png", "second.png", NULL), 0);
    size_t sizes[2] = {0};
    char *best = read_bytes("best.csv", &sizes[0]), *portable = read_bytes("portable.csv", &sizes[1]);
    assert_non_null(best);
    assert_non_null(portable);
    assert_string_equal(best, portable);
    free(best);
    free(portable);
}

static void times_are_printed_on_request(void **state)
{
    (void)state;
    const outcome *result = run_cli("match", "--time", "-q", "first.png", "second.png", NULL);
    expect_code(result, 0);
    for (int32_t stage = ASJ_STAGE_GRADIENT; stage <= ASJ_STAGE_ASSIGN; stage++)
        expect_in(result, result->err, asj_stage_name(stage)); /* of all looks */
    result = run_cli("match", "--time", "-q", "first.png", "second.png", "--region2", "0,0,320,240", NULL);
    expect_code(result, 0);
    for (int32_t stage = ASJ_STAGE_GRADIENT; stage <= ASJ_STAGE_ASSIGN; stage++)
        expect_in(result, result->err, asj_stage_name(stage));
    expect_in(result, result->err, "second.png: 320 x 240");
    expect_in(result, result->err, "reading");
    assert_null(strchr(result->err, '\r'));
}

/* Stopped wherever it is, nothing half done stays. The pauses grow until one ends in the middle of the work. */
static void an_interrupt_leaves_nothing(void **state)
{
    (void)state;
    static const char *const arguments[] = {"match", "--threads", "1", "-o", "stopped.csv", "large.png", "large.png", NULL};
    write_noise("large.png", 2000, 1500);
    for (long ms = 10; ms < 1000; ms *= 2) {
        const struct timespec pause = {0, ms * 1000000};
        pid_t process = start_cli(CAPTURED, CAPTURED, arguments);
        nanosleep(&pause, NULL);
        kill(process, SIGINT);
        const outcome *result = finish_cli(process);
        if (result->signal == SIGINT) /* it came before the program was ready for it */
            continue;
        expect_code(result, 130);
        expect_in(result, result->err, "asj-cli: interrupted at ");
        expect_empty(result, "standard output", result->out);
        assert_false(exists("stopped.csv"));
        return;
    }
    print_message("[  NOTE    ] the program never was ready in time: not tested\n");
    skip();
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matches_go_to_standard_output_and_words_to_standard_error),
        cmocka_unit_test(the_name_or_the_option_chooses_the_format),
        cmocka_unit_test(swapped_images_give_swapped_matches),
        cmocka_unit_test(no_match_is_a_result),
        cmocka_unit_test(junctions_come_from_files),
        cmocka_unit_test(the_preset_match_detects_for_match),
        cmocka_unit_test(the_surest_junctions_give_a_warning),
        cmocka_unit_test(stretched_images_match_in_their_own_pixels),
        cmocka_unit_test(a_glancing_view_is_stretched_by_itself),
        cmocka_unit_test(colours_are_looked_at_by_themselves),
        cmocka_unit_test(colours_are_hinted_at),
        cmocka_unit_test(smooth_colours_are_not_hinted_at),
        cmocka_unit_test(whole_images_are_upsampled_by_themselves),
        cmocka_unit_test(a_stretch_goes_with_images_alone),
        cmocka_unit_test(features_take_the_place_of_images),
        cmocka_unit_test(what_the_geometry_is_is_told),
        cmocka_unit_test(views_that_no_camera_has_are_doubted),
#ifdef ASJ_IMAGES
        cmocka_unit_test(focal_lengths_come_from_exif),
#endif
        cmocka_unit_test(former_names_are_taken_with_a_warning),
        cmocka_unit_test(options_reach_detector_and_matcher),
        cmocka_unit_test(presets_are_for_both_or_for_one),
        cmocka_unit_test(threads_do_not_change_the_result),
        cmocka_unit_test(the_portable_form_gives_the_same),
        cmocka_unit_test(times_are_printed_on_request),
        cmocka_unit_test(an_interrupt_leaves_nothing),
    };
    program_start(argc, argv);
    return program_end(cmocka_run_group_tests(tests, make_views, NULL));
}
