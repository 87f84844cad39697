/* SPDX-License-Identifier: BSD-2-Clause */
/* libOpenCL, found at run time: the library links to nothing, and works without. */
#ifndef ASJ_SRC_CL_LOADER_H
#define ASJ_SRC_CL_LOADER_H

#include <stddef.h>

#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif
#include <CL/cl.h>

/* Every function that is called, without cl: X(result, name, parameters). All are part of OpenCL 1.2. */
#define ASJ_CL_FUNCTIONS(X)                                                                                                       \
    X(cl_int, GetPlatformIDs, (cl_uint, cl_platform_id *, cl_uint *))                                                             \
    X(cl_int, GetPlatformInfo, (cl_platform_id, cl_platform_info, size_t, void *, size_t *))                                      \
    X(cl_int, GetDeviceIDs, (cl_platform_id, cl_device_type, cl_uint, cl_device_id *, cl_uint *))                                 \
    X(cl_int, GetDeviceInfo, (cl_device_id, cl_device_info, size_t, void *, size_t *))                                            \
    X(cl_context, CreateContext, (const cl_context_properties *, cl_uint, const cl_device_id *,                                   \
                                  void(CL_CALLBACK *)(const char *, const void *, size_t, void *), void *, cl_int *))             \
    X(cl_int, ReleaseContext, (cl_context))                                                                                       \
    X(cl_command_queue, CreateCommandQueue, (cl_context, cl_device_id, cl_command_queue_properties, cl_int *))                    \
    X(cl_int, ReleaseCommandQueue, (cl_command_queue))                                                                            \
    X(cl_mem, CreateBuffer, (cl_context, cl_mem_flags, size_t, void *, cl_int *))                                                 \
    X(cl_int, ReleaseMemObject, (cl_mem))                                                                                         \
    X(cl_program, CreateProgramWithSource, (cl_context, cl_uint, const char **, const size_t *, cl_int *))                        \
    X(cl_program, CreateProgramWithBinary, (cl_context, cl_uint, const cl_device_id *, const size_t *, const unsigned char **,    \
                                            cl_int *, cl_int *))                                                                  \
    X(cl_int, BuildProgram, (cl_program, cl_uint, const cl_device_id *, const char *,                                             \
                             void(CL_CALLBACK *)(cl_program, void *), void *))                                                    \
    X(cl_int, GetProgramInfo, (cl_program, cl_program_info, size_t, void *, size_t *))                                            \
    X(cl_int, GetProgramBuildInfo, (cl_program, cl_device_id, cl_program_build_info, size_t, void *, size_t *))                   \
    X(cl_int, ReleaseProgram, (cl_program))                                                                                       \
    X(cl_kernel, CreateKernel, (cl_program, const char *, cl_int *))                                                              \
    X(cl_int, ReleaseKernel, (cl_kernel))                                                                                         \
    X(cl_int, SetKernelArg, (cl_kernel, cl_uint, size_t, const void *))                                                           \
    X(cl_int, GetKernelWorkGroupInfo, (cl_kernel, cl_device_id, cl_kernel_work_group_info, size_t, void *, size_t *))             \
    X(cl_int, EnqueueNDRangeKernel, (cl_command_queue, cl_kernel, cl_uint, const size_t *, const size_t *, const size_t *,        \
                                     cl_uint, const cl_event *, cl_event *))                                                      \
    X(cl_int, EnqueueReadBuffer, (cl_command_queue, cl_mem, cl_bool, size_t, size_t, void *, cl_uint, const cl_event *,           \
                                  cl_event *))                                                                                    \
    X(cl_int, EnqueueWriteBuffer, (cl_command_queue, cl_mem, cl_bool, size_t, size_t, const void *, cl_uint, const cl_event *,    \
                                   cl_event *))                                                                                   \
    X(cl_int, EnqueueReadBufferRect, (cl_command_queue, cl_mem, cl_bool, const size_t *, const size_t *, const size_t *, size_t,  \
                                      size_t, size_t, size_t, void *, cl_uint, const cl_event *, cl_event *))                     \
    X(cl_int, EnqueueWriteBufferRect, (cl_command_queue, cl_mem, cl_bool, const size_t *, const size_t *, const size_t *, size_t, \
                                       size_t, size_t, size_t, const void *, cl_uint, const cl_event *, cl_event *))              \
    X(cl_int, EnqueueFillBuffer, (cl_command_queue, cl_mem, const void *, size_t, size_t, size_t, cl_uint, const cl_event *,      \
                                  cl_event *))                                                                                    \
    X(cl_int, WaitForEvents, (cl_uint, const cl_event *))                                                                         \
    X(cl_int, GetEventProfilingInfo, (cl_event, cl_profiling_info, size_t, void *, size_t *))                                     \
    X(cl_int, ReleaseEvent, (cl_event))                                                                                           \
    X(cl_int, Finish, (cl_command_queue))

#define ASJ_CL_MEMBER(result, name, parameters) result(CL_API_CALL *name) parameters;
typedef struct asj_cl_api {
    ASJ_CL_FUNCTIONS(ASJ_CL_MEMBER)
    void *library; /* NULL = not loaded */
} asj_cl_api;

/* Loads the library at `path`, NULL = where the system has it (libOpenCL.so.1). 1 and a filled table, or 0 and a line of text. */
int asj_cl_load(const char *path, asj_cl_api *api, char *message, size_t message_size);

/* Gives it back. Its code stays in the process: drivers do not bear being unloaded. */
void asj_cl_unload(asj_cl_api *api);

#endif
