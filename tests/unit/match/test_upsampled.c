/* SPDX-License-Identifier: BSD-2-Clause */
/* Junctions of octave -1: they are matched in the upsampled images, from images, features and bytes alike, and only where the
 * images themselves confirm them; otherwise the result is what there is without them. L-junctions are numbered as all of them
 * are. */
#include "core/bytes.h"
#include "upsampled_views.h"
#include "match/same_place.h"

static asj_match_result *match(asj_context *context, const asj_detection *a, const asj_detection *b,
                               const asj_match_options *options)
{
    asj_match_result *result = NULL;
    assert_int_equal(asj_match(context, &views[0].image, a->junctions, a->junction_count, &views[1].image, b->junctions,
                               b->junction_count, options, &result), ASJ_OK);
    return result;
}

/* L-junctions are all of the detection's, and matches stand where theirs do. */
static void assert_numbered(const asj_match_result *r, const asj_detection *a, const asj_detection *b)
{
    const size_t counts[2] = {r->l_junction_count1, r->l_junction_count2};
    const asj_detection *const of[2] = {a, b};
    for (int32_t n = 0; n < 2; n++) {
        const asj_l_junction *shown = n ? r->l_junctions2 : r->l_junctions1;
        assert_int_equal(counts[n], of[n]->l_junction_count);
        for (size_t l = 0; l < counts[n]; l++) {
            const asj_l_junction *wanted = &of[n]->l_junctions[l];
            assert_int_equal(shown[l].junction, wanted->junction);
            unit_near("x", (double)n, (double)l, (double)shown[l].x, (double)wanted->x, 1e-4);
            unit_near("by", (double)n, (double)l, (double)shown[l].by, (double)wanted->by, 1e-3);
        }
    }
    for (uint32_t k = 0; k < r->match_count; k++) {
        const asj_junction_match *m = &r->matches[k];
        assert_true(m->l1 < counts[0] && m->l2 < counts[1]);
        assert_true(m->x1 == r->l_junctions1[m->l1].x && m->y1 == r->l_junctions1[m->l1].y);
        assert_int_equal(m->junction1, r->l_junctions1[m->l1].junction);
        assert_int_equal(m->junction2, r->l_junctions2[m->l2].junction);
        assert_true(hypotf(m->x2 - r->l_junctions2[m->l2].x, m->y2 - r->l_junctions2[m->l2].y) < 8);
    }
}

static uint32_t upsampled_ones(const asj_match_result *r, const asj_detection *a)
{
    uint32_t count = 0;
    for (uint32_t k = 0; k < r->match_count; k++)
        count += a->junctions[r->matches[k].junction1].octave < 0;
    return count;
}

static void more_matches(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *plain = match(context, views[0].plain, views[1].plain, NULL);
    asj_match_result *upsampled = match(context, views[0].upsampled, views[1].upsampled, NULL);
    asj_match_result *mixed = match(context, views[0].upsampled, views[1].plain, NULL);
    printf("%u matches, with octave -1 %u, with that of one image %u\n", (unsigned)plain->match_count,
           (unsigned)upsampled->match_count, (unsigned)mixed->match_count);
    assert_true(plain->match_count > 10 && 4 * upsampled->match_count > 5 * plain->match_count);
    assert_true(4 * upsampled_ones(upsampled, views[0].upsampled) > upsampled->match_count);
    assert_numbered(plain, views[0].plain, views[1].plain);
    assert_numbered(upsampled, views[0].upsampled, views[1].upsampled);
    assert_numbered(mixed, views[0].upsampled, views[1].plain);
    asj_match_result_free(&plain);
    asj_match_result_free(&upsampled);
    asj_match_result_free(&mixed);
}

/* --- which of two results holds: passes that answer as they are told -------------------------------------------------------- */

typedef struct answers {
    int32_t passes;
    int own_is_empty, upsampled_is_other; /* what they answer */
    uint32_t upsampled_count;
} answers;

/* Matches of the plain junctions for the images themselves; for the upsampled ones of all, right or of the first image with
 * itself upside down. */
