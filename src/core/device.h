/* SPDX-License-Identifier: BSD-2-Clause */
/* Which device a context takes. */
#ifndef ASJ_SRC_DEVICE_H
#define ASJ_SRC_DEVICE_H

#include "memory.h"

#include <asj/device.h>

/* Index of the device to take for the back end (ASJ_BACKEND_...), or `count` when none will do: the first usable one that fits;
 * without a selector GPUs before accelerators before the others. ASJ_BACKEND_AUTO takes GPUs only. */
size_t asj_device_choose(const asj_device *devices, size_t count, int32_t backend, const char *selector);

/* The public list of these records, which it takes over: they come from `memory`, and are released when this fails. `message` is
 * that of asj_device_list. */
asj_status asj_device_list_make(asj_memory *memory, asj_device *devices, size_t count, const char *message, asj_device_list **list);

#endif
