/* SPDX-License-Identifier: BSD-2-Clause */
/* Features that are kept: they match as asj_match() does, bit for bit, from any context, any thread and any bytes; bytes that are
 * damaged, cut or hostile give an error. */
#include "core/bytes.h"
#include "core/threads.h"
#include "match/kept_features.h"
#include "unit_test.h"

#define WIDTH 320
#define HEIGHT 237

/* Two views of the room with the junctions that the detector finds. */
typedef struct view {
    uint8_t *pixels;
    asj_image image;
    asj_detection *found;
    uint32_t count; /* of its junctions that are used */
} view;

static view views[2];

static int make_views(void **state)
{
    assert_int_equal(unit_set_up(state), 0);
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_detect_options options;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    for (int32_t n = 0; n < 2; n++) {
        views[n].pixels = unit_room_picture(n, WIDTH, HEIGHT);
        views[n].image = unit_gray8(views[n].pixels, WIDTH, HEIGHT);
        assert_int_equal(asj_detect(context, &views[n].image, &options, &views[n].found), ASJ_OK);
        assert_true(views[n].found->junction_count > 60);
        views[n].count = views[n].found->junction_count;
    }
    return 0;
}

static int free_views(void **state)
{
    for (int32_t n = 0; n < 2; n++) {
        asj_detection_free(&views[n].found);
        free(views[n].pixels);
    }
    return unit_tear_down(state);
}

static asj_features *features_of(asj_context *context, int32_t n, const asj_match_options *options)
{
    asj_features *features = NULL;
    assert_int_equal(asj_features_create(context, &views[n].image, views[n].found->junctions, views[n].count, options,
                                         &features), ASJ_OK);
    assert_non_null(features);
    return features;
}

static asj_match_result *match_images(asj_context *context, const asj_match_options *options)
{
    asj_match_result *result = NULL;
    assert_int_equal(asj_match(context, &views[0].image, views[0].found->junctions, views[0].count, &views[1].image,
                               views[1].found->junctions, views[1].count, options, &result), ASJ_OK);
    return result;
}

static void assert_same(const asj_match_result *a, const asj_match_result *b)
{
    assert_int_equal(a->match_count, b->match_count);
    assert_int_equal(a->candidates, b->candidates);
    assert_int_equal(a->l_junction_count1, b->l_junction_count1);
    if (a->match_count > 0)
        assert_memory_equal(a->matches, b->matches, a->match_count * sizeof *a->matches);
    assert_memory_equal(a->l_junctions2, b->l_junctions2, a->l_junction_count2 * sizeof *a->l_junctions2);
    assert_memory_equal(&a->geometry, &b->geometry, sizeof a->geometry);
}

/* Matches kept features with the context, and frees them. */
static void assert_matches(asj_context *context, asj_features *f[2], const asj_match_options *options,
                           const asj_match_result *expected)
{
    asj_match_result *result = NULL;
    assert_int_equal(asj_match_features(context, f[0], f[1], options, &result), ASJ_OK);
    assert_same(expected, result);
    asj_match_result_free(&result);
    asj_features_free(&f[0]);
    asj_features_free(&f[1]);
    assert_null(f[0]);
}

static uint8_t *bytes_of(const asj_features *features, size_t *size)
{
    *size = asj_features_save(features, NULL, 0);
    uint8_t *bytes = malloc(*size);
    assert_non_null(bytes);
    memset(bytes, 0xa5, *size);
    assert_int_equal(asj_features_save(features, bytes, *size - 1), *size); /* does not fit */
    assert_int_equal(bytes[0], 0xa5);
    assert_int_equal(asj_features_save(features, bytes, *size), *size);
    return bytes;
}

/* Through bytes and back; frees those given. */
static asj_features *again(asj_context *context, asj_features *features)
{
    size_t size, size2;
    asj_features *loaded = NULL;
    uint8_t *bytes = bytes_of(features, &size);
    assert_int_equal(asj_features_load(context, bytes, size, &loaded), ASJ_OK);
    uint8_t *second = bytes_of(loaded, &size2);
    assert_int_equal(size, size2);
    assert_memory_equal(bytes, second, size);
    asj_features_info info, info2;
    asj_features_get_info(features, &info);
    asj_features_get_info(loaded, &info2);
    assert_int_equal(info.bytes, info2.bytes);
    assert_memory_equal(info.junctions, info2.junctions, info.junction_count * sizeof *info.junctions);
    free(bytes);
    free(second);
    asj_features_free(&features);
    return loaded;
}

