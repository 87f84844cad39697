/* SPDX-License-Identifier: BSD-2-Clause */
#include "subset.h"
#include "core/nth_smallest.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

/* Those of L-junctions that are no guests, of junctions up to `log10_nfa`; `first_only` of each. */
typedef struct choice {
    int32_t first_only;
    float log10_nfa;
} choice;

/* How many frames of L-junction i are in it. */
static uint32_t frames_of(const asj_l_junctions *l, uint32_t i, const choice *c)
{
    const uint32_t all = l->first_frame[i + 1] - l->first_frame[i];
    return asj_is_guest(l, i) || l->log10_nfa[i] > c->log10_nfa ? 0 : c->first_only && all > 1 ? 1 : all;
}

/* What the `most` most meaningful L-junctions that are no guests reach. */
static asj_status find_log10_nfa(asj_context *context, const asj_l_junctions *l, uint32_t most, float *log10_nfa)
{
    *log10_nfa = INFINITY;
    if (most == 0 || l->count <= most)
        return ASJ_OK;
    float *values = asj_allocate(&context->memory, l->count, sizeof *values);
    if (!values)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the order of %u L-junctions", (unsigned)l->count);
    size_t count = 0;
    for (uint32_t i = 0; i < l->count; i++)
        if (!asj_is_guest(l, i))
            values[count++] = l->log10_nfa[i];
    if (count > most)
        *log10_nfa = asj_nth_smallest(values, count, most);
    asj_release(&context->memory, values);
    return ASJ_OK;
}

static asj_status fill(asj_context *context, const asj_image_features *all, const choice *c, asj_subset *s)
{
    const asj_l_junctions *l = &all->l_junctions;
    uint32_t count = 0;
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_DISTANCES);
    for (uint32_t i = 0; i < l->count && !asj_watch_stops(&watch, NULL); i++) {
        const uint32_t f = l->first_frame[i], some = frames_of(l, i, c);
        s->first_frame[i] = count;
        memcpy(s->frames + count, l->frames + f, some * sizeof *s->frames);
        memcpy(s->usable + count, all->usable + f, some);
        for (uint32_t n = 0; n < some; n++)
            s->patch_of[count++] = asj_patch_number(all, f + n);
    }
    s->first_frame[l->count] = count;
    return asj_watch_end(&watch);
}

asj_status asj_subset_create(const asj_match_run *run, int32_t side, int32_t first_only, uint32_t most, asj_subset *s)
{
    asj_memory *memory = &run->context->memory;
    const asj_image_features *all = run->image[side];
    const asj_l_junctions *l = &all->l_junctions;
    choice c = {first_only, 0};
    size_t count = 0;
    const asj_status status = find_log10_nfa(run->context, l, most, &c.log10_nfa);
    if (status != ASJ_OK)
        return status;
    for (uint32_t i = 0; i < l->count; i++)
        count += frames_of(l, i, &c);
    s->frames = asj_allocate(memory, count, sizeof *s->frames);
    s->first_frame = asj_allocate(memory, (size_t)l->count + 1, sizeof *s->first_frame);
    s->patch_of = asj_allocate(memory, count, sizeof *s->patch_of);
    s->usable = asj_allocate(memory, count, sizeof *s->usable);
    if (!s->frames || !s->first_frame || !s->patch_of || !s->usable)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for a part of %u L-junctions", (unsigned)l->count);
    const asj_status filled = fill(run->context, all, &c, s);
    s->features = *all;
    s->features.device_copy = 0;
    s->features.patch_of = s->patch_of;
    s->features.usable = s->usable;
    s->features.l_junctions.frames = s->frames;
    s->features.l_junctions.first_frame = s->first_frame;
    s->features.l_junctions.frame_count = (uint32_t)count;
    return filled;
}

void asj_subset_free(asj_memory *memory, asj_subset *s)
{
    asj_release_much(memory, s->frames);
    asj_release_much(memory, s->first_frame);
    asj_release_much(memory, s->patch_of);
    asj_release_much(memory, s->usable);
}
