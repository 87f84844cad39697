/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, alignment: the affine map of a candidate pair, refined on the images.
 *
 * The map from branch ends is as wrong as the ends are: 5 % in a length, a degree in a direction. For a true pair a few
 * Gauss-Newton steps on a disc around the junction find the map under which both images agree; for a false one nothing is
 * found. Afterwards the correlation tells them apart far better than before, the map predicts where neighbours must be
 * (consensus.c), and the location in the other image is good to a fraction of a pixel.
 *
 * Inverse compositional form (Baker and Matthews 2004): derivatives belong to the template and are computed once for each
 * location (disc.c), and a step costs one sampling and eight products.
 *
 * Which image is the template: the one in which the corner is smaller (template_side()), so that the other is sampled down, never
 * up, and swapping the images changes nothing. */
#include "align.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

/* One step. */
#define CONVERGED 0.02        /* px at the centre, and px at the disc's border for the linear part: an order below what locations
                               * are good to */
#define MOST_STEPS 2.0        /* samples: the farthest that one step moves the centre; farther out the linearisation says nothing */
#define LEAST_INCREMENT 0.3   /* determinant of a step's linear part: a step that changes the area threefold is no small one */
#define MOST_INCREMENT 3.0

/* So many times the steps in upsampled images, where maps and places are off by twice as many px; not for the candidates of a
 * geometry, most of which are wrong, and of which one in a few is enough. Right matches of sixteen pairs 4766 of 4892 -> 4963
 * of 5064 in 1.04 of the time (tests/accuracy/tried/matching.md, "Images upsampled"). */
#define UPSAMPLED_STEPS 2

/* The result: both lengths of a frame wrong by 1.58 change the area by 2.5; ends are wrong by 5 %. */
#define LEAST_AREA_CHANGE 0.4 /* of the map's area, against the start */
#define MOST_AREA_CHANGE 2.5

/* Floors of 1 - similarity and of the squared canonical distance 2 (1 - similarity), so that one exact distance does not hide the
 * other one. */
#define LEAST_UNLIKENESS 1e-4f
#define LEAST_DISTANCE2 2e-4f

/* Pairs without a usable disc (similarity -1), or whose discs are each other's negatives, would only slow the consensus down. */
#define LEAST_SIMILARITY (-0.5f)

/* --- alignment -------------------------------------------------------------------------------------------------------------- */

/* A A' x = b with the factor A; x replaces b. */
static void solve(const double a[36], double b[6])
{
    for (int32_t i = 0; i < 6; i++) {
        for (int32_t k = 0; k < i; k++)
            b[i] -= a[6 * i + k] * b[k];
        b[i] /= a[6 * i + i];
    }
    for (int32_t i = 5; i >= 0; i--) {
        for (int32_t k = i + 1; k < 6; k++)
            b[i] -= a[6 * k + i] * b[k];
        b[i] /= a[6 * i + i];
    }
}

static double determinant(const double m[4])
{
    return m[0] * m[3] - m[1] * m[2];
}

static asj_disc_map map_of(const asj_disc *disc, const asj_pyramid *source, const asj_disc_pose *pose)
{
    const double *l = pose->linear, area = fabs(determinant(l));
    return (asj_disc_map){asj_pyramid_level(source, area * (double)disc->step * (double)disc->step), (float)pose->x,
                          (float)pose->y, {(float)l[0], (float)l[1], (float)l[2], (float)l[3]}};
}

