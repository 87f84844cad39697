/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_match() as a whole: a picture with known corners and its affine copy, views of the room with exact truth, swapping, threads,
 * empty input, bad input, lack of memory. */
#include "match/match_options.h"
#include "match/match_result.h"
#include "room.h"
#include "unit_test.h"

#include <asj/match.h>

#define SIDE 300
#define GRID 5
#define CELL 50
#define CORNERS (GRID * GRID)

static const double identity[4] = {1, 0, 0, 1}, oblique[4] = {0.85, 0.12, -0.1, 0.9};

/* Rectangles on a grid, each of its own grey and its own texture. Image 2 shows at x' what image 1 shows at m (x' - 150) + 150. */
static double shade(double x, double y)
{
    const double cx = (x - 15) / CELL, cy = (y - 15) / CELL;
    const int32_t i = (int32_t)floor(cx), j = (int32_t)floor(cy);
    if (i < 0 || j < 0 || i >= GRID || j >= GRID || cx - i > 0.7 || cy - j > 0.6)
        return 100 + 8 * sin(0.05 * x) + 8 * cos(0.06 * y);
    const int32_t n = (7 * i + 11 * j) % 13;
    return 130 + 8 * n + (6 + n % 5) * sin((0.2 + 0.04 * n) * x + 0.15 * (n % 7) * y);
}

static uint8_t *picture(const double m[4])
{
    uint8_t *pixels = malloc((size_t)SIDE * SIDE);
    assert_non_null(pixels);
    for (int32_t y = 0; y < SIDE; y++)
        for (int32_t x = 0; x < SIDE; x++) {
            double sum = 0; /* 3 x 3 samples a pixel */
            for (int32_t k = 0; k < 9; k++) {
                double u = x + (k % 3 - 1) / 3.0 - 150, v = y + (k / 3 - 1) / 3.0 - 150;
                sum += shade(150 + m[0] * u + m[1] * v, 150 + m[2] * u + m[3] * v);
            }
            pixels[y * SIDE + x] = (uint8_t)(sum / 9 + 0.5);
        }
    return pixels;
}

/* The upper left corner of each rectangle, in the copy under m, `wrong` times as long as true along a. Returns those inside. */
static size_t corners(const double m[4], double wrong, asj_junction *junctions, int32_t *names)
{
    const double d = m[0] * m[3] - m[1] * m[2], to[4] = {m[3] / d, -m[1] / d, -m[2] / d, m[0] / d};
    size_t count = 0;
    for (int32_t n = 0; n < CORNERS; n++) {
        const double u = 15 + CELL * (n % GRID) - 150, v = 15 + CELL * (n / GRID) - 150, width = 0.7 * CELL, height = 0.6 * CELL;
        asj_junction *j = &junctions[count];
        memset(j, 0, sizeof *j);
        j->x = (float)(150 + to[0] * u + to[1] * v);
        j->y = (float)(150 + to[2] * u + to[3] * v);
        if (j->x < 20 || j->y < 20 || j->x > SIDE - 21 || j->y > SIDE - 21)
            continue;
        j->branch_count = 2;
        j->branches[0].angle = (float)atan2(to[2], to[0]);
        j->branches[0].length = (float)(wrong * width * hypot(to[0], to[2]));
        j->branches[1].angle = (float)atan2(to[3], to[1]);
        j->branches[1].length = (float)(height * hypot(to[1], to[3]));
        names[count++] = n;
    }
    return count;
}

typedef struct scene {
    uint8_t *pixels;
    asj_image image;
    asj_junction junctions[CORNERS];
    int32_t names[CORNERS];
    size_t count;
} scene;

static void scene_make(const double m[4], double wrong, scene *s)
{
    s->pixels = picture(m);
    s->image = unit_gray8(s->pixels, SIDE, SIDE);
    s->count = corners(m, wrong, s->junctions, s->names);
    assert_true(s->count >= 15);
}

static asj_match_result *match(asj_context *context, const scene *a, const scene *b, const asj_match_options *options)
{
    asj_match_result *result = NULL;
    assert_int_equal(asj_match(context, &a->image, a->junctions, a->count, &b->image, b->junctions, b->count, options,
                               &result), ASJ_OK);
    assert_non_null(result);
    return result;
}

