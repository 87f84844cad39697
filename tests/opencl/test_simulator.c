/* SPDX-License-Identifier: BSD-2-Clause */
/* The work on whatever device there is; simulator.sh runs it on one that watches every access. */
#include "work.h"

#include <stdio.h>

static void print(void *user, int32_t level, const char *message)
{
    (void)user;
    (void)level;
    printf("%s\n", message);
}

static asj_status run(int32_t backend, const work_images *images, work_answer *answer)
{
    asj_context_options options;
    asj_context *context = NULL;
    asj_context_options_init(&options);
    options.backend = backend;
    options.threads = 1;
    options.log = print;
    asj_status status = asj_context_create(&options, &context);
    if (status == ASJ_OK)
        status = work_run(context, images, answer);
    if (status == ASJ_OK && backend == ASJ_BACKEND_OPENCL)
        printf("%s: %zu and %zu junctions, %zu matches\n", asj_context_device(context), answer->counts[0], answer->counts[1],
               answer->match_count);
    asj_context_free(&context);
    return status;
}

int main(void)
{
    work_images images;
    work_answer expected = {0}, found = {0};
    int result = 0;
    if (work_images_make(&images) != 0)
        return 99;
    if (run(ASJ_BACKEND_CPU, &images, &expected) != ASJ_OK || expected.counts[0] < 6 || expected.match_count < 4)
        result = 99;
    else if (run(ASJ_BACKEND_OPENCL, &images, &found) != ASJ_OK)
        result = work_without_device();
    else if (!work_same(&expected, &found) || found.backend != ASJ_BACKEND_OPENCL)
        result = 1;
    if (result == 1)
        printf("not what the CPU finds\n");
    work_forget(&expected);
    work_forget(&found);
    work_images_free(&images);
    return result;
}
