/* SPDX-License-Identifier: BSD-2-Clause */
/* Derivatives of residuals against differences, and the first look at candidates against the exact one. */
#include "unit_test.h"

#include "geometry/near.h"
#include "geometry/slopes.h"
#include "geometry/small_matrix.h"

#define STEP 1e-6
#define COUNT 500
#define TURN (ASJ_GEOMETRY_HOMOGRAPHY + 1) /* of a camera that only turns */

static void random_model(synth_random *random, int32_t kind, asj_model *m)
{
    const asj_camera camera = {synth_random_between(random, 400, 800), 610, 320, 240};
    double w[3];
    memset(m, 0, sizeof *m);
    for (int k = 0; k < 3; k++) {
        w[k] = synth_random_between(random, -0.4, 0.4);
        m->translation[k] = synth_random_between(random, -1, 1);
    }
    asj_rotation_of(w, m->rotation);
    m->cameras[0] = m->cameras[1] = camera;
    m->kind = ASJ_GEOMETRY_ESSENTIAL;
    m->parameters = 11;
    m->view.plane_count = 2;
    for (int n = 0; n < 2; n++)
        for (int k = 0; k < 3; k++)
            m->planes[n][k] = k == 2 ? synth_random_between(random, 0.3, 0.6) : synth_random_between(random, -0.2, 0.2);
    assert_true(asj_model_complete(m));
    if (kind == ASJ_GEOMETRY_ESSENTIAL)
        return;
    m->kind = kind;
    m->view.plane_count = 0;
    m->parameters = kind == ASJ_GEOMETRY_FUNDAMENTAL ? 7 : kind == TURN ? 3 : 8;
    if (kind == TURN)
        m->kind = ASJ_GEOMETRY_HOMOGRAPHY;
    if (kind == ASJ_GEOMETRY_HOMOGRAPHY)
        memcpy(m->view.matrix, m->view.planes[0], sizeof m->view.matrix);
    m->view.has_motion = 0;
    assert_true(asj_model_complete(m));
}

/* A candidate a few px away from what the part says. */
static asj_pair near_part(synth_random *random, const asj_model *m, int32_t part)
{
    const double *h = part > 0 ? m->view.planes[part - 1] : m->view.matrix;
    asj_pair c;
    memset(&c, 0, sizeof c);
    c.x1 = synth_random_between(random, 0, 640);
    c.y1 = synth_random_between(random, 0, 480);
    const double a = h[0] * c.x1 + h[1] * c.y1 + h[2], b = h[3] * c.x1 + h[4] * c.y1 + h[5], w = h[6] * c.x1 + h[7] * c.y1 + h[8];
    if (asj_part_is_planar(&m->view, part)) {
        c.x2 = a / w;
        c.y2 = b / w;
    } else { /* the point of the line nearest to the middle */
        const double off = (a * 320 + b * 240 + w) / (a * a + b * b);
        c.x2 = 320 - a * off;
        c.y2 = 240 - b * off;
    }
    c.x2 += synth_random_between(random, -4, 4);
    c.y2 += synth_random_between(random, -4, 4);
    for (int k = 0; k < 4; k++)
        c.affine[k] = (k % 3 == 0) + synth_random_between(random, -0.3, 0.3);
    return c;
}

static void check_slopes(const asj_pairs *set, const asj_model *m, int32_t part, const asj_pair *c, const asj_model_slopes *slopes,
                         int *used)
{
    double slope[ASJ_PART_PARAMETERS][6];
    asj_residuals at, ends[2];
    const int32_t rows = asj_residual_slopes(&m->view, part, set, c, slopes, &at, slope);
    for (int32_t i = 0; i < slopes->count[part] && rows > 0; i++) {
        for (int end = 0; end < 2; end++) {
            double delta[ASJ_MODEL_PARAMETERS] = {0}, dot = 0;
            asj_model moved;
            delta[slopes->parameter[part][i]] = end ? STEP : -STEP;
            assert_true(asj_model_move(m, delta, &moved));
            for (int k = 0; k < 9; k++)
                dot += moved.view.matrix[k] * m->view.matrix[k];
            for (int k = 0; k < 9 && dot < 0; k++)
                moved.view.matrix[k] = -moved.view.matrix[k];
            memcpy(moved.view.thickness, m->view.thickness, sizeof m->view.thickness); /* as if it stayed so */
            asj_part_residuals(&moved.view, part, set, c, &ends[end]);
        }
        if (!isfinite(ends[0].square) || !isfinite(ends[1].square))
            continue;
        for (int32_t r = 0; r < rows; r++) {
            const double difference = (ends[1].value[r] - ends[0].value[r]) / (2 * STEP);
            unit_near("slope", (int)part, (int)(10 * i + r), slope[i][r], difference, 1e-5 * (1 + fabs(difference)));
        }
        ++*used;
    }
}

