/* SPDX-License-Identifier: BSD-2-Clause */
/* What is at the ends of branches, in scenes where it is known; and where edges end by their contrast. */
#include "detect/end_kind.h"
#include "detect/end_profile.h"
#include "unit_test.h"

#include <asj/asj.h>

enum { SIZE = 200 };

/* A branch of 70 px that ends at the middle, coming at `angle`; its kind. */
static int32_t kind_at_middle(const unit_fixture *f, synth_scene *scene, double angle, double off)
{
    asj_frame frame;
    asj_end_rays rays;
    asj_hypothesis h;
    asj_detect_options options = f->options;
    options.end_contrast = 0;
    memset(&h, 0, sizeof h);
    h.branch_count = 1;
    h.branches[0].angle = angle < 0 ? angle + 2 * UNIT_PI : angle;
    h.branches[0].length = 70;
    h.x = SIZE / 2.0 + (off - 70) * cos(angle);
    h.y = SIZE / 2.0 + (off - 70) * sin(angle);
    unit_frame_of(f->context, scene, 0.8, 2, &f->options, &frame);
    asj_end_rays_make(&rays);
    asj_end_kinds(&asj_edge_reference, &frame, &rays, &options, &h);
    asj_frame_free(&f->context->memory, &frame);
    assert_true(h.branches[0].length == 70 && h.branches[0].end_variance > 0);
    return h.branches[0].end;
}

/* Sectors around the middle: the branch comes along the first one's first side, from behind. */
static void test_kinds(void **state)
{
    const unit_fixture *f = *state;
    static const struct {
        const char *name;
        int32_t count;
        double angles[5], grays[5];
        int32_t wanted;
    } cases[] = {
        {"T, from its foot", 3, {0.5 * UNIT_PI, UNIT_PI, 1.5 * UNIT_PI}, {60, 150, -1}, ASJ_BRANCH_END_OCCLUSION},
        {"T that leans", 3, {0.6 * UNIT_PI, UNIT_PI, 1.6 * UNIT_PI}, {60, 150, -1}, ASJ_BRANCH_END_OCCLUSION},
        {"X", 4, {0, 0.5 * UNIT_PI, UNIT_PI, 1.5 * UNIT_PI}, {180, 60, 200, 40}, ASJ_BRANCH_END_CROSSING},
        {"L", 2, {0.5 * UNIT_PI, UNIT_PI}, {200, -1}, ASJ_BRANCH_END_CROSSING},
        {"Y", 3, {0.34 * UNIT_PI, UNIT_PI, 1.66 * UNIT_PI}, {60, 200, 130}, ASJ_BRANCH_END_CROSSING},
    };
    for (size_t i = 0; i < UNIT_COUNT(cases); i++)
        for (int n = 0; n < 12; n++) {
            const double turn = 0.1 + n * 0.523;
            double angles[5];
            synth_scene scene;
            for (int32_t k = 0; k < cases[i].count; k++)
                angles[k] = cases[i].angles[k] + turn;
            synth_scene_init(&scene, SIZE, SIZE, 110);
            synth_add_star(&scene, (synth_point){SIZE / 2.0, SIZE / 2.0}, angles, cases[i].grays, cases[i].count, 90);
            const int32_t found = kind_at_middle(f, &scene, turn, n % 3 - 1); /* the scan knows the end to a pixel */
            if (found != cases[i].wanted)
                fail_msg("%s turned by %g: kind %d, not %d", cases[i].name, turn, (int)found, (int)cases[i].wanted);
        }
}

/* The scan gave up in the middle of an edge, or the edge ends there without another. */
static void test_faded(void **state)
{
    const unit_fixture *f = *state;
    for (int n = 0; n < 12; n++) {
        synth_scene scene;
        const double turn = 0.1 + n * 0.523;
        synth_scene_init(&scene, SIZE, SIZE, 110);
        synth_add_star(&scene, (synth_point){SIZE / 2.0, SIZE / 2.0}, (const double[]){turn, turn + UNIT_PI},
                       (const double[]){170, -1}, 2, 90);
        assert_int_equal(kind_at_middle(f, &scene, turn, 0), ASJ_BRANCH_END_FADED);
    }
}

