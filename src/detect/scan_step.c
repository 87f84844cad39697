/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 4 over an image: which rays are followed, and what their ends say about the branches.
 *
 * The first scan may be rough (ray_walk.c): it says how long a line to fit, and where the next scan begins. Most of what a scan
 * takes it takes around ends.
 *
 * A branch is scanned when it has no length yet, and again when it has turned or moved away from the ray that gave it. Where a
 * length is known only the last SCANNED_AGAIN px are scanned again, since a better angle mostly changes the end; a branch that
 * ends before that part is scanned once more from its beginning. */
#include "steps.h"
#include "core/sort.h"

#include <math.h>

#define STRIP 64 /* px: see by_strip() */

/* px. Chosen: the diameter of the local junctions (15), of which those around an end decide where it is. Less has more branches end
 * before the part that is scanned again, which are then scanned from their beginning; more follows the same pixels again. */
#define SCANNED_AGAIN 16

/* px that a rough scan leaves out: half a stride, what the axis lives longer than what looks forward, and more: a line over a
 * longer part tells arcs (the discs of test_curvature.c have 6 junctions with 4, 3 or 4 with 5 to 8). */
#define LEFT_OUT 6

/* px: branches of votes (sizes.c) are followed no farther. With 25 2 % fewer junctions stay, with 60 as many. */
#define VOTE_LENGTH 40

#define SAME_RAY 1 /* px: a ray that is never farther from the branch than this visits the same pixels, or their neighbours */

/* Whether a branch has no length yet, or is somewhere along it more than SAME_RAY away from the ray that gave it. */
static int needs_scan(const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch)
{
    const asj_scanned_ray *ray = &branch->scanned;
    const double turned = asj_angle_distance(branch->angle, ray->angle) * branch->length;
    return branch->length <= 0 || turned + hypot(hypothesis->x - ray->x, hypothesis->y - ray->y) > SAME_RAY;
}

/* A rough length is scanned again wherever its branch is then. */
static void set_length(const asj_detection_run *run, const asj_scan *scan, const asj_ray *ray, asj_hypothesis_branch *branch)
{
    if (scan->rough) {
        branch->length = ray->forward > 0 ? ray->forward + LEFT_OUT : 0;
        branch->scanned = (asj_scanned_ray){HUGE_VAL, HUGE_VAL, 0};
        return;
    }
    branch->length = asj_ray_length(run->options, ray);
    branch->scanned = (asj_scanned_ray){ray->x, ray->y, ray->angle};
}

/* The first radius of the ray: the option's, the isotropic scale when it is 0, or the last part of a branch whose length is
 * known. */
static int32_t first_radius(const asj_detection_run *run, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch)
{
    const int32_t start = run->options->scan_start, again = (int32_t)branch->length - SCANNED_AGAIN;
    if (start <= 0)
        return (int32_t)hypothesis->radius;
    return again > start ? again : start;
}

/* One ray for each branch that needs it, of votes or of others. */
static size_t list_rays(const asj_detection_run *run, int32_t votes, asj_ray *rays, asj_hypothesis_branch **branches)
{
    size_t count = 0;
    for (size_t i = run->validated; i < run->hypothesis_count; i++) {
        asj_hypothesis *hypothesis = &run->hypotheses[i];
        for (int32_t b = 0; b < hypothesis->branch_count; b++) {
            asj_hypothesis_branch *branch = &hypothesis->branches[b];
            if (hypothesis->is_vote != votes || !needs_scan(hypothesis, branch))
                continue;
            branches[count] = branch;
            rays[count++] = (asj_ray){hypothesis->x, hypothesis->y, branch->angle, first_radius(run, hypothesis, branch), 0, 0};
        }
    }
    return count;
}

/* From top to bottom in strips, in a strip from left to right: rays that follow each other then need the same local junctions.
 * Those of one place, directions that a junction may have missed (complete_step.c), by their angle. */
