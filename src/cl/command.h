/* SPDX-License-Identifier: BSD-2-Clause */
/* The end of every command that was put into the queue: its error, and its time while that is measured. */
#ifndef ASJ_SRC_CL_COMMAND_H
#define ASJ_SRC_CL_COMMAND_H

#include "runtime.h"

/* What is measured beside the kernels. */
enum { ASJ_CL_WRITE = -1, ASJ_CL_READ = -2, ASJ_CL_ZERO = -3 };

/* Where the command puts its event: `event`, or NULL while nothing is measured. */
cl_event *asj_cl_timed(asj_context *context, cl_event *event);

/* After the command was enqueued with this error. `what` is a kernel's number or one of the above; `subject` NULL = the number of
 * bytes. Releases the event. */
asj_status asj_cl_end(asj_context *context, const char *call, const char *subject, int32_t what, size_t bytes, cl_int error,
                      cl_event event);

#endif