static void slopes_are_those_of_differences(void **state)
{
    (void)state;
    asj_pairs set = {.location_sd = 1.5, .angle_sd = 0.157, .scale_sd = 0.22};
    synth_random random;
    synth_random_seed(&random, 3);
    for (int32_t kind = ASJ_GEOMETRY_ESSENTIAL; kind <= TURN; kind++) {
        int used = 0;
        for (int i = 0; i < 20; i++) {
            asj_model m;
            asj_model_slopes slopes;
            random_model(&random, kind, &m);
            assert_true(asj_model_slopes_of(&m, &slopes));
            for (int32_t part = 0; part <= m.view.plane_count; part++)
                for (int k = 0; k < 20; k++) {
                    const asj_pair c = near_part(&random, &m, part);
                    check_slopes(&set, &m, part, &c, &slopes, &used);
                }
        }
        assert_true(used > 500);
    }
}

/* Squared distance over that of the limit, as likelihood.c has it. */
static double squared_distance(const asj_model *m, const asj_pair *c)
{
    const double *f = m->view.matrix;
    const double n2x = f[0] * c->x1 + f[1] * c->y1 + f[2], n2y = f[3] * c->x1 + f[4] * c->y1 + f[5];
    const double w = f[6] * c->x1 + f[7] * c->y1 + f[8], dx = c->x2 - n2x / w, dy = c->y2 - n2y / w;
    const double n1x = f[0] * c->x2 + f[3] * c->y2 + f[6], n1y = f[1] * c->x2 + f[4] * c->y2 + f[7];
    const double e = c->x2 * n2x + c->y2 * n2y + w;
    return m->view.planar ? dx * dx + dy * dy : e * e / fmin(n1x * n1x + n1y * n1y, n2x * n2x + n2y * n2y);
}

static void a_first_look_leaves_out_what_is_far(void **state)
{
    (void)state;
    static asj_pair list[COUNT];
    static uint32_t near[COUNT + 1];
    unit_counter counter = {0, 0, 0, 0};
    asj_memory memory = unit_memory(&counter);
    synth_random random;
    synth_random_seed(&random, 4);
    for (int i = 0; i < 60; i++) {
        const double size = i % 3 == 2 ? 40000 : 640, limit = i % 2 ? 9 : 0.01;
        asj_pairs set = {.list = list, .count = COUNT, .middle = {{320, 240}, {320, 240}}};
        asj_model m;
        int32_t exact = 0, at = 0;
        random_model(&random, i % 4 == 0 ? ASJ_GEOMETRY_HOMOGRAPHY : ASJ_GEOMETRY_ESSENTIAL, &m);
        for (int k = 0; k < COUNT; k++) {
            list[k] = near_part(&random, &m, 0);
            if (k % 2)
                list[k].x2 = synth_random_between(&random, 0, size);
        }
        assert_true(asj_near_prepare(&memory, &asj_near_reference, &set));
        const int32_t found = asj_near(&set, COUNT, &m.view, limit, near);
        for (int32_t k = 0; k < COUNT; k++) {
            const int32_t listed = at < found && near[at] == (uint32_t)k;
            const int32_t is_near = squared_distance(&m, &list[k]) <= limit;
            at += listed;
            exact += is_near;
            assert_true(listed || !is_near);
        }
        assert_int_equal(at, found);
        if (size < 1000 && limit > 1) /* and little else */
            assert_true(found <= exact + exact / 20 + 2);
        asj_release(&memory, set.at);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slopes_are_those_of_differences),
        cmocka_unit_test(a_first_look_leaves_out_what_is_far),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
