/* SPDX-License-Identifier: BSD-2-Clause */
/* What matching needs of one image, made once and matched with many:
 *
 *     asj_features_create(context, &image1, found1->junctions, found1->junction_count, NULL, &features1);
 *     ...
 *     asj_match_features(context, features1, features2, NULL, &matches12);
 *     asj_match_features(context, features1, features3, NULL, &matches13);
 */
#ifndef ASJ_FEATURES_H
#define ASJ_FEATURES_H

#include <asj/context.h>
#include <asj/image.h>
#include <asj/junction.h>
#include <asj/match.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The L-junctions of an image with their frames, neighbours, patches and colours, and the image's pyramid. Complete and never
 * changed once it is made; it needs neither the image nor the junctions nor the context that it was made from. Memory: 2.7 bytes
 * per pixel, and patch_size^2 x 2 bytes for each frame of an L-junction (1 to 9 each with the defaults). With junctions of
 * octave -1 all of this is there twice, once of the image upsampled by two: 15 bytes per pixel. 8-bit colour images take 0.75 bytes
 * per pixel more. */
typedef struct asj_features asj_features;

/* Makes the features of an image: the part of asj_match() that concerns one image.
 *
 * image            a view; only read, and only during the call
 * junctions        from asj_detect() or a file; copied; may be NULL when the count is 0. Detect with ASJ_PRESET_MATCH
 * options          those of the groups "frames of L-junctions" and "description", neighbours and separation count here and are
 *                  recorded, as the others are. NULL = preset `default`
 * features         on success *features belongs to the caller until asj_features_free()
 *
 * The same input gives the same features with any number of threads and on every back end. One call at a time for a context.
 *
 * ASJ_ERROR_ARGUMENT, ASJ_ERROR_IMAGE, ASJ_ERROR_LIMIT, ASJ_ERROR_OPTION, ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED, ASJ_ERROR_DEVICE
 *                  as asj_match(); ASJ_ERROR_LIMIT also for junctions of octave -1 that it leaves out */
ASJ_API asj_status asj_features_create(asj_context *context, const asj_image *image, const asj_junction *junctions, size_t count,
                                       const asj_match_options *options, asj_features **features);

/* Frees features and sets the pointer to NULL. NULL and a pointer to NULL are fine. Valid as long as the allocator of the context
 * is that they were made with; the context itself may be gone. */
ASJ_API void asj_features_free(asj_features **features);

/* Matches two images by their features: the result of asj_match() with the same images, junctions and options, bit for bit.
 *
 * features1, 2     only read: any number of threads may match the same features at once, each with its own context. They may
 *                  have been made with other contexts, other back ends, or read from a file. They may be the same
 * options          NULL = those that features1 was made with
 * result           as asj_match()
 *
 * ASJ_ERROR_ARGUMENT   a NULL pointer
 * ASJ_ERROR_OPTION     features that were made with other options than those given, which the message names; one out of range
 * ASJ_ERROR_LIMIT, ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED, ASJ_ERROR_DEVICE   as asj_match() */
ASJ_API asj_status asj_match_features(asj_context *context, const asj_features *features1, const asj_features *features2,
                                      const asj_match_options *options, asj_match_result **result);

/* What features hold. The pointers are valid as long as the features are; arrays are NULL when empty. */
typedef struct asj_features_info {
    int32_t width, height;             /* px: of the image */
    uint32_t junction_count, l_junction_count;
    const asj_junction *junctions;     /* as they were given */
    const asj_l_junction *l_junctions; /* as asj_decompose() numbers them: what the l1 and l2 of matches count */
    const asj_match_options *options;  /* that they were made with */
    uint64_t bytes;                    /* of memory that they hold */
    uint64_t reserved[4];
} asj_features_info;

/* Any thread, any time. All zero for NULL features. */
ASJ_API void asj_features_get_info(const asj_features *features, asj_features_info *info);

/* Features as bytes, for files and other machines (asj-formats(5), .asjf): the same on every machine; 2 bytes per pixel, 2.75 of
 * an 8-bit colour image, and some 100 for each junction. Any thread. Writes them when they fit into `capacity` bytes, and returns
 * how many they are, so a first call with capacity 0 tells the size; 0 for NULL features. */
ASJ_API size_t asj_features_save(const asj_features *features, void *bytes, size_t capacity);

/* Features from bytes. What is not among the bytes is computed once more, so that they equal those that were saved (where the C
 * library is another one, whose cos or log may differ in the last digit: but for that), except the geometry of the options, which
 * concerns pairs and is that of preset `default` again; and damaged or hostile bytes can do no more
 * than any other image and junctions. On success *features belongs to the caller until asj_features_free(). One call at a time for
 * a context.
 *
 * ASJ_ERROR_ARGUMENT     a NULL pointer
 * ASJ_ERROR_FORMAT       no such bytes, truncated, more of them than there should be, a wrong checksum, values that cannot be
 * ASJ_ERROR_UNSUPPORTED  bytes of a later version of the format
 * ASJ_ERROR_LIMIT        a side beyond ASJ_MAX_SIDE, more than ASJ_MAX_PIXELS, more than 2^24 L-junctions
 * ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED, ASJ_ERROR_DEVICE */
ASJ_API asj_status asj_features_load(asj_context *context, const void *bytes, size_t size, asj_features **features);

#ifdef __cplusplus
}
#endif
#endif
