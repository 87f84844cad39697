/* SPDX-License-Identifier: BSD-2-Clause */
#include "more_operations.h"

#include "detect/scan_cache.h"

#include <math.h>
#include <string.h>

static size_t ray_count(const subject *s)
{
    return 12 + (size_t)s->frame.width * (size_t)s->frame.height / 400;
}

size_t rays_size(const subject *s)
{
    return ray_count(s) * sizeof(asj_ray);
}

/* In and around the image, in all directions, some of them along the axes. */
static void choose_rays(const subject *s, asj_ray *rays)
{
    synth_random random = s->random;
    memset(rays, 0, rays_size(s));
    for (size_t i = 0; i < ray_count(s); i++) {
        rays[i].x = synth_random_between(&random, -3, s->frame.width + 3);
        rays[i].y = synth_random_between(&random, -3, s->frame.height + 3);
        rays[i].angle = i % 5 ? synth_random_between(&random, 0, 6.283) : (double)(i % 4) * 2 * atan(1.0);
        rays[i].start = (int32_t)synth_random_between(&random, 0, i % 7 ? 12 : 300);
    }
}

/* Some rays, then the rest: what the first have found is there for the second. */
asj_status run_rays(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    asj_detect_options options = s->options;
    asj_scan_cache cache = {0};
    asj_scan scan;
    asj_ray *rays = output;
    const size_t count = ray_count(s), some = count / 3;
    const asj_scratch whole = {scratch, s->scratch_size};
    options.arc_half_width = 1 + (int32_t)(s->seed % 3);
    options.scan_tolerance = (int32_t)(s->seed / 3 % 3);
    options.scan_axial = s->seed % 5 > 0;
    asj_scan_prepare(&options, &s->field, &cache, &scan);
    scan.rough = s->seed % 7 > 4;
    asj_scan_set_size(&options, s->frame.width, s->frame.height, &scan);
    if (s->seed % 4 > 0)
        scan.threshold = 1 + scan.threshold / (1 << s->seed % 4); /* longer ways in what is no picture */
    choose_rays(s, rays);
    asj_status status = asj_scan_cache_prepare(context, &s->frame, context->threads, &cache);
    if (status == ASJ_OK)
        status = context->ops->scan->rays(context, &scan, &s->frame, &whole, rays, some);
    if (status == ASJ_OK)
        status = context->ops->scan->rays(context, &scan, &s->frame, &whole, rays + some, count - some);
    asj_scan_cache_free(&context->memory, &cache);
    return status;
}
