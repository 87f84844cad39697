/* SPDX-License-Identifier: BSD-2-Clause */
/* What asj-cli match writes as CSV, as numbers. */
#ifndef ASJ_TEST_MATCH_TABLE_H
#define ASJ_TEST_MATCH_TABLE_H

#include <stddef.h>

#define MATCH_HEADER "i,j,x1,y1,ax1,ay1,bx1,by1,x2,y2,ax2,ay2,bx2,by2,distance,ratio,h11,h12,h13,h21,h22,h23\n"
enum { COLUMNS = 22, MOST_ROWS = 400 };
enum { I, J, X1, Y1, AX1, AY1, BX1, BY1, X2, Y2, AX2, AY2, BX2, BY2, DISTANCE, RATIO, H11, H12, H13, H21, H22, H23 };

typedef struct table {
    double rows[MOST_ROWS][COLUMNS]; /* NaN = empty */
    size_t count;
} table;

/* Columns by their place; every line must have them all. */
void parse_csv(const char *text, table *t);
void read_csv(const char *path, table *t);

/* px from where the views (files.h) have the first point to the second. */
double transfer_error(double x1, double y1, double x2, double y2);

#endif
