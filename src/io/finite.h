/* SPDX-License-Identifier: BSD-2-Clause */
/* Numbers that a file can tell: JSON has neither NaN nor infinity. */
#ifndef ASJ_IO_FINITE_H
#define ASJ_IO_FINITE_H

#include <asj/options.h>

#include <math.h>
#include <string.h>

static inline int asj_all_finite(const double *numbers, size_t count)
{
    size_t i;
    for (i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return 0;
    return 1;
}

/* Of an options struct, or NULL, with the rows of its table. */
static inline int asj_options_are_finite(const void *options, size_t count, const asj_option_info *(*row_at)(size_t index))
{
    size_t i;
    for (i = 0; options && i < count; i++) {
        double number = 0;
        if (row_at(i)->type == ASJ_OPTION_NUMBER)
            memcpy(&number, (const char *)options + row_at(i)->offset, sizeof number);
        if (!isfinite(number))
            return 0;
    }
    return 1;
}

#endif
