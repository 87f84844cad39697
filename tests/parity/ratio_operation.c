/* SPDX-License-Identifier: BSD-2-Clause */
#include "more_operations.h"

#include "geometry/ratios.h"
#include "geometry/small_matrix.h"

#include <string.h>

enum { MOST = 300, RUNS = 24 };

typedef struct answers {
    double lines[MOST], sides[MOST], places[MOST];
} answers;

size_t ratio_size(const subject *s)
{
    (void)s;
    return RUNS * sizeof(answers);
}

/* A motion with one plane, n'X = 1, seen by two cameras. */
static void random_motion(synth_random *random, asj_two_view *view)
{
    double w[3], n[3], skew[9], essential[9], kept[9], *t = view->translation;
    const double f1 = synth_random_between(random, 400, 800), f2 = synth_random_between(random, 400, 800);
    const double from_pixel[9] = {1 / f1, 0, -320 / f1, 0, 1 / 610.0, -240 / 610.0, 0, 0, 1};
    const double to_pixel[9] = {f2, 0, 320, 0, 610, 240, 0, 0, 1};
    const double line_to_pixel[9] = {1 / f2, 0, 0, 0, 1 / 610.0, 0, -320 / f2, -240 / 610.0, 1};
    memset(view, 0, sizeof *view);
    for (int32_t k = 0; k < 3; k++) {
        w[k] = synth_random_between(random, -0.5, 0.5);
        t[k] = synth_random_between(random, -0.7, 0.7);
        n[k] = k == 2 ? synth_random_between(random, 0.3, 0.6) : synth_random_between(random, -0.4, 0.4);
    }
    view->has_motion = view->plane_count = 1;
    view->thickness[0] = 0.7;
    view->parallax2 = 1e-5;
    memcpy(view->ray2, (double[4]){1 / f2, 1 / 610.0, 320, 240}, sizeof view->ray2);
    asj_rotation_of(w, view->rotation);
    asj_multiply3(view->rotation, from_pixel, view->turned);
    asj_skew3(t, skew);
    asj_multiply3(skew, view->turned, essential);
    asj_multiply3(line_to_pixel, essential, view->matrix);
    for (int32_t k = 0; k < 9; k++)
        kept[k] = view->rotation[k] + t[k / 3] * n[k % 3];
    asj_multiply3(kept, from_pixel, kept);
    asj_multiply3(to_pixel, kept, view->planes[0]);
    for (int32_t k = 0; k < 3; k++)
        view->in_front[0][k] = n[0] * from_pixel[k] + n[1] * from_pixel[3 + k] + n[2] * from_pixel[6 + k];
}

/* A candidate on the plane but for errors, of the map's entries by so much. */
static asj_pair on_plane(synth_random *random, const double h[9], double px, double by)
{
    asj_pair c;
    double at[3], turn[4];
    memset(&c, 0, sizeof c);
    c.x1 = synth_random_between(random, -200, 840);
    c.y1 = synth_random_between(random, -200, 680);
    for (int32_t k = 0; k < 3; k++)
        at[k] = h[3 * k] * c.x1 + h[3 * k + 1] * c.y1 + h[3 * k + 2];
    for (int32_t k = 0; k < 4; k++)
        turn[k] = (k % 3 == 0) + synth_random_between(random, -by, by);
    const double x = at[0] / at[2], y = at[1] / at[2];
    const double j[4] = {h[0] - x * h[6], h[1] - x * h[7], h[3] - y * h[6], h[4] - y * h[7]};
    for (int32_t k = 0; k < 4; k++)
        c.affine[k] = (j[k / 2 * 2] * turn[k % 2] + j[k / 2 * 2 + 1] * turn[2 + k % 2]) / at[2];
    c.x2 = x + synth_random_between(random, -px, px);
    c.y2 = y + synth_random_between(random, -px, px);
    return c;
}

/* Lists of any length of candidates near motions, planes and homographies, or far from them, with standard deviations as they are
 * and loosened. What is no candidate of a plane is beside it, behind a camera or turned over. */
asj_status run_ratio(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    static asj_pair list[MOST];
    static uint32_t which[MOST];
    const asj_ratio_ops *ops = context->ops->ratio;
    asj_pairs set = {.list = list, .location_sd = 1.5, .angle_sd = 0.15, .scale_sd = 0.12, .spread = 100, .area = 640 * 480};
    synth_random random = s->random;
    answers *out = output;
    (void)scratch;
    memset(output, 0, ratio_size(s));
    for (int32_t run = 0; run < RUNS; run++, out++) {
        const int32_t count = run == 0 ? MOST : (int32_t)(synth_random_bits(&random) % (MOST + 1));
        asj_two_view view;
        random_motion(&random, &view);
        for (int32_t k = 0; k < MOST; k++) {
            list[k] = on_plane(&random, view.planes[0], k % 3 ? 2 : 20, k % 4 ? 0.15 : 2);
            which[k] = (uint32_t)(synth_random_bits(&random) % MOST);
        }
        set.count = MOST;
        const asj_peaks peaks = asj_likelihood_peaks(&set, &view, run % 3 ? 1 : 2);
        asj_ratio_plan plan = {&set, &view, &peaks, 0};
        ops->lines(&plan, which, count, out->lines, out->sides);
        for (int32_t k = 0; k < count; k++)
            out->sides[k] = out->lines[k] > 0 ? out->sides[k] : 0;
        plan.part = 1;
        if (run % 4 == 3) {
            view.planar = 1;
            view.plane_count = plan.part = 0;
            memcpy(view.matrix, view.planes[0], sizeof view.matrix);
        }
        ops->places(&plan, which, count, out->places);
    }
    return ASJ_OK;
}
