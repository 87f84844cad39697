/* SPDX-License-Identifier: BSD-2-Clause */
/* A camera that only turns, or moves by less than can be seen: x2 ~ K2 R K1^-1 x1 (Hartley and Zisserman, 8.4.2). It is a
 * homography of three parameters, and what an essential matrix with any translation and planes that are far away explains as well.
 * Which of them it is, the evidence says (evidence.c): directions of a translation and planes that nothing needs cost their volume.
 * (Without it 5 of 100 rooms whose camera turns had a translation, one that suits the errors of locations.)
 *
 * Starts: the rotations of the best motions, and the rotations nearest to the best homographies: U V' of the singular value
 * decomposition of K2^-1 H K1. Each in two forms, for how exact locations are differs from pair to pair: as in planes without
 * parallax (model.c), or as in homographies. (With the first alone a homography has more evidence where locations are out by 1 px,
 * with the second alone where they are exact.) Planes of motions have the first form only: before both are compared, a motion is
 * given what it would gain in the second one. Motions themselves have no second form: points of any depth, known to 1 px, lie on
 * thick planes of some wrong motion (tests/accuracy/tried/geometry.md, "A camera that only turns"). */
#include "pure_rotation.h"
#include "core/threads.h"
#include "evidence.h"
#include "small_matrix.h"
#include "stop.h"

#include <math.h>
#include <string.h>

#define MOST_STARTS 8 /* of either kind */
#define FORMS 2
#define ROUNDS 6
#define LOST 6.0        /* of a motion's matches, which some wrong ones suit as well, a camera that only turns may lose so many, */
#define LOST_SHARE 0.15 /* or such a part */

typedef struct job {
    const asj_pairs *set;
    asj_adjust_scratch *scratch; /* for each thread */
    asj_model *starts;
} job;

/* Of an essential matrix or a homography; 0 when it has none. */
static int32_t rotation_near(const asj_model *model, const asj_camera cameras[2], double rotation[9])
{
    double n[9], u[9], s[3], v[9];
    if (model->kind == ASJ_GEOMETRY_ESSENTIAL) {
        memcpy(rotation, model->rotation, sizeof model->rotation);
        return 1;
    }
    asj_normal_homography(model->view.matrix, cameras, n);
    asj_svd3(n, u, s, v); /* u and v are rotations */
    asj_multiply3_transposed(u, v, rotation);
    return s[2] > 0 && isfinite(s[0]);
}

double asj_far_from_rotation(const asj_model *homography, const asj_camera cameras[2])
{
    double n[9], u[9], s[3], v[9];
    asj_normal_homography(homography->view.matrix, cameras, n);
    asj_svd3(n, u, s, v);
    return s[2] > 0 && isfinite(s[0]) ? log(s[0] / s[2]) : HUGE_VAL;
}

/* What a motion's evidence gains when its planes are as thick as errors of locations; 0 at least. */
static double gain_of_thick_planes(const asj_pairs *set, const asj_model *motion, asj_adjust_scratch *scratch)
{
    asj_model thick = *motion;
    thick.thick = 1;
    if (motion->view.plane_count == 0 || !asj_model_complete(&thick))
        return 0;
    asj_adjust_like(set, &thick, motion, ROUNDS, scratch);
    return fmax(0, asj_log_evidence(set, &thick, scratch) - asj_log_evidence(set, motion, scratch));
}

/* What says where a match is has more evidence for each than what says on which line, and may so outweigh a motion that explains
 * more of them. So it may lose few. (Of 100 rooms whose camera turns it loses 4.7 of 52 at most, of 15 up to 4.6, of a rendered
 * panorama 27 of 248; of 60 matches with a parallax of 25 px 12 to 16.) */
int32_t asj_rotation_outdoes(const asj_pairs *set, const asj_model *rotation, const asj_model *motion, asj_adjust_scratch *scratch)
{
    if (!(rotation->evidence > motion->evidence))
        return 0;
    const double has = asj_explained(set, motion, scratch), lost = has - asj_explained(set, rotation, scratch);
    return lost < fmax(LOST, LOST_SHARE * has) &&
           rotation->evidence > motion->evidence + gain_of_thick_planes(set, motion, scratch);
}

static int32_t collect(const asj_camera cameras[2], const asj_model *models, int32_t count, asj_model *starts)
{
    int32_t of_kind[2] = {0, 0}, found = 0;
    for (int32_t k = 0; k < count; k++) {
        int32_t *kind = &of_kind[models[k].kind == ASJ_GEOMETRY_HOMOGRAPHY];
        if (*kind == MOST_STARTS)
            continue;
        asj_model *m = &starts[found];
        memset(m, 0, sizeof *m);
        if (!rotation_near(&models[k], cameras, m->rotation))
            continue;
        m->kind = ASJ_GEOMETRY_HOMOGRAPHY;
        m->parameters = 3;
        memcpy(m->cameras, cameras, sizeof m->cameras);
        if (!asj_model_complete(m))
            continue;
        ++*kind;
        found++;
        starts[found] = *m;
        starts[found++].view.plane_count = 1;
    }
    return found;
}

static void adjust_some(const void *data, const asj_part *part)
{
    const job *j = data;
    asj_adjust_scratch *s = &j->scratch[part->thread];
    for (int64_t n = part->first; n < part->end; n++) {
        asj_model *m = &j->starts[n];
        m->evidence = -HUGE_VAL;
        if (asj_pairs_stop(j->set, part))
            continue;
        asj_adjust(j->set, m, ROUNDS, s);
        m->evidence = asj_log_evidence(j->set, m, s);
    }
}

asj_status asj_find_pure_rotation(asj_context *context, const asj_pairs *set, const asj_camera cameras[2], const asj_model *models,
                                  int32_t count, asj_model *rotation, int32_t *found)
{
    asj_memory *memory = &context->memory;
    asj_adjust_scratch *scratch = asj_adjust_scratches_create(memory, set, context->threads);
    asj_model *starts = asj_allocate(memory, (size_t)2 * MOST_STARTS * FORMS, sizeof *starts);
    const int32_t good = scratch && starts;
    *found = 0;
    if (good) {
        const job j = {set, scratch, starts};
        const int32_t some = collect(cameras, models, count, starts);
        double most = -HUGE_VAL;
        asj_parallel(context, context->threads, some, 1, adjust_some, &j);
        for (int32_t k = 0; k < some; k++)
            if (starts[k].evidence > most) {
                most = starts[k].evidence;
                *rotation = starts[k];
                *found = 1;
            }
    }
    asj_release(memory, starts);
    asj_adjust_scratches_free(memory, scratch, context->threads);
    return good ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for a camera that only turns");
}
