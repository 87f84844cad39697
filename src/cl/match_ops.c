/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7 on the device: canonical patches (kernels/patch.cl), products of all pairs and best partners (kernels/distance.cl). The
 * planes of the pyramid come from the host, which needs them as well; patches stay on the device between the two steps. SIFT
 * descriptors, patches that keep their mean when they are compared, and the paper's induced patches are left to the CPU. */
#include "kernels/contract.h"
#include "detect.h"
#include "match/describe.h"
#include "match/expected.h"
#include "overrides.h"
#include "state.h"

#include <asj/device.h>

#include <string.h>

/* Sizes of work-groups are fixed, as some drivers compile a kernel anew for each, and at most 64: every device has those. */

#define IMAGES 2
#define MOST_FRAMES (ASJ_MAX_HYPOTHESES * ASJ_MAX_HYPOTHESES) /* of an L-junction */

/* An image's patches as the device has them. */
typedef struct device_features {
    uint64_t number; /* asj_image_features.device_copy; 0 = empty */
    asj_cl_buffer patches, usable, frames;
} device_features;

struct asj_cl_match {
    uint64_t last_number;
    device_features images[IMAGES];
    asj_cl_buffer planes, grids, inside;
    asj_cl_buffer points[IMAGES], boxes[IMAGES]; /* asj_expected */
    asj_cl_buffer products, scores, lists, rows, columns;
    asj_cl_host_buffer host_grids;
};

static asj_status get(asj_context *context, struct asj_cl_match **match)
{
    if (!context->cl->match)
        context->cl->match = asj_allocate_zero(&context->memory, 1, sizeof *context->cl->match);
    *match = context->cl->match;
    return *match ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the matcher's state on the device");
}

void asj_cl_free_match(asj_context *context)
{
    struct asj_cl_match *match = context->cl->match;
    if (!match)
        return;
    asj_cl_buffer *const buffers[] = {&match->planes, &match->grids, &match->inside, &match->products,
                                      &match->scores, &match->lists, &match->rows,   &match->columns};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        asj_cl_release(context, buffers[i]);
    for (int v = 0; v < IMAGES; v++) {
        asj_cl_release(context, &match->points[v]);
        asj_cl_release(context, &match->boxes[v]);
        asj_cl_release(context, &match->images[v].patches);
        asj_cl_release(context, &match->images[v].usable);
        asj_cl_release(context, &match->images[v].frames);
    }
    asj_release(&context->memory, match->host_grids.memory);
    asj_release(&context->memory, match);
    context->cl->match = NULL;
}

static int processor(const asj_context *context)
{
    return asj_cl_get_limits(context)->type == ASJ_DEVICE_CPU;
}

static size_t round_up(size_t count, size_t multiple)
{
    return (count + multiple - 1) / multiple * multiple;
}

/* Whether a buffer of this size is a modest part of the device's memory. */
static int fits(const asj_context *context, uint64_t bytes)
{
    const asj_cl_limits *limits = asj_cl_get_limits(context);
    return bytes <= limits->largest_buffer && bytes <= limits->global_memory / 4;
}

static int patches_fit(const asj_context *context, const asj_match_options *options, const asj_image_features *features)
{
    return fits(context, (uint64_t)features->l_junctions.frame_count * (uint64_t)asj_patch_length(options) * sizeof(int16_t));
}

/* ---- patches ---- */

static asj_status send_planes(asj_context *context, struct asj_cl_match *match, const asj_pyramid *pyramid, patch_pyramid *sizes)
{
    size_t elements[ASJ_PYRAMID_LEVELS], total = 0;
    memset(sizes, 0, sizeof *sizes);
    for (int32_t l = 0; l < pyramid->levels; l++) {
        elements[l] = ((size_t)pyramid->width[l] + 1) * ((size_t)pyramid->height[l] + 1);
        sizes->width[l] = pyramid->width[l];
        sizes->height[l] = pyramid->height[l];
        sizes->offset[l] = (int32_t)total;
        total += elements[l];
    }
    asj_status status = asj_cl_reserve(context, &match->planes, total * sizeof(uint16_t));
    for (int32_t l = 0; l < pyramid->levels && status == ASJ_OK; l++)
        status = asj_cl_write(context, &match->planes, (size_t)sizes->offset[l] * sizeof(uint16_t), pyramid->plane[l],
                              elements[l] * sizeof(uint16_t));
    return status;
}