/* A result knows where its matches are; a copy of it, or one that the caller has given other matches, does not, and has the same
 * segments. */
static void segments_do_not_depend_on_places(asj_match_result *r)
{
    const asj_junction_match *const own = r->matches;
    const asj_match_result copy = *r;
    asj_segment_match segments[ASJ_MAX_BRANCHES * CORNERS], others[ASJ_MAX_BRANCHES * CORNERS];
    const size_t room = sizeof segments / sizeof *segments, count = asj_match_segments(r, ASJ_END_CUT, segments, room);
    const asj_around around = asj_match_result_around(r);
    assert_non_null(around.places[0]);
    assert_non_null(around.places[1]);
    assert_int_equal(around.place_count, r->match_count);
    assert_null(asj_match_result_around(&copy).places[0]);
    assert_true(count > r->match_count && count <= room);
    assert_int_equal(asj_match_segments(&copy, ASJ_END_CUT, others, room), count);
    assert_memory_equal(segments, others, count * sizeof *segments);
    r->matches = own + 1;
    assert_null(asj_match_result_around(r).places[0]);
    r->matches = own;
}

static void finds_the_corners_of_an_oblique_copy(void **state)
{
    const unit_fixture *fixture = *state;
    asj_context *context = fixture->context;
    scene a, b;
    scene_make(identity, 1, &a);
    scene_make(oblique, 1.05, &b);
    asj_match_result *r = match(context, &a, &b, NULL);
    uint32_t right = 0;
    for (uint32_t n = 0; n < r->match_count; n++) {
        const asj_junction_match *m = &r->matches[n];
        right += a.names[m->junction1] == b.names[m->junction2];
        const asj_junction *j2 = &b.junctions[m->junction2];
        unit_near("x2", n, 0, (double)m->x2, (double)j2->x, 0.3); /* both true; the map was 5 % wrong */
        unit_near("y2", n, 0, (double)m->y2, (double)j2->y, 0.3);
        const double *h = m->affine, x1 = (double)m->x1, y1 = (double)m->y1;
        unit_near("affine x", n, 0, h[0] * x1 + h[1] * y1 + h[2], (double)m->x2, 1e-3);
        unit_near("affine y", n, 0, h[3] * x1 + h[4] * y1 + h[5], (double)m->y2, 1e-3);
        assert_true(n == 0 || r->matches[n - 1].distance <= m->distance);
        assert_int_equal(m->end_a, ASJ_END_BOTH);
        assert_int_equal(m->end_b, ASJ_END_BOTH);
    }
    assert_int_equal(right, r->match_count); /* not one wrong */
    segments_do_not_depend_on_places(r);
    assert_true(r->match_count + 2 >= b.count);  /* and all but two found */
    asj_match_result_free(&r);
    assert_null(r);
    free(a.pixels);
    free(b.pixels);
}

static double direction(float x, float y, float ex, float ey)
{
    return atan2((double)ey - (double)y, (double)ex - (double)x);
}

/* In image 1 branch 0 points elsewhere and says that it may; image 2 knows better. Both show the direction of image 2; where
 * nothing is said of the deviations each its own. */