static void test_border(void **state)
{
    const unit_fixture *f = *state;
    synth_scene scene;
    asj_end_rays rays;
    asj_frame frame;
    asj_hypothesis h;
    memset(&h, 0, sizeof h);
    h.branch_count = 2;
    h.x = h.y = 100;
    h.branches[0].length = 96; /* to the right, 3 px before the border */
    h.branches[1].length = 90; /* down, as much as the end may lie behind the scan's */
    h.branches[1].angle = UNIT_PI / 2;
    synth_scene_init(&scene, SIZE, SIZE, 110);
    synth_add_rectangle(&scene, (synth_point){100, 100}, 150, 150, 0, 180);
    unit_frame_of(f->context, &scene, 0.8, 2, &f->options, &frame);
    asj_end_rays_make(&rays);
    asj_detect_options options = f->options;
    options.end_contrast = 0;
    asj_ends_by_contrast(&asj_edge_reference, &frame, &options, &h);
    assert_true(h.branches[0].length == 96 && h.branches[1].length == 90);
    asj_end_kinds(&asj_edge_reference, &frame, &rays, &options, &h);
    assert_int_equal(h.branches[0].end, ASJ_BRANCH_END_BORDER);
    assert_int_equal(h.branches[1].end, ASJ_BRANCH_END_FADED);
    for (options.end_contrast = 0.1; options.end_contrast < 0.8; options.end_contrast += 0.2) { /* by contrast both reach it */
        asj_ends_by_contrast(&asj_edge_reference, &frame, &options, &h);
        asj_end_kinds(&asj_edge_reference, &frame, &rays, &options, &h);
        for (int b = 0; b < 2; b++) {
            assert_int_equal(h.branches[b].end, ASJ_BRANCH_END_BORDER);
            unit_near("border", b, 0, h.branches[b].length, 99, 1);
            assert_true(h.branches[b].end_variance > 0 && h.branches[b].end_variance < 1);
            h.branches[b].length = 92;
        }
    }
    h.branches[0].end = ASJ_BRANCH_END_JUNCTION; /* is left alone */
    h.branches[0].end_variance = 7;
    asj_end_kinds(&asj_edge_reference, &frame, &rays, &options, &h);
    options.end_contrast = 0;
    asj_end_kinds(&asj_edge_reference, &frame, &rays, &options, &h);
    assert_true(h.branches[0].end == ASJ_BRANCH_END_JUNCTION && h.branches[0].end_variance == 7);
    asj_frame_free(&f->context->memory, &frame);
}

/* ---- edges that break off, and edges that fade ---- */

/* A branch along y = 90, to the right. */
static asj_hypothesis branch_from(double x, double length)
{
    asj_hypothesis h;
    memset(&h, 0, sizeof h);
    h.x = x;
    h.y = 90;
    h.branch_count = 1;
    h.branches[0].length = length;
    return h;
}

/* An edge of contrast `first` for 60 px, then of `then` for `part` px, then none: where its end is found by `share`. */
static double end_of(const unit_fixture *f, double first, double then, double part, double scanned, double share, int steady)
{
    synth_scene scene;
    asj_frame frame;
    const asj_hypothesis h = branch_from(40, scanned);
    synth_scene_init(&scene, SIZE, SIZE, 100);
    synth_add_rectangle(&scene, (synth_point){40, 90}, 60, 80, 0, 100 + first);
    if (part > 0)
        synth_add_rectangle(&scene, (synth_point){100, 90}, part, 80, 0, 100 + then);
    unit_frame_of(f->context, &scene, 0.8, 1, &f->options, &frame);
    const double end = asj_end_profile_of(&asj_edge_reference, &frame, &h, &h.branches[0], share, steady).end;
    asj_frame_free(&f->context->memory, &frame);
    return end;
}

static double end_after(const unit_fixture *f, double first, double then, double part, double scanned, double share)
{
    return end_of(f, first, then, part, scanned, share, 0);
}

/* The edge ends at the corner wherever the scan has left it, within reach; it goes on as a weaker one that has the share, also as a
 * short one; not as one that has less, nor over a gap that is longer than what follows. */