static void the_same_bits_with_any_options(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static const char *const settings[][2] = {{"ratio", "1.5"}, {"descriptor", "sift"}, {"neighbours", "0"}, {"normalise", "no"},
                                              {"smoothing", "0"}, {"patches", "induced"}, {"length_hypotheses", "1"}};
    for (size_t n = 0; n < UNIT_COUNT(settings); n++) {
        asj_match_options options;
        char message[256];
        asj_match_options_init(&options);
        assert_int_equal(asj_match_options_set(&options, settings[n][0], settings[n][1], message, sizeof message), ASJ_OK);
        if (strcmp(settings[n][0], "neighbours") == 0)
            options.minimum_support = 0;
        for (int32_t v = 0; v < 2; v++) /* induced patches take long */
            views[v].count = options.patches == ASJ_PATCHES_INDUCED ? 60 : views[v].found->junction_count;
        if (n == 0)
            options.geometry.model = ASJ_GEOMETRY_FUNDAMENTAL;
        asj_match_result *expected = match_images(context, &options);
        assert_true(expected->match_count > 0);
        asj_features *f[2] = {features_of(context, 0, &options), features_of(context, 1, &options)};
        assert_matches(context, f, n == 0 ? &options : NULL, expected);
        asj_features *g[2] = {again(context, features_of(context, 0, &options)), again(context, features_of(context, 1, &options))};
        assert_matches(context, g, &options, expected);
        asj_match_result_free(&expected);
    }
}

static void they_outlive_their_context(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *expected = match_images(context, NULL);
    asj_context_options options;
    asj_context_options_init(&options);
    options.threads = 3;
    options.simd = ASJ_SIMD_REFERENCE;
    asj_features *f[2];
    for (int32_t n = 0; n < 2; n++) {
        asj_context *other;
        assert_int_equal(asj_context_create(&options, &other), ASJ_OK);
        f[n] = features_of(other, n, NULL);
        asj_context_free(&other);
    }
    assert_matches(context, f, NULL, expected);
    asj_match_result_free(&expected);
}

typedef struct job {
    asj_features *const *f;
    asj_context **contexts;
    asj_match_result **results;
    asj_status *status;
} job;

static void match_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end; n++)
        j->status[n] = asj_match_features(j->contexts[n], j->f[0], j->f[1], NULL, &j->results[n]);
}

/* At once where there are threads, with a context each. */
static void many_threads_match_the_same_features(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *expected = match_images(context, NULL);
    asj_features *f[2] = {features_of(context, 0, NULL), features_of(context, 1, NULL)};
    asj_match_result *results[2];
    asj_status status[2];
    asj_context *contexts[2], *two;
    asj_context_options options;
    asj_context_options_init(&options);
    options.threads = 2;
    assert_int_equal(asj_context_create(&options, &two), ASJ_OK);
    for (int32_t n = 0; n < 2; n++)
        assert_int_equal(asj_context_create(NULL, &contexts[n]), ASJ_OK);
    const job j = {f, contexts, results, status};
    asj_parallel(two, 2, 2, 1, match_some, &j);
    asj_context_free(&two);
    for (int32_t n = 0; n < 2; n++) {
        assert_int_equal(status[n], ASJ_OK);
        assert_same(expected, results[n]);
        asj_match_result_free(&results[n]);
        asj_context_free(&contexts[n]);
    }
    asj_match_result_free(&expected);
    asj_features_free(&f[0]);
    asj_features_free(&f[1]);
}

static void other_options_are_refused(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_options sift, wider;
    asj_match_result *result = NULL;
    asj_match_options_init(&sift);
    sift.descriptor = ASJ_DESCRIPTOR_SIFT;
    asj_match_options_init(&wider);
    wider.separation = 7;
    asj_features *raw = features_of(context, 0, NULL), *other = features_of(context, 1, &sift);
    assert_int_equal(asj_match_features(context, raw, other, NULL, &result), ASJ_ERROR_OPTION);
    assert_string_equal(asj_context_message(context), "the features of image 2 were made with descriptor sift, not raw");
    assert_int_equal(asj_match_features(context, raw, raw, &wider, &result), ASJ_ERROR_OPTION);
    assert_string_equal(asj_context_message(context), "the features of image 1 were made with separation 6, not 7");
    asj_match_options_init(&wider);
    wider.ratio = 1.2; /* concerns the pair only */
    assert_int_equal(asj_match_features(context, raw, raw, &wider, &result), ASJ_OK);
    asj_match_result_free(&result);
    asj_features_free(&other); /* -0 is 0 */
    wider.window_start = 0;
    other = features_of(context, 1, &wider);
    wider.window_start = -wider.window_start;
    assert_int_equal(asj_match_features(context, other, other, &wider, &result), ASJ_OK);
    asj_match_result_free(&result);
    wider.ratio = 0;
    assert_int_equal(asj_match_features(context, raw, raw, &wider, &result), ASJ_ERROR_OPTION);
    assert_int_equal(asj_match_features(context, raw, NULL, NULL, &result), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_match_features(NULL, raw, raw, NULL, &result), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_match_features(context, raw, raw, NULL, NULL), ASJ_ERROR_ARGUMENT);
    asj_features_free(&raw);
    asj_features_free(&other);
    asj_features_free(&other);
    asj_features_free(NULL);
    assert_int_equal(asj_features_create(context, NULL, NULL, 0, NULL, &raw), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_features_create(context, &views[0].image, NULL, 1, NULL, &raw), ASJ_ERROR_ARGUMENT);
    const asj_junction one = {.branch_count = 2};
    assert_int_equal(asj_features_create(context, &views[0].image, &one, SIZE_MAX / sizeof one, NULL, &raw), ASJ_ERROR_LIMIT);
    assert_int_equal(asj_features_create(context, &views[0].image, NULL, 0, NULL, NULL), ASJ_ERROR_ARGUMENT);
    asj_match_options bad;
    for (int what = 0; what < 3; what++) {
        asj_match_options_init(&bad);
        bad.geometry.model = what == 0 ? 99 : ASJ_GEOMETRY_AUTO;
        bad.reserved[15] = what == 1;
        bad.geometry.reserved[11] = what == 2;
        assert_int_equal(asj_features_create(context, &views[0].image, NULL, 0, &bad, &raw), ASJ_ERROR_OPTION);
        assert_null(raw);
    }
    assert_int_equal(asj_features_load(context, NULL, 0, &raw), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_features_save(NULL, NULL, 0), 0);
}