typedef struct grid_job {
    const asj_match_options *options;
    const asj_image_features *features;
    asj_patch_grid *grids;
} grid_job;

static void set_grids(const void *data, const asj_part *part)
{
    const grid_job *j = data;
    for (int64_t f = part->first; f < part->end; f++)
        asj_patch_grid_set(&j->features->pyramid, &j->features->l_junctions.frames[f], j->options->patch_size,
                           j->options->window_start, j->options->window_end, &j->grids[f]);
}

static asj_status send_grids(asj_context *context, struct asj_cl_match *match, const asj_match_options *options,
                             const asj_image_features *features)
{
    const int64_t count = features->l_junctions.frame_count;
    const size_t bytes = (size_t)count * sizeof(asj_patch_grid);
    asj_status status = asj_cl_host_reserve(context, &match->host_grids, bytes);
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &match->grids, bytes);
    if (status != ASJ_OK)
        return status;
    asj_patch_grid *grids = match->host_grids.memory;
    const grid_job j = {options, features, grids};
    asj_parallel(context, context->threads, count, 0, set_grids, &j);
    return asj_cl_write(context, &match->grids, 0, grids, bytes);
}

static asj_status run_describe(asj_context *context, struct asj_cl_match *match, const asj_match_options *options,
                               const patch_pyramid *sizes, device_features *to, size_t count)
{
    const size_t samples = (size_t)(options->patch_size * options->patch_size);
    const size_t local[2] = {processor(context) ? 1 : 16, processor(context) ? 1 : 4}, global[2] = {count * local[0], local[1]};
    const asj_cl_argument arguments[] = {
        ASJ_CL_BUFFER(&match->planes), ASJ_CL_STRUCT(sizes, sizeof *sizes), ASJ_CL_BUFFER(&match->grids),
        ASJ_CL_INT(options->patch_size), ASJ_CL_INT(options->normalise ? 0 : asj_patch_plain_scale(options->patch_size)),
        ASJ_CL_BUFFER(&to->patches), ASJ_CL_BUFFER(&match->inside), ASJ_CL_LOCAL(samples * sizeof(uint16_t)),
        ASJ_CL_LOCAL((local[0] * local[1] + 1) * sizeof(patch_sums))};
    asj_status status = asj_cl_reserve(context, &to->patches, count * samples * sizeof(int16_t));
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &match->inside, count * sizeof(int32_t));
    return status == ASJ_OK ? asj_cl_run(context, "patch_describe", 2, global, local, ASJ_CL_ARGUMENTS(arguments)) : status;
}

/* What is written where an L-junction's frames begin, and which frames can be used. */
static asj_status send_frames(asj_context *context, device_features *to, const asj_image_features *features)
{
    const size_t starts = ((size_t)features->l_junctions.count + 1) * sizeof(uint32_t), count = features->l_junctions.frame_count;
    asj_status status = asj_cl_reserve(context, &to->usable, count);
    if (status == ASJ_OK)
        status = asj_cl_write(context, &to->usable, 0, features->usable, count);
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &to->frames, starts);
    return status == ASJ_OK ? asj_cl_write(context, &to->frames, 0, features->l_junctions.first_frame, starts) : status;
}

