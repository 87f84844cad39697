/* SPDX-License-Identifier: BSD-2-Clause */
/* Results: hypotheses become junctions in memory that outlives the context and serves the next image. */
#include "result.h"

#include <math.h>
#include <string.h>

/* What stands behind the public struct. */
typedef struct result {
    asj_detection detection; /* first: the public pointer is this one */
    asj_memory memory;       /* the allocator; results outlive their context */
    void *junctions, *l_junctions, *edges;
    size_t capacity, l_capacity, edge_capacity;
} result;

static void convert(const asj_hypothesis *hypothesis, asj_junction *out)
{
    memset(out, 0, sizeof *out);
    out->x = (float)hypothesis->x;
    out->y = (float)hypothesis->y;
    out->scale = (float)hypothesis->radius;
    out->log10_nfa = (float)(hypothesis->log_nfa / ASJ_LN_10);
    out->location_sd = (float)sqrt(hypothesis->location_variance);
    out->branch_count = hypothesis->branch_count;
    out->octave = (int32_t)(hypothesis->octave < 0 ? floor(hypothesis->octave) : ceil(hypothesis->octave));
    for (int32_t i = 0; i < hypothesis->branch_count; i++) {
        const asj_hypothesis_branch *branch = &hypothesis->branches[i];
        float angle = (float)branch->angle;
        out->branches[i].angle = angle < 6.2831853f ? angle : 0; /* rounding to float may reach 2 pi */
        out->branches[i].length = (float)branch->length;
        out->branches[i].strength = (float)branch->strength;
        out->branches[i].log10_nfa = (float)(branch->log_nfa / ASJ_LN_10);
        out->branches[i].angle_sd = (float)sqrt(branch->angle_variance);
        out->branches[i].width = (float)(branch->width * asj_octave_scale(branch->octave));
        out->branches[i].length_sd = (float)sqrt(branch->end_variance);
        out->branches[i].end = branch->end;
    }
}

void asj_result_clear(asj_detection *detection)
{
    memset(detection, 0, sizeof *detection);
}

/* Room for half as many again: the next picture's list fits too. */
static asj_status reserve(asj_memory *memory, void **list, size_t *capacity, size_t count, size_t size)
{
    return count > *capacity ? asj_grow(memory, list, capacity, count + count / 2, size, 0) : ASJ_OK;
}

/* All or nothing: there is room for every list before the first is told. */
static asj_status fill(result *r, const asj_findings *findings, double minimum_opening)
{
    const size_t count = findings->count, edge_count = findings->edge_count;
    asj_status status = reserve(&r->memory, &r->junctions, &r->capacity, count, sizeof(asj_junction));
    if (status == ASJ_OK)
        status = reserve(&r->memory, &r->edges, &r->edge_capacity, edge_count, sizeof(asj_edge));
    if (status != ASJ_OK || count == 0)
        return status;
    asj_junction *junctions = r->junctions;
    for (size_t i = 0; i < count; i++)
        convert(&findings->hypotheses[i], &junctions[i]);
    const size_t l_count = asj_decompose(junctions, count, minimum_opening, NULL, 0);
    status = reserve(&r->memory, &r->l_junctions, &r->l_capacity, l_count, sizeof(asj_l_junction));
    if (status != ASJ_OK)
        return status;
    if (l_count > 0)
        asj_decompose(junctions, count, minimum_opening, r->l_junctions, l_count);
    if (edge_count > 0)
        memcpy(r->edges, findings->edges, edge_count * sizeof(asj_edge));
    r->detection.junctions = junctions;
    r->detection.junction_count = (uint32_t)count;
    r->detection.l_junctions = l_count > 0 ? r->l_junctions : NULL;
    r->detection.l_junction_count = (uint32_t)l_count;
    r->detection.edges = edge_count > 0 ? r->edges : NULL;
    r->detection.edge_count = (uint32_t)edge_count;
    return ASJ_OK;
}

asj_status asj_result_fill(const asj_context *context, const asj_findings *findings, double minimum_opening,
                           asj_detection **detection)
{
    result *r = (result *)*detection;
    if (r) {
        asj_result_clear(&r->detection);
        return fill(r, findings, minimum_opening);
    }
    asj_memory memory = {.allocator = context->memory.allocator};
    r = asj_allocate_zero(&memory, 1, sizeof *r);
    if (!r)
        return ASJ_ERROR_MEMORY;
    r->memory = memory;
    *detection = &r->detection;
    const asj_status status = fill(r, findings, minimum_opening);
    if (status != ASJ_OK)
        asj_detection_free(detection);
    return status;
}

void asj_detection_free(asj_detection **pointer)
{
    if (!pointer || !*pointer)
        return;
    result *r = (result *)*pointer;
    asj_memory memory = r->memory;
    asj_release(&memory, r->edges);
    asj_release(&memory, r->l_junctions);
    asj_release(&memory, r->junctions);
    asj_release(&memory, r);
    *pointer = NULL;
}