static void test_break(void **state)
{
    const unit_fixture *f = *state;
    for (double scanned = 52.5; scanned <= 80; scanned += 2.5)
        unit_near("corner", scanned, 0, end_after(f, 60, 0, 0, scanned, 0.15), 60, 1.5);
    unit_near("scan too short", 0, 0, end_after(f, 60, 0, 0, 30, 0.15), 38, 1);
    for (double part = 15; part <= 40; part += 5) {
        unit_near("weaker", part, 0, end_after(f, 80, 30, part, 60 + part, 0.15), 60 + part, 1.5);
        unit_near("from weak to strong", part, 0, end_after(f, 30, 80, part, 60 + part, 0.15), 60 + part, 1.5);
        unit_near("other side", part, 0, end_after(f, 60, -40, part, 60 + part, 0.15), 60 + part, 1.5);
        unit_near("too weak", part, 0, end_after(f, 90, 6, part, 60 + part, 0.15), 60, 1.5);
        unit_near("too weak for half", part, 0, end_after(f, 90, 30, part, 60 + part, 0.5), 60, 1.5);
    }
}

/* Two panels in a row, the second `gap` px behind the first, which is 60 px long: the edge ends with the first one; and it does not
 * where a bar too thin to hide its contrast stands before it. */
static double end_of_first_panel(const unit_fixture *f, double gap, double second)
{
    synth_scene scene;
    asj_frame frame;
    const asj_hypothesis h = branch_from(20, 60 + gap + second);
    synth_scene_init(&scene, SIZE, SIZE, 100);
    synth_add_rectangle(&scene, (synth_point){20, 90}, 60, 80, 0, 160);
    synth_add_rectangle(&scene, (synth_point){80 + gap, 90}, second, 80, 0, 160);
    unit_frame_of(f->context, &scene, 0.8, 1, &f->options, &frame);
    const double end = asj_end_profile_of(&asj_edge_reference, &frame, &h, &h.branches[0], 0.15, 1).end;
    asj_frame_free(&f->context->memory, &frame);
    return end;
}

static void test_gap(void **state)
{
    const unit_fixture *f = *state;
    for (double gap = 12; gap <= 24; gap += 2)
        unit_near("panels", gap, 0, end_of_first_panel(f, gap, 40), 60, 1.5);
    for (double gap = 0; gap <= 2; gap++)
        unit_near("a thin line", gap, 0, end_of_first_panel(f, gap, 60), 120 + gap, 1.5);
    unit_near("much more edge", 0, 0, end_of_first_panel(f, 8, 100), 168, 1.5);
}

/* What shading turns round, from 40 grey levels to -20 over 120 px, is one edge. */
static void test_turned_round(void **state)
{
    const unit_fixture *f = *state;
    const asj_hypothesis h = branch_from(20, 210);
    const synth_point ramp[4] = {{80, 90}, {200, 90}, {200, 180}, {80, 180}};
    synth_scene scene;
    asj_frame frame;
    synth_scene_init(&scene, 240, SIZE, 100);
    synth_add_rectangle(&scene, (synth_point){20, 90}, 60, 90, 0, 140);
    synth_scene_add(&scene, ramp, 4, (synth_paint){140, -0.5, 0, 80, 90}, 1);
    synth_add_rectangle(&scene, (synth_point){200, 90}, 30, 90, 0, 80);
    unit_frame_of(f->context, &scene, 0.8, 1, &f->options, &frame);
    unit_near("end", 0, 0, asj_end_profile_of(&asj_edge_reference, &frame, &h, &h.branches[0], 0.15, 0).end, 210, 2);
    asj_frame_free(&f->context->memory, &frame);
}

/* A weaker edge that is as strong all along is followed to its own end; not one too faint or too short to tell. */
static void test_steady(void **state)
{
    const unit_fixture *f = *state;
    for (double part = 24; part <= 60; part += 4) {
        for (double scanned = 56 + part; scanned <= 64 + part; scanned += 4)
            unit_near("goes on", part, scanned, end_of(f, 90, 7, part, scanned, 0.15, 1), 60 + part, 2);
        unit_near("too faint", part, 0, end_of(f, 90, 2, part, 60 + part, 0.15, 1), 60, 1.5);
    }
    unit_near("too short", 0, 0, end_of(f, 90, 7, 10, 70, 0.15, 1), 60, 1.5);
    unit_near("nothing behind", 0, 0, end_of(f, 60, 0, 0, 90, 0.15, 1), 60, 1.5);
}

