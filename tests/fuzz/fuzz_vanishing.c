/* SPDX-License-Identifier: BSD-2-Clause */
/* Vanishing points: branches that run towards three points, and others, with a camera and without. Twice the same input, twice the
 * same answer. */
#include "fuzz.h"

#include <math.h>
#include <string.h>

enum { MOST = 48, WIDTH = 640, HEIGHT = 480 };

static void make_options(fuzz_bytes *bytes, asj_vanishing_options *options)
{
    const unsigned what = fuzz_byte(bytes);
    asj_vanishing_options_init(options);
    options->width = WIDTH;
    options->height = HEIGHT;
    if (what & 1) {
        options->camera.fx = options->camera.fy = (double)fuzz_pair(bytes) / 20; /* 0: not known; below 1: refused */
        options->camera.cx = (what & 2) ? WIDTH / 2 : (double)fuzz_pair(bytes) - 32768;
        options->camera.cy = HEIGHT / 2;
    }
    if (what & 4)
        options->epsilon = pow(10, -(double)(fuzz_byte(bytes) % 13));
}

static size_t make_junctions(fuzz_bytes *bytes, asj_junction *list)
{
    const size_t count = fuzz_byte(bytes) % (MOST + 1);
    double points[3][2];
    size_t i;
    for (i = 0; i < 3; i++) {
        points[i][0] = 4 * (double)fuzz_pair(bytes) - 131072;
        points[i][1] = 4 * (double)fuzz_pair(bytes) - 131072;
    }
    memset(list, 0, MOST * sizeof *list);
    for (i = 0; i < count; i++) {
        asj_branch *branch = list[i].branches;
        const unsigned kind = fuzz_byte(bytes);
        const double *to = points[kind % 4 < 3 ? kind % 4 : 0];
        list[i].x = (float)fuzz_byte(bytes) * (WIDTH / 256.0F);
        list[i].y = (float)fuzz_byte(bytes) * (HEIGHT / 256.0F);
        list[i].branch_count = 1;
        branch->length = (float)fuzz_byte(bytes);
        branch->angle = kind % 4 < 3 ? (float)atan2(to[1] - (double)list[i].y, to[0] - (double)list[i].x)
                                     : (float)fuzz_byte(bytes) / 40;
        branch->angle_sd = (kind & 4) ? 0.004F : 0;
        if (kind == 255)
            list[i].x = (fuzz_byte(bytes) & 1) ? 3e38F : NAN; /* on no line; refused */
    }
    return count;
}

static void check_points(const asj_vanishing_points *found, const asj_vanishing_options *options)
{
    int32_t k;
    fuzz_check(found->count >= 0 && found->count <= ASJ_MOST_VANISHING, "a count out of range");
    fuzz_check(found->focal_source >= ASJ_FOCAL_UNKNOWN && found->focal_source <= ASJ_FOCAL_FOUND, "an unknown source");
    fuzz_check((found->focal_source == ASJ_FOCAL_GIVEN) == (options->camera.fx > 0), "a camera that was not given");
    for (k = 0; k < found->count; k++) {
        const asj_vanishing_point *p = &found->points[k];
        const double *v = p->point, *d = p->direction, is = found->focal_source != ASJ_FOCAL_UNKNOWN;
        fuzz_check(fabs(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] - 1) < 1e-9, "a point that is not of length 1");
        fuzz_check(fabs(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - is) < 1e-9, "a direction that is not of length 1");
        fuzz_check(p->log10_nfa <= log10(options->epsilon) + 1e-9 && p->branch_count > 0, "a point that chance may bring");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes bytes = {data, size};
    static asj_junction list[MOST];
    asj_vanishing_options options;
    asj_vanishing_points first, second;
    size_t count;

    make_options(&bytes, &options);
    count = make_junctions(&bytes, list);
    if (asj_find_vanishing_points(fuzz_context(), list, count, &options, &first) != ASJ_OK) {
        fuzz_check(*asj_context_message(fuzz_context()) != '\0', "a failure without a message");
        return 0;
    }
    check_points(&first, &options);
    fuzz_check(asj_find_vanishing_points(fuzz_context(), list, count, &options, &second) == ASJ_OK &&
               !memcmp(&first, &second, sizeof first), "another answer the second time");
    return 0;
}
