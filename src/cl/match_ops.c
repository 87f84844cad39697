/* SPDX-License-Identifier: BSD-2-Clause */
#include "overrides.h"

void asj_cl_fill_match(asj_ops *ops)
{
    (void)ops;
}

void asj_cl_free_match(asj_context *context)
{
    (void)context;
}