static void an_image_without_junctions(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_features *f = NULL, *g = features_of(context, 1, NULL);
    asj_match_result *result = NULL;
    asj_features_info info;
    assert_int_equal(asj_features_create(context, &views[0].image, NULL, 0, NULL, &f), ASJ_OK);
    f = again(context, f);
    asj_features_get_info(f, &info);
    assert_true(info.width == WIDTH && info.height == HEIGHT && info.junctions == NULL && info.l_junctions == NULL);
    assert_int_equal(asj_match_features(context, f, g, NULL, &result), ASJ_OK);
    assert_int_equal(result->match_count, 0);
    asj_match_result_free(&result);
    asj_features_free(&f);
    asj_features_free(&g);
    asj_features_get_info(NULL, &info);
    assert_int_equal(info.width, 0);
}

/* --- bytes that cannot be ----------------------------------------------------------------------------------------------------- */

static void refuse(asj_context *context, const uint8_t *bytes, size_t size, asj_status status, const char *word)
{
    asj_features *features = NULL;
    assert_int_equal(asj_features_load(context, bytes, size, &features), status);
    assert_null(features);
    if (!strstr(asj_context_message(context), word))
        fail_msg("\"%s\" does not say %s", asj_context_message(context), word);
}

static void seal(uint8_t *bytes, size_t size)
{
    asj_put_u64(bytes + 16, size);
    asj_put_u32(bytes + 12, asj_crc32(bytes + 16, size - 16));
}

static void damaged_and_cut_bytes(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_features *features = features_of(context, 0, NULL);
    size_t size;
    uint8_t *bytes = bytes_of(features, &size);
    for (size_t cut = 0; cut < size; cut += cut < 100 ? 1 : 9973) {
        uint8_t *shorter = malloc(cut + 1); /* so that a sanitizer sees what is read beyond */
        assert_non_null(shorter);
        memcpy(shorter, bytes, cut);
        refuse(context, shorter, cut, ASJ_ERROR_FORMAT, cut < 8 ? "no features" : cut < 40 ? "truncated" : "where there should be");
        free(shorter);
    }
    for (size_t at = 8; at < size; at += at < 100 ? 1 : 4999) {
        bytes[at] ^= 0x10;
        refuse(context, bytes, size, at >= 8 && at < 12 ? ASJ_ERROR_UNSUPPORTED : ASJ_ERROR_FORMAT,
               at < 12 ? "version" : at >= 16 && at < 24 ? "where there should be" : "checksum");
        bytes[at] ^= 0x10;
    }
    refuse(context, (const uint8_t *)"no such file at all, but long enough for a header", 49, ASJ_ERROR_FORMAT, "no features");
    free(bytes);
    asj_features_free(&features);
}

