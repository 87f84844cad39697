/* SPDX-License-Identifier: BSD-2-Clause */
/* A pair's geometry sees the images in colours where both have some, and in grey levels otherwise. Cells are what it looks at
 * (../geometry/picture_look.c), a 48th of the longer side each, so the colours of large images are made smaller for it. */
#include "shown_pictures.h"
#include "small_picture.h"

#define LONGEST 400 /* px: a cell is 8 px then */

static asj_status make_colours(asj_context *context, const asj_image_features *image, asj_pyramid colours[ASJ_MOST_CHANNELS],
                               asj_picture *shown)
{
    const asj_small_picture *p = &image->picture;
    const int32_t longer = p->width > p->height ? p->width : p->height, reduction = (longer + LONGEST - 1) / LONGEST;
    asj_status status = ASJ_OK;
    for (int32_t c = 0; c < ASJ_MOST_CHANNELS && status == ASJ_OK; c++) {
        status = asj_pyramid_allocate(context, p->width / reduction, p->height / reduction, &colours[c]);
        if (status == ASJ_OK)
            asj_small_picture_fill(context, p, c, reduction, &colours[c]);
        shown->channels[c] = &colours[c];
    }
    shown->channel_count = ASJ_MOST_CHANNELS;
    shown->scale = reduction * (image->l_junctions.upsampled ? 4 : 2);
    return status;
}

/* One that is so long that its reduced picture would have no rows is seen in grey levels. */
static int32_t has_colours(const asj_image_features *image)
{
    const asj_small_picture *p = &image->picture;
    const int32_t longer = p->width > p->height ? p->width : p->height, shorter = p->width + p->height - longer;
    return p->level && shorter >= (longer + LONGEST - 1) / LONGEST;
}

asj_status asj_show_pictures(const asj_match_run *run, asj_shown_pictures *shown, asj_picture pictures[2])
{
    const int32_t in_colours = has_colours(run->image[0]) && has_colours(run->image[1]);
    asj_status status = ASJ_OK;
    for (int32_t side = 0; side < 2 && status == ASJ_OK; side++) {
        const asj_pyramid *grey = &run->image[side]->pyramid;
        pictures[side] = (asj_picture){{grey}, 1, 1, grey->width[0], grey->height[0]};
        if (in_colours)
            status = make_colours(run->context, run->image[side], shown->colours[side], &pictures[side]);
    }
    return status;
}

void asj_shown_pictures_free(asj_memory *memory, asj_shown_pictures *shown)
{
    for (int32_t k = 0; k < 2 * ASJ_MOST_CHANNELS; k++)
        asj_pyramid_free(memory, &shown->colours[k / ASJ_MOST_CHANNELS][k % ASJ_MOST_CHANNELS]);
}
