/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_MATCH_INPUT_H
#define ASJ_CLI_MATCH_INPUT_H

#include "match_arguments.h"

#include <asj/detect.h>
#include <asj/io.h>

/* One of the two photographs with its junctions, or its features from a file. */
typedef struct cli_match_input {
    const char *name;
    asj_image_file *image;
    asj_junction_file *file;  /* junctions from a file, or ... */
    asj_detection *detection; /* ... from the detector */
    asj_features *features;   /* from a file, in place of all these; or made to go with the other image's */
    asj_image pixels;         /* of the image; without data when there are only features */
    double read_ms;
} cli_match_input;

/* Reads image v, or its features, and where given its file of junctions, whose locations must be those of such an image. */
int cli_match_input_read(cli_session *session, const cli_match_arguments *arguments, int v, cli_match_input *input);

/* Detects junctions unless a file gave them. CLI_FAILED without a word when a signal came. */
int cli_match_input_detect(cli_session *session, const cli_match_arguments *arguments, int v, cli_match_input *input);

/* Features of an image that has been read, with its junctions, unless a file gave them. */
asj_status cli_match_input_describe(cli_session *session, const cli_match_arguments *arguments, cli_match_input *input);

const asj_junction *cli_match_input_junctions(const cli_match_input *input, size_t *count);
void cli_match_input_free(cli_match_input *input);

#endif