static void branches_point_where_both_images_say(void **state)
{
    enum { FIRST = 0 };
    static const double off = 0.12;
    asj_context *context = ((unit_fixture *)*state)->context;
    scene a, b;
    scene_make(identity, 1, &a);
    scene_make(oblique, 1, &b);
    for (int known = 0; known < 2; known++) {
        const scene plain_a = a, plain_b = b;
        for (size_t n = 0; n < CORNERS; n++) {
            a.junctions[n].branches[FIRST].angle += (float)off;
            a.junctions[n].branches[FIRST].angle_sd = known ? 0.3f : 0;
            a.junctions[n].branches[1].angle_sd = b.junctions[n].branches[1].angle_sd = 0.002f;
            b.junctions[n].branches[FIRST].angle_sd = 0.002f;
        }
        asj_match_result *r = match(context, &a, &b, NULL);
        assert_true(r->match_count >= 10);
        for (uint32_t n = 0; n < r->match_count; n++) {
            const asj_junction_match *m = &r->matches[n];
            const asj_branch *of_b = b.junctions[m->junction2].branches, *of_a = plain_a.junctions[m->junction1].branches;
            assert_int_equal(r->l_junctions1[m->l1].branch_a, FIRST);
            assert_int_equal(r->l_junctions2[m->l2].branch_a, FIRST);
            const double a1 = direction(m->x1, m->y1, m->ax1, m->ay1), a2 = direction(m->x2, m->y2, m->ax2, m->ay2);
            const double b1 = direction(m->x1, m->y1, m->bx1, m->by1), b2 = direction(m->x2, m->y2, m->bx2, m->by2);
            unit_near("a1", n, known, unit_turn(a1, (double)of_a[FIRST].angle), known ? 0 : off, known ? 0.04 : 1e-4);
            unit_near("b1", n, known, unit_turn(b1, (double)of_a[1].angle), 0, known ? 0.02 : 1e-4);
            if (known) {
                unit_near("a2", n, known, unit_turn(a2, (double)of_b[FIRST].angle), 0, 0.02);
                unit_near("b2", n, known, unit_turn(b2, (double)of_b[1].angle), 0, 0.02);
            }
        }
        asj_match_result_free(&r);
        a = plain_a;
        b = plain_b;
    }
    free(a.pixels);
    free(b.pixels);
}

/* Branches so short that the corner, once aligned, lies half as far off their line as they are long: they stay as detected. */
static void short_branches_stay_where_the_corner_moved(void **state)
{
    static const float length = 6, moved = 4;
    asj_context *context = ((unit_fixture *)*state)->context;
    scene a, b;
    scene_make(identity, 1, &a);
    scene_make(oblique, 1, &b);
    for (size_t n = 0; n < CORNERS; n++) {
        for (int32_t k = 0; k < 2; k++) {
            a.junctions[n].branches[k].length = b.junctions[n].branches[k].length = length;
            a.junctions[n].branches[k].angle_sd = 0.3f;
            b.junctions[n].branches[k].angle_sd = 0.002f;
        }
        b.junctions[n].y += moved; /* across branch a */
    }
    asj_match_result *r = match(context, &a, &b, NULL);
    uint32_t aligned = 0;
    for (uint32_t n = 0; n < r->match_count; n++) {
        const asj_junction_match *m = &r->matches[n];
        if (fabsf(m->y2 - b.junctions[m->junction2].y) < 3.5f)
            continue;
        aligned++;
        const double a1 = direction(m->x1, m->y1, m->ax1, m->ay1), own = (double)a.junctions[m->junction1].branches[0].angle;
        unit_near("a1", n, 0, unit_turn(a1, own), 0, 1e-4);
    }
    assert_true(aligned >= 5);
    asj_match_result_free(&r);
    free(a.pixels);
    free(b.pixels);
}

static void paper_preset_and_sift_work_too(void **state)
{
    const unit_fixture *fixture = *state;
    asj_context *context = fixture->context;
    scene a, b;
    scene_make(identity, 1, &a);
    scene_make(oblique, 1, &b);
    for (int32_t n = 0; n < 4; n++) {
        asj_match_options options;
        assert_int_equal(asj_match_options_preset(&options, n < 2 ? ASJ_PRESET_DEFAULT : ASJ_PRESET_PAPER), ASJ_OK);
        options.descriptor = n % 2 ? ASJ_DESCRIPTOR_SIFT : ASJ_DESCRIPTOR_RAW;
        asj_match_result *r = match(context, &a, &b, &options);
        uint32_t right = 0;
        for (uint32_t k = 0; k < r->match_count; k++)
            right += a.names[r->matches[k].junction1] == b.names[r->matches[k].junction2];
        assert_true(right >= 8 && 10 * right >= 9 * r->match_count);
        asj_match_result_free(&r);
    }
    free(a.pixels);
    free(b.pixels);
}

/* Every corner again as a coarse octave would have it, 3 px off: still one match for each, between fine ones. Where image 2 has the
 * coarse ones alone they match; and junctions that are all of one coarse octave match as those of the image itself do. */