static asj_status answer(asj_context *context, const asj_match_options *options, const void *data, int32_t upsampled,
                         const asj_known_matches *known, asj_match_result **result)
{
    answers *a = *(answers *const *)data;
    static uint8_t turned[WIDTH * HEIGHT];
    asj_detection *found = NULL;
    asj_detect_options how;
    a->passes++;
    assert_true(!known == !upsampled); /* the images' own matches say where those of the upsampled ones lie */
    if (!upsampled) {
        const uint32_t count = a->own_is_empty ? 3 : views[0].plain->junction_count;
        return asj_match(context, &views[0].image, views[0].plain->junctions, count, &views[1].image, views[1].plain->junctions,
                         views[1].plain->junction_count, options, result);
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        turned[i] = views[0].pixels[WIDTH * HEIGHT - 1 - i];
    const asj_image image = unit_gray8(a->upsampled_is_other ? turned : views[1].pixels, WIDTH, HEIGHT);
    asj_detect_options_preset(&how, ASJ_PRESET_MATCH);
    how.epsilon = 1e5; /* and so some more of them */
    assert_int_equal(asj_detect(context, &image, &how, &found), ASJ_OK);
    const asj_status status = asj_match(context, &views[0].image, views[0].plain->junctions, views[0].plain->junction_count, &image,
                                        found->junctions, found->junction_count, options, result);
    asj_detection_free(&found);
    a->upsampled_count = status == ASJ_OK ? (*result)->match_count : 0;
    return status;
}

static uint32_t twice_at_one_place(const asj_match_result *r)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < r->match_count; n++)
        for (uint32_t m = 0; m < n; m++) {
            const asj_junction_match *a = &r->matches[n], *b = &r->matches[m];
            count += fabsf(a->x1 - b->x1) <= 1 && fabsf(a->y1 - b->y1) <= 1 && fabsf(a->x2 - b->x2) <= 1 &&
                     fabsf(a->y2 - b->y2) <= 1;
        }
    return count;
}

/* Of a corner that octaves -1 and 0 have found, within a pixel in both images, the match that looks most alike. */
static void one_match_for_each_place(void **state)
{
    static const struct { float dx1, dy1, dx2, dy2, similarity; uint32_t left; } moves[] = {
        {0, 0, 0, 0, 0.5f, 1},  {0.9f, -0.9f, 0.9f, 0.9f, 0.5f, 1}, {-0.9f, 0.9f, 0, -0.9f, 0.9f, 1}, {1.1f, 0, 0, 0, 0.5f, 2},
        {0, -1.1f, 0, 0, 1, 2}, {0, 0, -1.1f, 0, 0.5f, 2},         {0, 0, 0, 1.1f, 1, 2},
    };
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(moves); k++) {
        asj_match_result *r = match(context, views[0].upsampled, views[1].upsampled, NULL);
        asj_junction_match *list = ((asj_own_result *)r)->matches;
        assert_true(r->match_count > 20);
        assert_int_equal(twice_at_one_place(r), 0);
        const uint32_t before = r->match_count;
        const float x = list[7].x1 = 50 + list[7].x1 / 1000; /* unlike any other */
        list[7].similarity = 0.7f;
        list[3] = list[7];
        list[3].x1 += moves[k].dx1;
        list[3].y1 += moves[k].dy1;
        list[3].x2 += moves[k].dx2;
        list[3].y2 += moves[k].dy2;
        list[3].similarity = moves[k].similarity;
        assert_int_equal(asj_same_place(context, r), ASJ_OK);
        assert_int_equal(before - r->match_count, 2 - moves[k].left);
        uint32_t left = 0, of_seven = 0;
        for (uint32_t n = 0; n < r->match_count; n++) {
            const int is_seven = r->matches[n].x1 == x && r->matches[n].similarity == 0.7f;
            of_seven += is_seven ? 1 : 0;
            left += is_seven || r->matches[n].similarity == moves[k].similarity;
        }
        assert_int_equal(left, moves[k].left);
        assert_int_equal(of_seven, moves[k].left == 2 || moves[k].similarity < 0.7f);
        asj_match_result_free(&r);
    }
}

