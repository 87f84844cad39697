/* SPDX-License-Identifier: BSD-2-Clause */
/* Words that were meant. */
#ifndef ASJ_CLI_SPELLING_H
#define ASJ_CLI_SPELLING_H

#include <stddef.h>

/* How many letters are to be changed, left out, put in, or swapped with their neighbour to get from the first `length` characters
 * of `text` to `word`; a large number for words of 64 letters and more. */
size_t cli_spelling_distance(const char *text, size_t length, const char *word);

/* Whether so many are few enough for a word of that length: one in three. */
int cli_spelling_is_close(size_t distance, size_t length);

#endif