/* One step: the map followed by the inverse of the increment. Returns 0 when nothing is left to gain or the increment is wild. */
static int32_t step(const asj_disc *disc, const asj_template *t, const float descent[6], asj_disc_pose *pose)
{
    double b[6];
    for (int32_t k = 0; k < 6; k++)
        b[k] = (double)descent[k];
    solve(t->factor, b);
    const double radius = (double)disc->radius, limit = MOST_STEPS * (double)disc->step;
    const double length = sqrt(b[0] * b[0] + b[1] * b[1]), change = fabs(b[2]) + fabs(b[3]) + fabs(b[4]) + fabs(b[5]);
    if (length < CONVERGED && change < CONVERGED)
        return 0;
    const double shorten = length > limit ? limit / length : 1;
    const double increment[4] = {1 + b[2] / radius, b[3] / radius, b[4] / radius, 1 + b[5] / radius};
    const double area = determinant(increment);
    double inverse[4];
    if (!(area > LEAST_INCREMENT && area < MOST_INCREMENT) || !asj_affine_invert(increment, inverse))
        return 0;
    const double tx = -(inverse[0] * b[0] + inverse[1] * b[1]) * shorten, ty = -(inverse[2] * b[0] + inverse[3] * b[1]) * shorten;
    double *l = pose->linear;
    pose->x += l[0] * tx + l[1] * ty;
    pose->y += l[2] * tx + l[3] * ty;
    const double next[4] = {l[0] * inverse[0] + l[1] * inverse[2], l[0] * inverse[1] + l[1] * inverse[3],
                            l[2] * inverse[0] + l[3] * inverse[2], l[2] * inverse[1] + l[3] * inverse[3]};
    memcpy(l, next, sizeof next);
    return 1;
}

/* Did the alignment stay where it may? */
static int32_t within_limits(const asj_disc_pose *start, const asj_disc_pose *end, double max_move)
{
    const double area = determinant(end->linear) / determinant(start->linear), dx = end->x - start->x, dy = end->y - start->y;
    return area >= LEAST_AREA_CHANGE && area <= MOST_AREA_CHANGE && dx * dx + dy * dy <= max_move * max_move;
}

asj_alignment asj_align(const asj_aligner *aligner, const asj_template *t, const asj_pyramid *source, const asj_disc_pose *start)
{
    const asj_disc *disc = aligner->disc;
    asj_disc_pose now = *start;
    asj_alignment best = {*start, 0, 0, 0};
    int32_t best_inside = 0;
    for (int32_t n = 0; n <= aligner->iterations; n++) {
        const asj_disc_map map = map_of(disc, source, &now);
        asj_disc_sums sums;
        source->ops->disc->compare(disc, t, source, &map, &sums);
        if (n == 0 || sums.similarity > best.similarity) {
            best = (asj_alignment){now, n == 0 ? sums.similarity : best.first, sums.similarity, n > 0};
            best_inside = sums.inside;
        }
        if (n == aligner->iterations || !t->solvable || !step(disc, t, sums.descent, &now))
            break;
    }
    if (!within_limits(start, &best.pose, aligner->max_move) || !asj_disc_inside(best_inside, disc->count))
        best = (asj_alignment){*start, best.first, best.first, 0};
    return best;
}

/* --- all candidates --------------------------------------------------------------------------------------------------------- */

/* The image whose corner is smaller: 0 or 1. */
static int32_t template_side(const asj_candidate *c)
{
    return determinant(c->map.to) >= determinant(c->map.from) ? 0 : 1;
}

/* sqrt(d_c d_r): the geometric mean of the canonical distance and of the aligned one, floored; squared. */
static float combine(float canonical2, float similarity)
{
    const float rest = 1 - similarity > LEAST_UNLIKENESS ? 1 - similarity : LEAST_UNLIKENESS;
    const float canonical = canonical2 > LEAST_DISTANCE2 ? canonical2 : LEAST_DISTANCE2;
    return sqrtf(canonical * 2 * rest);
}

/* All that decides what comes of it; `side` is the image of the template. */
static asj_alignment_key key_of(const asj_match_run *run, const asj_candidate *c, int32_t side, int32_t steps)
{
    const asj_l_junctions *in = &run->image[side]->l_junctions;
    const asj_l_junction *l = asj_match_run_l(run, c, 1 - side);
    const uint32_t location = in->location[asj_candidate_l(c, side)];
    const double *map = asj_candidate_map(c, side);
    return (asj_alignment_key){{map[0], map[1], map[2], map[3]}, in->location_x[location], in->location_y[location],
                               l->x, l->y, (uint16_t)side, (uint16_t)steps,
                               {run->image[0]->l_junctions.upsampled != 0, run->image[1]->l_junctions.upsampled != 0}};
}

