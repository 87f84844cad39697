/* SPDX-License-Identifier: BSD-2-Clause */
#include "targets.h"

#include <asj/device.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef ASJ_HAVE_OPENCL
#include "cl/planes.h"
#include "cl/state.h"
#endif

static asj_status open_context(int32_t simd, int32_t backend, const char *device, asj_context **context)
{
    asj_context_options options;
    asj_context_options_init(&options);
    options.threads = 1;
    options.simd = simd;
    options.backend = backend;
    options.device = device;
    return asj_context_create(&options, context);
}

static target *add(target_list *list, const char *name)
{
    target *t = &list->targets[list->count++];
    snprintf(t->name, sizeof t->name, "%s", name);
    return t;
}

static int add_variant(target_list *list, int32_t simd)
{
    target *t = add(list, asj_simd_name(simd));
    if (!asj_tables_runs(simd))
        return 0;
    return open_context(simd, ASJ_BACKEND_CPU, NULL, &t->context) == ASJ_OK ? 1 : -1;
}

/* Each form gets a context of its own. */
static int add_device(target_list *list, uint32_t number, const asj_device *device)
{
    static const char *const suffixes[] = {"", "", ", other kernels", ", in bands"};
    char selector[16];
    snprintf(selector, sizeof selector, "%u", (unsigned)number);
    for (int32_t form = FORM_OWN; form <= FORM_BANDS && list->count < MOST_TARGETS; form++) {
        target *t = add(list, "");
        snprintf(t->name, sizeof t->name, "%u %.32s%s", (unsigned)number, device->name, suffixes[form]);
        t->form = form;
        if (open_context(ASJ_SIMD_AUTO, ASJ_BACKEND_OPENCL, selector, &t->context) != ASJ_OK)
            return -1;
#ifdef ASJ_HAVE_OPENCL
        asj_cl_limits *limits = &t->context->cl->limits;
        if (form == FORM_OTHER)
            limits->type = limits->type == ASJ_DEVICE_CPU ? ASJ_DEVICE_GPU : ASJ_DEVICE_CPU;
        if (form == FORM_BANDS)
            limits->largest_buffer = 400000;
#endif
    }
    return 1;
}

static int32_t add_devices(target_list *list)
{
    asj_device_list *found;
    int32_t count = 0;
    if (asj_device_list_create(NULL, &found) != ASJ_OK)
        return -1;
    if (found->count == 0)
        printf("devices: %s\n", found->message);
    for (uint32_t i = 0; i < found->count && count >= 0; i++)
        if (!found->devices[i].usable)
            printf("device %u, %s: %s\n", (unsigned)i, found->devices[i].name, found->devices[i].reason);
        else
            count = add_device(list, i, &found->devices[i]) < 0 ? -1 : count + 1;
    asj_device_list_free(&found);
    return count;
}

int32_t targets_open(int devices, target_list *list)
{
    int32_t count = 0;
    memset(list, 0, sizeof *list);
    list->devices = devices;
    int added = add_variant(list, ASJ_SIMD_REFERENCE);
    if (devices && added > 0)
        count = add_devices(list);
    for (int32_t v = ASJ_SIMD_REFERENCE + 1; !devices && added >= 0 && v < ASJ_SIMD_COUNT; v++) {
        added = add_variant(list, v);
        count += added > 0;
    }
    if (added >= 0 && count >= 0)
        return count;
    fprintf(stderr, "parity: no context for %s\n", list->targets[list->count - 1].name);
    return -1;
}

void targets_close(target_list *list)
{
    for (int32_t i = 0; i < list->count; i++)
        asj_context_free(&list->targets[i].context);
}

int targets_missing(const target_list *list)
{
    if (!list->devices) {
        printf("SKIPPED: only the reference is there, nothing to compare\n");
        return 77;
    }
    const char *required = getenv("ASJ_REQUIRE_OPENCL");
    const int fail = required && *required && strcmp(required, "0") != 0;
    printf("%s: no OpenCL device\n", fail ? "FAILED" : "SKIPPED");
    return fail ? 1 : 77;
}

int targets_report(const target_list *list, const char *things, size_t count, const char *found, int failed)
{
    for (int32_t i = 1; i < list->count; i++)
        if (list->targets[i].context)
            printf("%-9s %ld %s\n", list->targets[i].name, list->targets[i].compared, things);
    const int bad = failed || count == 0;
    printf("%zu %s, %s\n", count, found, bad ? "FAILED" : "all equal");
    return bad;
}

void target_prepare(target *t, ptrdiff_t stride)
{
#ifdef ASJ_HAVE_OPENCL
    if (t->form == FORM_NONE)
        return;
    asj_cl_planes_forget(t->context);
    if (t->form == FORM_BANDS) /* seventeen rows and what is around them, in an eighth of the memory; bands of rays share twelve */
        t->context->cl->limits.global_memory = 8 * (17 + 2 * ASJ_MARGIN + 1) * (uint64_t)stride * sizeof(int16_t);
#else
    (void)t;
    (void)stride;
#endif
}