static void only_what_is_confirmed(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_options options;
    asj_match_options_init(&options);
    asj_match_result *plain = match(context, views[0].plain, views[1].plain, NULL);
    for (int32_t n = 0; n < 2; n++) {
        answers a = {0, n == 0, n == 1, 0};
        answers *data = &a;
        asj_match_result *result = NULL;
        const asj_upsampled_match both = {answer, &data, {views[0].upsampled->junctions, views[1].upsampled->junctions},
                                      {views[0].upsampled->junction_count, views[1].upsampled->junction_count}, 0, NULL};
        assert_int_equal(asj_match_upsampled(context, &options, &both, &result), ASJ_OK);
        assert_int_equal(a.passes, n == 0 ? 1 : 2); /* nothing comes of the images: no second look */
        assert_true(n == 0 || a.upsampled_count > plain->match_count); /* enough, of the first image turned */
        assert_int_equal(result->match_count, n == 0 ? 0 : plain->match_count);
        for (uint32_t k = 0; k < result->match_count; k++)
            assert_true(result->matches[k].x1 == plain->matches[k].x1 && result->matches[k].y2 == plain->matches[k].y2 &&
                        memcmp(result->matches[k].affine, plain->matches[k].affine, sizeof plain->matches[k].affine) == 0);
        asj_match_result_free(&result);
    }
    asj_match_result_free(&plain);
}

/* Matches that would do, and geometries as told: a pose for the images themselves, and for the upsampled ones perhaps. */
static asj_status answer_with_geometry(asj_context *context, const asj_match_options *options, const void *data, int32_t upsampled,
                                       const asj_known_matches *known, asj_match_result **result)
{
    const int32_t upsampled_has_pose = **(const int32_t *const *)data;
    (void)known;
    const asj_detection *a = upsampled ? views[0].upsampled : views[0].plain, *b = upsampled ? views[1].upsampled : views[1].plain;
    const asj_status status = asj_match(context, &views[0].image, a->junctions, a->junction_count, &views[1].image, b->junctions,
                                        b->junction_count, options, result);
    if (status == ASJ_OK) {
        (*result)->geometry.status = ASJ_GEOMETRY_ACCEPTED;
        (*result)->geometry.model = ASJ_GEOMETRY_ESSENTIAL;
        (*result)->geometry.has_pose = !upsampled || upsampled_has_pose;
        (*result)->geometry.log10_nfa = upsampled ? -2 : -1;
    }
    return status;
}

static void a_pose_is_kept(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_options options;
    asj_match_options_init(&options);
    for (int32_t has_pose = 0; has_pose < 2; has_pose++) {
        const int32_t *data = &has_pose;
        asj_match_result *result = NULL;
        const asj_upsampled_match both = {answer_with_geometry, &data,
                                          {views[0].upsampled->junctions, views[1].upsampled->junctions},
                                          {views[0].upsampled->junction_count, views[1].upsampled->junction_count}, 0, NULL};
        assert_int_equal(asj_match_upsampled(context, &options, &both, &result), ASJ_OK);
        assert_true(result->geometry.has_pose);
        assert_true(result->geometry.log10_nfa == (has_pose ? -2 : -1)); /* of the upsampled images only with a pose */
        asj_match_result_free(&result);
    }
}

/* The images' own matches, and those of the left part of the upsampled ones. */
static asj_status answer_part(asj_context *context, const asj_match_options *options, const void *data, int32_t upsampled,
                              const asj_known_matches *known, asj_match_result **result)
{
    const asj_detection *a = upsampled ? views[0].upsampled : views[0].plain, *b = upsampled ? views[1].upsampled : views[1].plain;
    asj_junction *left = calloc(a->junction_count, sizeof *left);
    size_t count = 0;
    (void)data;
    (void)known;
    assert_non_null(left);
    for (uint32_t k = 0; k < a->junction_count; k++)
        if (!upsampled || a->junctions[k].x < 0.7 * WIDTH)
            left[count++] = a->junctions[k];
    const asj_status status = asj_match(context, &views[0].image, left, count, &views[1].image, b->junctions, b->junction_count,
                                        options, result);
    free(left);
    return status;
}

