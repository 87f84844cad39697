/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_CL_CHECK_H
#define ASJ_SRC_CL_CHECK_H

#include "runtime.h"

/* ASJ_ERROR_DEVICE when the context's device fails, or computes otherwise than the kernels expect. */
asj_status asj_cl_check(asj_context *context);

#endif
