/* SPDX-License-Identifier: BSD-2-Clause */
/* Options as text: reading, printing and checking, in any locale. With the argument "comma" in one with a decimal comma; exit code
 * 77 when there is none. */
#define _POSIX_C_SOURCE 200809L
#include "core/option_table.h"
#include "core/number_text.h"
#include "unit_test.h"

#include <asj/asj.h>

#include <float.h>
#include <locale.h>

typedef struct set {
    double number;
    int32_t integer, on, word, stepped;
    uint32_t radii;
} set;

static const char *const words[] = {"one", "two", "three_four", NULL};
static const asj_option_info rows[] = {
    {"a_number", "px", "help", NULL, ASJ_OPTION_NUMBER, offsetof(set, number), -1e30, 1e30, 0.25, 7, 8, 0, "one", NULL, 0, 0},
    {"an_integer", "", "help", NULL, ASJ_OPTION_INTEGER, offsetof(set, integer), INT32_MIN, INT32_MAX, 3, -4, 5, 1,
     "one", NULL, 1, 0},
    {"a_switch", "", "help", NULL, ASJ_OPTION_SWITCH, offsetof(set, on), 0, 1, 1, 0, 1, 1, "one", NULL, 0, 0},
    {"a_word", "", "help", words, ASJ_OPTION_CHOICE, offsetof(set, word), 0, 2, 1, 2, 0, 1, "two", NULL, 0, 0},
    {"radii", "px", "help", NULL, ASJ_OPTION_RADII, offsetof(set, radii), 3, 30, 1u << 5 | 1u << 7, 0x1ff8, 8, 0,
     "two", NULL, 0, 0},
    {"stepped", "px", "help", NULL, ASJ_OPTION_INTEGER, offsetof(set, stepped), 3, 11, 5, 7, 11, 2, "two", "old_name", 0, 0},
};
static const asj_option_table table = {rows, UNIT_COUNT(rows), sizeof(set)};

static set filled(int32_t preset)
{
    set s;
    memset(&s, 0xff, sizeof s);
    assert_int_equal(asj_option_table_preset(&table, &s, preset), ASJ_OK);
    return s;
}

static void test_fill(void **state)
{
    const set standard = filled(ASJ_PRESET_DEFAULT), paper = filled(ASJ_PRESET_PAPER);
    (void)state;
    assert_true(standard.number == 0.25 && paper.number == 7);
    assert_true(standard.integer == 3 && paper.integer == -4);
    assert_true(standard.on == 1 && paper.on == 0);
    assert_true(standard.word == 1 && paper.word == 2);
    assert_true(standard.radii == 0xa0 && paper.radii == 0x1ff8);
    const set match = filled(ASJ_PRESET_MATCH);
    assert_true(match.number == 8 && match.integer == 5 && match.on == 1 && match.word == 0 && match.radii == 8);
    assert_true(standard.stepped == 5 && paper.stepped == 7 && match.stepped == 11);
    set s = standard;
    assert_int_equal(asj_option_table_preset(&table, NULL, 0), ASJ_ERROR_ARGUMENT);
    static const int32_t unknown[] = {-1, 3, INT32_MAX, INT32_MIN};
    for (size_t i = 0; i < UNIT_COUNT(unknown); i++) {
        assert_int_equal(asj_option_table_preset(&table, &s, unknown[i]), ASJ_ERROR_OPTION);
        assert_memory_equal(&s, &standard, sizeof s); /* left as it was */
    }
    assert_ptr_equal(asj_option_table_row(&table, 1), &rows[1]);
    assert_null(asj_option_table_row(&table, UNIT_COUNT(rows)));
}

static asj_status put(set *s, const char *key, const char *text)
{
    return asj_option_table_set(&table, s, key, text, NULL, 0);
}

/* ---- numbers ---- */

static void check_number(const char *text, double expected)
{
    set s = filled(0);
    if (put(&s, "a_number", text) != ASJ_OK || s.number != expected)
        fail_msg("'%s' reads as %.17g, not %.17g", text, s.number, expected);
}

