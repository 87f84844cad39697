/* SPDX-License-Identifier: BSD-2-Clause */
/* Numbers of messages and options as text, with a point whatever the locale of the process. */
#ifndef ASJ_SRC_CORE_NUMBER_TEXT_H
#define ASJ_SRC_CORE_NUMBER_TEXT_H

enum { ASJ_NUMBER_TEXT = 48, ASJ_DECIMAL_POINT = 16 /* bytes: room for what the functions below write */ };

/* As "%g", for an argument of "%s" in its stead. It stays as long as the block around it. */
#define ASJ_TEXT(value) asj_number_text((char[ASJ_NUMBER_TEXT]){0}, 6, value)
/* As "%.9g" */
#define ASJ_TEXT_NINE(value) asj_number_text((char[ASJ_NUMBER_TEXT]){0}, 9, value)

/* As "%.*g" with so many digits, 1 to 17. Returns text. */
const char *asj_number_text(char text[ASJ_NUMBER_TEXT], int digits, double value);

/* What stands for the decimal point in the locale of the process, a few bytes. */
void asj_decimal_point(char point[ASJ_DECIMAL_POINT]);

#endif
