/* SPDX-License-Identifier: BSD-2-Clause */
/* All devices of all platforms, each looked at for what the library needs. */
#include "enumerate.h"
#include "error.h"

#include <stdio.h>
#include <string.h>

enum { MOST_PLATFORMS = 64, MOST_DEVICES = 256, LONGEST_TEXT = 1024 };

/* What a device must have; every OpenCL 1.2 device of the full profile has these work-groups, this local memory and more. */
#define LEAST_WORK_GROUP 64
#define LEAST_LOCAL_MEMORY 16384

/* One line without blanks at the ends and without what is no printable ASCII, cut to size. */
static void copy_text(char *to, size_t size, const char *from)
{
    size_t length = 0;
    for (; *from && length + 1 < size; from++) {
        const char c = *from >= ' ' && *from <= '~' ? *from : ' ';
        if (c != ' ' || (length > 0 && to[length - 1] != ' '))
            to[length++] = c;
    }
    if (length > 0 && to[length - 1] == ' ')
        length--;
    to[length] = '\0';
}

/* ---- platforms ---- */

static void platform_text(const asj_cl_api *api, cl_platform_id platform, cl_platform_info what, char *to, size_t size)
{
    char text[LONGEST_TEXT];
    memset(text, 0, sizeof text);
    to[0] = '\0';
    if (api->GetPlatformInfo(platform, what, sizeof text - 1, text, NULL) == CL_SUCCESS)
        copy_text(to, size, text);
}

/* ---- devices ---- */

/* Asks for the properties of a device; the first question that fails is the reason. */
typedef struct query {
    const asj_cl_api *api;
    cl_device_id device;
    asj_device *record;
} query;

static void ask(const query *q, cl_device_info what, const char *name, void *to, size_t size)
{
    char error_text[ASJ_CL_ERROR_SIZE];
    memset(to, 0, size);
    const cl_int error = q->api->GetDeviceInfo(q->device, what, size, to, NULL);
    if (error == CL_SUCCESS)
        return;
    memset(to, 0, size);
    if (!q->record->reason[0])
        snprintf(q->record->reason, sizeof q->record->reason, "clGetDeviceInfo(%s): %s", name,
                 asj_cl_error_name(error, error_text));
}
#define ASK(q, what, to) ask(q, what, #what, &(to), sizeof(to))

static void ask_text(const query *q, cl_device_info what, const char *name, char *to, size_t size)
{
    char text[LONGEST_TEXT + 1];
    ask(q, what, name, text, LONGEST_TEXT);
    text[LONGEST_TEXT] = '\0';
    copy_text(to, size, text);
}
#define ASK_TEXT(q, what, to) ask_text(q, what, #what, to, sizeof(to))

static int32_t type_of(cl_device_type type)
{
    if (type & CL_DEVICE_TYPE_CPU)
        return ASJ_DEVICE_CPU;
    if (type & CL_DEVICE_TYPE_GPU)
        return ASJ_DEVICE_GPU;
    return type & CL_DEVICE_TYPE_ACCELERATOR ? ASJ_DEVICE_ACCELERATOR : ASJ_DEVICE_OTHER;
}

static int host_is_little_endian(void)
{
    const uint16_t one = 1;
    unsigned char bytes[sizeof one];
    memcpy(bytes, &one, sizeof one);
    return bytes[0] == 1;
}

/* At least OpenCL 1.2, going by "OpenCL MAJOR.MINOR ...". */
static int is_recent(const char *version)
{
    int major = 0, minor = 0;
    return sscanf(version, "OpenCL %d.%d", &major, &minor) == 2 && (major > 1 || (major == 1 && minor >= 2));
}

static void check(const query *q)
{
    asj_device *record = q->record;
    cl_bool available, compiler, little;
    char profile[64];
    size_t work_group;
    cl_uint bits;
    ASK(q, CL_DEVICE_AVAILABLE, available);
    ASK(q, CL_DEVICE_COMPILER_AVAILABLE, compiler);
    ASK(q, CL_DEVICE_ENDIAN_LITTLE, little);
    ASK_TEXT(q, CL_DEVICE_PROFILE, profile);
    ASK(q, CL_DEVICE_MAX_WORK_GROUP_SIZE, work_group);
    ASK(q, CL_DEVICE_ADDRESS_BITS, bits);
    const struct {
        int bad;
        const char *reason;
    } reasons[] = {
        {!available, "it is not available"},
        {record->type == ASJ_DEVICE_OTHER, "it is neither a CPU, a GPU nor an accelerator"},
        {!is_recent(record->version), "it is older than OpenCL 1.2"},
        {strcmp(profile, "FULL_PROFILE") != 0, "it has the embedded profile only"},
        {!compiler, "it has no compiler"},
        {(little != CL_FALSE) != host_is_little_endian(), "its byte order is not that of the host"},
        {work_group < LEAST_WORK_GROUP, "its work-groups are too small"},
        {record->local_memory < LEAST_LOCAL_MEMORY, "it has too little local memory"},
        {bits != 32 && bits != 64, "its addresses have neither 32 nor 64 bits"},
    };
    for (size_t i = 0; i < sizeof reasons / sizeof reasons[0] && !record->reason[0]; i++)
        if (reasons[i].bad)
            snprintf(record->reason, sizeof record->reason, "%s", reasons[i].reason);
    record->usable = !record->reason[0];
}

