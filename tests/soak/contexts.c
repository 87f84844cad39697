/* SPDX-License-Identifier: BSD-2-Clause */
/* Contexts in threads, made, used and freed at once, several times: contexts ROUNDS. All find the same. For the thread sanitizer,
 * and everywhere. */
#include "render.h"
#include "scenes.h"

#include <asj/asj.h>

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 6 };

typedef struct job {
    const asj_image *image;
    uint32_t junctions, matches;
    asj_junction first;
    int failed;
} job;

static void *work(void *user)
{
    job *j = user;
    asj_context *context = NULL;
    asj_detection *found = NULL;
    asj_match_result *result = NULL;
    j->failed = asj_context_create(NULL, &context) != ASJ_OK || asj_detect(context, j->image, NULL, &found) != ASJ_OK ||
                asj_match(context, j->image, found->junctions, found->junction_count, j->image, found->junctions,
                          found->junction_count, NULL, &result) != ASJ_OK;
    if (!j->failed) {
        j->junctions = found->junction_count;
        j->matches = result->match_count;
        j->first = found->junctions[0];
    }
    asj_match_result_free(&result);
    asj_detection_free(&found);
    asj_context_free(&context);
    return NULL;
}

static int run_together(const asj_image *image)
{
    pthread_t threads[THREADS];
    job jobs[THREADS];
    int good = 1;
    memset(jobs, 0, sizeof jobs);
    for (int i = 0; i < THREADS; i++) {
        jobs[i].image = image;
        if (pthread_create(&threads[i], NULL, work, &jobs[i]) != 0)
            abort();
    }
    for (int i = 0; i < THREADS; i++)
        pthread_join(threads[i], NULL);
    for (int i = 0; i < THREADS; i++)
        good &= !jobs[i].failed && jobs[i].junctions > 3 && jobs[i].junctions == jobs[0].junctions &&
                jobs[i].matches == jobs[0].matches && memcmp(&jobs[i].first, &jobs[0].first, sizeof jobs[0].first) == 0;
    return good;
}

int main(int argc, char **argv)
{
    const long rounds = argc > 1 ? strtol(argv[1], NULL, 10) : 1;
    synth_scene scene;
    synth_tiles(&scene, SYNTH_RANDOM_TILES, 3);
    const int32_t width = scene.width;
    uint8_t *pixels = synth_photograph(&scene, 0.8, 2, 4);
    synth_scene_free(&scene);
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, 160, 120, 0, width}; /* a part of it */
    int good = pixels != NULL;
    for (long n = 0; n < rounds && good; n++)
        good = run_together(&image);
    free(pixels);
    if (!good)
        fprintf(stderr, "threads do not find the same\n");
    return !good;
}