/* One number of the file set, with a right checksum. */
static void refuse_number(asj_context *context, const uint8_t *bytes, size_t size, size_t at, uint32_t number, asj_status status,
                          const char *word)
{
    uint8_t *copy = malloc(size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    asj_put_u32(copy + at, number);
    seal(copy, size);
    refuse(context, copy, size, status, word);
    free(copy);
}

static void hostile_bytes(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_features *features = features_of(context, 0, NULL);
    size_t size;
    uint8_t *bytes = bytes_of(features, &size);
    const size_t junctions = 40 + asj_get_u32(bytes + 32);
    refuse_number(context, bytes, size, 24, 0, ASJ_ERROR_FORMAT, "without pixels");
    refuse_number(context, bytes, size, 24, 65536, ASJ_ERROR_LIMIT, "65536 x");
    refuse_number(context, bytes, size, 24, WIDTH + 1, ASJ_ERROR_FORMAT, "damaged");
    refuse_number(context, bytes, size, 28, HEIGHT - 1, ASJ_ERROR_FORMAT, "pixels are not all there");
    refuse_number(context, bytes, size, 32, 0xffffffff, ASJ_ERROR_FORMAT, "counts");
    refuse_number(context, bytes, size, 32, 0, ASJ_ERROR_FORMAT, "damaged");
    refuse_number(context, bytes, size, 36, 0xffffffff, ASJ_ERROR_FORMAT, "counts");
    refuse_number(context, bytes, size, 36, asj_get_u32(bytes + 36) + 1, ASJ_ERROR_FORMAT, "damaged");
    refuse_number(context, bytes, size, 40, 0x0a0a0a0a, ASJ_ERROR_FORMAT, "without a value");
    refuse_number(context, bytes, size, 40, 0x01010101, ASJ_ERROR_FORMAT, "no text");
    refuse_number(context, bytes, size, 40, 0x61616161, ASJ_ERROR_FORMAT, "option that cannot be");
    refuse_number(context, bytes, size, junctions, 0x7fc00000, ASJ_ERROR_FORMAT, "a junction that cannot be"); /* x is NaN */
    refuse_number(context, bytes, size, junctions + 20, 6, ASJ_ERROR_FORMAT, "too many branches");
    refuse_number(context, bytes, size, junctions + 24, 256, ASJ_ERROR_FORMAT, "cannot be, with octave 256");
    refuse_number(context, bytes, size, junctions + 24, UINT32_MAX, ASJ_ERROR_FORMAT, "an octave that there is not"); /* -1 */
    refuse_number(context, bytes, size, junctions + 28 + 4, 0xff800000, ASJ_ERROR_FORMAT, "a junction that cannot be"); /* -inf */
    refuse_number(context, bytes, size, junctions + 28 + 4, 0x48927c00, ASJ_ERROR_FORMAT, "a length of 300000"); /* 3e5f */
    refuse_number(context, bytes, size, junctions + 28, 0x49f42400, ASJ_ERROR_FORMAT, "an angle of 2e+06"); /* 2e6f */
    refuse_number(context, bytes, size, junctions + 28 + 28, 42, ASJ_ERROR_FORMAT, "an end of kind 42");
    refuse_number(context, bytes, size, junctions + 28 + 28, 0xfffffffe, ASJ_ERROR_FORMAT, "an end of kind -2");
    refuse_number(context, bytes, size, size - 4, 0xffffffff, ASJ_ERROR_FORMAT, "whiter than white");
    free(bytes);
    asj_features_free(&features);
}

static void out_of_memory(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_features *features = features_of(context, 0, NULL);
    size_t size;
    uint8_t *bytes = bytes_of(features, &size);
    asj_features_free(&features);
    for (int32_t what = 0; what < 2; what++) {
        int reached = 1;
        for (long n = 1; n < 2000 && reached; n++) {
            unit_counter counter = {0, 0, 0, 0};
            asj_context *poor = unit_context(&counter, 1);
            counter.fail_at = counter.calls + n;
            const asj_status status = what == 0
                ? asj_features_create(poor, &views[0].image, views[0].found->junctions, 60, NULL, &features)
                : asj_features_load(poor, bytes, size, &features);
            reached = unit_reached(&counter);
            assert_true(status == ASJ_OK ? features != NULL : reached && status == ASJ_ERROR_MEMORY && features == NULL);
            asj_features_free(&features);
            unit_context_free(&counter, &poor);
        }
        assert_false(reached);
    }
    free(bytes);
}

static void checksums(void **state)
{
    (void)state;
    assert_int_equal(asj_crc32((const uint8_t *)"123456789", 9), 0xcbf43926); /* the check value of CRC-32 */
    assert_int_equal(asj_crc32((const uint8_t *)"", 0), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_bits_with_any_options),
        cmocka_unit_test(they_outlive_their_context),
        cmocka_unit_test(many_threads_match_the_same_features),
        cmocka_unit_test(other_options_are_refused),
        cmocka_unit_test(an_image_without_junctions),
        cmocka_unit_test(damaged_and_cut_bytes),
        cmocka_unit_test(hostile_bytes),
        cmocka_unit_test(out_of_memory),
        cmocka_unit_test(checksums),
    };
    return cmocka_run_group_tests(tests, make_views, free_views);
}
