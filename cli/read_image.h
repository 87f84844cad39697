/* SPDX-License-Identifier: BSD-2-Clause */
/* Images as the options of the command line want them read, and what their levels tell. */
#ifndef ASJ_CLI_READ_IMAGE_H
#define ASJ_CLI_READ_IMAGE_H

#include "common.h"

#include <asj/io.h>

/* An image file no larger than --max-megapixels, its white that of --white where that may be its own. CLI_SUCCESS, or CLI_FAILED
 * after saying why. */
int cli_read_image(cli_session *session, const cli_common *common, const char *path, asj_image_file **file);

/* Warns, once in a session, where --colours has nothing to look at: colours of 16 bits and of floats are read as grey levels. */
void cli_warn_of_gray(cli_session *session, const char *command, const char *name, const asj_image *image);

/* Does it have colours that --colours looks at, and do they change from one place to the next, as at edges? */
int cli_has_colour_edges(const asj_image *image);

/* Are all pixels alike? There is nothing to find then. */
int cli_is_uniform(const asj_image *image);

/* The brightest level of a 16-bit image far darker than the white that its format has; 0: there is none, or its white was given.
 * Samples of 10 or 12 bits are such images, in which corners are too weak to be found. */
uint32_t cli_dark_level(const asj_image *image);

/* The brightest level of an image of floats more than half of which is brighter than white, and so has no corners; 0: it is none,
 * or its white was given. Samples of 0 to 255 are such images. */
double cli_bright_level(const asj_image *image);

/* The white of samples whose brightest level this is: 1023, 4095. */
uint32_t cli_likely_white(uint32_t level);

/* What may help floats whose brightest level this is: "--white 255?", or that it does not go so far. */
void cli_advise_white(double level, char *text, size_t size);

/* Say so of an image, with what may help. */
void cli_note_dark(const char *name, uint32_t level);
void cli_note_bright(const char *name, double level);

#endif
