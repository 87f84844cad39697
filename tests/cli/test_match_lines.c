/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli match --lines: line segments, and those of one edge as one. */
#include "files.h"
#include "match_table.h"
#include "program.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static table found;

/* How many lines there are; nine of ten have both ends in place. */
static size_t expect_lines_right(const outcome *result)
{
    size_t good = 0;
    expect_code(result, 0);
    parse_csv(result->out, &found);
    for (size_t k = 0; k < found.count; k++) {
        const double *row = found.rows[k];
        good += transfer_error(row[AX1], row[AY1], row[AX2], row[AY2]) < 5 &&
                transfer_error(row[BX1], row[BY1], row[BX2], row[BY2]) < 5;
    }
    assert_true(good >= found.count - found.count / 10);
    return found.count;
}

/* Whether the segment `one` lies in `all`, within 1 px, in both images. */
static int lies_in(const double *one, const double *all)
{
    for (int c = AX1; c <= AX2; c += AX2 - AX1) {
        const double dx = all[c + 2] - all[c], dy = all[c + 3] - all[c + 1], length = hypot(dx, dy);
        for (int end = 0; end < 4; end += 2) {
            const double x = one[c + end] - all[c], y = one[c + end + 1] - all[c + 1], along = (x * dx + y * dy) / length;
            if (fabs(y * dx - x * dy) > length || along < -1 || along > length + 1)
                return 0;
        }
    }
    return 1;
}

static void line_segments_take_the_place_of_matches(void **state)
{
    (void)state;
    size_t kept[3];
    static const char *const ends[] = {"cut", "inner", "both"};
    for (size_t e = 0; e < 3; e++) {
        const outcome *result = run_cli("match", "--lines", "--line-ends", ends[e], "first.png", "second.png", NULL);
        expect_code(result, 0);
        expect_in(result, result->err, " lines");
        parse_csv(result->out, &found);
        kept[e] = found.count;
        assert_true(found.count >= 10);
        for (size_t k = 0; k < found.count; k++) {
            const double *row = found.rows[k];
            assert_true(isnan(row[X1]) && isnan(row[Y1]) && isnan(row[X2]) && isnan(row[Y2]));
            for (int c = 0; c < COLUMNS; c++)
                assert_true(c == X1 || c == Y1 || c == X2 || c == Y2 || !isnan(row[c]));
            assert_true(hypot(row[AX1] - row[BX1], row[AY1] - row[BY1]) > 3);
        }
    }
    assert_true(kept[0] >= kept[1] && kept[1] >= kept[2]);
    assert_int_equal(expect_lines_right(run_cli("match", "--lines", "first.png", "second.png", NULL)), kept[1]);
}

/* One each of those that are parts of one edge: fewer, as right, and none of them lies in another. */
static void joined_lines_are_whole_edges(void **state)
{
    (void)state;
    const size_t all = expect_lines_right(run_cli("match", "--lines", "first.png", "second.png", NULL));
    const size_t joined = expect_lines_right(run_cli("match", "--lines", "--join-lines", "first.png", "second.png", NULL));
    printf("%zu lines, %zu joined\n", all, joined);
    assert_true(joined > all / 4 && joined < all - all / 10);
    for (size_t k = 0; k < joined; k++)
        for (size_t n = 0; n < joined; n++)
            assert_true(n == k || !lies_in(found.rows[k], found.rows[n]));
    char summary[32];
    snprintf(summary, sizeof summary, ", %zu lines", joined);
    const outcome *result = run_cli("match", "--lines", "--join-lines", "-o", "l.csv", "first.png", "second.png", NULL);
    expect_in(result, result->err, summary);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(line_segments_take_the_place_of_matches),
        cmocka_unit_test(joined_lines_are_whole_edges),
    };
    program_start(argc, argv);
    return program_end(cmocka_run_group_tests(tests, make_views, NULL));
}