/* How many of the matches have one of m's places, and how many both. */
static void count_near(const asj_match_result *r, const asj_junction_match *m, uint32_t *one, uint32_t *both)
{
    *one = *both = 0;
    for (uint32_t k = 0; k < r->match_count; k++) {
        const asj_junction_match *f = &r->matches[k];
        const int at1 = fabsf(f->x1 - m->x1) <= 4 && fabsf(f->y1 - m->y1) <= 4;
        const int at2 = fabsf(f->x2 - m->x2) <= 4 && fabsf(f->y2 - m->y2) <= 4;
        *one += (uint32_t)(at1 || at2);
        *both += (uint32_t)(at1 && at2);
    }
}

/* What the upsampled images do not see remains, as it is in the images; no place has another match for that. */
static void what_only_the_images_have_remains(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_options options;
    asj_match_options_init(&options);
    asj_match_result *own = NULL, *part = NULL;
    assert_int_equal(answer_part(context, &options, NULL, 0, NULL, &own), ASJ_OK);
    assert_int_equal(answer_part(context, &options, NULL, 1, NULL, &part), ASJ_OK);
    const uint32_t part_count = part->match_count, first = part->l_junction_count1;
    assert_true(part_count > own->match_count);
    uint32_t wanted = 0, kept = 0, one, both;
    for (uint32_t k = 0; k < own->match_count; k++) {
        count_near(part, &own->matches[k], &one, &both);
        wanted += one == 0;
    }
    assert_int_equal(asj_upsampled_choose(context, &own, &part, 0), ASJ_OK);
    assert_null(part);
    assert_true(wanted > 3);
    assert_int_equal(own->match_count, part_count + wanted);
    for (uint32_t k = 0; k < own->match_count; k++) {
        const asj_junction_match *m = &own->matches[k];
        assert_true(k == 0 || own->matches[k - 1].distance <= m->distance);
        assert_true(m->l1 < own->l_junction_count1 && m->l2 < own->l_junction_count2);
        assert_true(m->x1 == own->l_junctions1[m->l1].x && m->y1 == own->l_junctions1[m->l1].y);
        assert_int_equal(m->junction1, own->l_junctions1[m->l1].junction);
        assert_int_equal(m->junction2, own->l_junctions2[m->l2].junction);
        if (m->l1 < first)
            continue;
        kept++;
        count_near(own, m, &one, &both);
        assert_int_equal(one, 1); /* itself */
        assert_true(m->junction1 > own->l_junctions1[first - 1].junction);
    }
    assert_int_equal(kept, wanted);
    const asj_around around = asj_match_result_around(own);
    assert_int_equal(around.place_count, own->match_count);
    asj_match_result_free(&own);
}

/* As many matches of the upsampled images moved as make them contradict the images' own, as a period does: the own ones are the
 * answer, although half of them come again. */
static void what_contradicts_is_no_answer(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, views[0].plain, views[1].plain, NULL);
    asj_match_result *upsampled = match(context, views[0].upsampled, views[1].upsampled, NULL);
    const uint32_t own_count = own->match_count, upsampled_count = upsampled->match_count;
    assert_true(upsampled_count > own_count);
    for (int32_t moved = 0; moved < 2; moved++) {
        asj_match_result *kept = match(context, views[0].plain, views[1].plain, NULL);
        asj_match_result *other = match(context, views[0].upsampled, views[1].upsampled, NULL);
        asj_junction_match *matches = (asj_junction_match *)(uintptr_t)other->matches;
        for (uint32_t k = 0; moved && k < upsampled_count; k += 2)
            matches[k].x2 += 20;
        assert_int_equal(asj_upsampled_choose(context, &kept, &other, 1), ASJ_OK);
        assert_true(moved ? kept->match_count == own_count : kept->match_count >= upsampled_count);
        asj_match_result_free(&kept);
    }
    asj_match_result_free(&own);
    asj_match_result_free(&upsampled);
}

