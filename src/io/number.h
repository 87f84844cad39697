/* SPDX-License-Identifier: BSD-2-Clause */
/* Numbers as text in the form of the C locale, whatever the locale of the process: files must not change with it. */
#ifndef ASJ_IO_NUMBER_H
#define ASJ_IO_NUMBER_H

#include <stddef.h>

/* Room for every number that the functions below write. */
#define ASJ_NUMBER_SIZE 64

/* The shortest of %.6g to %.9g that reads back to the same float. Returns text. */
const char *asj_number_float(char text[ASJ_NUMBER_SIZE], float value);

/* Nine significant digits at most: for doubles whose error is far larger than that. Returns text. */
const char *asj_number_nine(char text[ASJ_NUMBER_SIZE], double value);

/* Six decimals, as .asj files have them. Returns text. */
const char *asj_number_fixed(char text[ASJ_NUMBER_SIZE], float value);

/* Reads `length` characters that must be one decimal number and nothing else: [+-]digits[.digits][e[+-]digits]. 1, or 0 for
 * anything else; NaN, infinity, hexadecimal and numbers that overflow are all "anything else". */
int asj_number_parse(const char *text, size_t length, double *value);

/* The same for an integer without fraction or exponent, from -1e15 to 1e15. */
int asj_number_parse_integer(const char *text, size_t length, long long *value);

#endif
