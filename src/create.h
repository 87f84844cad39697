/* SPDX-License-Identifier: BSD-2-Clause */
/* Contexts and lists of devices with another libOpenCL than the system's, for tests; `library` NULL = the system's. */
#ifndef ASJ_SRC_CREATE_H
#define ASJ_SRC_CREATE_H

#include <asj/context.h>
#include <asj/device.h>

asj_status asj_context_create_from(const char *library, const asj_context_options *options, asj_context **context);
asj_status asj_device_list_create_from(const char *library, const asj_context_options *options, asj_device_list **list);

#endif