static void test_numbers(void **state)
{
    (void)state;
    check_number("0", 0);
    check_number("-0", 0);
    check_number("+5", 5);
    check_number("007", 7);
    check_number(".5", 0.5);
    check_number("5.", 5);
    check_number("0.1", 0.1);
    check_number("0.3", 0.3);
    check_number("2.675", 2.675);
    check_number("1e-5", 1e-5);
    check_number("1E5", 1e5);
    check_number("1e+5", 1e5);
    check_number("123.456e-2", 1.23456);
    check_number("1e-30", 1e-30);
    check_number("-1e30", -1e30);
    check_number("3.1415926535897931", 3.1415926535897931);
    check_number("0.10000000000000001", 0.1);
    check_number("9007199254740993e0", 9007199254740992.0);
    check_number("0.000000000000000000000000000000000000000000000000000001e54", 1);
    check_number("1e-99999", 0);
    check_number("0e99999", 0);
}

static void round_trip(double value)
{
    set s = filled(0), back = filled(0);
    char text[64];
    s.number = value;
    assert_int_equal(asj_option_table_get(&table, &s, "a_number", text, sizeof text), ASJ_OK);
    assert_null(strchr(text, ','));
    if (put(&back, "a_number", text) != ASJ_OK || memcmp(&back.number, &s.number, sizeof s.number) != 0)
        fail_msg("%.17g is printed as '%s', which reads as %.17g", value, text, back.number);
}

/* Every double of the range is printed so that it reads back to itself. */
static void test_number_round_trip(void **state)
{
    static const double some[] = {0, 0.1, 1.0 / 3, 2.0 / 3, 1e-30, 1e-6, 1e30, 5e-324, DBL_MIN, DBL_EPSILON, 123456789, 1e22, 1e23};
    synth_random random;
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(some); i++) {
        round_trip(some[i]);
        round_trip(-some[i] + 0.0);
        round_trip(nextafter(some[i], 1e30));
    }
    synth_random_seed(&random, 4);
    for (int i = 0; i < 20000; i++) {
        round_trip(synth_random_between(&random, -100, 100));
        round_trip(ldexp(synth_random_between(&random, 0.5, 1), (int)synth_random_between(&random, -90, 90)));
    }
}

/* ---- integers, switches, words ---- */

static void test_integers(void **state)
{
    static const struct {
        const char *text;
        int32_t value;
    } good[] = {{"0", 0}, {"-12", -12}, {"+3", 3}, {"7.0", 7}, {"1e3", 1000}, {"2147483647", INT32_MAX},
                {"-2147483647", -INT32_MAX}};
    set s = filled(0);
    char text[64];
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(good); i++) {
        assert_int_equal(put(&s, "an_integer", good[i].text), ASJ_OK);
        assert_int_equal(s.integer, good[i].value);
        assert_int_equal(asj_option_table_get(&table, &s, "an_integer", text, sizeof text), ASJ_OK);
        s.integer = 1;
        assert_int_equal(put(&s, "an_integer", text), ASJ_OK);
        assert_int_equal(s.integer, good[i].value);
    }
}

static void test_switches(void **state)
{
    static const char *const yes[] = {"yes", "on", "true", "1"}, *const no[] = {"no", "off", "false", "0"};
    set s = filled(0);
    char text[64];
    (void)state;
    for (int i = 0; i < 4; i++) {
        assert_int_equal(put(&s, "a_switch", no[i]), ASJ_OK);
        assert_int_equal(s.on, 0);
        assert_int_equal(put(&s, "a_switch", yes[i]), ASJ_OK);
        assert_int_equal(s.on, 1);
    }
    assert_int_equal(asj_option_table_get(&table, &s, "a_switch", text, sizeof text), ASJ_OK);
    assert_string_equal(text, "yes");
}

static void test_words(void **state)
{
    set s = filled(0);
    char text[64];
    (void)state;
    for (int32_t i = 0; words[i]; i++) {
        assert_int_equal(put(&s, "a_word", words[i]), ASJ_OK);
        assert_int_equal(s.word, i);
        assert_int_equal(asj_option_table_get(&table, &s, "a_word", text, sizeof text), ASJ_OK);
        assert_string_equal(text, words[i]);
    }
}

/* ---- radii ---- */