/* Of a template that is usable or not. */
static void align_key(const asj_match_run *run, const asj_aligner *aligner, const asj_template *t, asj_known_alignment *known)
{
    const asj_alignment_key *key = &known->key;
    const asj_disc_pose start = {(double)key->to_x, (double)key->to_y,
                                 {key->linear[0], key->linear[1], key->linear[2], key->linear[3]}};
    const asj_alignment found = t->usable ? asj_align(aligner, t, &run->image[1 - key->side]->pyramid, &start)
                                          : (asj_alignment){start, -1, -1, 0};
    known->pose = found.pose;
    known->similarity = found.similarity;
    known->moved = found.moved;
}

static void tell(const asj_known_alignment *known, asj_candidate *c)
{
    const int32_t side = known->key.side;
    asj_linear forth;
    c->similarity = known->similarity;
    if (known->moved && asj_affine_invert(known->pose.linear, forth.from)) {
        double *move = side == 0 ? c->move2 : c->move1;
        memcpy(forth.to, known->pose.linear, sizeof forth.to);
        memcpy(c->map.to, side == 0 ? forth.to : forth.from, sizeof forth.to);
        memcpy(c->map.from, side == 0 ? forth.from : forth.to, sizeof forth.to);
        move[0] = known->pose.x - (double)known->key.to_x;
        move[1] = known->pose.y - (double)known->key.to_y;
    }
    c->distance2 = combine(c->distance2, c->similarity);
}

static void drop_unlike(asj_candidates *candidates)
{
    size_t kept = 0;
    for (size_t k = 0; k < candidates->count; k++)
        if (candidates->list[k].similarity >= LEAST_SIMILARITY)
            candidates->list[kept++] = candidates->list[k];
    candidates->count = kept;
}

/* Candidates by the location of their template, those of image 1 before those of image 2: order[start[p]] .. are those of
 * location p. They are worked on together, so that each template is made once. */
typedef struct grouping {
    uint32_t *start, *order, *group;
    asj_alignments *known;
    uint32_t *number; /* of each in these, */
    size_t before;    /* of which so many were known before */
} grouping;

static void group_by_template(const asj_match_run *run, const asj_candidates *candidates, const grouping *g)
{
    const size_t count = candidates->count;
    const uint32_t count1 = run->image[0]->l_junctions.location_count;
    const uint32_t locations = count1 + run->image[1]->l_junctions.location_count;
    for (size_t k = 0; k < count; k++) {
        const asj_candidate *c = &candidates->list[k];
        const int32_t side = template_side(c);
        g->group[k] = (side ? count1 : 0) + run->image[side]->l_junctions.location[asj_candidate_l(c, side)];
        g->start[g->group[k] + 2]++;
    }
    for (uint32_t p = 2; p < locations + 2; p++)
        g->start[p] += g->start[p - 1];
    for (size_t k = 0; k < count; k++)
        g->order[g->start[g->group[k] + 1]++] = (uint32_t)k;
}

/* Those that are not known yet are added, to be filled in. */
static asj_status find_known(const asj_match_run *run, const asj_candidates *candidates, int32_t steps, grouping *g)
{
    const asj_status status = asj_alignments_reserve(run->context, g->known, candidates->count);
    g->before = g->known->count;
    for (size_t k = 0; k < candidates->count && status == ASJ_OK; k++) {
        const asj_candidate *c = &candidates->list[k];
        const asj_alignment_key key = key_of(run, c, template_side(c), steps);
        g->number[k] = asj_alignments_number(g->known, &key, (uint32_t)k);
    }
    return status;
}

