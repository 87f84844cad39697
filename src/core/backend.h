/* SPDX-License-Identifier: BSD-2-Clause */
/* The back end of a context, and what happens when its device fails. */
#ifndef ASJ_SRC_BACKEND_H
#define ASJ_SRC_BACKEND_H

#include "context.h"

#include <asj/device.h>

/* Failures of the device after which a context that may choose stays on the CPU. */
#define ASJ_BACKEND_FAILURES 3

/* Every public call that computes runs its work in this loop:
 *
 *     asj_backend_begin(context);
 *     do
 *         status = work(..);
 *     while (asj_backend_retry(context, status));
 *
 * The work leaves nothing behind when it fails. When it ends in ASJ_ERROR_DEVICE and the context may choose (ASJ_BACKEND_AUTO),
 * asj_backend_retry() puts the device aside and asks for the work once more, on the CPU; at the end it takes the device back.
 * After ASJ_BACKEND_FAILURES failures the context stays on the CPU. Memory that the work releases is kept for the next call. Such
 * loops do not nest. */
void asj_backend_begin(asj_context *context);
int asj_backend_retry(asj_context *context, asj_status status);

/* Builds what the device runs, when there is one. Inside that loop. */
asj_status asj_backend_prepare(asj_context *context);

#endif