/* --- features ---------------------------------------------------------------------------------------------------------------- */

static void assert_same(const asj_match_result *a, const asj_match_result *b)
{
    assert_true(a->match_count > 0);
    assert_int_equal(a->match_count, b->match_count);
    assert_memory_equal(a->matches, b->matches, a->match_count * sizeof *a->matches);
    assert_int_equal(a->l_junction_count2, b->l_junction_count2);
    assert_memory_equal(a->l_junctions2, b->l_junctions2, a->l_junction_count2 * sizeof *a->l_junctions2);
    assert_memory_equal(&a->geometry, &b->geometry, sizeof a->geometry);
}

static asj_features *features_of(asj_context *context, int32_t n)
{
    asj_features *features = NULL;
    assert_int_equal(asj_features_create(context, &views[n].image, views[n].upsampled->junctions,
                                         views[n].upsampled->junction_count, NULL, &features), ASJ_OK);
    return features;
}

static uint8_t *bytes_of(const asj_features *features, size_t *size)
{
    *size = asj_features_save(features, NULL, 0);
    uint8_t *bytes = malloc(*size);
    assert_non_null(bytes);
    assert_int_equal(asj_features_save(features, bytes, *size), *size);
    return bytes;
}

static void features_and_bytes(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_options options;
    asj_match_options_init(&options);
    for (int32_t model = 0; model < 2; model++) {
        options.geometry.model = model ? ASJ_GEOMETRY_FUNDAMENTAL : ASJ_GEOMETRY_NONE;
        asj_match_result *expected = match(context, views[0].upsampled, views[1].upsampled, &options);
        asj_features *made[2], *read[2];
        for (int32_t n = 0; n < 2; n++) {
            size_t size, size2;
            made[n] = features_of(context, n);
            uint8_t *bytes = bytes_of(made[n], &size);
            assert_int_equal(asj_get_u32(bytes + 8), 3); /* no colours */
            assert_true(size < 2 * WIDTH * HEIGHT + 4096 + 200 * (size_t)views[n].upsampled->junction_count); /* no plane of it */
            assert_int_equal(asj_features_load(context, bytes, size, &read[n]), ASJ_OK);
            uint8_t *second = bytes_of(read[n], &size2);
            assert_int_equal(size, size2);
            assert_memory_equal(bytes, second, size);
            free(bytes);
            free(second);
            asj_features_info info;
            asj_features_get_info(read[n], &info);
            assert_true(info.width == WIDTH && info.height == HEIGHT);
            assert_int_equal(info.l_junction_count, views[n].upsampled->l_junction_count);
            assert_memory_equal(info.l_junctions, views[n].upsampled->l_junctions,
                                info.l_junction_count * sizeof *info.l_junctions);
        }
        asj_match_result *result = NULL;
        assert_int_equal(asj_match_features(context, made[0], read[1], &options, &result), ASJ_OK);
        assert_same(expected, result);
        asj_match_result_free(&result);
        assert_int_equal(asj_match_features(context, read[0], made[1], &options, &result), ASJ_OK);
        assert_same(expected, result);
        asj_match_result_free(&result);
        asj_match_result_free(&expected);
        for (int32_t n = 0; n < 2; n++) {
            asj_features_free(&made[n]);
            asj_features_free(&read[n]);
        }
    }
}

/* Version 8: a file of octave -1 with the colours of the image and of the upsampled one. The image is reddish, and the junctions of
 * octave -1 come back as such. */