static void corners_of_several_octaves_match_once(void **state)
{
    const unit_fixture *fixture = *state;
    scene a, b;
    scene_make(identity, 1, &a);
    scene_make(oblique, 1, &b);
    asj_junction both[2 * CORNERS], coarse[CORNERS];
    size_t count = 0;
    for (size_t n = 0; n < b.count; n++) {
        coarse[n] = b.junctions[n];
        coarse[n].octave = 1;
        both[count++] = b.junctions[n];
        both[count] = coarse[n];
        both[count].x += 3;
        both[count++].octave = 1;
    }
    asj_match_result *alone = match(fixture->context, &a, &b, NULL), *r = NULL;
    assert_int_equal(asj_match(fixture->context, &a.image, a.junctions, a.count, &b.image, both, count, NULL, &r), ASJ_OK);
    assert_int_equal(r->match_count, alone->match_count);
    for (uint32_t n = 0; n < r->match_count; n++) {
        assert_int_equal(both[r->matches[n].junction2].octave, 0);
        assert_true(r->matches[n].x2 == alone->matches[n].x2 && r->matches[n].support == alone->matches[n].support);
    }
    asj_match_result_free(&r);
    assert_int_equal(asj_match(fixture->context, &a.image, a.junctions, a.count, &b.image, coarse, b.count, NULL, &r), ASJ_OK);
    assert_true(r->match_count + 2 >= alone->match_count);
    asj_match_result_free(&r);
    memcpy(both, a.junctions, a.count * sizeof *both);
    for (size_t n = 0; n < a.count; n++)
        both[n].octave = 1;
    assert_int_equal(asj_match(fixture->context, &a.image, both, a.count, &b.image, coarse, b.count, NULL, &r), ASJ_OK);
    assert_int_equal(r->match_count, alone->match_count);
    assert_memory_equal(r->matches, alone->matches, r->match_count * sizeof *r->matches);
    asj_match_result_free(&r);
    asj_match_result_free(&alone);
    free(a.pixels);
    free(b.pixels);
}

static void a_wrong_picture_gives_nothing(void **state)
{
    const unit_fixture *fixture = *state;
    asj_context *context = fixture->context;
    scene a, b;
    const double turned[4] = {-1, 0, 0, -1};
    scene_make(identity, 1, &a);
    scene_make(oblique, 1, &b);
    free(b.pixels);
    b.pixels = picture(turned); /* b's junctions now stand on the wrong corners: a test that passes everything fails here */
    b.image = unit_gray8(b.pixels, SIDE, SIDE);
    asj_match_result *r = match(context, &a, &b, NULL);
    assert_true(r->match_count <= 2);
    asj_match_result_free(&r);
    free(a.pixels);
    free(b.pixels);
}

static void swapping_the_images_swaps_the_matches(void **state)
{
    const unit_fixture *fixture = *state;
    asj_context *context = fixture->context;
    scene a, b;
    scene_make(identity, 1, &a);
    scene_make(oblique, 1.05, &b);
    asj_match_result *there = match(context, &a, &b, NULL), *back = match(context, &b, &a, NULL);
    assert_true(there->match_count > 0);
    assert_int_equal(there->match_count, back->match_count);
    for (uint32_t n = 0; n < there->match_count; n++) {
        const asj_junction_match *m = &there->matches[n], *w = NULL;
        for (uint32_t k = 0; k < back->match_count; k++)
            if (back->matches[k].l1 == m->l2)
                w = &back->matches[k];
        assert_non_null(w);
        assert_int_equal(w->l2, m->l1);
        assert_true(w->distance == m->distance && w->similarity == m->similarity && w->support == m->support);
    }
    asj_match_result_free(&there);
    asj_match_result_free(&back);
    free(a.pixels);
    free(b.pixels);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0}, other = {0, 0, 0, 0};
    scene a, b;
    scene_make(identity, 1, &a);
    scene_make(oblique, 1.05, &b);
    asj_context *one = unit_context(&counter, 1), *three = unit_context(&other, 3);
    asj_match_result *r1 = match(one, &a, &b, NULL), *r3 = match(three, &a, &b, NULL);
    assert_int_equal(r1->match_count, r3->match_count);
    assert_memory_equal(r1->matches, r3->matches, r1->match_count * sizeof *r1->matches);
    asj_match_result_free(&r1);
    asj_match_result_free(&r3);
    free(a.pixels);
    free(b.pixels);
    unit_context_free(&counter, &one);
    unit_context_free(&other, &three);
}

