/* SPDX-License-Identifier: BSD-2-Clause */
/* A context's device, from the choice to the end. */
#include "cl.h"
#include "check.h"
#include "core/device.h"
#include "detect.h"
#include "detect/gradient.h"
#include "enumerate.h"
#include "error.h"
#include "overrides.h"
#include "program.h"
#include "startup.h"
#include "state.h"

#include <stdio.h>
#include <string.h>

/* api->library NULL when there is no OpenCL: ASJ_OK and the reason then. */
static asj_status load_and_enumerate(asj_memory *memory, const char *library, asj_cl_api *api, asj_cl_found *found, char *message,
                                     size_t message_size)
{
    asj_status status = ASJ_OK;
    asj_cl_startup_begin();
    if (asj_cl_load(library, api, message, message_size))
        status = asj_cl_enumerate(memory, api, found, message, message_size);
    asj_cl_startup_end();
    return status;
}

asj_status asj_cl_list(asj_memory *memory, const char *library, asj_device **devices, size_t *count, char *message,
                       size_t message_size)
{
    asj_cl_api api;
    asj_cl_found found;
    *devices = NULL;
    *count = 0;
    asj_status status = load_and_enumerate(memory, library, &api, &found, message, message_size);
    if (!api.library)
        return ASJ_OK;
    if (status == ASJ_OK) {
        *devices = found.records;
        *count = found.count;
        found.records = NULL;
    }
    asj_cl_found_free(memory, &found);
    asj_cl_unload(&api);
    return status;
}

/* ---- opening ---- */

static cl_int get_limits(struct asj_cl *cl, const asj_device *record)
{
    asj_cl_limits *limits = &cl->limits;
    size_t sizes[16] = {0};
    cl_int error = cl->api.GetDeviceInfo(cl->device, CL_DEVICE_MAX_WORK_GROUP_SIZE, sizeof(size_t), &limits->max_work_group, NULL);
    if (error == CL_SUCCESS)
        error = cl->api.GetDeviceInfo(cl->device, CL_DEVICE_MAX_WORK_ITEM_SIZES, sizeof sizes, sizes, NULL);
    memcpy(limits->max_work_item, sizes, sizeof limits->max_work_item);
    limits->local_memory = record->local_memory;
    limits->largest_buffer = record->largest_buffer;
    limits->global_memory = record->global_memory;
    limits->compute_units = (uint32_t)record->compute_units;
    limits->type = record->type;
    return error;
}

/* PoCL compiles a kernel for its work-group when it first runs, and keeps that in files. Asked for binaries it compiles all kernels
 * once more, for any work-group, and of those it then runs none (3.1: 8 s instead of 5 at the first start, 0.2 s instead of 0.4
 * later). */
static int keeps_programs(const asj_device *record)
{
    return strcmp(record->platform, "Portable Computing Language") == 0;
}

static void set_identity(struct asj_cl *cl, cl_platform_id platform, const asj_device *record)
{
    char version[128] = "";
    if (cl->api.GetPlatformInfo(platform, CL_PLATFORM_VERSION, sizeof version - 1, version, NULL) != CL_SUCCESS)
        version[0] = '\0';
    version[sizeof version - 1] = '\0';
    cl->keeps_programs = keeps_programs(record);
    snprintf(cl->name, sizeof cl->name, "%s", record->name);
    snprintf(cl->identity, sizeof cl->identity, "%s\n%s\n%s\n%s\n%s\n%s\n%zu\n%s\n", record->platform, version, record->name,
             record->vendor, record->version, record->driver, sizeof(void *), ASJ_CL_BUILD_OPTIONS);
}

static void close_device(struct asj_cl *cl)
{
    if (cl->queue)
        cl->api.ReleaseCommandQueue(cl->queue);
    if (cl->context)
        cl->api.ReleaseContext(cl->context);
    cl->queue = NULL;
    cl->context = NULL;
}

/* 1, or 0 and the reason in the record. */
static int open_device(struct asj_cl *cl, const asj_cl_found *found, size_t index)
{
    const cl_context_properties properties[] = {CL_CONTEXT_PLATFORM, (cl_context_properties)found->platforms[index], 0};
    asj_device *record = &found->records[index];
    const char *call = "clCreateContext";
    char text[ASJ_CL_ERROR_SIZE];
    cl_int error = CL_SUCCESS;
    cl->device = found->devices[index];
    asj_cl_startup_begin();
    cl->context = cl->api.CreateContext(properties, 1, &cl->device, NULL, NULL, &error);
    if (cl->context) {
        call = "clCreateCommandQueue";
        cl->queue = cl->api.CreateCommandQueue(cl->context, cl->device, 0, &error);
    }
    asj_cl_startup_end();
    if (cl->queue) {
        call = "clGetDeviceInfo";
        error = get_limits(cl, record);
        if (error == CL_SUCCESS) {
            set_identity(cl, found->platforms[index], record);
            return 1;
        }
    }
    close_device(cl);
    snprintf(record->reason, sizeof record->reason, "%s: %s", call, asj_cl_error_name(error, text));
    record->usable = 0;
    return 0;
}

