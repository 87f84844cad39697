/* SPDX-License-Identifier: BSD-2-Clause */
/* What came of many images: hints for each of them would flood a log, so they are counted and told once, at the end. */
#ifndef ASJ_CLI_TALLY_H
#define ASJ_CLI_TALLY_H

#include <asj/detect.h>
#include <asj/options.h>

typedef struct cli_tally {
    size_t total;         /* images of the run; one alone has its hint at once */
    size_t done, failed;
    size_t uniform;       /* of one level */
    size_t bare;          /* others without a junction that are large enough for one */
    size_t dark;          /* far darker than white */
    uint32_t dark_level;  /* the brightest of these */
    size_t bright;        /* most of it brighter than white */
    double bright_level;
} cli_tally;

/* After an image: counts what there is to say of it, or says it where there is only one image. */
void cli_tally_image(cli_tally *tally, const char *name, const asj_image *image, const asj_detection *detection,
                     const asj_detect_options *options);

/* After the last of several images: one line, with the file that all results are in; NULL or "-": none has them all. */
void cli_tally_print(const cli_tally *tally, const asj_detect_options *options, const char *file);

#endif