static void test_radii(void **state)
{
    static const struct {
        const char *text;
        uint32_t bits;
        const char *printed;
    } good[] = {
        {"5", 1u << 5, "5"},
        {"5,7,10,14", 1u << 5 | 1u << 7 | 1u << 10 | 1u << 14, "5,7,10,14"},
        {"3-12", 0x1ff8, "3-12"},
        {"3-5,9", 0x238, "3-5,9"},
        {"9,3-5", 0x238, "3-5,9"},
        {"9,4,5,3", 0x238, "3-5,9"},
        {"7-7", 1u << 7, "7"},
        {"3,4", 0x18, "3,4"},
        {"3-30", 0x7ffffff8, "3-30"},
        {"30", 1u << 30, "30"},
        {"5,5,5", 1u << 5, "5"},
        {"005", 1u << 5, "5"},
    };
    set s = filled(0);
    char text[64];
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(good); i++) {
        assert_int_equal(put(&s, "radii", good[i].text), ASJ_OK);
        assert_int_equal(s.radii, good[i].bits);
        assert_int_equal(asj_option_table_get(&table, &s, "radii", text, sizeof text), ASJ_OK);
        assert_string_equal(text, good[i].printed);
    }
    synth_random random;
    synth_random_seed(&random, 1);
    for (int i = 0; i < 20000; i++) {
        set back = filled(0);
        s.radii = (uint32_t)(synth_random_bits(&random) >> 33) & ~7u;
        if (i % 3 == 0) /* few gaps */
            s.radii |= (uint32_t)(synth_random_bits(&random) >> 33) & ~7u;
        if (!s.radii)
            continue;
        assert_int_equal(asj_option_table_get(&table, &s, "radii", text, sizeof text), ASJ_OK);
        assert_int_equal(put(&back, "radii", text), ASJ_OK);
        assert_int_equal(back.radii, s.radii);
    }
}

/* ---- what is refused ---- */

static void check_refused(const char *key, const char *text)
{
    set s = filled(0), before = s;
    char message[256] = "";
    const asj_status status = asj_option_table_set(&table, &s, key, text, message, sizeof message);
    if (status != ASJ_ERROR_OPTION || memcmp(&s, &before, sizeof s) != 0)
        fail_msg("%s '%s' is taken, or not refused cleanly: status %d", key, text, (int)status);
    if (!strstr(message, key))
        fail_msg("%s '%s': the message '%s' does not name the key", key, text, message);
    if (strlen(text) < 100 && !strstr(message, text))
        fail_msg("%s '%s': the message '%s' does not quote the text", key, text, message);
}

static void test_refused(void **state)
{
    static const char *const numbers[] = {"", " ", " 1", "1 ", "1x", "x", "1,5", "0x10", "inf", "-inf", "nan", "NAN", "1e", "1e+",
                                          "1e-", "e5", "--1", "+-1", "+", "-", ".", "-.", "1..2", "1.2.3", "1e5.5", "1_000", "1e31",
                                              "-1.0000001e30", "1e999",
                                          "1e99999999999999999999", "\xd9\xa1", "1\n", "0x1p3"};
    static const char *const integers[] = {"", "1.5", "2147483648", "-2147483649", "1e10", "1e400", "yes", "1,000", "0.1"};
    static const char *const switches[] = {"", "2", "-1", "YES", "y", "yes ", "yesno", "nope", "00"};
    static const char *const choices[] = {"", "0", "on", "One", "one ", "one,two", "three-fou", "three_four_"};
    static const char *const radii[] = {"", ",", "5,", ",5", "5,,7", "5-", "-5", "5--7", "5-7-9", "2", "0", "31", "2-5", "29-31",
                                        "999", "5000000000",
                                        "7-5", "10,7-5", "5 ,7", "5, 7", "5;7", "a", "5.0", "+5", "0005"};
    static const struct {
        const char *key;
        const char *const *texts;
        size_t count;
    } all[] = {{"a_number", numbers, UNIT_COUNT(numbers)}, {"an_integer", integers, UNIT_COUNT(integers)},
               {"a_switch", switches, UNIT_COUNT(switches)},
               {"a_word", choices, UNIT_COUNT(choices)},   {"radii", radii, UNIT_COUNT(radii)}};
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(all); i++)
        for (size_t k = 0; k < all[i].count; k++)
            check_refused(all[i].key, all[i].texts[k]);
    char digits[3000];
    memset(digits, '9', sizeof digits);
    digits[sizeof digits - 1] = '\0';
    check_refused("a_number", digits); /* infinite in the end */
    check_refused("an_integer", digits);
    check_refused("radii", digits);
}

