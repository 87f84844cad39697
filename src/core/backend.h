/* SPDX-License-Identifier: BSD-2-Clause */
/* The back end of a context, and what happens when its device fails. */
#ifndef ASJ_SRC_BACKEND_H
#define ASJ_SRC_BACKEND_H

#include "context.h"

#include <asj/device.h>

/* Failures of the device after which a context that may choose stays on the CPU. */
#define ASJ_BACKEND_FAILURES 3

/* Runs a call, which must leave nothing behind when it fails. When it ends in ASJ_ERROR_DEVICE and the context may choose
 * (ASJ_BACKEND_AUTO), it runs once more, without the device. Memory that the call releases is kept for the next one. */
asj_status asj_backend_run(asj_context *context, asj_status (*call)(asj_context *context, void *arguments), void *arguments);

/* Builds what the device runs, when there is one. Inside asj_backend_run(). */
asj_status asj_backend_prepare(asj_context *context);

#endif