static asj_status fetch_patches(asj_context *context, struct asj_cl_match *match, const asj_match_options *options,
                                const device_features *from, asj_image_features *features)
{
    const size_t samples = (size_t)(options->patch_size * options->patch_size), count = features->l_junctions.frame_count;
    asj_status status = asj_cl_read(context, &from->patches, 0, features->patches, count * samples * sizeof(int16_t));
    int32_t *inside = match->host_grids.memory; /* the grids are there by now; a grid is larger than a number */
    if (status == ASJ_OK)
        status = asj_cl_read(context, &match->inside, 0, inside, count * sizeof *inside);
    for (size_t f = 0; f < count && status == ASJ_OK; f++)
        features->usable[f] = (size_t)inside[f] * 4 >= 3 * samples;
    return status;
}

/* The older of the two; its contents are lost. */
static device_features *free_features(struct asj_cl_match *match)
{
    device_features *features = &match->images[match->images[0].number > match->images[1].number];
    features->number = 0;
    return features;
}

asj_status asj_cl_describe_frames(asj_context *context, const asj_match_options *options, asj_image_features *features)
{
    const uint64_t count = features->l_junctions.frame_count;
    const uint64_t pixels = ((uint64_t)features->pyramid.width[0] + 1) * ((uint64_t)features->pyramid.height[0] + 1);
    patch_pyramid sizes;
    struct asj_cl_match *match;
    if (options->descriptor == ASJ_DESCRIPTOR_SIFT || count == 0 || count > INT32_MAX / 64 ||
        !fits(context, 2 * pixels * sizeof(uint16_t)) || !patches_fit(context, options, features))
        return asj_describe_frames(context, options, features);
    asj_status status = get(context, &match);
    if (status != ASJ_OK)
        return status;
    device_features *to = free_features(match);
    status = send_planes(context, match, &features->pyramid, &sizes);
    if (status == ASJ_OK)
        status = send_grids(context, match, options, features);
    if (status == ASJ_OK)
        status = run_describe(context, match, options, &sizes, to, (size_t)count);
    if (status == ASJ_OK)
        status = fetch_patches(context, match, options, to, features);
    if (status == ASJ_OK)
        status = send_frames(context, to, features);
    if (status == ASJ_OK)
        features->device_copy = to->number = ++match->last_number;
    return status;
}

/* ---- partners ---- */

/* The patches of all frames, those that follow each other at once. */
static asj_status send_patches(asj_context *context, device_features *to, const asj_image_features *features, int32_t length)
{
    const uint32_t count = features->l_junctions.frame_count;
    const size_t bytes = (size_t)length * sizeof(int16_t);
    asj_status status = asj_cl_reserve(context, &to->patches, count * bytes);
    for (uint32_t first = 0, end; first < count && status == ASJ_OK; first = end) {
        const uint32_t start = asj_patch_number(features, first);
        for (end = first + 1; end < count && asj_patch_number(features, end) == start + (end - first); end++)
            ;
        status = asj_cl_write(context, &to->patches, first * bytes, features->patches + start * (size_t)length,
                              (end - first) * bytes);
    }
    return status;
}

/* The device's copy of an image's features; those that were described elsewhere are brought there. `other` stays. */
static asj_status find_features(asj_context *context, struct asj_cl_match *match, const asj_match_options *options,
                                const asj_image_features *features, const device_features *other, device_features **found)
{
    for (int v = 0; v < IMAGES; v++)
        if (features->device_copy > 0 && match->images[v].number == features->device_copy) {
            *found = &match->images[v];
            return ASJ_OK;
        }
    device_features *to = other ? &match->images[other == &match->images[0]] : free_features(match);
    to->number = 0;
    const asj_status status = send_patches(context, to, features, asj_patch_length(options));
    *found = to;
    return status == ASJ_OK ? send_frames(context, to, features) : status;
}

