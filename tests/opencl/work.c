/* SPDX-License-Identifier: BSD-2-Clause */
#include "work.h"

#include "render.h"
#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WORK_FIELD (WORK_WIDTH * WORK_HEIGHT * ASJ_FIELD_BRANCHES)

int work_images_make(work_images *images)
{
    for (int v = 0; v < 2; v++) {
        synth_scene scene;
        const double shift = 2.0 * v;
        synth_scene_init(&scene, WORK_WIDTH, WORK_HEIGHT, 110);
        synth_add_rectangle(&scene, (synth_point){11 + shift, 7}, 24, 16, 0.1, 190);
        synth_add_rectangle(&scene, (synth_point){51 + shift, 10}, 19, 36, 0.2, 50);
        synth_add_rectangle(&scene, (synth_point){9 + shift, 38}, 26, 17, -0.1, 230);
        images->of[v] = (asj_image){NULL, ASJ_FORMAT_GRAY8, WORK_WIDTH, WORK_HEIGHT, 0, 0};
        images->of[v].data = synth_photograph(&scene, 0.8, 1.0, (uint64_t)v + 1);
        synth_scene_free(&scene);
        if (!images->of[v].data)
            return -1;
    }
    return 0;
}

void work_images_free(work_images *images)
{
    for (int v = 0; v < 2; v++)
        free((void *)(uintptr_t)images->of[v].data);
    memset(images, 0, sizeof *images);
}

static void *copy(const void *data, size_t count, size_t size)
{
    void *made = malloc(count * size + 1);
    if (!made)
        exit(99);
    if (count)
        memcpy(made, data, count * size);
    return made;
}

void work_forget(work_answer *a)
{
    for (int v = 0; v < 2; v++)
        free(a->junctions[v]);
    free(a->field);
    free(a->matches);
    memset(a, 0, sizeof *a);
}

static asj_status detect(asj_context *context, const work_images *images, int v, work_answer *a)
{
    asj_detect_options options;
    asj_detection *found = NULL;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    asj_status status = asj_detect(context, &images->of[v], &options, &found);
    if (status == ASJ_OK) {
        a->counts[v] = found->junction_count;
        a->junctions[v] = copy(found->junctions, found->junction_count, sizeof *found->junctions);
        a->backend = found->backend;
    }
    asj_detection_free(&found);
    return status;
}

/* Between two detections, since it shares buffers with them. */
static asj_status find_field(asj_context *context, const work_images *images, work_answer *a)
{
    a->field = calloc(WORK_FIELD, sizeof *a->field);
    if (!a->field)
        exit(99);
    return asj_local_field(context, &images->of[0], NULL, a->field);
}

asj_status work_run(asj_context *context, const work_images *images, work_answer *a)
{
    asj_match_result *found = NULL;
    memset(a, 0, sizeof *a);
    asj_status status = detect(context, images, 0, a);
    if (status == ASJ_OK)
        status = find_field(context, images, a);
    if (status == ASJ_OK)
        status = detect(context, images, 1, a);
    if (status == ASJ_OK)
        status = asj_match(context, &images->of[0], a->junctions[0], a->counts[0], &images->of[1], a->junctions[1], a->counts[1],
                           NULL, &found);
    if (status == ASJ_OK) {
        a->match_count = found->match_count;
        a->matches = copy(found->matches, found->match_count, sizeof *found->matches);
    }
    asj_match_result_free(&found);
    return status;
}

int work_same(const work_answer *a, const work_answer *b)
{
    for (int v = 0; v < 2; v++)
        if (a->counts[v] != b->counts[v] || memcmp(a->junctions[v], b->junctions[v], a->counts[v] * sizeof(asj_junction)) != 0)
            return 0;
    if (!a->field != !b->field || (a->field && memcmp(a->field, b->field, WORK_FIELD * sizeof *a->field) != 0))
        return 0;
    return a->match_count == b->match_count && memcmp(a->matches, b->matches, a->match_count * sizeof *a->matches) == 0;
}

int work_without_device(void)
{
    const char *required = getenv("ASJ_REQUIRE_OPENCL");
    const int fail = required && strcmp(required, "1") == 0;
    printf("%s: no OpenCL device\n", fail ? "FAILED" : "SKIPPED");
    return fail ? 1 : 77;
}
