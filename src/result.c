/* SPDX-License-Identifier: BSD-2-Clause */
#include "result.h"

#include <math.h>
#include <string.h>

#define LN_10 2.302585092994046

/* What stands behind the public struct. */
typedef struct result {
    asj_detection detection; /* first: the public pointer is this one */
    asj_memory memory;       /* the allocator; results outlive their context */
    asj_junction *junctions;
    asj_l_junction *l_junctions;
} result;

static void convert(const asj_draft *draft, asj_junction *out)
{
    memset(out, 0, sizeof *out);
    out->x = (float)draft->x;
    out->y = (float)draft->y;
    out->scale = (float)draft->radius;
    out->log10_nfa = (float)(draft->log_nfa / LN_10);
    out->location_sd = (float)sqrt(draft->location_variance);
    out->branch_count = draft->branch_count;
    for (int32_t i = 0; i < draft->branch_count; i++) {
        const asj_draft_branch *branch = &draft->branches[i];
        float angle = (float)branch->angle;
        out->branches[i].angle = angle < 6.2831853f ? angle : 0; /* rounding to float may reach 2 pi */
        out->branches[i].length = (float)branch->length;
        out->branches[i].strength = (float)branch->strength;
        out->branches[i].log10_nfa = (float)(branch->log_nfa / LN_10);
        out->branches[i].angle_sd = (float)sqrt(branch->angle_variance);
    }
}

asj_detection *asj_result_create(const asj_context *context, const asj_draft *drafts, size_t count, double minimum_opening)
{
    asj_memory memory = {context->memory.allocator, 0, 0};
    result *r = asj_allocate_zero(&memory, 1, sizeof *r);
    asj_detection *detection = r ? &r->detection : NULL;
    if (!r)
        return NULL;
    r->memory = memory;
    if (count == 0)
        return detection;
    r->junctions = asj_allocate(&r->memory, count, sizeof *r->junctions);
    if (!r->junctions) {
        asj_detection_free(&detection);
        return NULL;
    }
    for (size_t i = 0; i < count; i++)
        convert(&drafts[i], &r->junctions[i]);
    size_t l_count = asj_decompose(r->junctions, count, minimum_opening, NULL, 0);
    if (l_count > 0) {
        r->l_junctions = asj_allocate(&r->memory, l_count, sizeof *r->l_junctions);
        if (!r->l_junctions) {
            asj_detection_free(&detection);
            return NULL;
        }
        asj_decompose(r->junctions, count, minimum_opening, r->l_junctions, l_count);
    }
    detection->junctions = r->junctions;
    detection->junction_count = (uint32_t)count;
    detection->l_junctions = r->l_junctions;
    detection->l_junction_count = (uint32_t)l_count;
    return detection;
}

void asj_detection_free(asj_detection **pointer)
{
    if (!pointer || !*pointer)
        return;
    result *r = (result *)*pointer;
    asj_memory memory = r->memory;
    asj_release(&memory, r->l_junctions);
    asj_release(&memory, r->junctions);
    asj_release(&memory, r);
    *pointer = NULL;
}
