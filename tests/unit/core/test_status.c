/* SPDX-License-Identifier: BSD-2-Clause */
#include "unit_test.h"

#include <asj/version.h>

static void test_statuses(void **state)
{
    (void)state;
    for (asj_status a = ASJ_OK; a >= ASJ_ERROR_UNSUPPORTED; a--) {
        const char *text = asj_status_string(a);
        assert_true(strlen(text) > 5);
        assert_string_not_equal(text, "unknown status");
        assert_null(strchr(text, '\n'));
        assert_true(text[strlen(text) - 1] != '.');
        for (asj_status b = ASJ_OK; b > a; b--)
            assert_string_not_equal(text, asj_status_string(b));
    }
    static const asj_status others[] = {1, ASJ_ERROR_UNSUPPORTED - 1, INT32_MIN, INT32_MAX};
    for (size_t i = 0; i < UNIT_COUNT(others); i++)
        assert_string_equal(asj_status_string(others[i]), "unknown status");
}

static void test_stages(void **state)
{
    (void)state;
    assert_string_equal(asj_stage_name(ASJ_STAGE_GRADIENT), "gradient");
    assert_string_equal(asj_stage_name(ASJ_STAGE_CANDIDATES), "candidates");
    assert_string_equal(asj_stage_name(ASJ_STAGE_DECOMPOSE), "decompose");
    assert_string_equal(asj_stage_name(ASJ_STAGE_ASSIGN), "assign");
    for (int32_t a = 0; a < ASJ_STAGE_COUNT; a++)
        for (int32_t b = 0; b < a; b++)
            assert_string_not_equal(asj_stage_name(a), asj_stage_name(b));
    assert_string_equal(asj_stage_name(-1), "unknown");
    assert_string_equal(asj_stage_name(ASJ_STAGE_COUNT), "unknown");
}

static void test_version(void **state)
{
    char text[32];
    (void)state;
    assert_int_equal(asj_version(), ASJ_VERSION_MAJOR << 16 | ASJ_VERSION_MINOR << 8 | ASJ_VERSION_PATCH);
    snprintf(text, sizeof text, "%d.%d.%d", ASJ_VERSION_MAJOR, ASJ_VERSION_MINOR, ASJ_VERSION_PATCH);
    assert_string_equal(asj_version_string(), text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_statuses),
        cmocka_unit_test(test_stages),
        cmocka_unit_test(test_version),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