/* Where partners are expected, if that is known. */
static asj_status send_expected(const asj_match_run *run, struct asj_cl_match *match)
{
    const asj_expected *e = run->expected;
    asj_context *context = run->context;
    asj_status status = ASJ_OK;
    for (int v = 0; e && v < IMAGES && status == ASJ_OK; v++) {
        const size_t count = run->image[v]->l_junctions.count;
        status = asj_cl_reserve(context, &match->points[v], count * sizeof **e->points);
        if (status == ASJ_OK)
            status = asj_cl_write(context, &match->points[v], 0, e->points[v], count * sizeof **e->points);
        if (status == ASJ_OK)
            status = asj_cl_reserve(context, &match->boxes[v], count * sizeof **e->boxes);
        if (status == ASJ_OK)
            status = asj_cl_write(context, &match->boxes[v], 0, e->boxes[v], count * sizeof **e->boxes);
    }
    return status;
}

/* A block of L-junctions of image 1, and how the work is divided. */
typedef struct block {
    const device_features *images[2];
    uint32_t count2, frames2; /* L-junctions and frames of image 2 */
    int32_t length, limit, parts;
    uint32_t first, count;    /* L-junctions of the block */
    uint32_t frame, frames;   /* its frames */
    int32_t expected;         /* do partners lie where they are expected? */
} block;

#define PRODUCT_ARGUMENTS                                                                                                     \
    ASJ_CL_BUFFER(&b->images[0]->patches), ASJ_CL_BUFFER(&b->images[1]->patches), ASJ_CL_INT(b->length),                      \
        ASJ_CL_INT(b->frame), ASJ_CL_INT(b->frames), ASJ_CL_INT(b->frames2), ASJ_CL_INT(b->frames2),                          \
        ASJ_CL_BUFFER(&match->products)

static asj_status run_products(asj_context *context, struct asj_cl_match *match, const block *b)
{
    const size_t local[2] = {8, 8};
    const size_t global[2] = {round_up((b->frames + PRODUCT_ROWS - 1) / PRODUCT_ROWS, local[0]),
                              round_up((b->frames2 + PRODUCT_COLUMNS - 1) / PRODUCT_COLUMNS, local[1])};
    const asj_cl_argument arguments[] = {PRODUCT_ARGUMENTS}, paired[] = {PRODUCT_ARGUMENTS, ASJ_CL_INT(-1)};
    if (processor(context))
        return asj_cl_run(context, "distance_products_paired", 2, global, local, ASJ_CL_ARGUMENTS(paired));
    return asj_cl_run(context, "distance_products", 2, global, local, ASJ_CL_ARGUMENTS(arguments));
}

static asj_status run_scores(asj_context *context, struct asj_cl_match *match, const block *b)
{
    const size_t local[2] = {64, 1};
    const size_t global[2] = {round_up(b->count2, local[0]), b->count};
    const asj_cl_argument arguments[] = {
        ASJ_CL_BUFFER(&match->products), ASJ_CL_INT(b->frames2), ASJ_CL_BUFFER(&b->images[0]->frames),
        ASJ_CL_BUFFER(&b->images[0]->usable), ASJ_CL_BUFFER(&b->images[1]->frames), ASJ_CL_BUFFER(&b->images[1]->usable),
        ASJ_CL_INT(b->first), ASJ_CL_INT(b->count), ASJ_CL_INT(b->count2), ASJ_CL_BUFFER(&match->scores)};
    const asj_cl_argument places[] = {
        ASJ_CL_BUFFER(&match->points[0]), ASJ_CL_BUFFER(&match->boxes[0]), ASJ_CL_BUFFER(&match->points[1]),
        ASJ_CL_BUFFER(&match->boxes[1]), ASJ_CL_INT(b->first), ASJ_CL_INT(b->count), ASJ_CL_INT(b->count2),
        ASJ_CL_BUFFER(&match->scores)};
    const asj_status status = asj_cl_run(context, "distance_scores", 2, global, local, ASJ_CL_ARGUMENTS(arguments));
    if (status != ASJ_OK || !b->expected)
        return status;
    return asj_cl_run(context, "distance_expected", 2, global, local, ASJ_CL_ARGUMENTS(places));
}

