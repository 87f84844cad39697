/* SPDX-License-Identifier: BSD-2-Clause */
/* How far each stage is from what the machine can do.
 *
 * What a stage works on is counted while it runs, by wrappers around the operations of src/core/ops.h: pixels of tiles, candidates,
 * pixels that rays visit. Bytes and operations follow from that and from the tables of the sectors; each is stated beside its line
 * below.
 *
 * bytes       what must come from and go to memory if caches were perfect: every sample of a plane that the stage looks at, once
 * operations  of the formulas as src/ evaluates them: additions, multiplications, comparisons, absolute values, one for each
 *             number, not for each vector; 16-bit whole numbers in the first stages, in locate and refine compared with
 *             the peak of double precision, though their sums over pixels are in single precision.
 *             Addresses, loops, tests and divisions are not counted, nor is what depends on the data in locate and refine (narrower
 *             fits, sorting): there it is the least that the stage does. */
#include "profile.h"
#include "machine.h"
#include "measure.h"

#include "core/threads.h"
#include "detect/isotropic.h"
#include "detect/detection_run.h"

#include <stdio.h>
#include <string.h>

#define MAX_RUNS 99
#define STAGES (ASJ_STAGE_REFINE + 1)

typedef struct work {
    double tile_pixels;  /* whose field is evaluated for candidates */
    double plane_pixels; /* with the rows and columns around the tiles */
    double candidates, candidate_runs, candidate_branches;
    double visited;      /* pixels whose branches are wanted by rays */
    double located;      /* junctions that go on to the scan */
} work;

typedef struct cost {
    double bytes, operations;
    int floating;
} cost;

/* The wrappers have no other place to count. */
static work counted;
static struct {
    asj_field_ops field;
    asj_isotropic_ops isotropic;
} wrapped;

static void add(double *sum, double more)
{
    double before, after;
    __atomic_load(sum, &before, __ATOMIC_RELAXED);
    do
        after = before + more;
    while (!__atomic_compare_exchange(sum, &before, &after, 0, __ATOMIC_RELAXED, __ATOMIC_RELAXED));
}

static void count_tile(const asj_field *field, const asj_frame *frame, const asj_tile *tile, uint16_t *scratch, uint16_t *masks)
{
    const int32_t around = 2 * field->sectors.radius, width = tile->runs * ASJ_LANES, height = tile->bottom - tile->top;
    add(&counted.tile_pixels, (double)width * height / (field->step * field->step));
    add(&counted.plane_pixels, (double)(width + around) * (height + around));
    wrapped.field.tile(field, frame, tile, scratch, masks);
}

static void count_pixels(const asj_field *field, const asj_frame *frame, const asj_pixel *pixels, int32_t count, uint16_t *scratch,
                         asj_field_branch (*branches)[ASJ_FIELD_BRANCHES])
{
    add(&counted.visited, count);
    wrapped.field.pixels(field, frame, pixels, count, scratch, branches);
}

static void count_band(const asj_isotropic *test, const asj_frame *frame, int32_t top, int32_t bottom, const uint16_t *masks,
                       uint16_t *scratch, asj_isotropic_junction *junctions)
{
    int32_t candidates = 0, runs = 0, branches = 0;
    for (ptrdiff_t b = (ptrdiff_t)top * frame->blocks; b < (ptrdiff_t)bottom * frame->blocks; b++) {
        runs += masks[b] != 0;
        for (uint32_t mask = masks[b]; mask; mask &= mask - 1)
            candidates++;
    }
    wrapped.isotropic.band(test, frame, top, bottom, masks, scratch, junctions);
    for (int32_t i = 0; i < candidates; i++)
        branches += junctions[i].branch_count;
    add(&counted.candidates, candidates);
    add(&counted.candidate_runs, runs);
    add(&counted.candidate_branches, branches);
}

static void count_points(void *user, const asj_dump *dump)
{
    (void)user;
    if (dump->stage == ASJ_STAGE_LOCATE && dump->kind == ASJ_DUMP_POINTS)
        counted.located = (double)dump->count;
}

/* --- what the stages must do ------------------------------------------------------------------------------------------------ */

static double least(double a, double b)
{
    return a < b ? a : b;
}

/* Strengths and peaks of one pixel: a difference of two running sums, minus the mean, times the scale; then each sector against
 * `suppress` others on either side and the threshold. */
static double sector_operations(const asj_sectors *s, int32_t suppress)
{
    return s->count * (3 + 2.0 * suppress + 1);
}

/* Junction-ness of an offset and its sum: 4 products, 3 differences, 2 absolute values, 1 addition. */
#define OFFSET_OPERATIONS 10

