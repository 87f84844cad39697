/* SPDX-License-Identifier: BSD-2-Clause */
/* --region and --mask. */
#include "region.h"
#include "message.h"
#include "read_image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int cli_region_take(const char *command, const char *name, const char *text, cli_region *region)
{
    int32_t values[4];
    const char *at = text;
    int count = 0;
    for (; count < 4 && *at >= '0' && *at <= '9'; count++) {
        char *end;
        const long value = strtol(at, &end, 10);
        if (value > ASJ_MAX_SIDE)
            return cli_usage_error(command, "--%s: '%s' goes beyond %d, the longest side of an image", name, text, ASJ_MAX_SIDE);
        if (count < 3 ? *end != ',' : *end != '\0')
            break;
        values[count] = (int32_t)value;
        at = end + (count < 3);
    }
    if (count == 4 && (values[2] < 1 || values[3] < 1))
        return cli_usage_error(command, "--%s: '%s' has no pixel", name, text);
    if (count < 4)
        return cli_usage_error(command, "--%s: '%s' is not X,Y,WIDTH,HEIGHT in whole pixels, from 0,0 at the top left", name, text);
    region->x = values[0];
    region->y = values[1];
    region->width = values[2];
    region->height = values[3];
    return CLI_SUCCESS;
}

static int fail(cli_session *session, const char *name, const char *problem, const asj_image *image)
{
    char message[CLI_MESSAGE_SIZE];
    snprintf(message, sizeof message, "%s an image of %d x %d pixels", problem, (int)image->width, (int)image->height);
    return cli_session_fail(session, name, message, ASJ_ERROR_ARGUMENT);
}

static int fail_outside(cli_session *session, const cli_region *region, const char *name, const asj_image *image)
{
    char message[CLI_MESSAGE_SIZE];
    snprintf(message, sizeof message, "the region %d,%d,%d,%d is not within the image of %d x %d pixels", (int)region->x,
             (int)region->y, (int)region->width, (int)region->height, (int)image->width, (int)image->height);
    return cli_session_fail(session, name, message, ASJ_ERROR_ARGUMENT);
}

int cli_region_read_mask(cli_session *session, const cli_common *common, const cli_region *region,
                         asj_image_file **mask)
{
    if (!region->mask)
        return CLI_SUCCESS;
    if (cli_read_image(session, common, region->mask, mask) != CLI_SUCCESS)
        return CLI_FAILED;
    const int32_t format = (*mask)->image.format;
    if (format == ASJ_FORMAT_GRAY8)
        return CLI_SUCCESS;
    return cli_session_fail(session, region->mask,
                            format == ASJ_FORMAT_GRAY16     ? "a mask is an 8-bit gray image, and this one has 16 bits" :
                            format == ASJ_FORMAT_GRAY_FLOAT ? "a mask is an 8-bit gray image, and this one is in floats" :
                                                              "a mask is an 8-bit gray image, and this one is in colour",
                            ASJ_ERROR_ARGUMENT);
}

int cli_region_of(cli_session *session, const cli_region *region, const asj_image_file *mask, const char *name,
                  const asj_image *image, asj_region *result)
{
    memset(result, 0, sizeof *result);
    if (region->width > 0 && (region->x >= image->width || region->width > image->width - region->x ||
                              region->y >= image->height || region->height > image->height - region->y))
        return fail_outside(session, region, name, image);
    if (mask && (mask->image.width != image->width || mask->image.height != image->height))
        return fail(session, region->mask, "this mask has another size than", image);
    result->x = region->x;
    result->y = region->y;
    result->width = region->width;
    result->height = region->height;
    result->mask = mask ? &mask->image : NULL;
    return CLI_SUCCESS;
}
