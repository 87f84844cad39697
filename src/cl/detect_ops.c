/* SPDX-License-Identifier: BSD-2-Clause */
#include "overrides.h"

void asj_cl_fill_detect(asj_ops *ops)
{
    (void)ops;
}

void asj_cl_free_detect(asj_context *context)
{
    (void)context;
}