/* What an option takes is told in full. */
static void test_refusals_say_what_is_taken(void **state)
{
    static const char *const wanted[][3] = {{"a_number", "x", "a_number: 'x' is not a number"},
                                            {"an_integer", "1.5", "an_integer: '1.5' is not a whole number"},
                                            {"an_integer", "99999999999",
                                             "an_integer: 99999999999 is outside -2.14748365e+09 .. 2.14748365e+09"},
                                            {"stepped", "99999999999", "stepped: 99999999999 is not one of 3, 5 .. 11"},
                                            {"stepped", "-1e999", "stepped: -1e999 is not one of 3, 5 .. 11"},
                                            {"a_switch", "maybe", "a_switch: 'maybe' is not yes or no"},
                                            {"a_word", "four", "a_word: 'four' is none of one, two, three_four"},
                                            {"radii", "5-", "radii: '5-' is not a set of radii such as 5,7,10 or 3-12"}};
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(wanted); i++) {
        set s = filled(0);
        char message[128];
        assert_int_equal(asj_option_table_set(&table, &s, wanted[i][0], wanted[i][1], message, sizeof message), ASJ_ERROR_OPTION);
        assert_string_equal(message, wanted[i][2]);
    }
}

static void test_keys(void **state)
{
    static const char *const unknown[] = {"", "a", "a_numbe", "a_numbers", "A_number", "a__number", "a number", "_", "-"};
    set s = filled(0);
    char text[64], message[128];
    (void)state;
    assert_int_equal(put(&s, "a-number", "2"), ASJ_OK);
    assert_true(s.number == 2);
    assert_int_equal(put(&s, "a_number", "3"), ASJ_OK);
    assert_true(s.number == 3);
    assert_int_equal(asj_option_table_get(&table, &s, "a-number", text, sizeof text), ASJ_OK);
    assert_string_equal(text, "3");
    for (size_t i = 0; i < UNIT_COUNT(unknown); i++) {
        assert_int_equal(asj_option_table_set(&table, &s, unknown[i], "1", message, sizeof message), ASJ_ERROR_OPTION);
        assert_non_null(strstr(message, unknown[i]));
        assert_int_equal(asj_option_table_get(&table, &s, unknown[i], text, sizeof text), ASJ_ERROR_OPTION);
    }
    assert_int_equal(put(NULL, "a_number", "1"), ASJ_ERROR_ARGUMENT);
    assert_int_equal(put(&s, NULL, "1"), ASJ_ERROR_ARGUMENT);
    assert_int_equal(put(&s, "a_number", NULL), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_option_table_get(&table, NULL, "a_number", text, 64), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_option_table_get(&table, &s, NULL, text, 64), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_option_table_get(&table, &s, "a_number", NULL, 64), ASJ_ERROR_ARGUMENT);
}

/* Only minimum + a multiple of the step. */
static void test_steps(void **state)
{
    char message[128];
    (void)state;
    for (int32_t value = 1; value <= 13; value++) {
        const int good = value >= 3 && value <= 11 && value % 2 == 1;
        set s = filled(0);
        char text[16];
        snprintf(text, sizeof text, "%d", (int)value);
        const asj_status status = asj_option_table_set(&table, &s, "stepped", text, message, sizeof message);
        assert_int_equal(status, good ? ASJ_OK : ASJ_ERROR_OPTION);
        assert_int_equal(s.stepped, good ? value : 5);
        if (!good)
            assert_non_null(strstr(message, "not one of 3, 5 .. 11"));
        s.stepped = value;
        assert_int_equal(asj_option_table_check(&table, &s, message, sizeof message), good ? ASJ_OK : ASJ_ERROR_OPTION);
    }
}

