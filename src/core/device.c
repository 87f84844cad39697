/* SPDX-License-Identifier: BSD-2-Clause */
/* Selectors and lists of devices, and the choice among them. */
#include "device.h"

#include <stdio.h>
#include <string.h>

const char *asj_device_type_name(int32_t type)
{
    static const char *const names[] = {"other", "cpu", "gpu", "accelerator"};
    return type > ASJ_DEVICE_OTHER && type <= ASJ_DEVICE_ACCELERATOR ? names[type] : names[ASJ_DEVICE_OTHER];
}

/* ---- selectors ---- */

/* ASCII only: names of devices are, and the locale must not matter. */
static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static int starts_with(const char *text, const char *part)
{
    while (*part && lower(*text) == lower(*part)) {
        text++;
        part++;
    }
    return *part == '\0';
}

static int contains(const char *text, const char *part)
{
    for (; *text; text++)
        if (starts_with(text, part))
            return 1;
    return 0;
}

static int same(const char *text, const char *word)
{
    return starts_with(text, word) && text[strlen(word)] == '\0';
}

/* 1 and the number when the text is nothing but digits; a number that no list reaches when it is too long. */
static int parse_index(const char *text, size_t *index)
{
    *index = 0;
    if (!*text)
        return 0;
    for (; *text; text++) {
        if (*text < '0' || *text > '9')
            return 0;
        *index = *index > 1000000 ? 1000000 : 10 * *index + (size_t)(*text - '0');
    }
    return 1;
}

/* Whether a selector (asj_context_options.device) fits device number `index`. NULL and "" fit all. */
static int fits(const asj_device *device, size_t index, const char *selector)
{
    size_t wanted;
    if (!selector || !*selector)
        return 1;
    if (parse_index(selector, &wanted))
        return wanted == index;
    for (int32_t type = ASJ_DEVICE_CPU; type <= ASJ_DEVICE_ACCELERATOR; type++)
        if (same(selector, asj_device_type_name(type)))
            return device->type == type;
    return contains(device->name, selector) || contains(device->platform, selector);
}

size_t asj_device_choose(const asj_device *devices, size_t count, int32_t backend, const char *selector)
{
    static const int32_t ranks[] = {2, 2, 0, 1}; /* by type */
    const int anything = !selector || !*selector;
    size_t best = count;
    int32_t best_rank = 3;
    for (size_t i = 0; i < count; i++) {
        const asj_device *device = &devices[i];
        if (!device->usable || !fits(device, i, selector) ||
            (backend == ASJ_BACKEND_AUTO && device->type != ASJ_DEVICE_GPU))
            continue;
        const int32_t rank = anything ? ranks[device->type] : 0;
        if (rank < best_rank) {
            best = i;
            best_rank = rank;
        }
    }
    return best;
}

/* ---- lists ---- */

/* What stands behind the public struct. */
typedef struct device_list {
    asj_device_list list; /* first: the public pointer is this one */
    asj_memory memory;
    asj_device *devices;
} device_list;

asj_status asj_device_list_make(asj_memory *memory, asj_device *devices, size_t count, const char *message,
                                asj_device_list **result)
{
    device_list *made = asj_allocate_zero(memory, 1, sizeof *made);
    if (!made) {
        asj_release(memory, devices);
        return ASJ_ERROR_MEMORY;
    }
    snprintf(made->list.message, sizeof made->list.message, "%s", message);
    made->list.devices = made->devices = devices;
    made->list.count = (uint32_t)count;
    made->memory = *memory;
    *result = &made->list;
    return ASJ_OK;
}

void asj_device_list_free(asj_device_list **pointer)
{
    if (!pointer || !*pointer)
        return;
    device_list *made = (device_list *)*pointer;
    asj_memory memory = made->memory;
    asj_release(&memory, made->devices);
    asj_release(&memory, made);
    *pointer = NULL;
}
