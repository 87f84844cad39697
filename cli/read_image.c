/* SPDX-License-Identifier: BSD-2-Clause */
/* Reads images for detect and match. */
#include "read_image.h"
#include "message.h"
#include "pixels.h"
#include "platform.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WHITE_16 = 65535, DARK = 4095 /* 12 bits: brighter images are dark by themselves */ };

/* Adds the option that moves the limit to the library's "W x H pixels are more than the limit", which does not know it. */
static void name_limit_option(char *message, size_t size)
{
    const char *end = NULL, *start;
    unsigned long long width, height;
    for (const char *found = message; (found = strstr(found, " pixels are more than the limit of ")) != NULL; found++)
        end = found;
    if (!end)
        return;
    for (start = end; start > message && strchr("0123456789x ", start[-1]);)
        start--;
    if (sscanf(start, "%llu x %llu", &width, &height) != 2)
        return;
    const double megapixels = ceil((double)width * (double)height / 1e6);
    const size_t used = strlen(message);
    if (megapixels <= CLI_LARGEST_MEGAPIXELS)
        snprintf(message + used, size - used, " (--max-megapixels %.0f)", megapixels);
    else
        snprintf(message + used, size - used, " (--max-megapixels goes up to %d)", CLI_LARGEST_MEGAPIXELS);
}

/* Results of this program are no images: what to do with them instead. NULL: it is none of them. */
static const char *find_result(const char *path)
{
    char message[CLI_MESSAGE_SIZE], head[512] = "";
    asj_junction_file *file = NULL;
    FILE *stream = cli_is_special(path) ? NULL : fopen(path, "rb"); /* a pipe has been read */
    const size_t size = stream ? fread(head, 1, sizeof head - 1, stream) : 0;
    if (stream)
        fclose(stream);
    if (size == 0 || memchr(head, 0, size))
        return NULL;
    const int junctions = strstr(head, "\"asj-junctions-1\"") || asj_junctions_read(path, &file, message, sizeof message) == ASJ_OK;
    asj_junction_file_free(&file);
    if (junctions && strncmp(head, "{\"schema\":", 10) == 0)
        return "junctions as JSON lines, not an image; a line alone is what --junctions1 of 'asj-cli match' takes";
    if (junctions)
        return "junctions, not an image: 'asj-cli match' takes them with --junctions1 FILE --junctions2 FILE beside the images; or "
               "write features ('asj-cli detect -f asjf'), which stand for images";
    return strstr(head, "\"asj-matches-1\"") ? "matches, not an image" : NULL;
}

int cli_is_uniform(const asj_image *image)
{
    const unsigned char *first = image->data;
    const size_t size = cli_pixel_size(image->format), row = size * (size_t)image->width;
    if (!first || memcmp(first, first + size, row - size) != 0) /* each pixel with the next one */
        return 0;
    for (int32_t y = 1; y < image->height; y++)
        if (memcmp(first, cli_pixel_at(image, 0, y), row) != 0)
            return 0;
    return 1;
}

/* Of a 16-bit image; 0 of others. */
static uint32_t brightest(const asj_image *image)
{
    uint16_t level, most = 0;
    if (!image->data || image->format != ASJ_FORMAT_GRAY16)
        return 0;
    for (int32_t y = 0; y < image->height; y++)
        for (int32_t x = 0; x < image->width; x++) {
            memcpy(&level, cli_pixel_at(image, x, y), sizeof level);
            most = level > most ? level : most;
        }
    return most;
}

/* Images of a run may have other white: 8 bits always, and those of 16 bits that are brighter than the one that was given. */
static int has_white(const asj_image *image, double white)
{
    return image->format == ASJ_FORMAT_GRAY_FLOAT || (image->format == ASJ_FORMAT_GRAY16 && brightest(image) <= white);
}

/* Pages and frames are asked for by nobody, so nobody may notice that they were left out. */
static void warn_of_more(cli_session *session, const cli_common *common, const char *path)
{
    if (common->quiet || session->warned_of_more)
        return;
    cli_progress_clear(&session->progress);
    cli_note("asj-cli %s: warning: %s holds several pictures, of which the first is read", common->command, path);
    session->warned_of_more = 1;
}

