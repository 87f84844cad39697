/* SPDX-License-Identifier: BSD-2-Clause */
/* A service that runs for days, in short: frames COUNT
 *
 * COUNT small pictures through one context and one result, every tenth matched with itself: once all kinds have been seen the
 * memory that the context holds grows no more, nor does that of the process, nor its open files, and nothing leaks. Then
 * COUNT / 10 detections and matches with an allocator that fails at random: each ends well, with the result of the first time,
 * or reports the failure. */
#define _DEFAULT_SOURCE
#include "random.h"
#include "render.h"
#include "scenes.h"

#include <asj/asj.h>

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum { PICTURES = 40, WARM = 2 * PICTURES, SPARE_KB = 1024 };

typedef struct heap {
    long live;
    uint32_t failing; /* one in so many calls fails; 0 = none */
    synth_random random;
} heap;

static void *allocate(void *user, size_t size)
{
    heap *h = user;
    if (h->failing && synth_random_between(&h->random, 0, h->failing) < 1)
        return NULL;
    void *block = malloc(size);
    h->live += block != NULL;
    return block;
}

static void release(void *user, void *block)
{
    ((heap *)user)->live--;
    free(block);
}

static int fail(const char *what, long at)
{
    fprintf(stderr, "%s, at %ld\n", what, at);
    return 1;
}

static int make_pictures(asj_image *pictures)
{
    for (int i = 0; i < PICTURES; i++) {
        synth_scene scene;
        synth_random_star(&scene, 40, (uint64_t)i);
        const int32_t width = scene.width;
        uint8_t *pixels = synth_photograph(&scene, 0.7, 3, (uint64_t)i);
        synth_scene_free(&scene);
        if (!pixels)
            return 0;
        /* of 200 x 200 pixels those in the middle: 96 x 72, and a little smaller each time */
        pictures[i] = (asj_image){pixels + 60 * width + 50, ASJ_FORMAT_GRAY8, 96 - i % 7, 72 - i % 5, 0, width};
    }
    return 1;
}

static asj_context *create(heap *h)
{
    asj_context_options options;
    asj_context *context = NULL;
    asj_context_options_init(&options);
    options.backend = ASJ_BACKEND_CPU;
    options.threads = 1;
    options.allocator = (asj_allocator){allocate, release, h};
    asj_context_create(&options, &context);
    return context;
}

static asj_status match(asj_context *context, const asj_image *image, const asj_detection *found, uint32_t *count)
{
    asj_match_result *result = NULL;
    const asj_status status = asj_match(context, image, found->junctions, found->junction_count, image, found->junctions,
                                        found->junction_count, NULL, &result);
    *count = result ? result->match_count : 0;
    asj_match_result_free(&result);
    return status;
}

/* How many of the first descriptors are open. */
static int open_files(void)
{
    int count = 0;
    for (int i = 0; i < 256; i++)
        count += fcntl(i, F_GETFD) != -1;
    return count;
}

/* The most memory that the process has had, kB; 0 where a sanitizer keeps what was freed. */
static long most_memory(void)
{
    struct rusage use;
#ifdef ASJ_IS_SANITIZED
    return 0;
#endif
    return getrusage(RUSAGE_SELF, &use) == 0 ? use.ru_maxrss : 0;
}

/* The stream. Memory may grow while the pictures are new, and when all have been seen no more. */
static int stream(const asj_image *pictures, long frames)
{
    heap h = {0};
    asj_context *context = create(&h);
    asj_detection *found = NULL;
    uint64_t before = 0, now;
    long live = 0, resident = 0;
    int files = 0;
    uint32_t matches;
    if (!context)
        return fail("no context", 0);
    for (long n = 0; n < frames + WARM; n++) {
        const asj_image *image = &pictures[n % PICTURES];
        if (asj_detect_into(context, image, NULL, &found) != ASJ_OK)
            return fail(asj_context_message(context), n);
        if (n % 10 == 0 && match(context, image, found, &matches) != ASJ_OK)
            return fail(asj_context_message(context), n);
        if (n % PICTURES != 0)
            continue;
        asj_context_memory(context, &now, NULL);
        if (n > WARM && (now > before || h.live > live))
            return fail("memory grows", n);
        if (n == WARM) {
            resident = most_memory();
            files = open_files();
        }
        before = now;
        live = h.live;
    }
    if (most_memory() > resident + SPARE_KB)
        return fail("the process grows, kB", most_memory() - resident);
    if (open_files() != files)
        return fail("files stay open", open_files());
    asj_detection_free(&found);
    asj_context_free(&context);
    printf("%ld frames: %lu bytes held, %ld kB resident, %d open files\n", frames, (unsigned long)before, most_memory(), files);
    return h.live ? fail("memory is lost", h.live) : 0;
}

/* One picture with failures. 1 = done, 0 = memory failed, -1 = wrong. */
static int attempt(asj_context *context, const asj_image *image, const asj_detection *expected, uint32_t expected_matches)
{
    asj_detection *found = NULL;
    uint32_t matches;
    asj_status status = asj_detect(context, image, NULL, &found);
    if (status != ASJ_OK)
        return status == ASJ_ERROR_MEMORY && !found ? 0 : -1;
    int good = found->junction_count == expected->junction_count &&
               (!expected->junction_count ||
                memcmp(found->junctions, expected->junctions, found->junction_count * sizeof *found->junctions) == 0);
    status = match(context, image, expected, &matches);
    asj_detection_free(&found);
    if (!good || (status != ASJ_OK && status != ASJ_ERROR_MEMORY) || (status == ASJ_OK && matches != expected_matches))
        return -1;
    return status == ASJ_OK;
}

static int failures(const asj_image *pictures, long rounds)
{
    heap h = {0};
    long done = 0, failed = 0;
    synth_random_seed(&h.random, 1);
    for (long n = 0; n < rounds; n++) {
        const asj_image *image = &pictures[n % PICTURES];
        asj_context *context = create(&h);
        asj_detection *expected = NULL;
        uint32_t matches = 0;
        if (!context || asj_detect(context, image, NULL, &expected) != ASJ_OK ||
            match(context, image, expected, &matches) != ASJ_OK)
            return fail("no result to compare with", n);
        for (int i = 0; i < 4; i++) {
            h.failing = (uint32_t)(4 + n % 60);
            const int result = attempt(context, image, expected, matches);
            h.failing = 0;
            if (result < 0)
                return fail("a wrong result after failing allocations", n);
            done += result;
            failed += !result;
        }
        if (attempt(context, image, expected, matches) != 1)
            return fail("no result when memory is there again", n);
        asj_detection_free(&expected);
        asj_context_free(&context);
        if (h.live)
            return fail("memory is lost", n);
    }
    printf("%ld calls without memory, %ld with enough\n", failed, done);
    return failed > rounds && done > 0 ? 0 : fail("hardly anything failed, or everything", failed);
}

int main(int argc, char **argv)
{
    asj_image pictures[PICTURES];
    const long frames = argc > 1 ? strtol(argv[1], NULL, 10) : 0;
    if (frames < PICTURES || !make_pictures(pictures))
        return 2;
    int result = stream(pictures, frames);
    if (!result)
        result = failures(pictures, frames / 10);
    for (int i = 0; i < PICTURES; i++)
        free((uint8_t *)(size_t)pictures[i].data - 60 * (size_t)pictures[i].stride - 50);
    return result;
}