static void empty_sets_and_single_junctions(void **state)
{
    const unit_fixture *fixture = *state;
    asj_context *context = fixture->context;
    scene a, b;
    scene_make(identity, 1, &a);
    scene_make(oblique, 1, &b);
    const size_t counts[][2] = {{0, 0}, {0, 5}, {5, 0}, {1, 1}};
    for (size_t n = 0; n < UNIT_COUNT(counts); n++) {
        scene p = a, q = b;
        p.count = counts[n][0];
        q.count = counts[n][1];
        asj_match_result *r = match(context, &p, &q, NULL);
        assert_int_equal(r->match_count, 0); /* one match has no neighbour that agrees */
        assert_null(r->matches);
        assert_int_equal(asj_match_segments(r, ASJ_END_CUT, NULL, 0), 0);
        asj_match_result_free(&r);
    }
    asj_match_result *r = NULL;
    assert_int_equal(asj_match(context, &a.image, NULL, 0, &b.image, NULL, 0, NULL, &r), ASJ_OK);
    asj_match_result_free(&r);
    free(a.pixels);
    free(b.pixels);
}

static void refuse(asj_context *context, const scene *a, const scene *b, const asj_match_options *options, asj_status expected,
                   const char *word)
{
    asj_match_result *r = NULL;
    assert_int_equal(asj_match(context, &a->image, a->junctions, a->count, &b->image, b->junctions, b->count, options, &r),
                     expected);
    assert_null(r);
    assert_non_null(strstr(asj_context_message(context), word));
}

static void bad_input_is_refused(void **state)
{
    const unit_fixture *fixture = *state;
    asj_context *context = fixture->context;
    scene a, b;
    scene_make(identity, 1, &a);
    scene_make(oblique, 1, &b);
    scene broken = b;
    broken.count = SIZE_MAX / sizeof *broken.junctions;
    refuse(context, &a, &broken, NULL, ASJ_ERROR_LIMIT, "of image 2 are too many"); /* before any is read */
    broken.count = b.count;
    broken.junctions[3].x = NAN;
    refuse(context, &a, &broken, NULL, ASJ_ERROR_ARGUMENT, "junction 3 of image 2");
    broken = b;
    broken.junctions[4].y = SIDE + 50;
    refuse(context, &broken, &a, NULL, ASJ_ERROR_ARGUMENT, "junction 4 of image 1");
    broken = b;
    broken.junctions[2].branches[1].length = -1;
    refuse(context, &a, &broken, NULL, ASJ_ERROR_ARGUMENT, "junction 2 of image 2 has a branch 1 with a length of -1");
    broken = b;
    broken.junctions[2].branches[0].angle = HUGE_VALF;
    refuse(context, &a, &broken, NULL, ASJ_ERROR_ARGUMENT, "junction 2 of image 2 has a branch 0 with an angle");
    broken = b;
    broken.junctions[2].branches[1].end = INT32_MIN;
    refuse(context, &a, &broken, NULL, ASJ_ERROR_ARGUMENT, "an end of kind");
    broken = b;
    broken.junctions[0].branch_count = 6;
    refuse(context, &a, &broken, NULL, ASJ_ERROR_ARGUMENT, "6 branches");
    broken = b;
    broken.image.width = 0;
    refuse(context, &a, &broken, NULL, ASJ_ERROR_IMAGE, "0 x");
    asj_match_options options;
    asj_match_options_init(&options);
    options.ratio = 0.5;
    refuse(context, &a, &b, &options, ASJ_ERROR_OPTION, "ratio");
    asj_match_options_init(&options);
    options.patch_size = 13;
    refuse(context, &a, &b, &options, ASJ_ERROR_OPTION, "patch_size");
    asj_match_result *r = NULL;
    assert_int_equal(asj_match(NULL, &a.image, NULL, 0, &b.image, NULL, 0, NULL, &r), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_match(context, &a.image, NULL, 3, &b.image, NULL, 0, NULL, &r), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_match(context, NULL, NULL, 0, &b.image, NULL, 0, NULL, &r), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_match(context, &a.image, NULL, 0, &b.image, NULL, 0, NULL, NULL), ASJ_ERROR_ARGUMENT);
    free(a.pixels);
    free(b.pixels);
}