int cli_read_image(cli_session *session, const cli_common *common, const char *path, asj_image_file **file)
{
    char message[CLI_MESSAGE_SIZE] = "";
    const asj_status status = asj_image_file_read(path, common->max_pixels, file, message, sizeof message);
    const char *result = status == ASJ_ERROR_FORMAT ? find_result(path) : NULL;
    if (status == ASJ_ERROR_FORMAT && cli_is_special(path) && strstr(message, "features (.asjf)"))
        result = "features (.asjf) from a pipe: 'asj-cli match' takes them from a file, whose beginning it looks at first";
    if (status == ASJ_ERROR_LIMIT)
        name_limit_option(message, sizeof message);
    if (status != ASJ_OK)
        return cli_session_fail(session, path, result ? result : message, status);
    if (common->white > 0 && has_white(&(*file)->image, common->white))
        (*file)->image.white = (float)common->white;
    if ((*file)->has_more)
        warn_of_more(session, common, path);
    return CLI_SUCCESS;
}

void cli_warn_of_gray(cli_session *session, const char *command, const char *name, const asj_image *image)
{
    const int deep = image->data && (image->format == ASJ_FORMAT_GRAY16 || image->format == ASJ_FORMAT_GRAY_FLOAT);
    if (!deep || session->warned_of_gray)
        return;
    cli_progress_clear(&session->progress);
    cli_note("asj-cli %s: warning: %s: --colours looks at 8-bit colours; images of 16 bits and floats are read as grey levels",
             command, name);
    session->warned_of_gray = 1;
}

enum { BLOCK = 8 };          /* px; the mean of a block has an eighth of the noise of a pixel */
#define COLOUR_CHANGE 8.0    /* levels of red - green or blue - green, from a block to the next */

/* Means of red - green and blue - green. */
static void mean_colour(const asj_image *image, int32_t left, int32_t top, double mean[2])
{
    int32_t sums[2] = {0, 0};
    for (int32_t y = top; y < top + BLOCK; y++)
        for (int32_t x = left; x < left + BLOCK; x++) {
            const unsigned char *pixel = cli_pixel_at(image, x, y);
            sums[0] += pixel[0] - pixel[1];
            sums[1] += pixel[2] - pixel[1];
        }
    for (int k = 0; k < 2; k++)
        mean[k] = (double)sums[k] / (BLOCK * BLOCK);
}

static int colours_differ(const double one[2], const asj_image *image, int32_t left, int32_t top)
{
    double other[2];
    if (left + BLOCK > image->width || top + BLOCK > image->height)
        return 0;
    mean_colour(image, left, top, other);
    return fabs(one[0] - other[0]) >= COLOUR_CHANGE || fabs(one[1] - other[1]) >= COLOUR_CHANGE;
}

int cli_has_colour_edges(const asj_image *image)
{
    double mean[2];
    if (!image->data || (image->format != ASJ_FORMAT_RGB8 && image->format != ASJ_FORMAT_BGR8))
        return 0;
    for (int32_t y = 0; y + BLOCK <= image->height; y += BLOCK)
        for (int32_t x = 0; x + BLOCK <= image->width; x += BLOCK) {
            mean_colour(image, x, y, mean);
            if (colours_differ(mean, image, x + BLOCK, y) || colours_differ(mean, image, x, y + BLOCK))
                return 1;
        }
    return 0;
}

uint32_t cli_dark_level(const asj_image *image)
{
    const uint32_t level = brightest(image);
    return image->white > 0 || level > DARK ? 0 : level;
}

double cli_bright_level(const asj_image *image)
{
    size_t brighter = 0;
    float level, most = 0;
    if (!image->data || image->format != ASJ_FORMAT_GRAY_FLOAT || image->white > 0)
        return 0;
    for (int32_t y = 0; y < image->height; y++)
        for (int32_t x = 0; x < image->width; x++) {
            memcpy(&level, cli_pixel_at(image, x, y), sizeof level);
            brighter += level > 1;
            most = level > most ? level : most;
        }
    return 2 * brighter > (size_t)image->width * (size_t)image->height ? (double)most : 0;
}

uint32_t cli_likely_white(uint32_t level)
{
    uint32_t white = 1023; /* no camera has fewer bits in 16 */
    while (white < level)
        white = 2 * white + 1;
    return white;
}

void cli_advise_white(double level, char *text, size_t size)
{
    double white = 255;
    while (white < level)
        white = 2 * white + 1;
    if (white <= CLI_LARGEST_WHITE)
        snprintf(text, size, "--white %.10g?", white);
    else
        snprintf(text, size, "up to %.3g, and --white goes up to %g", level, CLI_LARGEST_WHITE);
}

void cli_note_bright(const char *name, double level)
{
    char advice[64];
    cli_advise_white(level, advice, sizeof advice);
    cli_note("%s: most pixels are brighter than white, 1 in floats: %s", name, advice);
}

void cli_note_dark(const char *name, uint32_t level)
{
    cli_note("%s: brightest pixel is %.2g %% of white: --white %lu?", name, 100.0 * level / WHITE_16,
             (unsigned long)cli_likely_white(level));
}