static void colours_and_octaves_come_back(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    uint8_t *rgb = malloc((size_t)3 * WIDTH * HEIGHT);
    const uint8_t *gray = views[0].image.data;
    assert_non_null(rgb);
    for (size_t n = 0; n < (size_t)WIDTH * HEIGHT; n++) {
        rgb[3 * n] = gray[n];
        rgb[3 * n + 1] = gray[n] / 2;
        rgb[3 * n + 2] = gray[n] / 3;
    }
    const asj_image image = {rgb, ASJ_FORMAT_RGB8, WIDTH, HEIGHT, 0, 0};
    const asj_detection *found = views[0].upsampled;
    asj_features *made = NULL, *read = NULL;
    assert_int_equal(asj_features_create(context, &image, found->junctions, found->junction_count, NULL, &made), ASJ_OK);
    size_t size, size2;
    uint8_t *bytes = bytes_of(made, &size);
    assert_int_equal(asj_get_u32(bytes + 8), 16);
    assert_int_equal(asj_features_load(context, bytes, size, &read), ASJ_OK);
    uint8_t *second = bytes_of(read, &size2);
    assert_int_equal(size, size2);
    assert_memory_equal(bytes, second, size);
    asj_features_info info;
    asj_features_get_info(read, &info);
    assert_int_equal(info.junction_count, found->junction_count);
    uint32_t upsampled = 0, own = 0;
    for (uint32_t n = 0; n < info.junction_count; n++) {
        assert_int_equal(info.junctions[n].octave, found->junctions[n].octave);
        upsampled += info.junctions[n].octave == -1;
        own += info.junctions[n].octave >= 0;
    }
    assert_true(upsampled > 0 && own > 0);
    free(bytes);
    free(second);
    free(rgb);
    asj_features_free(&made);
    asj_features_free(&read);
}

static void refuse(asj_context *context, uint8_t *bytes, size_t size, asj_status status, const char *word)
{
    asj_features *features = NULL;
    asj_put_u64(bytes + 16, size);
    asj_put_u32(bytes + 12, asj_crc32(bytes + 16, size - 16));
    assert_int_equal(asj_features_load(context, bytes, size, &features), status);
    assert_null(features);
    if (!strstr(asj_context_message(context), word))
        fail_msg("\"%s\" does not say %s", asj_context_message(context), word);
}

static void hostile_bytes(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_features *features = features_of(context, 0);
    size_t size;
    uint8_t *bytes = bytes_of(features, &size);
    asj_put_u32(bytes + 8, 5); /* colours of a finer octave, and no finer octave */
    refuse(context, bytes, size, ASJ_ERROR_FORMAT, "upsampled image");
    asj_put_u32(bytes + 8, 17);
    refuse(context, bytes, size, ASJ_ERROR_UNSUPPORTED, "version 17");
    asj_put_u32(bytes + 8, 11); /* octave -1, and an image at half its size that is not there */
    refuse(context, bytes, size, ASJ_ERROR_FORMAT, "half its size");
    asj_put_u32(bytes + 8, 4);
    refuse(context, bytes, size, ASJ_ERROR_FORMAT, "colours are not all there");
    asj_put_u32(bytes + 8, 3);
    const size_t octave = 40 + asj_get_u32(bytes + 32) + 24; /* of the first junction */
    const uint32_t right = asj_get_u32(bytes + octave);
    asj_put_u32(bytes + octave, (uint32_t)-2);
    refuse(context, bytes, size, ASJ_ERROR_FORMAT, "cannot be, with octave -2");
    asj_put_u32(bytes + octave, right);
    refuse(context, bytes, size - 2, ASJ_ERROR_FORMAT, "damaged");
    asj_put_u16(bytes + size - 2, 0xffff);
    refuse(context, bytes, size, ASJ_ERROR_FORMAT, "whiter than white");
    free(bytes);
    asj_features_free(&features);
}

enum { PART = 110 }; /* px */

/* The junctions left of x. */
static asj_junction *left_part(const asj_detection *detection, float x, uint32_t *count)
{
    asj_junction *list = calloc(detection->junction_count, sizeof *list);
    assert_non_null(list);
    *count = 0;
    for (uint32_t n = 0; n < detection->junction_count; n++)
        if (detection->junctions[n].x < x)
            list[(*count)++] = detection->junctions[n];
    return list;
}

/* Every allocation once (UNIT_ALLOCATION_STEP), each in a run of its own; the library may do without one, and then
 * there is a result. Of a part of the images, which is enough for the upsampled ones to hold. */