static void segments_of_matches(void **state)
{
    (void)state;
    asj_junction_match matches[2];
    memset(matches, 0, sizeof matches);
    /* the same 100 px line seen from both its ends, and from each a second branch, one of them cut */
    matches[0] = (asj_junction_match){.x1 = 10, .y1 = 10, .ax1 = 110, .ay1 = 10, .bx1 = 10, .by1 = 60,
                                      .x2 = 20, .y2 = 20, .ax2 = 120, .ay2 = 20, .bx2 = 20, .by2 = 70,
                                      .end_a = ASJ_END_BOTH, .end_b = ASJ_END_CUT};
    matches[1] = (asj_junction_match){.x1 = 109, .y1 = 11, .ax1 = 12, .ay1 = 10, .bx1 = 110, .by1 = 90,
                                      .x2 = 119, .y2 = 21, .ax2 = 22, .ay2 = 20, .bx2 = 120, .by2 = 100,
                                      .end_a = ASJ_END_BOTH, .end_b = ASJ_END_INNER};
    const asj_match_result result = {.matches = matches, .match_count = 2};
    asj_segment_match s[4];
    assert_int_equal(asj_match_segments(&result, ASJ_END_CUT, s, 4), 3);
    assert_int_equal(s[0].match, 0);
    assert_true(s[0].branch1 == -1 && s[2].branch2 == -1); /* no L-junctions */
    unit_near("far end", 0, 0, (double)s[0].ex1, 110, 0);
    assert_int_equal(s[1].end, ASJ_END_CUT);
    assert_int_equal(s[2].match, 1);
    unit_near("second branch", 0, 0, (double)s[2].ey2, 100, 0);
    assert_int_equal(asj_match_segments(&result, ASJ_END_INNER, NULL, 0), 2);
    assert_int_equal(asj_match_segments(&result, ASJ_END_BOTH, NULL, 0), 1);
    assert_int_equal(asj_match_segments(NULL, ASJ_END_BOTH, s, 4), 0);
}

/* A match of two junctions with four branches each: the other two correspond too, by direction; and what is a part of a longer
 * segment is a segment. */
static void segments_of_other_branches(void **state)
{
    (void)state;
    const asj_l_junction first[] = {{7, 0, 1, 50, 50, 90, 50, 50, 80}, {7, 1, 2, 50, 50, 50, 80, 20, 50},
                                    {7, 2, 3, 50, 50, 20, 50, 50, 10}};
    const asj_l_junction second[] = {{3, 2, 0, 60, 60, 100, 60, 60, 90}, {3, 0, 3, 60, 60, 60, 90, 29, 61},
                                     {3, 3, 1, 60, 60, 29, 61, 60, 40}};
    const int32_t branches[4][2] = {{0, 2}, {1, 0}, {2, 3}, {3, 1}};
    asj_junction_match matches[2];
    memset(matches, 0, sizeof matches);
    matches[0] = (asj_junction_match){.affine = {1, 0, 10, 0, 1, 10}, .x1 = 50, .y1 = 50, .ax1 = 90, .ay1 = 50, .bx1 = 50,
                                      .by1 = 80, .x2 = 60, .y2 = 60, .ax2 = 100, .ay2 = 60, .bx2 = 60, .by2 = 90,
                                      .end_a = ASJ_END_BOTH, .end_b = ASJ_END_BOTH};
    asj_match_result result = {.matches = matches, .match_count = 1, .l_junctions1 = first, .l_junctions2 = second,
                               .l_junction_count1 = 3, .l_junction_count2 = 3};
    asj_segment_match s[2 * ASJ_MAX_BRANCHES];
    assert_int_equal(asj_match_segments(&result, ASJ_END_CUT, s, 2 * ASJ_MAX_BRANCHES), 4);
    for (int32_t k = 0; k < 4; k++)
        assert_true(s[k].branch1 == branches[k][0] && s[k].branch2 == branches[k][1]);
    assert_int_equal(s[2].end, ASJ_END_BOTH); /* to the left */
    unit_near("left", 1, 0, (double)s[2].ex1, 20, 1e-4);
    unit_near("left", 2, 0, (double)s[2].ex2, 29, 1e-4);
    assert_int_equal(s[3].end, ASJ_END_CUT); /* upwards: 40 px against 20 */
    unit_near("up", 1, 0, (double)s[3].ey1, 30, 1e-4);
    unit_near("up", 2, 0, (double)s[3].ey2, 40, 1e-4);
    assert_int_equal(asj_match_segments(&result, ASJ_END_BOTH, NULL, 0), 3);
    result.l_junction_count2 = 1; /* nothing is known of other branches there */
    assert_int_equal(asj_match_segments(&result, ASJ_END_CUT, NULL, 0), 2);
    matches[1] = matches[0]; /* from the middle of branch a to its end: another segment, as is its branch b */
    matches[1].x1 = 70;
    matches[1].x2 = 80;
    matches[1].bx1 = 70;
    matches[1].bx2 = 80;
    result.match_count = 2;
    assert_int_equal(asj_match_segments(&result, ASJ_END_BOTH, NULL, 0), 4);
    matches[1] = matches[0]; /* another one, at the upper end of the cut branch, that sees the scene half as large along it */
    matches[1].y1 = 20;
    matches[1].y2 = 45;
    matches[1].affine[4] = 0.5;
    result.l_junction_count2 = 3;
    assert_true(asj_match_segments(&result, ASJ_END_CUT, s, 2 * ASJ_MAX_BRANCHES) > 4);
    assert_int_equal(s[3].end, ASJ_END_CUT);
    assert_true(s[3].ey1 > 13 && s[3].ey1 < 17); /* where the two put the end at 40: 30 by itself, 10 by the nearer one */
    unit_near("up", 3, 0, (double)s[3].ey2, 40, 1e-4);
    matches[1] = matches[0];
    result.l_junction_count2 = 1;
    assert_int_equal(asj_match_segments(&result, ASJ_END_BOTH, NULL, 0), 2);
}

