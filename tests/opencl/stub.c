/* SPDX-License-Identifier: BSD-2-Clause */
#define _POSIX_C_SOURCE 200809L
#include "cl/loader.h" /* what the library looks up, and CL/cl.h */
#include "stub.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#if defined(__GNUC__)
#define EXPORT __attribute__((visibility("default")))
#else
#define EXPORT
#endif

/* A failure that any call may have. */
#define FAILURE CL_OUT_OF_RESOURCES

static stub_state state;
static asj_cl_api real;

EXPORT stub_state *stub_get_state(void);

/* The real library; loaded once, never given back. */
static int ready(void)
{
    if (!state.loaded) {
        const char *const path = getenv("STUB_OPENCL"); /* where the stub itself is found under the usual name */
        void *library = dlopen(path ? path : "libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);
        void *symbol;
        if (!library)
            return 0;
#define LOOK_UP(result, function, parameters)             \
    symbol = dlsym(library, "cl" #function);              \
    if (!symbol)                                          \
        return 0;                                         \
    memcpy(&real.function, &symbol, sizeof symbol);
        ASJ_CL_FUNCTIONS(LOOK_UP)
        state.loaded = 1;
    }
    return 1;
}

stub_state *stub_get_state(void)
{
    ready();
    return &state;
}

/* Counts a call; 1 = it is to fail. A call that releases fails only by itself: what it does is done. */
#define fails(name, releases) fails_from(name, releases, __builtin_return_address(0))
static int fails_from(const char *name, int releases, const void *site)
{
    if (!ready())
        return 1;
    if (state.counted && !strstr(name, state.counted))
        return 0;
    if (state.calls < STUB_SITES)
        state.sites[state.calls] = site;
    state.calls++;
    const int now = state.fail_at > 0 && (state.calls == state.fail_at ||
                                          (state.fail_from_there && !releases && state.calls > state.fail_at));
    if (now && state.failures++ == 0)
        state.failed = name;
    return now;
}

static void count(int kind, int made)
{
    state.live[kind] += made;
}

static void count_event(cl_int error, const cl_event *event)
{
    if (error == CL_SUCCESS && event)
        count(STUB_EVENT, 1);
}

#define PASS(name, parameters, arguments)                        \
    EXPORT cl_int CL_API_CALL cl##name parameters                \
    {                                                            \
        return fails("cl" #name, 0) ? FAILURE : real.name arguments; \
    }

/* The last parameter of these is cl_int *error. */
#define MAKE(result, kind, name, parameters, arguments)          \
    EXPORT result CL_API_CALL cl##name parameters                \
    {                                                            \
        if (fails("cl" #name, 0)) {                              \
            if (error)                                           \
                *error = FAILURE;                                \
            return NULL;                                         \
        }                                                        \
        const result made = real.name arguments;                 \
        count(kind, made != NULL);                               \
        return made;                                             \
    }

#define RELEASE(kind, name, type)                                \
    EXPORT cl_int CL_API_CALL cl##name(type object)              \
    {                                                            \
        const int failing = fails("cl" #name, 1);                \
        const cl_int error = real.name(object);                  \
        count(kind, -1);                                         \
        return failing ? FAILURE : error;                        \
    }

/* The last parameter of these is cl_event *event. */
#define ENQUEUE(name, parameters, arguments)                     \
    EXPORT cl_int CL_API_CALL clEnqueue##name parameters         \
    {                                                            \
        if (fails("clEnqueue" #name, 0))                         \
            return FAILURE;                                      \
        const cl_int error = real.Enqueue##name arguments;       \
        count_event(error, event);                               \
        return error;                                            \
    }

PASS(GetPlatformIDs, (cl_uint room, cl_platform_id *list, cl_uint *found), (room, list, found))
/* Under another name, so that what is done for one platform only does not hide what is done for all. */
EXPORT cl_int CL_API_CALL clGetPlatformInfo(cl_platform_id of, cl_platform_info what, size_t room, void *to, size_t *size)
{
    static const char name[] = "stub";
    if (fails("clGetPlatformInfo", 0))
        return FAILURE;
    const cl_int error = real.GetPlatformInfo(of, what, room, to, size);
    if (error == CL_SUCCESS && what == CL_PLATFORM_NAME && to && room >= sizeof name)
        memcpy(to, name, sizeof name);
    return error;
}

EXPORT cl_int CL_API_CALL clGetDeviceIDs(cl_platform_id of, cl_device_type type, cl_uint room, cl_device_id *list, cl_uint *found)
{
    if (fails("clGetDeviceIDs", 0))
        return FAILURE;
    return state.no_devices ? CL_DEVICE_NOT_FOUND : real.GetDeviceIDs(of, type, room, list, found);
}

EXPORT cl_int CL_API_CALL clGetDeviceInfo(cl_device_id of, cl_device_info what, size_t room, void *to, size_t *size)
{
    static const cl_device_type gpu = CL_DEVICE_TYPE_GPU;
    if (fails("clGetDeviceInfo", 0))
        return FAILURE;
    const cl_int error = real.GetDeviceInfo(of, what, room, to, size);
    if (error == CL_SUCCESS && state.all_are_gpus && what == CL_DEVICE_TYPE && to)
        memcpy(to, &gpu, sizeof gpu);
    return error;
}

MAKE(cl_context, STUB_CONTEXT, CreateContext,
     (const cl_context_properties *properties, cl_uint room, const cl_device_id *devices,
      void(CL_CALLBACK *notify)(const char *, const void *, size_t, void *), void *user, cl_int *error),
     (properties, room, devices, notify, user, error))
RELEASE(STUB_CONTEXT, ReleaseContext, cl_context)
MAKE(cl_command_queue, STUB_QUEUE, CreateCommandQueue,
     (cl_context of, cl_device_id device, cl_command_queue_properties properties, cl_int *error), (of, device, properties, error))
RELEASE(STUB_QUEUE, ReleaseCommandQueue, cl_command_queue)
MAKE(cl_mem, STUB_BUFFER, CreateBuffer, (cl_context of, cl_mem_flags flags, size_t size, void *host, cl_int *error),
     (of, flags, size, host, error))
RELEASE(STUB_BUFFER, ReleaseMemObject, cl_mem)
MAKE(cl_program, STUB_PROGRAM, CreateProgramWithSource,
     (cl_context of, cl_uint parts, const char **texts, const size_t *sizes, cl_int *error), (of, parts, texts, sizes, error))
MAKE(cl_program, STUB_PROGRAM, CreateProgramWithBinary,
     (cl_context of, cl_uint room, const cl_device_id *devices, const size_t *sizes, const unsigned char **binaries, cl_int *states,
      cl_int *error),
     (of, room, devices, sizes, binaries, states, error))
PASS(BuildProgram,
     (cl_program program, cl_uint room, const cl_device_id *devices, const char *options,
      void(CL_CALLBACK *notify)(cl_program, void *), void *user),
     (program, room, devices, options, notify, user))
PASS(GetProgramInfo, (cl_program of, cl_program_info what, size_t room, void *to, size_t *size), (of, what, room, to, size))
PASS(GetProgramBuildInfo, (cl_program of, cl_device_id device, cl_program_build_info what, size_t room, void *to, size_t *size),
     (of, device, what, room, to, size))
RELEASE(STUB_PROGRAM, ReleaseProgram, cl_program)
MAKE(cl_kernel, STUB_KERNEL, CreateKernel, (cl_program of, const char *name, cl_int *error), (of, name, error))
RELEASE(STUB_KERNEL, ReleaseKernel, cl_kernel)
PASS(SetKernelArg, (cl_kernel kernel, cl_uint index, size_t size, const void *value), (kernel, index, size, value))
PASS(GetKernelWorkGroupInfo,
     (cl_kernel of, cl_device_id device, cl_kernel_work_group_info what, size_t room, void *to, size_t *size),
     (of, device, what, room, to, size))

#define WAIT cl_uint waits, const cl_event *for_these, cl_event *event
ENQUEUE(NDRangeKernel,
        (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t *offset, const size_t *global,
         const size_t *local, WAIT),
        (queue, kernel, dimensions, offset, global, local, waits, for_these, event))
ENQUEUE(ReadBuffer, (cl_command_queue queue, cl_mem from, cl_bool blocking, size_t offset, size_t size, void *to, WAIT),
        (queue, from, blocking, offset, size, to, waits, for_these, event))
ENQUEUE(WriteBuffer, (cl_command_queue queue, cl_mem to, cl_bool blocking, size_t offset, size_t size, const void *from, WAIT),
        (queue, to, blocking, offset, size, from, waits, for_these, event))
ENQUEUE(ReadBufferRect,
        (cl_command_queue queue, cl_mem from, cl_bool blocking, const size_t *origin, const size_t *host, const size_t *region,
         size_t row, size_t slice, size_t host_row, size_t host_slice, void *to, WAIT),
        (queue, from, blocking, origin, host, region, row, slice, host_row, host_slice, to, waits, for_these, event))
ENQUEUE(WriteBufferRect,
        (cl_command_queue queue, cl_mem to, cl_bool blocking, const size_t *origin, const size_t *host, const size_t *region,
         size_t row, size_t slice, size_t host_row, size_t host_slice, const void *from, WAIT),
        (queue, to, blocking, origin, host, region, row, slice, host_row, host_slice, from, waits, for_these, event))
ENQUEUE(FillBuffer,
        (cl_command_queue queue, cl_mem buffer, const void *pattern, size_t pattern_size, size_t offset, size_t size, WAIT),
        (queue, buffer, pattern, pattern_size, offset, size, waits, for_these, event))
PASS(WaitForEvents, (cl_uint number, const cl_event *events), (number, events))
PASS(GetEventProfilingInfo, (cl_event of, cl_profiling_info what, size_t room, void *to, size_t *size), (of, what, room, to, size))
RELEASE(STUB_EVENT, ReleaseEvent, cl_event)
PASS(Finish, (cl_command_queue queue), (queue))
