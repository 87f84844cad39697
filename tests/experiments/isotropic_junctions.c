/* SPDX-License-Identifier: BSD-2-Clause */
/* The isotropic junctions of an image, before any branch is followed to its end: what the paper compares ASJ with (ACJ).
 *
 *     isotropic_junctions [--preset paper] [key=value ...] IMAGE FILE.json
 *
 * Steps 1 to 3 of the detector and the location, at the image's own size, as the options say (preset default: line fits and their
 * rejection of edges; preset paper: whole pixels). Every branch of a junction is as long as the junction's isotropic scale.
 * The format is that of asj-cli detect (asj-junctions-1). */
#include "photograph.h"

#include "detect/result.h"
#include "detect/steps.h"

#include <asj/io.h>

#include <stdio.h>
#include <string.h>

static int fail(const char *what)
{
    fprintf(stderr, "isotropic_junctions: %s\n", what);
    return -1;
}

static asj_status run_steps(asj_detection_run *run)
{
    asj_status status = asj_step_load(run);
    if (status == ASJ_OK)
        status = asj_step_gradient(run);
    if (status == ASJ_OK)
        status = asj_step_candidates(run);
    if (status == ASJ_OK)
        status = asj_step_isotropic(run);
    if (status == ASJ_OK)
        status = asj_step_guess(run);
    return status == ASJ_OK ? asj_step_locate(run) : status;
}

static asj_status fill(const asj_detection_run *run, asj_detection **found)
{
    for (size_t i = 0; i < run->hypothesis_count; i++) {
        asj_hypothesis *hypothesis = &run->hypotheses[i];
        for (int32_t b = 0; b < hypothesis->branch_count; b++) {
            hypothesis->branches[b].length = hypothesis->radius;
            hypothesis->branches[b].log_nfa = hypothesis->log_nfa;
        }
    }
    asj_status status = asj_result_fill(run->context, &(asj_findings){run->hypotheses, run->hypothesis_count, NULL, 0},
                                        run->options->minimum_opening, found);
    if (status != ASJ_OK)
        return status;
    (*found)->width = run->image->width;
    (*found)->height = run->image->height;
    (*found)->backend = ASJ_BACKEND_CPU;
    (*found)->candidates = run->candidate_count;
    (*found)->isotropic = run->isotropic_count;
    return ASJ_OK;
}

/* The hypotheses as they are after step 3, or NULL. */
static asj_detection *find(asj_context *context, const asj_detect_options *options, const asj_image *image)
{
    asj_detection_run run;
    asj_detection *found = NULL;
    asj_status status = asj_detection_run_begin(&run, context, image, options, &found);
    if (status == ASJ_OK)
        status = run_steps(&run);
    if (status == ASJ_OK)
        status = fill(&run, &found);
    asj_detection_run_end(&run);
    if (status != ASJ_OK)
        fail(asj_context_message(context));
    return found;
}

static int write_file(const char *path, const char *name, const asj_detection *found, const asj_detect_options *options)
{
    char message[512];
    asj_detection_report report;
    memset(&report, 0, sizeof report);
    report.detection = found;
    report.options = options;
    report.image_name = name;
    return asj_junctions_write(path, ASJ_FILE_JSON, &report, message, sizeof message) == ASJ_OK ? 0 : fail(message);
}

static int run(const asj_detect_options *options, const char *image_path, const char *path)
{
    photograph p;
    asj_context_options how;
    asj_context *context = NULL;
    if (photograph_read(image_path, &p) != 0)
        return -1;
    const asj_image image = {p.pixels, ASJ_FORMAT_GRAY8, p.width, p.height, 0, 0};
    asj_context_options_init(&how);
    how.backend = ASJ_BACKEND_CPU;
    how.threads = 1;
    asj_detection *found = asj_context_create(&how, &context) == ASJ_OK ? find(context, options, &image) : NULL;
    const int result = found ? write_file(path, image_path, found, options) : -1;
    asj_detection_free(&found);
    asj_context_free(&context);
    photograph_free(&p);
    return result;
}

int main(int argc, char **argv)
{
    asj_detect_options options;
    int n = 1;
    asj_detect_options_init(&options);
    if (argc > 2 && strcmp(argv[1], "--preset") == 0) {
        if (asj_detect_options_preset(&options, strcmp(argv[2], "paper") == 0 ? ASJ_PRESET_PAPER : ASJ_PRESET_DEFAULT) != ASJ_OK)
            return 2;
        n = 3;
    }
    for (; n < argc - 2; n++)
        if (photograph_option(&options, argv[n]) != 0)
            return 2;
    if (n + 2 != argc) {
        fprintf(stderr, "usage: isotropic_junctions [--preset paper] [key=value ...] IMAGE FILE.json\n");
        return 2;
    }
    return run(&options, argv[n], argv[n + 1]) == 0 ? 0 : 1;
}
