/* SPDX-License-Identifier: BSD-2-Clause */
#define _POSIX_C_SOURCE 200809L
#include "copy.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef ASJ_HAVE_OPENCL
#include "cl/state.h"
#endif

#define BYTES ((size_t)64 << 20)
#define RUNS 7

static double thread_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

double copy_rate_host(void)
{
    char *from = malloc(BYTES), *to = malloc(BYTES);
    double best = 0;
    if (from && to) {
        memset(from, 1, BYTES);
        memset(to, 2, BYTES);
        for (int i = 0; i < RUNS; i++) {
            const double start = thread_ms();
            memcpy(i % 2 ? from : to, i % 2 ? to : from, BYTES);
            const double rate = 2e-6 * (double)BYTES / (thread_ms() - start);
            best = rate > best ? rate : best;
        }
    }
    free(from);
    free(to);
    return best;
}

#ifdef ASJ_HAVE_OPENCL
static double run_copies(const struct asj_cl *cl, cl_kernel kernel, cl_mem from, cl_mem to)
{
    const size_t count = BYTES / 16;
    double best = 0;
    if (cl->api.SetKernelArg(kernel, 0, sizeof from, &from) != CL_SUCCESS ||
        cl->api.SetKernelArg(kernel, 1, sizeof to, &to) != CL_SUCCESS)
        return 0;
    for (int i = 0; i < RUNS; i++) {
        const double start = asj_clock_ms();
        if (cl->api.EnqueueNDRangeKernel(cl->queue, kernel, 1, NULL, &count, NULL, 0, NULL, NULL) != CL_SUCCESS ||
            cl->api.Finish(cl->queue) != CL_SUCCESS)
            return 0;
        const double rate = 2e-6 * (double)BYTES / (asj_clock_ms() - start);
        best = rate > best ? rate : best;
    }
    return best;
}

double copy_rate_device(asj_context *context)
{
    const char *source = "__kernel void copy(__global const uint4 *from, __global uint4 *to)\n"
                         "{ const size_t i = get_global_id(0); to[i] = from[i]; }\n";
    const struct asj_cl *cl = context->cl;
    cl_int error;
    cl_kernel kernel = NULL;
    double rate = 0;
    cl_program program = cl->api.CreateProgramWithSource(cl->context, 1, &source, NULL, &error);
    cl_mem from = cl->api.CreateBuffer(cl->context, CL_MEM_READ_WRITE, BYTES, NULL, &error);
    cl_mem to = cl->api.CreateBuffer(cl->context, CL_MEM_READ_WRITE, BYTES, NULL, &error);
    if (program && cl->api.BuildProgram(program, 1, &cl->device, "", NULL, NULL) == CL_SUCCESS)
        kernel = cl->api.CreateKernel(program, "copy", &error);
    if (kernel && from && to)
        rate = run_copies(cl, kernel, from, to);
    if (kernel)
        cl->api.ReleaseKernel(kernel);
    if (from)
        cl->api.ReleaseMemObject(from);
    if (to)
        cl->api.ReleaseMemObject(to);
    if (program)
        cl->api.ReleaseProgram(program);
    return rate;
}
#else
double copy_rate_device(asj_context *context)
{
    (void)context;
    return 0;
}
#endif