/* A branch between the two others: to 48 px in the first picture, and `beyond` px farther. */
static void add_third_branches(scene *s, const double m[4], double beyond)
{
    const double d = m[0] * m[3] - m[1] * m[2], x = (m[3] - m[1]) / d, y = (m[0] - m[2]) / d;
    for (size_t n = 0; n < s->count; n++) {
        asj_junction *j = &s->junctions[n];
        j->branch_count = 3;
        j->branches[2] = j->branches[1];
        j->branches[1].angle = (float)atan2(y, x);
        j->branches[1].length = (float)(48 * hypot(x, y) / sqrt(2) + beyond);
    }
}

/* Of the third branches of matches of the other two those whose ends correspond; of how many. */
static size_t third_ends(const asj_match_result *r, size_t *all)
{
    asj_segment_match s[ASJ_MAX_BRANCHES * CORNERS];
    const size_t count = asj_match_segments(r, ASJ_END_CUT, s, sizeof s / sizeof *s);
    size_t ends = 0;
    *all = 0;
    for (size_t n = 0; n < count; n++) {
        const asj_l_junction *l = &r->l_junctions1[r->matches[s[n].match].l1];
        if (s[n].branch1 != 1 || s[n].branch2 != 1 || l->branch_a == 1 || l->branch_b == 1)
            continue;
        ends += s[n].end == ASJ_END_BOTH;
        ++*all;
    }
    return ends;
}

/* Other branches are judged by the options of the call, too; a copy of the result does not know them. */
static void end_tolerance_is_that_of_the_call(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static const double tolerances[] = {0.01, 1};
    scene a, b;
    scene_make(identity, 1, &a);
    scene_make(oblique, 1, &b);
    add_third_branches(&a, identity, 0);
    add_third_branches(&b, oblique, 6); /* more than 4 px, less than a sixth of the length */
    for (int k = 0; k < 2; k++) {
        asj_match_options options;
        size_t all, of_copy;
        asj_match_options_init(&options);
        options.end_tolerance = tolerances[k];
        asj_match_result *r = match(context, &a, &b, &options);
        const asj_match_result copy = *r;
        const size_t ends = third_ends(r, &all);
        printf("end_tolerance %g: %zu of %zu\n", tolerances[k], ends, all);
        assert_true(all >= 5);
        assert_int_equal(ends, k ? all : 0);
        assert_int_equal(third_ends(&copy, &of_copy), 0);
        assert_int_equal(of_copy, all);
        asj_match_result_free(&r);
    }
    free(a.pixels);
    free(b.pixels);
}