/* A former key sets and gets the same field, and says so; every other success leaves the message empty. */
static void test_former_keys(void **state)
{
    static const char *const former[] = {"old_name", "old-name"};
    char message[128], text[64];
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(former); i++) {
        set s = filled(0);
        strcpy(message, "before");
        assert_int_equal(asj_option_table_set(&table, &s, former[i], "9", message, sizeof message), ASJ_OK);
        assert_int_equal(s.stepped, 9);
        assert_non_null(strstr(message, "old_name is called stepped now"));
        assert_int_equal(asj_option_table_get(&table, &s, former[i], text, sizeof text), ASJ_OK);
        assert_string_equal(text, "9");
        assert_int_equal(asj_option_table_set(&table, &s, former[i], "9", NULL, 0), ASJ_OK);
        assert_int_equal(asj_option_table_set(&table, &s, "stepped", "7", message, sizeof message), ASJ_OK);
        assert_string_equal(message, "");
        assert_int_equal(asj_option_table_set(&table, &s, former[i], "8", message, sizeof message), ASJ_ERROR_OPTION);
        assert_non_null(strstr(message, "stepped: 8"));
        strcpy(message, "before");
        assert_int_equal(asj_option_table_set(&table, &s, NULL, "8", message, sizeof message), ASJ_ERROR_ARGUMENT);
        assert_string_equal(message, "");
    }
}

/* Messages and values in buffers of any size: whole, or cut and ended. */
static void test_short_buffers(void **state)
{
    static const char *const keys[] = {"a_number", "an_integer", "a_switch", "a_word", "radii"};
    set s = filled(0);
    (void)state;
    s.number = 0.1;
    s.integer = -1234567;
    s.radii = 0x36db6db0;
    for (size_t k = 0; k < UNIT_COUNT(keys); k++) {
        char whole[64], text[64];
        assert_int_equal(asj_option_table_get(&table, &s, keys[k], whole, sizeof whole), ASJ_OK);
        for (size_t size = 0; size < sizeof text; size++) {
            memset(text, 'z', sizeof text);
            const asj_status status = asj_option_table_get(&table, &s, keys[k], text, size);
            assert_int_equal(status, size > strlen(whole) ? ASJ_OK : ASJ_ERROR_ARGUMENT);
            if (status == ASJ_OK)
                assert_string_equal(text, whole);
            for (size_t i = size; i < sizeof text; i++)
                assert_int_equal(text[i], 'z');
        }
        for (size_t size = 0; size < sizeof text; size++) {
            memset(text, 'z', sizeof text);
            assert_int_equal(asj_option_table_set(&table, &s, keys[k], "~", text, size), ASJ_ERROR_OPTION);
            assert_true(size == 0 || memchr(text, '\0', size));
            for (size_t i = size; i < sizeof text; i++)
                assert_int_equal(text[i], 'z');
        }
    }
}

static void test_check(void **state)
{
    static const double doubles[] = {NAN, INFINITY, -INFINITY, 1.0000001e30, -1.0000001e30};
    static const uint32_t bits[] = {0, 1, 4, 0x80000000u, 0x80000020u, 0xffffffffu, 7};
    static const int32_t switches[] = {-1, 2, INT32_MIN, INT32_MAX}, choices[] = {-1, 3, INT32_MAX};
    char message[256];
    (void)state;
    set s = filled(0);
    assert_int_equal(asj_option_table_check(&table, &s, message, sizeof message), ASJ_OK);
    for (size_t i = 0; i < UNIT_COUNT(doubles); i++) {
        s = filled(0);
        s.number = doubles[i];
        assert_int_equal(asj_option_table_check(&table, &s, message, sizeof message), ASJ_ERROR_OPTION);
        assert_non_null(strstr(message, "a_number"));
        assert_int_equal(asj_option_table_check(&table, &s, NULL, 0), ASJ_ERROR_OPTION);
    }
    for (size_t i = 0; i < UNIT_COUNT(bits); i++) {
        s = filled(0);
        s.radii = bits[i];
        assert_int_equal(asj_option_table_check(&table, &s, message, sizeof message), ASJ_ERROR_OPTION);
        assert_non_null(strstr(message, "radii"));
    }
    for (size_t i = 0; i < UNIT_COUNT(switches); i++) {
        s = filled(0);
        s.on = switches[i];
        assert_int_equal(asj_option_table_check(&table, &s, message, sizeof message), ASJ_ERROR_OPTION);
        assert_non_null(strstr(message, "a_switch"));
    }
    for (size_t i = 0; i < UNIT_COUNT(choices); i++) {
        char text[64];
        s = filled(0);
        s.word = choices[i];
        assert_int_equal(asj_option_table_check(&table, &s, message, sizeof message), ASJ_ERROR_OPTION);
        assert_non_null(strstr(message, "a_word"));
        asj_option_table_get(&table, &s, "a_word", text, sizeof text); /* prints something, reads nothing it should not */
    }
}

