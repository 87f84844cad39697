/* SPDX-License-Identifier: BSD-2-Clause */
#include "more_operations.h"

#include <math.h>

size_t wedge_size(const subject *s)
{
    (void)s;
    return sizeof(asj_wedge_sums);
}

/* In and around the image, with edges in any directions, short and long, of any blur. */
asj_status run_wedge(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    synth_random random = s->random;
    const double blur = synth_random_between(&random, 0.5, 4);
    asj_wedge wedge = {{0}};
    asj_wedge_window in = {.reach = 3 * blur, .across = 2 * blur};
    (void)scratch;
    in.x = wedge.p[ASJ_WEDGE_X] = synth_random_between(&random, -2, s->picture->width + 2);
    in.y = wedge.p[ASJ_WEDGE_Y] = synth_random_between(&random, -2, s->picture->height + 2);
    wedge.p[ASJ_WEDGE_BLUR] = blur;
    for (int edge = 0; edge < 2; edge++) {
        const double angle = synth_random_between(&random, 0, 6.283);
        wedge.p[ASJ_WEDGE_FIRST + edge] = angle;
        in.ux[edge] = cos(angle);
        in.uy[edge] = sin(angle);
        in.last[edge] = fmax(synth_random_between(&random, -10, 80), 0);
    }
    context->ops->wedge->add_up(s->picture, &wedge, &in, output);
    return ASJ_OK;
}
