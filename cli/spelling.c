/* SPDX-License-Identifier: BSD-2-Clause */
/* Edit distance with swaps of neighbours ("optimal string alignment"): d[i][j] is that of the first i letters of one word and the
 * first j of the other,
 *     d[i][j] = min(d[i-1][j] + 1, d[i][j-1] + 1, d[i-1][j-1] + (a_i != b_j), and d[i-2][j-2] + 1 where the last two are swapped),
 *
 * Damerau 1964, restricted so that no letter is changed twice. */
#include "spelling.h"

#include <string.h>

enum { LONGEST = 63, FAR = 1000 };

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

size_t cli_spelling_distance(const char *text, size_t length, const char *word)
{
    size_t d[3][LONGEST + 1]; /* rows i - 2, i - 1, i, in turn */
    const size_t other = strlen(word);
    if (length > LONGEST || other > LONGEST)
        return FAR;
    for (size_t j = 0; j <= other; j++)
        d[0][j] = j;
    for (size_t i = 1; i <= length; i++) {
        size_t *row = d[i % 3], *above = d[(i + 2) % 3], *top = d[(i + 1) % 3];
        row[0] = i;
        for (size_t j = 1; j <= other; j++) {
            row[j] = least(least(above[j], row[j - 1]) + 1, above[j - 1] + (text[i - 1] != word[j - 1]));
            if (i > 1 && j > 1 && text[i - 1] == word[j - 2] && text[i - 2] == word[j - 1])
                row[j] = least(row[j], top[j - 2] + 1);
        }
    }
    return d[length % 3][other];
}

int cli_spelling_is_close(size_t distance, size_t length)
{
    return distance > 0 && 3 * distance <= length + 1;
}
