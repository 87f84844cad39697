/* SPDX-License-Identifier: BSD-2-Clause */
/* Numbers as text. */
#include "number.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void short_and_exact(void **state)
{
    static const struct {
        float value;
        const char *text;
    } known[] = {{0, "0"}, {1, "1"}, {-2.5f, "-2.5"}, {0.1f, "0.1"}, {1e10f, "1e+10"}, {16777216, "16777216"},
                 {1.0f / 3, "0.33333334"}, {FLT_MAX, "3.4028235e+38"}, {FLT_MIN, "1.1754944e-38"}};
    char text[ASJ_NUMBER_SIZE];
    uint32_t bits = 1;
    size_t i;
    (void)state;
    for (i = 0; i < sizeof known / sizeof known[0]; i++)
        assert_string_equal(asj_number_float(text, known[i].value), known[i].text);
    for (i = 0; i < 200000; i++) {
        float value;
        double back;
        bits = bits * 1664525u + 1013904223u;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        asj_number_float(text, value);
        assert_true(asj_number_parse(text, strlen(text), &back));
        assert_true((float)back == value);
    }
}

static void six_decimals(void **state)
{
    char text[ASJ_NUMBER_SIZE];
    (void)state;
    assert_string_equal(asj_number_fixed(text, 0), "0.000000");
    assert_string_equal(asj_number_fixed(text, -12.25f), "-12.250000");
    assert_string_equal(asj_number_fixed(text, 65535.5f), "65535.500000");
    assert_true(strlen(asj_number_fixed(text, -FLT_MAX)) < ASJ_NUMBER_SIZE);
}

static void what_is_a_number(void **state)
{
    static const struct {
        const char *text;
        double value;
    } good[] = {{"0", 0}, {"-1", -1}, {"+2.5", 2.5}, {".5", 0.5}, {"5.", 5}, {"1e3", 1000}, {"1E-2", 0.01}, {"00012", 12},
                {"123456789.123456789", 123456789.123456789}};
    static const char *const bad[] = {"", "+", ".", "-.", "e5", "1e", "1e+", "1 ", " 1", "1,5", "0x1", "nan", "inf", "INFINITY",
                                      "1e999", "--1", "1.2.3", "1e1.5", "1f", "\xd9\xa1"};
    char long_text[400];
    double value = 7;
    size_t i;
    (void)state;
    for (i = 0; i < sizeof good / sizeof good[0]; i++) {
        assert_true(asj_number_parse(good[i].text, strlen(good[i].text), &value));
        assert_true(value == good[i].value);
    }
    value = 7;
    for (i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_false(asj_number_parse(bad[i], strlen(bad[i]), &value));
    memset(long_text, '1', sizeof long_text);
    assert_false(asj_number_parse(long_text, sizeof long_text, &value));
    assert_true(value == 7);
}

static void what_is_an_integer(void **state)
{
    static const char *const bad[] = {"", "-", "+", "1.0", "1e3", " 1", "1x", "99999999999999999999999"};
    long long value = 7;
    size_t i;
    (void)state;
    for (i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_false(asj_number_parse_integer(bad[i], strlen(bad[i]), &value));
    assert_true(value == 7);
    assert_true(asj_number_parse_integer("-12345", 6, &value));
    assert_true(value == -12345);
    assert_true(asj_number_parse_integer("+0", 2, &value));
    assert_true(value == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(short_and_exact), cmocka_unit_test(six_decimals),
                                       cmocka_unit_test(what_is_a_number), cmocka_unit_test(what_is_an_integer)};
    return cmocka_run_group_tests_name("io: numbers", tests, NULL, NULL);
}
