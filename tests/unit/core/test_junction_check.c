/* SPDX-License-Identifier: BSD-2-Clause */
/* One answer to what a junction may be, whoever is asked: the check itself, segments, vanishing points, the matcher, features. */
#include "unit_test.h"

#include <asj/asj.h>

enum { SIDE = 64 };

typedef struct asked {
    asj_context *context;
    asj_image image;
    asj_vanishing_options vanishing;
} asked;

static asj_junction sound(void)
{
    asj_junction j;
    memset(&j, 0, sizeof j);
    j.x = j.y = 20;
    j.scale = 5;
    j.log10_nfa = -7;
    j.branch_count = 2;
    j.branches[0].length = j.branches[1].length = 12;
    j.branches[1].angle = 1.5f;
    return j;
}

/* All of them. `text`: what they say that it has. */
static void expect(const asked *to, const asj_junction *j, asj_status expected, const char *text)
{
    char message[128] = "old", in_context[160];
    asj_segment_list *list = NULL;
    asj_vanishing_points points;
    asj_match_result *result = NULL;
    asj_features *features = NULL;
    assert_int_equal(asj_junction_check(j, message, sizeof message), expected);
    assert_int_equal(asj_junction_check(j, NULL, 0), expected);
    if (!strstr(message, text) || (expected == ASJ_OK && message[0]))
        fail_msg("'%s' is missing in '%s'", text, message);
    snprintf(in_context, sizeof in_context, "has %s", message);
    for (int k = 0; k < 5; k++) {
        const asj_image *image = &to->image;
        asj_status status = ASJ_OK;
        switch (k) {
        case 0: status = asj_find_segments(to->context, j, 1, NULL, 0, &list); break;
        case 1: status = asj_find_vanishing_points(to->context, j, 1, &to->vanishing, &points); break;
        case 2: status = asj_match(to->context, image, j, 1, image, NULL, 0, NULL, &result); break;
        case 3: status = asj_match(to->context, image, NULL, 0, image, j, 1, NULL, &result); break;
        case 4: status = asj_features_create(to->context, image, j, 1, NULL, &features); break;
        }
        if (status != expected || (expected != ASJ_OK && !strstr(asj_context_message(to->context), in_context)))
            fail_msg("caller %d says %d, '%s', of '%s'", k, (int)status, asj_context_message(to->context), message);
        asj_match_result_free(&result);
    }
    asj_segment_list_free(&list);
    asj_features_free(&features);
}

static void what_cannot_be(const asked *to)
{
    asj_junction j;
    static const int32_t counts[] = {-1, 6, INT32_MIN, INT32_MAX}, octaves[] = {-2, 16, INT32_MAX}, ends[] = {-1, 6, 42, INT32_MIN};
    static const float lengths[] = {-4, 3e5f, INFINITY, NAN}, angles[] = {2e6f, -2e6f, INFINITY, NAN};
    static const float not_finite[] = {NAN, INFINITY, -INFINITY};
    for (size_t k = 0; k < UNIT_COUNT(counts); k++) {
        j = sound();
        j.branch_count = counts[k];
        expect(to, &j, ASJ_ERROR_ARGUMENT, " branches");
    }
    for (size_t k = 0; k < UNIT_COUNT(octaves); k++) {
        j = sound();
        j.octave = octaves[k];
        expect(to, &j, ASJ_ERROR_ARGUMENT, "octave ");
    }
    for (size_t k = 0; k < UNIT_COUNT(ends); k++) {
        j = sound();
        j.branches[1].end = ends[k];
        expect(to, &j, ASJ_ERROR_ARGUMENT, "a branch 1 with an end of kind ");
        j = sound();
        j.branches[0].length = lengths[k];
        expect(to, &j, ASJ_ERROR_ARGUMENT, "a branch 0 with a length of ");
        j = sound();
        j.branches[1].angle = angles[k];
        expect(to, &j, ASJ_ERROR_ARGUMENT, "a branch 1 with an angle of ");
    }
    for (size_t k = 0; k < 3 * 9; k++) {
        float *const numbers[] = {&j.x, &j.y, &j.log10_nfa, &j.location_sd, &j.branches[0].strength, &j.branches[0].log10_nfa,
                                  &j.branches[0].angle_sd, &j.branches[0].width, &j.branches[0].length_sd};
        j = sound();
        *numbers[k / 3] = not_finite[k % 3];
        expect(to, &j, ASJ_ERROR_ARGUMENT, "NaN or infinity");
        j = sound();
        j.scale = k % 4 < 3 ? not_finite[k % 3] : -1;
        expect(to, &j, ASJ_ERROR_ARGUMENT, "a scale of ");
    }
    assert_int_equal(asj_junction_check(NULL, NULL, 0), ASJ_ERROR_ARGUMENT);
}

/* Extremes, fewer branches than two, and whatever stands beyond the last one. */
static void what_can_be(const asked *to)
{
    asj_junction j = sound();
    j.octave = ASJ_LARGEST_OCTAVE;
    j.scale = 0;
    j.branches[0].length = ASJ_MAX_BRANCH_LENGTH;
    j.branches[0].angle = -ASJ_MAX_BRANCH_ANGLE;
    j.branches[1].length = 0;
    j.branches[1].end = ASJ_BRANCH_END_BORDER;
    j.branches[2].length = NAN;
    expect(to, &j, ASJ_OK, "");
    for (j = sound(); j.branch_count >= 0; j.branch_count--)
        expect(to, &j, ASJ_OK, "");
    j = sound();
    j.octave = ASJ_LEAST_OCTAVE;
    expect(to, &j, ASJ_OK, "");
}

static void all_say_the_same(void **state)
{
    const unit_fixture *fixture = *state;
    static uint8_t pixels[SIDE * SIDE];
    asked to = {.context = fixture->context, .image = unit_gray8(pixels, SIDE, SIDE)};
    for (int32_t n = 0; n < SIDE * SIDE; n++)
        pixels[n] = n % SIDE > 20 && n / SIDE > 20 ? 200 : 90;
    asj_vanishing_options_init(&to.vanishing);
    to.vanishing.width = to.vanishing.height = SIDE;
    what_cannot_be(&to);
    what_can_be(&to);
}

/* As much of it as there is room for. */
static void short_messages(void **state)
{
    asj_junction j = sound();
    char text[4] = "old";
    (void)state;
    j.branch_count = 6;
    assert_int_equal(asj_junction_check(&j, text, sizeof text), ASJ_ERROR_ARGUMENT);
    assert_string_equal(text, "6 b");
    assert_int_equal(asj_junction_check(&j, text, 0), ASJ_ERROR_ARGUMENT);
    assert_string_equal(text, "6 b");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_say_the_same), cmocka_unit_test(short_messages)};
    return cmocka_run_group_tests_name("junction_check", tests, unit_set_up, unit_tear_down);
}