static int by_strip(const void *a, const void *b)
{
    const asj_hypothesis *p = a, *q = b;
    const int32_t row = (int32_t)p->y / STRIP, other = (int32_t)q->y / STRIP;
    const double angle = p->branches[0].angle, other_angle = q->branches[0].angle;
    if (row != other)
        return row < other ? -1 : 1;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    return angle < other_angle ? -1 : angle > other_angle;
}

/* Whether a ray that started in the last part of a branch ended before it began. */
static int ends_before(const asj_detection_run *run, const asj_ray *ray)
{
    const asj_detect_options *options = run->options;
    return options->scan_start > 0 && ray->start != options->scan_start &&
           (ray->forward <= 0 || (options->scan_axial && ray->axial <= 0));
}

static asj_status follow(const asj_detection_run *run, const asj_scan *scan, asj_ray *rays, size_t count)
{
    return run->context->ops->scan->rays(run->context, scan, run->frame, &run->scratch, rays, count);
}

static asj_status scan_branches(asj_detection_run *run, const asj_scan *scan, int32_t votes, asj_ray *rays,
                                asj_hypothesis_branch **branches)
{
    const size_t count = list_rays(run, votes, rays, branches);
    size_t left = 0;
    asj_status status = follow(run, scan, rays, count);
    for (size_t i = 0; i < count && status == ASJ_OK; i++) {
        if (!ends_before(run, &rays[i])) {
            set_length(run, scan, &rays[i], branches[i]);
            continue;
        }
        branches[left] = branches[i];
        rays[left] = rays[i];
        rays[left++].start = run->options->scan_start;
    }
    if (left > 0 && status == ASJ_OK)
        status = follow(run, scan, rays, left);
    for (size_t i = 0; i < left && status == ASJ_OK; i++)
        set_length(run, scan, &rays[i], branches[i]);
    return status;
}

/* Of votes (sizes.c) nobody asks where their branches end. */
static asj_status scan_votes(asj_detection_run *run, const asj_scan *scan, asj_ray *rays, asj_hypothesis_branch **branches)
{
    asj_scan near = *scan;
    near.longest = VOTE_LENGTH + (int32_t)ceil(run->options->minimum_length / asj_octave_scale(run->octave));
    return run->size > 0 ? scan_branches(run, &near, 1, rays, branches) : ASJ_OK;
}

static asj_status scan_all(asj_detection_run *run, const asj_scan *scan)
{
    asj_memory *memory = &run->context->memory;
    size_t total = 0;
    for (size_t i = run->validated; i < run->hypothesis_count; i++)
        total += (size_t)run->hypotheses[i].branch_count;
    asj_ray *rays = asj_allocate_list(memory, asj_detection_run_room(total), sizeof *rays);
    asj_hypothesis_branch **branches = asj_allocate_list(memory, asj_detection_run_room(total), sizeof *branches);
    asj_status status = ASJ_OK;
    if (rays && branches) {
        if (run->hypothesis_count > run->validated)
            asj_sort(run->hypotheses + run->validated, run->hypothesis_count - run->validated, sizeof *run->hypotheses, by_strip);
        status = scan_branches(run, scan, 0, rays, branches);
        if (status == ASJ_OK)
            status = scan_votes(run, scan, rays, branches);
    } else
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu rays", total);
    asj_release(memory, branches);
    asj_release(memory, rays);
    return status;
}

asj_status asj_step_scan(asj_detection_run *run)
{
    return scan_all(run, run->scan);
}

/* Not in coarse octaves, where what fails by chance is a larger part of an edge, nor where the strip does not judge. */
asj_status asj_step_scan_roughly(asj_detection_run *run)
{
    asj_scan scan = *run->scan;
    if (!run->options->strip_test || run->frame->octave > 0)
        return asj_step_scan(run);
    scan.axial = 0;
    scan.rough = 1;
    return scan_all(run, &scan);
}