/* Is candidate k the one to fill in its alignment? */
static int is_first(const grouping *g, uint32_t k)
{
    return g->number[k] >= g->before && g->known->list[g->number[k]].first == k;
}

typedef struct job {
    const asj_match_run *run;
    const grouping *g;
    const asj_aligner *aligner;
    asj_watch *watch;
} job;

/* The candidates of location p. */
static void align_group(const job *j, const asj_part *part, int64_t p)
{
    const grouping *g = j->g;
    const int64_t count1 = j->run->image[0]->l_junctions.location_count, at = p >= count1 ? p - count1 : p;
    const asj_image_features *features = j->run->image[p >= count1];
    int32_t has_template = 0;
    asj_template t;
    for (uint32_t n = g->start[p]; n < g->start[p + 1] && !asj_watch_stops(j->watch, part); n++) {
        if (!is_first(g, g->order[n]))
            continue;
        if (!has_template)
            asj_template_create(j->aligner->disc, &features->pyramid, features->l_junctions.location_x[at],
                                features->l_junctions.location_y[at], &t);
        has_template = 1;
        align_key(j->run, j->aligner, &t, &g->known->list[g->number[g->order[n]]]);
    }
}

static void align_some(const void *data, const asj_part *part)
{
    for (int64_t p = part->first; p < part->end; p++)
        align_group(data, part, p);
}

static asj_status align_groups(const asj_match_run *run, const grouping *g, const asj_aligner *aligner)
{
    asj_watch watch;
    const int64_t locations = (int64_t)run->image[0]->l_junctions.location_count + run->image[1]->l_junctions.location_count;
    const job j = {run, g, aligner, &watch};
    asj_watch_start(&watch, run->context, ASJ_STAGE_ALIGN);
    asj_parallel(run->context, run->context->threads, locations, 4, align_some, &j);
    return asj_watch_end(&watch);
}

int32_t asj_align_steps(const asj_match_run *run)
{
    const int32_t upsampled = run->image[0]->l_junctions.upsampled || run->image[1]->l_junctions.upsampled;
    return run->options->align_iterations * (upsampled && !run->for_geometry ? UPSAMPLED_STEPS : 1);
}

asj_status asj_align_candidates(const asj_match_run *run, asj_candidates *candidates)
{
    asj_memory *memory = &run->context->memory;
    const size_t count = candidates->count;
    const size_t locations = (size_t)run->image[0]->l_junctions.location_count + run->image[1]->l_junctions.location_count;
    asj_alignments own = {NULL, NULL, 0, 0, 0};
    grouping g = {asj_allocate_zero(memory, locations + 2, sizeof *g.start), asj_allocate(memory, count, sizeof *g.order),
                  asj_allocate(memory, count, sizeof *g.group), run->alignments ? run->alignments : &own,
                  asj_allocate(memory, count, sizeof *g.number), 0};
    asj_disc *disc = asj_allocate(memory, 1, sizeof *disc);
    asj_status status = ASJ_OK;
    if (!g.start || !g.order || !g.group || !g.number || !disc) {
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to align %zu candidates", count);
    } else {
        const asj_aligner aligner = {disc, asj_align_steps(run), run->options->max_move};
        asj_disc_create(run->options->align_radius, disc);
        group_by_template(run, candidates, &g);
        status = find_known(run, candidates, aligner.iterations, &g);
        if (status == ASJ_OK)
            status = align_groups(run, &g, &aligner);
        for (size_t k = 0; k < count && status == ASJ_OK; k++)
            tell(&g.known->list[g.number[k]], &candidates->list[k]);
        if (status == ASJ_OK)
            drop_unlike(candidates);
        else
            asj_alignments_free(memory, g.known); /* which are not all filled in */
    }
    asj_release(memory, g.start);
    asj_release(memory, g.order);
    asj_release(memory, g.group);
    asj_release(memory, g.number);
    asj_alignments_free(memory, &own);
    asj_release(memory, disc);
    return status;
}
