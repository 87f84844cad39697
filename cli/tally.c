/* SPDX-License-Identifier: BSD-2-Clause */
/* Counts images, and says what they came to. */
#include "tally.h"
#include "message.h"
#include "read_image.h"

#include <stdio.h>
#include <string.h>

enum { SMALLEST = 16 /* px, of a side: below it there is no room for the branches of a junction */ };
#define WEAKER "weaker corners are found with --epsilon 100 --candidate-strength 2"

/* Would these options find no more? */
static int is_strict(const asj_detect_options *options)
{
    return options->epsilon < 100 || options->candidate_strength > 2;
}

void cli_tally_image(cli_tally *tally, const char *name, const asj_image *image, const asj_detection *detection,
                     const asj_detect_options *options)
{
    const int uniform = cli_is_uniform(image);
    const uint32_t dark = uniform ? 0 : cli_dark_level(image);
    const double bright = uniform ? 0 : cli_bright_level(image);
    const int is_white_known = dark == 0 && !(bright > 0), is_large = image->width >= SMALLEST && image->height >= SMALLEST;
    const int bare = is_white_known && is_large && !uniform && detection->junction_count == 0;
    tally->uniform += uniform != 0;
    tally->dark += dark > 0;
    tally->dark_level = dark > tally->dark_level ? dark : tally->dark_level;
    tally->bright += bright > 0;
    tally->bright_level = bright > tally->bright_level ? bright : tally->bright_level;
    tally->bare += bare != 0;
    if (tally->total > 1)
        return;
    if (uniform)
        cli_note("%s: no contrast: all pixels are alike", name);
    else if (dark > 0)
        cli_note_dark(name, dark);
    else if (bright > 0)
        cli_note_bright(name, bright);
    else if (bare && is_strict(options))
        cli_note("%s: " WEAKER, name);
}

void cli_tally_print(const cli_tally *tally, const asj_detect_options *options, const char *file)
{
    const int named = file && strcmp(file, "-") != 0;
    char failed[48] = "", uniform[48] = "", bare[160] = "", dark[96] = "", bright[160] = "", advice[64];
    if (tally->failed > 0)
        snprintf(failed, sizeof failed, ", %zu failed", tally->failed);
    if (tally->uniform > 0)
        snprintf(uniform, sizeof uniform, ", %zu without contrast", tally->uniform);
    if (tally->bare > 0)
        snprintf(bare, sizeof bare, ", %zu without a junction%s", tally->bare, is_strict(options) ? " (" WEAKER ")" : "");
    if (tally->dark > 0)
        snprintf(dark, sizeof dark, ", %zu far darker than white (--white %lu?)", tally->dark,
                 (unsigned long)cli_likely_white(tally->dark_level));
    cli_advise_white(tally->bright_level, advice, sizeof advice);
    if (tally->bright > 0)
        snprintf(bright, sizeof bright, ", %zu with most pixels brighter than white (%s)", tally->bright, advice);
    cli_note("%zu image%s done%s%s%s%s%s%s%s", tally->done, tally->done == 1 ? "" : "s", failed, uniform, bare, dark, bright,
             named ? " -> " : "", named ? file : "");
}
