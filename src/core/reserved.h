/* SPDX-License-Identifier: BSD-2-Clause */
/* Fields of options that have no meaning yet. What is not zero there was not filled in, or means something in a later version. */
#ifndef ASJ_SRC_CORE_RESERVED_H
#define ASJ_SRC_CORE_RESERVED_H

#include <stddef.h>

#define ASJ_RESERVED_MESSAGE "a reserved field is not zero: options that no _init() has filled in, or of a later version"

static inline int asj_is_zero(const void *field, size_t size)
{
    const unsigned char *bytes = field;
    for (size_t n = 0; n < size; n++)
        if (bytes[n])
            return 0;
    return 1;
}

#endif