static void describe(const asj_cl_api *api, cl_device_id device, asj_device *record)
{
    const query q = {api, device, record};
    cl_device_type type;
    cl_uint units, clock;
    cl_ulong global, local, largest;
    ASK_TEXT(&q, CL_DEVICE_NAME, record->name);
    ASK_TEXT(&q, CL_DEVICE_VENDOR, record->vendor);
    ASK_TEXT(&q, CL_DEVICE_VERSION, record->version);
    ASK_TEXT(&q, CL_DRIVER_VERSION, record->driver);
    ASK(&q, CL_DEVICE_TYPE, type);
    ASK(&q, CL_DEVICE_MAX_COMPUTE_UNITS, units);
    ASK(&q, CL_DEVICE_MAX_CLOCK_FREQUENCY, clock);
    ASK(&q, CL_DEVICE_GLOBAL_MEM_SIZE, global);
    ASK(&q, CL_DEVICE_LOCAL_MEM_SIZE, local);
    ASK(&q, CL_DEVICE_MAX_MEM_ALLOC_SIZE, largest);
    record->type = type_of(type);
    record->compute_units = (int32_t)(units & INT32_MAX);
    record->clock_mhz = (int32_t)(clock & INT32_MAX);
    record->global_memory = global;
    record->local_memory = local;
    record->largest_buffer = largest;
    check(&q);
}

/* ---- lists ---- */

/* Room for one more. */
static asj_status grow(asj_memory *memory, asj_cl_found *found)
{
    struct {
        void *block;
        size_t size;
    } arrays[] = {{found->platforms, sizeof *found->platforms},
                  {found->devices, sizeof *found->devices},
                  {found->records, sizeof *found->records}};
    const size_t capacity = found->capacity;
    size_t grown = capacity;
    asj_status status = ASJ_OK;
    for (size_t i = 0; i < 3 && status == ASJ_OK; i++) {
        grown = capacity;
        status = asj_grow(memory, &arrays[i].block, &grown, found->count + 1, arrays[i].size, found->count);
    }
    found->platforms = arrays[0].block;
    found->devices = arrays[1].block;
    found->records = arrays[2].block;
    if (status == ASJ_OK)
        found->capacity = grown;
    return status;
}

static asj_status add(asj_memory *memory, const asj_cl_api *api, cl_platform_id platform, cl_device_id device, const char *reason,
                      asj_cl_found *found)
{
    asj_status status = grow(memory, found);
    if (status != ASJ_OK)
        return status;
    asj_device *record = &found->records[found->count];
    memset(record, 0, sizeof *record);
    found->platforms[found->count] = platform;
    found->devices[found->count++] = device;
    platform_text(api, platform, CL_PLATFORM_NAME, record->platform, sizeof record->platform);
    if (device) {
        describe(api, device, record);
    } else {
        platform_text(api, platform, CL_PLATFORM_VENDOR, record->vendor, sizeof record->vendor);
        platform_text(api, platform, CL_PLATFORM_VERSION, record->version, sizeof record->version);
        snprintf(record->reason, sizeof record->reason, "%s", reason);
    }
    return ASJ_OK;
}

static asj_status add_platform(asj_memory *memory, const asj_cl_api *api, cl_platform_id platform, asj_cl_found *found)
{
    cl_device_id devices[MOST_DEVICES];
    char reason[128], text[ASJ_CL_ERROR_SIZE];
    cl_uint count = 0;
    const cl_int error = api->GetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, MOST_DEVICES, devices, &count);
    if (error == CL_DEVICE_NOT_FOUND || (error == CL_SUCCESS && count == 0))
        return add(memory, api, platform, NULL, "the platform has no devices", found);
    if (error != CL_SUCCESS) {
        snprintf(reason, sizeof reason, "clGetDeviceIDs: %s", asj_cl_error_name(error, text));
        return add(memory, api, platform, NULL, reason, found);
    }
    asj_status status = ASJ_OK;
    for (cl_uint i = 0; i < count && i < MOST_DEVICES && status == ASJ_OK; i++)
        status = add(memory, api, platform, devices[i], "the platform gives no handle of it", found);
    return status;
}

asj_status asj_cl_enumerate(asj_memory *memory, const asj_cl_api *api, asj_cl_found *found, char *message, size_t message_size)
{
    cl_platform_id platforms[MOST_PLATFORMS];
    char text[ASJ_CL_ERROR_SIZE];
    cl_uint count = 0;
    asj_status status = ASJ_OK;
    memset(found, 0, sizeof *found);
    const cl_int error = api->GetPlatformIDs(MOST_PLATFORMS, platforms, &count);
    if (error != CL_SUCCESS) {
        snprintf(message, message_size, "no OpenCL platform: clGetPlatformIDs: %s", asj_cl_error_name(error, text));
        return ASJ_OK;
    }
    if (count == 0)
        snprintf(message, message_size, "no OpenCL platform");
    for (cl_uint i = 0; i < count && i < MOST_PLATFORMS && status == ASJ_OK; i++)
        status = add_platform(memory, api, platforms[i], found);
    return status;
}

void asj_cl_found_free(asj_memory *memory, asj_cl_found *found)
{
    asj_release(memory, found->platforms);
    asj_release(memory, found->devices);
    asj_release(memory, found->records);
    memset(found, 0, sizeof *found);
}