static cost gradient_cost(double pixels)
{
    /* image in (1) and grey out (2); grey in (2), both gradients out (4). Differences 2, norm 4, window 6, its share 4, both
     * components 6. */
    return (cost){9 * pixels, 22 * pixels, 0};
}

/* Of the planes for each pixel: a family of four takes 6 products, 4 differences, 4 absolute values, and a saturated difference for
 * each of its planes; where candidates are two apart, that depends on row and column being even or odd. */
static double plane_operations(const asj_field *field)
{
    double operations = 0;
    for (int32_t f = 0; f < field->plan.family_count; f++)
        for (int32_t part = 0; part < 4; part++) {
            int used = field->step > 1 ? field->plan.used[part / 2][f] >> 4 * (part % 2) & 15 : 15;
            operations += used ? 14 : 0;
            for (; used; used &= used - 1)
                operations++;
        }
    return operations / 4;
}

static cost candidates_cost(const asj_field *field, const work *w, double pixels)
{
    /* both gradients in (4), masks out (1/8) */
    const double planes = plane_operations(field) * w->plane_pixels;
    const double sums = (field->sectors.offset_count + sector_operations(&field->sectors, field->suppress)) * w->tile_pixels;
    return (cost){4.125 * pixels, planes + sums, 0};
}

static cost isotropic_cost(const asj_isotropic *test, const work *w, double pixels)
{
    double operations = 0;
    int32_t radius = 0;
    for (int32_t i = 0; i < test->radius_count; i++) {
        const asj_isotropic_radius *r = &test->radii[i];
        operations += r->source == i ? OFFSET_OPERATIONS * r->sectors.offset_count : r->sectors.offset_count;
        operations += sector_operations(&r->sectors, r->suppress);
        radius = r->sectors.radius > radius ? r->sectors.radius : radius;
    }
    /* both gradients around the runs that hold candidates, records out */
    const double around = (ASJ_LANES + 2.0 * radius) * (2.0 * radius + 1);
    const double bytes = 4 * least(pixels, w->candidate_runs * around) + w->candidates * sizeof(asj_isotropic_junction);
    return (cost){bytes, operations * w->candidates, 0};
}

/* A sample of a line fit: its place 4, bilinear differences 22, across and along 6, weight and sums 6. */
#define SAMPLE_OPERATIONS 38

static cost locate_cost(const asj_detection *found, const work *w, double pixels)
{
    /* the first fit of each branch: t = 2 .. 10, nine samples across; grey in a disc of 14 px */
    const double per_junction = w->candidate_branches / (w->candidates > 0 ? w->candidates : 1);
    const double branches = (double)found->isotropic * (per_junction > 2 ? per_junction : 2);
    return (cost){2 * least(pixels, (double)found->isotropic * 29 * 29), branches * 9 * 9 * SAMPLE_OPERATIONS, 1};
}

static cost scan_cost(const asj_field *field, const work *w, double pixels)
{
    /* the field of the pixels that rays visit: gradients around them in, four branches for each pixel out */
    const asj_sectors *s = &field->sectors;
    const double around = (2.0 * s->radius + 1) * (2.0 * s->radius + 1);
    const double bytes = 4 * least(pixels, w->visited * around) + w->visited * ASJ_FIELD_BRANCHES * sizeof(asj_field_branch);
    const double operations = OFFSET_OPERATIONS * s->offset_count + sector_operations(s, field->suppress);
    return (cost){bytes, operations * w->visited, 0};
}

static cost refine_cost(const asj_detection *found, const work *w, double pixels)
{
    /* twice two fits along every branch, five samples across; branches of located junctions are taken to be as many and as long as
     * those of the reported ones. Grey in a band of eight pixels. */
    double length = 0, samples = 0;
    for (uint32_t i = 0; i < found->junction_count; i++)
        for (int32_t b = 0; b < found->junctions[i].branch_count; b++) {
            length += found->junctions[i].branches[b].length;
            samples += 4 * 5 * least(96, found->junctions[i].branches[b].length);
        }
    const double share = w->located / (found->junction_count ? found->junction_count : 1);
    return (cost){2 * least(pixels, 8 * length * share), samples * share * SAMPLE_OPERATIONS, 1};
}

static void all_costs(const asj_context *context, const asj_detection *found, const work *w, cost costs[STAGES])
{
    const asj_detector *detector = context->detector.state;
    const double pixels = (double)found->width * found->height;
    costs[ASJ_STAGE_GRADIENT] = gradient_cost(pixels);
    costs[ASJ_STAGE_CANDIDATES] = candidates_cost(&detector->field, w, pixels);
    costs[ASJ_STAGE_ISOTROPIC] = isotropic_cost(&detector->isotropic, w, pixels);
    costs[ASJ_STAGE_LOCATE] = locate_cost(found, w, pixels);
    costs[ASJ_STAGE_SCAN] = scan_cost(&detector->field, w, pixels);
    costs[ASJ_STAGE_REFINE] = refine_cost(found, w, pixels);
}

