/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_CL_ERROR_H
#define ASJ_SRC_CL_ERROR_H

#include "runtime.h"

/* Room for any name below. */
#define ASJ_CL_ERROR_SIZE 48

/* "CL_OUT_OF_RESOURCES"; "error -9999" for numbers without a name. Returns `text`. */
const char *asj_cl_error_name(cl_int error, char text[ASJ_CL_ERROR_SIZE]);

/* asj_fail(): "clCALL(SUBJECT): CL_OUT_OF_RESOURCES on NAME". Returns ASJ_ERROR_DEVICE. */
asj_status asj_cl_fail(asj_context *context, const char *call, const char *subject, cl_int error);

#endif