static void out_of_memory(void **state)
{
    (void)state;
    scene a, b;
    scene_make(identity, 1, &a);
    scene_make(oblique, 1, &b);
    int reached = 1;
    for (long n = 1; n < 2000 && reached; n++) {
        unit_counter counter = {0, 0, 0, 0};
        asj_context *context = unit_context(&counter, 1);
        asj_match_result *r = NULL;
        counter.fail_at = counter.calls + n;
        asj_status status = asj_match(context, &a.image, a.junctions, a.count, &b.image, b.junctions, b.count, NULL, &r);
        reached = unit_reached(&counter);
        assert_true(status == ASJ_OK ? r != NULL : reached && status == ASJ_ERROR_MEMORY && r == NULL);
        asj_match_result_free(&r);
        unit_context_free(&counter, &context);
    }
    assert_false(reached);
    free(a.pixels);
    free(b.pixels);
}

static void options_are_read_and_written(void **state)
{
    (void)state;
    asj_match_options options;
    char message[256], text[64];
    asj_match_options_init(&options);
    assert_int_equal(asj_match_options_check(&options, message, sizeof message), ASJ_OK);
    for (size_t n = 0; n < asj_match_option_count(); n++) {
        const asj_option_info *row = asj_match_option(n);
        assert_int_equal(asj_match_options_get(&options, row->key, text, sizeof text), ASJ_OK);
        assert_int_equal(asj_match_options_set(&options, row->key, text, message, sizeof message), ASJ_OK);
    }
    asj_match_options again;
    asj_match_options_init(&again);
    assert_memory_equal(&again, &options, sizeof again);
    assert_int_equal(asj_match_options_set(&options, "descriptor", "sift", message, sizeof message), ASJ_OK);
    assert_int_equal(options.descriptor, ASJ_DESCRIPTOR_SIFT);
    static const char *const former[][2] = {{"witnesses", "3"}, {"witness-distance", "50"}, {"minimum_agreement", "0.5"}};
    for (size_t n = 0; n < UNIT_COUNT(former); n++) {
        assert_int_equal(asj_match_options_set(&options, former[n][0], former[n][1], message, sizeof message), ASJ_OK);
        assert_non_null(strstr(message, "is called verify_"));
    }
    assert_true(options.verify_neighbours == 3 && options.verify_distance == 50 && options.verify_agreement == 0.5);
    assert_int_equal(asj_match_options_set(&options, "verify_agreement", "0.25", message, sizeof message), ASJ_OK);
    assert_string_equal(message, "");
    assert_int_equal(asj_match_options_preset(&options, ASJ_PRESET_MATCH), ASJ_OK);
    assert_memory_equal(&again, &options, sizeof again);
    assert_int_equal(asj_match_options_set(&options, "nonsense", "1", message, sizeof message), ASJ_ERROR_OPTION);
    assert_int_equal(asj_match_options_preset(&options, ASJ_PRESET_PAPER), ASJ_OK);
    assert_int_equal(options.patches, ASJ_PATCHES_INDUCED);
    assert_int_equal(asj_match_options_preset(&options, 9), ASJ_ERROR_OPTION);
    assert_null(asj_match_option(asj_match_option_count()));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_the_corners_of_an_oblique_copy),
        cmocka_unit_test(branches_point_where_both_images_say),
        cmocka_unit_test(short_branches_stay_where_the_corner_moved),
        cmocka_unit_test(paper_preset_and_sift_work_too),
        cmocka_unit_test(corners_of_several_octaves_match_once),
        cmocka_unit_test(a_wrong_picture_gives_nothing),
        cmocka_unit_test(swapping_the_images_swaps_the_matches),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(empty_sets_and_single_junctions),
        cmocka_unit_test(bad_input_is_refused),
        cmocka_unit_test(segments_of_matches),
        cmocka_unit_test(segments_of_other_branches),
        cmocka_unit_test(end_tolerance_is_that_of_the_call),
        cmocka_unit_test(out_of_memory),
        cmocka_unit_test(options_are_read_and_written),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