/* --- measuring -------------------------------------------------------------------------------------------------------------- */

/* One call with the wrappers in place. */
static int count_work(asj_context *context, const asj_image *image, const asj_detect_options *options, cost costs[STAGES])
{
    asj_detection *found = NULL;
    memset(&counted, 0, sizeof counted);
    wrapped.field = *context->ops->field;
    wrapped.isotropic = *context->ops->isotropic;
    context->ops->field->tile = count_tile;
    context->ops->field->pixels = count_pixels;
    context->ops->isotropic->band = count_band;
    context->options.dump = count_points;
    const asj_status status = asj_detect(context, image, options, &found);
    context->options.dump = NULL;
    *context->ops->field = wrapped.field;
    *context->ops->isotropic = wrapped.isotropic;
    if (status != ASJ_OK)
        return -1;
    all_costs(context, found, &counted, costs);
    printf("%.0f candidates, %.0f isotropic junctions, %.0f located, %u junctions; %.2f %% of the pixels visited by rays\n\n",
           counted.candidates, (double)found->isotropic, counted.located, (unsigned)found->junction_count,
           counted.visited / ((double)image->width * image->height) * 100);
    asj_detection_free(&found);
    return 0;
}

static int time_stages(asj_context *context, const asj_image *image, const asj_detect_options *options, int32_t runs,
                       double ms[STAGES + 1])
{
    double times[STAGES + 1][MAX_RUNS];
    for (int32_t run = 0; run < runs; run++) {
        asj_detection *found = NULL;
        if (asj_detect(context, image, options, &found) != ASJ_OK)
            return -1;
        for (int s = 0; s < STAGES; s++)
            times[s][run] = found->stage_ms[s];
        times[STAGES][run] = found->total_ms;
        asj_detection_free(&found);
    }
    for (int s = 0; s <= STAGES; s++)
        ms[s] = measure_median(times[s], runs);
    return 0;
}

static void print_row(const char *name, double ms, double total, const cost *c, const machine_limits *limits)
{
    const double seconds = ms * 1e-3, peak = c->floating ? limits->floating : limits->whole;
    printf("%-12s %9.3f %6.1f %% %9.2f %8.2f %7.1f %% %10.1f %9.2f %7.1f %%  %s\n", name, ms, 100 * ms / total, c->bytes * 1e-6,
           c->bytes / seconds * 1e-9, 100 * c->bytes / seconds / limits->bytes, c->operations * 1e-6,
           c->operations / seconds * 1e-9, 100 * c->operations / seconds / peak, c->floating ? "double" : "16 bit");
}

static int profile(asj_context *context, const asj_image *image, const asj_detect_options *options, int32_t runs,
                   const machine_limits *limits)
{
    cost costs[STAGES];
    double ms[STAGES + 1];
    if (count_work(context, image, options, costs) != 0 || time_stages(context, image, options, runs, ms) != 0)
        return -1;
    printf("%-12s %9s %8s %9s %8s %9s %10s %9s %9s\n", "stage", "ms", "share", "MB", "GB/s", "of limit", "M op", "G op/s",
           "of peak");
    for (int s = 0; s < STAGES; s++)
        print_row(asj_stage_name(s), ms[s], ms[STAGES], &costs[s], limits);
    printf("%-12s %9.3f\n", "total", ms[STAGES]);
    return 0;
}

int profile_print(const asj_image *image, const asj_detect_options *options, int32_t threads, int32_t runs)
{
    machine_limits limits;
    asj_detect_options one = *options; /* octave: what is counted is that of an image of one size */
    one.octaves = 1;
    asj_context *context = measure_context(threads);
    int result = -1;
    if (context && machine_measure(context, &limits) == 0) {
        printf("libasj %s, sample room %d x %d, one octave, %d thread%s, operations: %s\n", asj_version_string(), (int)image->width,
               (int)image->height, (int)asj_context_threads(context), asj_context_threads(context) == 1 ? "" : "s",
               context->ops->name);
        printf("limits: %.1f GB/s copied (read and written), %.0f G op/s on 16-bit numbers, %.0f G op/s in double precision"
               " (vectors of %d bytes)\n", limits.bytes * 1e-9, limits.whole * 1e-9, limits.floating * 1e-9, (int)limits.width);
        result = profile(context, image, &one, runs, &limits);
    }
    if (result != 0)
        fprintf(stderr, "detection: %s\n", context ? asj_context_message(context) : "no memory");
    asj_context_free(&context);
    return result;
}