/* ---- choosing ---- */

/* One line for each device: why it is not used. */
static void explain(asj_context *context, const asj_cl_found *found)
{
    const int32_t level = context->options.backend == ASJ_BACKEND_AUTO ? ASJ_LOG_DEBUG : ASJ_LOG_ERROR;
    for (size_t i = 0; i < found->count; i++) {
        const asj_device *record = &found->records[i];
        asj_log(context, level, "%zu: %s (%s, %s): %s", i, *record->name ? record->name : "no device", record->platform,
                asj_device_type_name(record->type), record->usable ? "not what was asked for" : record->reason);
    }
}

static asj_status choose(asj_context *context, const asj_cl_found *found)
{
    const asj_context_options *options = &context->options;
    const char *selector = options->device ? options->device : "";
    for (;;) {
        const size_t index = asj_device_choose(found->records, found->count, options->backend, options->device);
        if (index == found->count)
            break;
        if (open_device(context->cl, found, index))
            return ASJ_OK;
    }
    asj_status status = asj_fail(context, ASJ_ERROR_DEVICE, "no OpenCL %s can be used%s%s%s",
                                 options->backend == ASJ_BACKEND_AUTO ? "GPU" : "device", *selector ? " that fits '" : "", selector,
                                 *selector ? "'" : "");
    explain(context, found);
    return status;
}

static asj_status search(asj_context *context, const char *library)
{
    struct asj_cl *cl = context->cl;
    asj_cl_found found;
    char message[256] = "";
    asj_status status = load_and_enumerate(&context->memory, library, &cl->api, &found, message, sizeof message);
    if (!cl->api.library)
        return asj_fail(context, ASJ_ERROR_DEVICE, "%s", message);
    if (status != ASJ_OK)
        status = asj_fail(context, status, "no memory for a list of devices");
    else if (found.count == 0)
        status = asj_fail(context, ASJ_ERROR_DEVICE, "%s", message);
    else
        status = choose(context, &found);
    asj_cl_found_free(&context->memory, &found);
    return status;
}

static asj_status make_tables(asj_context *context)
{
    struct asj_cl *cl = context->cl;
    cl->programs = asj_allocate_zero(&context->memory, (size_t)asj_cl_source_count, sizeof *cl->programs);
    cl->kernels = asj_allocate_zero(&context->memory, (size_t)asj_cl_kernel_count, sizeof *cl->kernels);
    return cl->programs && cl->kernels ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for kernels");
}

static void free_device(asj_context *context)
{
    struct asj_cl *cl = context->cl;
    if (cl->queue)
        cl->api.Finish(cl->queue);
    asj_cl_free_detect(context);
    asj_cl_free_scan(context);
    asj_cl_free_match(context);
    asj_cl_free_programs(context);
    close_device(cl);
    asj_release(&context->memory, cl->times);
    asj_cl_unload(&cl->api);
    asj_release(&context->memory, cl);
    context->cl = NULL;
}

static const char *device_name(const asj_context *context)
{
    return context->cl->name;
}

asj_status asj_cl_create(asj_context *context, const char *library)
{
    static const asj_device_calls calls = {device_name, asj_cl_build_all, free_device};
    context->cl = asj_allocate_zero(&context->memory, 1, sizeof *context->cl);
    if (!context->cl)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for a device");
    context->device = &calls;
    asj_status status = search(context, library);
    if (status == ASJ_OK)
        status = make_tables(context);
    if (status == ASJ_OK)
        status = asj_cl_check(context);
    if (status == ASJ_OK) {
        asj_log(context, ASJ_LOG_DEBUG, "OpenCL device: %s", context->cl->name);
        return ASJ_OK;
    }
    free_device(context);
    if (status != ASJ_ERROR_DEVICE || context->options.backend == ASJ_BACKEND_OPENCL)
        return status;
    asj_log(context, ASJ_LOG_INFO, "%s; the CPU does the work", context->message);
    context->message[0] = '\0';
    return ASJ_OK;
}

void asj_cl_fill(const asj_ops *ops)
{
    ops->gradient->planes = asj_cl_gradient;
    ops->field->rows = asj_cl_field_rows;
    ops->field->branches = asj_cl_field_branches;
    ops->isotropic->rows = asj_cl_isotropic_rows;
    ops->scan->rays = asj_cl_scan_rays;
    ops->describe->frames = asj_cl_describe_frames;
    ops->rank->partners = asj_cl_rank_partners;
}