/* With one part only, the rows' lists are made where they belong. */
static asj_status run_rows(asj_context *context, struct asj_cl_match *match, const block *b)
{
    const size_t local[2] = {(size_t)b->parts, 1}, global[2] = {(size_t)b->parts, b->count};
    const size_t local_merge = 16, global_merge = round_up(b->count, local_merge);
    const asj_cl_buffer *to = b->parts > 1 ? &match->lists : &match->rows;
    const asj_cl_argument rows[] = {ASJ_CL_BUFFER(&match->scores), ASJ_CL_INT(b->parts > 1 ? 0 : b->first), ASJ_CL_INT(b->count),
                                    ASJ_CL_INT(b->count2), ASJ_CL_INT(b->parts), ASJ_CL_INT(b->limit), ASJ_CL_BUFFER(to)};
    const asj_cl_argument merge[] = {ASJ_CL_BUFFER(&match->lists), ASJ_CL_INT(b->first), ASJ_CL_INT(b->count),
                                     ASJ_CL_INT(b->parts), ASJ_CL_INT(b->limit), ASJ_CL_BUFFER(&match->rows)};
    asj_status status = asj_cl_run(context, "distance_rows", 2, global, local, ASJ_CL_ARGUMENTS(rows));
    if (status == ASJ_OK && b->parts > 1)
        status = asj_cl_run(context, "distance_merge", 1, &global_merge, &local_merge, ASJ_CL_ARGUMENTS(merge));
    return status;
}

static asj_status run_columns(asj_context *context, struct asj_cl_match *match, const block *b)
{
    const size_t local = 16, global = round_up(b->count2, local);
    const asj_cl_argument arguments[] = {ASJ_CL_BUFFER(&match->scores), ASJ_CL_INT(b->first), ASJ_CL_INT(b->count),
                                         ASJ_CL_INT(b->count2), ASJ_CL_INT(b->limit), ASJ_CL_BUFFER(&match->columns)};
    return asj_cl_run(context, "distance_columns", 1, &global, &local, ASJ_CL_ARGUMENTS(arguments));
}

/* Frames of image 1 whose products are held at once: on a processor what its caches like. At least those of an L-junction. */
static uint32_t block_frames(const asj_context *context, uint32_t frames2)
{
    const asj_cl_limits *limits = asj_cl_get_limits(context);
    uint64_t bytes = processor(context) ? 4 << 20 : limits->global_memory / 16;
    bytes = bytes < limits->largest_buffer ? bytes : limits->largest_buffer;
    const uint64_t frames = bytes / ((uint64_t)frames2 * sizeof(int32_t)), most = processor(context) ? 256 : 65536;
    return (uint32_t)(frames < MOST_FRAMES ? MOST_FRAMES : frames < most ? frames : most);
}

static asj_status reserve_block(asj_context *context, struct asj_cl_match *match, const block *b, uint32_t most, uint32_t count1)
{
    const struct {
        asj_cl_buffer *buffer;
        size_t bytes;
    } wanted[] = {{&match->products, (size_t)most * b->frames2 * sizeof(int32_t)},
                  {&match->scores, (size_t)most * b->count2 * sizeof(int32_t)},
                  {&match->lists, (size_t)most * (size_t)(b->parts * b->limit) * sizeof(asj_partner)},
                  {&match->rows, (size_t)count1 * (size_t)b->limit * sizeof(asj_partner)},
                  {&match->columns, (size_t)b->count2 * (size_t)b->limit * sizeof(asj_partner)}};
    asj_status status = ASJ_OK;
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0] && status == ASJ_OK; i++)
        status = asj_cl_reserve(context, wanted[i].buffer, wanted[i].bytes);
    return status;
}

