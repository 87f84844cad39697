/* SPDX-License-Identifier: BSD-2-Clause */
/* Two-view geometry: candidates that agree with a map, some that do not, some that must be refused; any options. Twice the same
 * input, twice the same answer. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 40, SIDE = 400 };

static void camera_of(fuzz_bytes *bytes, asj_camera *camera)
{
    camera->fx = camera->fy = (double)fuzz_pair(bytes) / 50.0;
    camera->cx = camera->cy = (double)fuzz_pair(bytes) / 100.0 - 100.0;
}

static void make_options(fuzz_bytes *bytes, asj_geometry_options *options)
{
    unsigned what = fuzz_byte(bytes);
    asj_geometry_options_init(options);
    options->model = (int32_t)(what % 6); /* 5 is refused */
    options->samples = 1 + (int32_t)(fuzz_byte(bytes) % 64);
    options->seed = fuzz_byte(bytes);
    options->widths[0] = options->widths[1] = options->heights[0] = options->heights[1] = SIDE;
    options->find_focal = !(what & 64) && (what & 32) && options->model == ASJ_GEOMETRY_AUTO;
    if (what & 64) {
        camera_of(bytes, &options->cameras[0]);
        camera_of(bytes, &options->cameras[1]);
    }
    if (what & 128)
        options->epsilon = pow(10, -(double)(fuzz_byte(bytes) % 14));
}

/* x2 = a + (1 + b) x1 + ..., by bytes, and for half of them farther along x, as what is nearer to affine cameras; every third or so
 * is off by more. */
static size_t make_candidates(fuzz_bytes *bytes, asj_geometry_candidate *list)
{
    size_t count = fuzz_byte(bytes) % (MOST + 1), i;
    double map[6], w;
    for (i = 0; i < 6; i++)
        map[i] = (double)(int)(fuzz_byte(bytes) - 128) / 256.0;
    for (i = 0; i < count; i++) {
        asj_geometry_candidate *c = &list[i];
        unsigned kind = fuzz_byte(bytes);
        c->place1 = (uint32_t)i;
        c->place2 = kind % 5 == 0 ? 0 : (uint32_t)i;
        c->x1 = (double)fuzz_byte(bytes) / 255.0 * SIDE;
        c->y1 = (double)fuzz_byte(bytes) / 255.0 * SIDE;
        w = 1 + map[5] * c->x1 / SIDE * 0.3;
        c->x2 = ((1 + map[0]) * c->x1 + map[1] * c->y1) / w + map[2] * 100;
        c->y2 = (map[3] * c->x1 + (1 + map[4]) * c->y1) / w;
        if (kind & 128)
            c->x2 += kind & 63;
        if (kind % 3 == 0) {
            c->x2 += (double)fuzz_byte(bytes) - 128;
            c->y2 += (double)fuzz_byte(bytes) - 128;
        }
        c->affine[0] = 1 + map[0];
        c->affine[1] = map[1];
        c->affine[2] = map[3];
        c->affine[3] = 1 + map[4];
        c->probability = (double)fuzz_byte(bytes) / 255.0;
        if (kind == 255)
            c->y1 = (fuzz_byte(bytes) & 1) ? NAN : 1e7; /* refused */
    }
    return count;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes bytes = {data, size};
    static asj_geometry_candidate list[MOST];
    double probabilities[2][MOST];
    asj_geometry geometry[2];
    asj_geometry_options options;
    asj_status status;
    size_t count, i;

    make_options(&bytes, &options);
    count = make_candidates(&bytes, list);
    fuzz_geometry_options(&bytes, &options);
    memset(geometry, 0, sizeof geometry);
    status = asj_geometry_estimate(fuzz_context(), list, count, &options, probabilities[0], &geometry[0]);
    if (status != ASJ_OK) {
        fuzz_check(*asj_context_message(fuzz_context()) != '\0', "a failure without a message");
        return 0;
    }
    for (i = 0; i < count; i++)
        fuzz_check(probabilities[0][i] >= 0 && probabilities[0][i] <= 1.0000001, "a probability out of range");
    fuzz_check_geometry(&geometry[0]);
    fuzz_check(asj_geometry_estimate(fuzz_context(), list, count, &options, probabilities[1], &geometry[1]) == ASJ_OK &&
               !memcmp(&geometry[0], &geometry[1], sizeof geometry[0]) &&
               (!count || !memcmp(probabilities[0], probabilities[1], count * sizeof(double))), "another answer the second time");
    return 0;
}
