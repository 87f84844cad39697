/* SPDX-License-Identifier: BSD-2-Clause */
/* Whether a device computes as it must: kernels/check.cl against the same in C, before anything else runs on it. */
#include "check.h"
#include "state.h"

enum { ITEMS = 256 };

static uint32_t leading_zeros(uint64_t number)
{
    uint32_t zeros = 0;
    for (; !(number >> 63); number <<= 1)
        zeros++;
    return zeros;
}

static uint32_t expected(uint32_t i)
{
    const uint32_t a = i * 2654435761u + 12345u;
    const int32_t s = (int32_t)((a >> 16 ^ 0x8000) & 0xffff) - 0x8000, t = (int32_t)((a ^ 0x8000) & 0xffff) - 0x8000;
    const uint64_t w = (uint64_t)a * 0x9e3779b97f4a7c15u;
    uint32_t sum = a >> 5 | (a >> 31 ? 0xf8000000u : 0);
    const int32_t product = s * t, low = (int32_t)((uint32_t)product & 0xffff);
    sum = sum * 31 + (uint32_t)((product - low) / 65536);
    sum = sum * 31 + ((a >> 16) * (a & 0xffff) >> 16) + (uint32_t)(s < 0 ? -s : s);
    sum = sum * 31 + (uint32_t)(w >> (a & 63)) + leading_zeros(w | 1);
    sum = sum * 31 + (uint32_t)(s < t ? t : s);
    const uint32_t m = a & 0xffff, n = a >> 8 & 0xffff;
    const volatile float rounded = (float)m * (float)n;
    const float left = rounded + -(float)(m * n & ~0xffu);
    const volatile float part = (float)t * 0.37f;
    return sum * 31 + (uint32_t)(int32_t)left + (uint32_t)(int32_t)part;
}

asj_status asj_cl_check(asj_context *context)
{
    uint32_t results[ITEMS];
    asj_cl_buffer buffer = {0};
    const size_t global = ITEMS;
    asj_status status = asj_cl_reserve(context, &buffer, sizeof results);
    const asj_cl_argument arguments[] = {ASJ_CL_BUFFER(&buffer)};
    if (status == ASJ_OK)
        status = asj_cl_run(context, "check", 1, &global, NULL, ASJ_CL_ARGUMENTS(arguments));
    if (status == ASJ_OK)
        status = asj_cl_read(context, &buffer, 0, results, sizeof results);
    asj_cl_release(context, &buffer);
    for (uint32_t i = 0; i < ITEMS && status == ASJ_OK; i++)
        if (results[i] != expected(i))
            status = asj_fail(context, ASJ_ERROR_DEVICE, "%s computes otherwise than OpenCL demands", context->cl->name);
    return status;
}
