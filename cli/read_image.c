/* SPDX-License-Identifier: BSD-2-Clause */
/* Reads images for detect and match. */
#include "read_image.h"
#include "message.h"

#include <string.h>

enum { WHITE_16 = 65535, DARK = 8 /* times darker than white */ };

int cli_read_image(cli_session *session, const cli_common *common, const char *path, asj_image_file **file)
{
    char message[CLI_MESSAGE_SIZE] = "";
    const asj_status status = asj_image_file_read(path, common->max_pixels, file, message, sizeof message);
    if (status != ASJ_OK)
        return cli_session_fail(session, path, message, status);
    (*file)->image.white = (float)common->white;
    return CLI_SUCCESS;
}

uint32_t cli_dark_level(const asj_image *image)
{
    uint16_t level, brightest = 0;
    if (!image->data || image->format != ASJ_FORMAT_GRAY16 || image->white > 0)
        return 0;
    const ptrdiff_t stride = image->stride ? image->stride : (ptrdiff_t)sizeof level * image->width;
    for (int32_t y = 0; y < image->height; y++)
        for (int32_t x = 0; x < image->width; x++) {
            memcpy(&level, (const unsigned char *)image->data + y * stride + (ptrdiff_t)sizeof level * x, sizeof level);
            brightest = level > brightest ? level : brightest;
        }
    return brightest < WHITE_16 / DARK ? brightest : 0;
}

uint32_t cli_likely_white(uint32_t level)
{
    uint32_t white = 255;
    while (white < level)
        white = 2 * white + 1;
    return white;
}

void cli_note_dark(const char *name, uint32_t level)
{
    cli_note("%s: brightest pixel is %.2g %% of white: --white %lu?", name, 100.0 * level / WHITE_16,
             (unsigned long)cli_likely_white(level));
}
