/* SPDX-License-Identifier: BSD-2-Clause */
#include "l_junctions.h"

#include <string.h>

uint32_t asj_l_junctions_of_image(const asj_junction *junctions, asj_l_junction *l, uint32_t count)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++)
        if (junctions[l[i].junction].octave >= 0)
            l[kept++] = l[i];
    return kept;
}

void asj_l_junctions_free(asj_memory *memory, asj_l_junctions *all)
{
    void *blocks[] = {all->l, all->lengths, all->direction, all->direction_sd, all->first_frame, all->frames, all->location,
                      all->location_x, all->location_y, all->neighbour, all->neighbour_count,
                      all->first_of_location, all->l_of_location, all->octave, all->log10_nfa,
                      all->t_junction};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        asj_release(memory, blocks[i]);
    memset(all, 0, sizeof *all);
}
