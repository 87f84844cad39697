/* SPDX-License-Identifier: BSD-2-Clause */
/* The first directory of a TIFF or BigTIFF file: size, orientation, and tiles that the format allows. */
#include "exif.h"
#include "probe.h"

enum { TAG_WIDTH = 256, TAG_HEIGHT = 257, TAG_TILE_WIDTH = 322, TAG_TILE_HEIGHT = 323 };

/* TIFF 6.0, section 15: sides of tiles are multiples of 16. Smaller ones only make tables long. */
static int is_good_side(const asj_input *input, unsigned tag)
{
    uint32_t side;
    return !asj_tiff_value(input->bytes, input->size, tag, &side) || (side && side % 16 == 0);
}

void asj_probe_tiff(const asj_input *input, asj_image_probe *probe)
{
    uint32_t width, height;

    if (asj_tiff_value(input->bytes, input->size, TAG_WIDTH, &width) &&
        asj_tiff_value(input->bytes, input->size, TAG_HEIGHT, &height)) {
        probe->width = width;
        probe->height = height;
        probe->has_size = 1;
    }
    if (!is_good_side(input, TAG_TILE_WIDTH) || !is_good_side(input, TAG_TILE_HEIGHT))
        probe->fault = "tiles whose sides are not multiples of 16";
    probe->orientation = asj_exif_orientation(input->bytes, input->size);
}