/* A bright corner whose upper side keeps its contrast for `plain` px and loses it over `fading` px. */
static void add_fading(synth_scene *scene, double contrast, double plain, double fading)
{
    const double x = 50, y = 90, end = x + plain + fading, slope = -contrast / fading;
    const synth_point flat[4] = {{x, y}, {x + plain, y}, {x + plain, 180}, {x, 180}};
    const synth_point ramp[4] = {{x + plain, y}, {end, y}, {end, 180}, {x + plain, 180}};
    synth_scene_init(scene, 240, SIZE, 100);
    synth_scene_add(scene, flat, 4, synth_flat(100 + contrast), 0);
    synth_scene_add(scene, ramp, 4, (synth_paint){100 + contrast, slope, 0, x + plain, y}, 1);
}

/* The half-contrast point, whatever contrast and noise are; the scan's end depends on both. */
static void test_half_contrast(void **state)
{
    const unit_fixture *f = *state;
    static const double contrasts[] = {40, 25, 40}, noises[] = {1, 2, 5};
    asj_detect_options options = f->options;
    double sum = 0;
    int moved = 0;
    for (size_t c = 0; c < UNIT_COUNT(contrasts); c++)
        for (double fading = 60; fading <= 100; fading += 20) { /* steeper ramps have edges of their own */
            synth_scene scene;
            asj_detection *found = NULL;
            double length = 0, sd = 0;
            add_fading(&scene, contrasts[c], 50, fading);
            uint8_t *pixels = unit_picture(&scene, 1, noises[c], 10 * c + (uint64_t)fading);
            const asj_image image = unit_gray8(pixels, 240, SIZE);
            for (int by_contrast = 0; by_contrast < 2; by_contrast++) {
                options.end_contrast = by_contrast ? 0.5 : 0;
                assert_int_equal(asj_detect(f->context, &image, &options, &found), ASJ_OK);
                for (uint32_t i = 0; i < found->junction_count; i++)
                    for (int32_t b = 0; b < found->junctions[i].branch_count; b++) {
                        const asj_junction *j = &found->junctions[i];
                        if (hypot(j->x - 50, j->y - 90) > 2 || unit_turn(j->branches[b].angle, 0) > 0.1)
                            continue;
                        assert_true(j->branches[b].end == ASJ_BRANCH_END_FADED || noises[c] > 2); /* noise has edges */
                        moved += by_contrast && fabs(j->branches[b].length - length) > 5;
                        length = j->branches[b].length;
                        sd = j->branches[b].length_sd;
                    }
                asj_detection_free(&found);
            }
            sum += length - 50 - fading / 2;
            unit_near("half contrast", contrasts[c], fading, length, 50 + fading / 2, fmin(3 * sd, 8));
            free(pixels);
        }
    unit_near("mean", 0, 0, sum / 9, 0, 2);
    assert_true(moved >= 6);
}

/* The contrast's share decides; of nothing there is no end. */
static void test_profile(void **state)
{
    const unit_fixture *f = *state;
    synth_scene scene;
    asj_frame frame;
    asj_hypothesis h = branch_from(50, 125);
    add_fading(&scene, 60, 60, 80);
    unit_frame_of(f->context, &scene, 0.8, 1, &f->options, &frame);
    for (double share = 0.25; share < 0.8; share += 0.25) {
        const asj_end_profile p = asj_end_profile_of(&asj_edge_reference, &frame, &h, &h.branches[0], share, 0);
        unit_near("share", share, 0, p.end, 60 + 80 * (1 - share), 3);
        const double left = share + 11 / 80.0; /* the contrast at the end: the upper quartile of that of the last 14 px */
        unit_near("fading", share, 0, p.fading, 80 * (fmax(0.75 * left, share) - 0.25 * left), 5);
    }
    asj_frame_free(&f->context->memory, &frame);
    synth_scene_init(&scene, SIZE, SIZE, 100);
    unit_frame_of(f->context, &scene, 0, 0, &f->options, &frame);
    assert_true(asj_end_profile_of(&asj_edge_reference, &frame, &h, &h.branches[0], 0.5, 0).end == 0);
    h.x = -5; /* outside */
    assert_true(asj_end_profile_of(&asj_edge_reference, &frame, &h, &h.branches[0], 0.5, 0).end == 0);
    asj_frame_free(&f->context->memory, &frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kinds), cmocka_unit_test(test_faded),         cmocka_unit_test(test_border),
        cmocka_unit_test(test_break), cmocka_unit_test(test_gap),           cmocka_unit_test(test_steady),
        cmocka_unit_test(test_half_contrast), cmocka_unit_test(test_profile),       cmocka_unit_test(test_turned_round),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
