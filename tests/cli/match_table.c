/* SPDX-License-Identifier: BSD-2-Clause */
#include "match_table.h"
#include "files.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

void parse_csv(const char *text, table *t)
{
    t->count = 0;
    if (strncmp(text, MATCH_HEADER, strlen(MATCH_HEADER)) != 0)
        fail_msg("not the header:\n%s", text);
    for (text += strlen(MATCH_HEADER); *text; t->count++) {
        assert_true(t->count < MOST_ROWS);
        for (int c = 0; c < COLUMNS; c++) {
            size_t length = strcspn(text, ",\n");
            t->rows[t->count][c] = length ? strtod(text, NULL) : NAN;
            text += length;
            assert_int_equal(*text, c + 1 < COLUMNS ? ',' : '\n');
            text++;
        }
    }
}

void read_csv(const char *path, table *t)
{
    size_t size = 0;
    char *text = read_bytes(path, &size);
    assert_non_null(text);
    parse_csv(text, t);
    free(text);
}

double transfer_error(double x1, double y1, double x2, double y2)
{
    return hypot(VIEW_SCALE * x1 + VIEW_X - x2, VIEW_SCALE * y1 + VIEW_Y - y2);
}