static asj_status run_block(asj_context *context, struct asj_cl_match *match, const block *b)
{
    asj_status status = run_products(context, match, b);
    if (status == ASJ_OK)
        status = run_scores(context, match, b);
    if (status == ASJ_OK)
        status = run_rows(context, match, b);
    if (status == ASJ_OK)
        status = run_columns(context, match, b);
    return status == ASJ_OK ? asj_cl_finish(context) : status;
}

/* Where the block that begins with L-junction `first` ends. */
static uint32_t block_end(const asj_l_junctions *l_junctions, uint32_t first, uint32_t most)
{
    const uint32_t *start = l_junctions->first_frame;
    uint32_t end = first + 1;
    while (end < l_junctions->count && end - first < most && start[end + 1] - start[first] <= most)
        end++;
    return end;
}

static asj_status run_blocks(asj_context *context, struct asj_cl_match *match, block *b, const asj_l_junctions *l_junctions)
{
    const uint32_t most = block_frames(context, b->frames2);
    asj_status status = reserve_block(context, match, b, most, l_junctions->count);
    for (uint32_t end; status == ASJ_OK && b->first < l_junctions->count; b->first = end) {
        end = block_end(l_junctions, b->first, most);
        b->count = end - b->first;
        b->frame = l_junctions->first_frame[b->first];
        b->frames = l_junctions->first_frame[end] - b->frame;
        status = run_block(context, match, b);
        if (status == ASJ_OK)
            status = asj_progress(context, ASJ_STAGE_DISTANCES, 0.2 + 0.4 * (double)end / (double)l_junctions->count);
    }
    return status;
}

static int32_t left_to_the_cpu(const asj_match_run *run)
{
    const asj_match_options *options = run->options;
    if (options->patches != ASJ_PATCHES_CANONICAL || (options->descriptor != ASJ_DESCRIPTOR_SIFT && !options->normalise))
        return 1;
    for (int side = 0; side < 2; side++) {
        const uint32_t frames = run->image[side]->l_junctions.frame_count;
        if (frames == 0 || frames > INT32_MAX / 64 || !patches_fit(run->context, options, run->image[side]))
            return 1;
    }
    return !fits(run->context, (uint64_t)run->image[1]->l_junctions.frame_count * MOST_FRAMES * sizeof(int32_t));
}

asj_status asj_cl_rank_partners(const asj_match_run *run, asj_partner *rows, asj_partner *columns)
{
    asj_context *context = run->context;
    const asj_l_junctions *in1 = &run->image[0]->l_junctions, *in2 = &run->image[1]->l_junctions;
    const size_t limit = (size_t)run->options->shortlist, bytes1 = in1->count * limit * sizeof *rows;
    const size_t bytes2 = in2->count * limit * sizeof *columns;
    device_features *images[2] = {NULL, NULL};
    struct asj_cl_match *match;
    if (left_to_the_cpu(run))
        return asj_rank_partners(run, rows, columns);
    asj_status status = get(context, &match);
    if (status == ASJ_OK)
        status = find_features(context, match, run->options, run->image[0], NULL, &images[0]);
    if (status == ASJ_OK)
        status = find_features(context, match, run->options, run->image[1], images[0], &images[1]);
    if (status != ASJ_OK)
        return status;
    block b = {{images[0], images[1]}, in2->count, in2->frame_count, asj_patch_length(run->options), run->options->shortlist,
               processor(context) ? 1 : 16, 0, 0, 0, 0, run->expected != NULL};
    status = send_expected(run, match);
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &match->columns, bytes2);
    if (status == ASJ_OK)
        status = asj_cl_write(context, &match->columns, 0, columns, bytes2);
    if (status == ASJ_OK)
        status = run_blocks(context, match, &b, in1);
    if (status == ASJ_OK)
        status = asj_cl_read(context, &match->rows, 0, rows, bytes1);
    return status == ASJ_OK ? asj_cl_read(context, &match->columns, 0, columns, bytes2) : status;
}