static void out_of_memory(void **state)
{
    (void)state;
    int reached = 1, upsampled = 0;
    uint32_t counts[2];
    asj_junction *part[2];
    for (int32_t side = 0; side < 2; side++)
        part[side] = left_part(views[side].upsampled, PART, &counts[side]);
    for (long n = 1; n < 2000 && reached; n += UNIT_ALLOCATION_STEP) {
        unit_counter counter = {0, 0, 0, 0};
        asj_context *poor = unit_context(&counter, 1);
        asj_match_result *result = NULL;
        counter.fail_at = counter.calls + n;
        const asj_status status = asj_match(poor, &views[0].image, part[0], counts[0], &views[1].image, part[1], counts[1], NULL,
                                            &result);
        reached = unit_reached(&counter);
        assert_true(status == ASJ_OK ? result != NULL : reached && status == ASJ_ERROR_MEMORY && result == NULL);
        upsampled = status == ASJ_OK && result->upsampled;
        asj_match_result_free(&result);
        unit_context_free(&counter, &poor);
    }
    assert_false(reached);
    assert_true(upsampled);
    free(part[0]);
    free(part[1]);
}

/* What the log says, line after line, and how serious the worst line is. */
typedef struct log_lines {
    int32_t worst;
    char text[4096];
} log_lines;

static void keep_lines(void *user, int32_t level, const char *message)
{
    log_lines *lines = user;
    const size_t used = strlen(lines->text);
    lines->worst = level < lines->worst ? level : lines->worst;
    snprintf(lines->text + used, sizeof lines->text - used, "%s\n", message);
}

/* An image that is too long to be upsampled: its junctions of octave -1 are left out, which is no error. */
static void what_is_too_large_to_upsample_is_left_out(void **state)
{
    enum { LONG = ASJ_MAX_SIDE / 2 + 2, HIGH = 16 };
    log_lines lines = {ASJ_LOG_DEBUG, ""};
    asj_context_options options;
    asj_context *context = NULL;
    asj_match_result *result = NULL;
    asj_features *features = NULL;
    asj_junction corner = {.x = 40, .y = 8, .scale = 7, .log10_nfa = -10, .branch_count = 2, .octave = -1};
    uint8_t *pixels = calloc(LONG, HIGH);
    assert_non_null(pixels);
    (void)state;
    corner.branches[0].length = corner.branches[1].length = 5;
    corner.branches[1].angle = 1.5f;
    const asj_image image = unit_gray8(pixels, LONG, HIGH);
    asj_context_options_init(&options);
    options.backend = ASJ_BACKEND_CPU;
    options.log = keep_lines;
    options.log_user = &lines;
    options.log_level = ASJ_LOG_INFO;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    assert_int_equal(asj_match(context, &image, &corner, 1, &image, &corner, 1, NULL, &result), ASJ_OK);
    assert_int_equal(result->upsampled, 0);
    assert_int_equal(lines.worst, ASJ_LOG_INFO);
    assert_non_null(strstr(lines.text, "left out: an image of 32769 x 16 pixels is too large for octave -1"));
    assert_string_equal(asj_context_message(context), "");
    asj_match_result_free(&result);
    assert_int_equal(asj_features_create(context, &image, &corner, 1, NULL, &features), ASJ_ERROR_LIMIT);
    assert_int_equal(lines.worst, ASJ_LOG_ERROR);
    assert_non_null(strstr(asj_context_message(context), "too large for octave -1"));
    asj_context_free(&context);
    free(pixels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_match_for_each_place),
        cmocka_unit_test(more_matches),       cmocka_unit_test(only_what_is_confirmed), cmocka_unit_test(a_pose_is_kept),
        cmocka_unit_test(features_and_bytes), cmocka_unit_test(hostile_bytes),          cmocka_unit_test(out_of_memory),
        cmocka_unit_test(colours_and_octaves_come_back), cmocka_unit_test(what_only_the_images_have_remains),
        cmocka_unit_test(what_contradicts_is_no_answer),  cmocka_unit_test(what_is_too_large_to_upsample_is_left_out),
    };
    return cmocka_run_group_tests(tests, make_views, free_views);
}