/* ---- locale ---- */

static void test_messages_have_a_point(void **state)
{
    set s = filled(0);
    char message[256], text[ASJ_NUMBER_TEXT];
    asj_junction junction;
    asj_context *context = NULL;
    asj_match_result *result = NULL;
    const uint8_t pixel = 0;
    const asj_image image = {.data = &pixel, .format = ASJ_FORMAT_GRAY8, .width = 1, .height = 1};
    (void)state;
    assert_string_equal(asj_number_text(text, 9, -1234.5625), "-1234.5625");
    assert_string_equal(asj_number_text(text, 6, 1e30), "1e+30");
    assert_string_equal(asj_number_text(text, 17, -1.5e-300), "-1.5000000000000001e-300");
    s.number = 1.25e31;
    assert_int_equal(asj_option_table_check(&table, &s, message, sizeof message), ASJ_ERROR_OPTION);
    assert_string_equal(message, "a_number: 1.25e+31 is outside -1e+30 .. 1e+30");
    memset(&junction, 0, sizeof junction);
    junction.scale = -1.5f;
    assert_int_equal(asj_junction_check(&junction, message, sizeof message), ASJ_ERROR_ARGUMENT);
    assert_string_equal(message, "a scale of -1.5 px");
    assert_int_equal(asj_context_create(NULL, &context), ASJ_OK);
    assert_int_equal(asj_match_images(context, &image, &image, &(asj_stretch){9.5, 1}, NULL, NULL, &result), ASJ_ERROR_OPTION);
    assert_string_equal(asj_context_message(context), "a stretch of 9.5, 1 is outside 0.5 .. 8");
    asj_context_free(&context);
}

/* Sets a locale with a decimal comma; one is made in a folder of its own where none is installed but its sources are. */
static int set_comma_locale(void)
{
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "fr_FR.utf8"};
    char command[512], folder[] = "/tmp/asj-locale-XXXXXX";
    for (size_t i = 0; i < UNIT_COUNT(names); i++)
        if (setlocale(LC_ALL, names[i]))
            return localeconv()->decimal_point[0] == ',';
    if (!mkdtemp(folder) || setenv("LOCPATH", folder, 1))
        return 0;
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 >/dev/null 2>&1", folder);
    const int made = !system(command) && setlocale(LC_ALL, "de_DE.UTF-8") && localeconv()->decimal_point[0] == ',';
    snprintf(command, sizeof command, "rm -r %s", folder);
    return !system(command) && made;
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fill),     cmocka_unit_test(test_numbers), cmocka_unit_test(test_number_round_trip),
        cmocka_unit_test(test_integers), cmocka_unit_test(test_switches), cmocka_unit_test(test_words),
        cmocka_unit_test(test_radii),    cmocka_unit_test(test_refused), cmocka_unit_test(test_keys),
        cmocka_unit_test(test_refusals_say_what_is_taken), cmocka_unit_test(test_steps),
        cmocka_unit_test(test_former_keys), cmocka_unit_test(test_short_buffers), cmocka_unit_test(test_check),
        cmocka_unit_test(test_messages_have_a_point),
    };
    if (argument_count > 1 && !strcmp(arguments[1], "comma") && !set_comma_locale()) {
        puts("SKIPPED: no locale with a decimal comma is installed, and localedef cannot make one");
        return 77;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
