/* SPDX-License-Identifier: BSD-2-Clause */
#include "more_operations.h"

#include "geometry/near.h"

#include <string.h>

enum { MOST = 300, RUNS = 12 };

size_t near_size(const subject *s)
{
    (void)s;
    return (size_t)(2 * RUNS * (MOST + 1)) * sizeof(uint32_t);
}

static float between(synth_random *random, double low, double high)
{
    return (float)synth_random_between(random, low, high);
}

/* Geometries of both kinds that some, all or none of the candidates are near, and lists of any length. */
asj_status run_near(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    static float numbers[4 * MOST + ASJ_NEAR_PADDING];
    synth_random random = s->random;
    uint32_t *near = output;
    (void)scratch;
    memset(output, 0, near_size(s));
    for (int32_t run = 0; run < RUNS; run++) {
        const int32_t count = run == 0 ? MOST : (int32_t)(synth_random_bits(&random) % (MOST + 1));
        const float *const at[4] = {numbers, numbers + count, numbers + 2 * count, numbers + 3 * count};
        asj_near_plan plan = {.factor = between(&random, 0, run % 3 ? 400 : 40000), .extra = between(&random, 0, 2)};
        for (int32_t k = 0; k < 4 * count + ASJ_NEAR_PADDING; k++)
            numbers[k] = between(&random, -320, 320);
        for (int32_t k = 0; k < 9; k++)
            plan.m[k] = between(&random, -1, 1) * (k == 8 ? 100.0f : k % 3 == 2 || k > 5 ? 1.0f : 0.01f);
        near[MOST] = (uint32_t)context->ops->near->lines(&plan, at, count, near);
        near += MOST + 1;
        near[MOST] = (uint32_t)context->ops->near->places(&plan, at, count, near);
        near += MOST + 1;
    }
    return ASJ_OK;
}
