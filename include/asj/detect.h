/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_DETECT_H
#define ASJ_DETECT_H

#include <asj/context.h>
#include <asj/image.h>
#include <asj/junction.h>
#include <asj/options.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Junctions of one image. The arrays belong to the result and are NULL when empty. */
typedef struct asj_detection {
    const asj_junction *junctions;     /* most meaningful first, before values became floats */
    const asj_l_junction *l_junctions; /* in order of their junction */
    uint32_t junction_count;
    uint32_t l_junction_count;
    int32_t width, height;             /* of the image */
    int32_t backend;                   /* ASJ_BACKEND_CPU or ASJ_BACKEND_OPENCL: what did the work */
    uint32_t edge_count;               /* of `edges` */
    double total_ms;                   /* wall time of the call */
    double stage_ms[16];               /* by ASJ_STAGE_... */
    uint64_t candidates;               /* pixels that reached the isotropic test */
    uint64_t isotropic;                /* junctions that passed it */
    const asj_edge *edges;             /* what joins two junctions; in order of junction_a, then of branch_a */
    uint64_t reserved[5];
} asj_detection;

/* Finds the anisotropic-scale junctions of an image: the pipeline of the paper, steps 1 to 6.
 *
 * image    a view; only read, and only during the call
 * options  NULL = preset `default`
 * result   on success *result belongs to the caller until asj_detection_free()
 *
 * Constant images, images of noise and images smaller than any sector are valid and give no junctions: in an image of noise preset
 * default finds `epsilon` junctions on average at most; preset match takes what is weaker, 600 to 1200 junctions in 640 x 480
 * pixels of it. The same image and options give the same result with any number of threads and on every back end.
 * Time: in proportion to the pixels, to the candidates, and to the length of all rays together: a chessboard of 5 px over a
 * megapixel, where those of 39 600 junctions are followed over half of the image, takes 16 s. Preset `paper`
 * follows 15 rays a branch in place of two: chessboards of 2000 x 1500 pixels take 6 times as long with it as with preset default,
 * of 4000 x 3000 9 times. How often the caller is asked whether to go on: asj_progress_callback (context.h).
 * Memory: about 7 bytes per pixel of the image, whatever the first octave, but 28 with first_octave -1; 2 more with half_octaves,
 * 13 more with seeds from line segments (preset `paper`), hardly more with colours; plus 2.6 MB and 1.1 to 1.5 MB a thread,
 * and for each junction 6 kB in photographs, up to 25 kB where branches are hundreds of pixels long: a photograph enlarged to 12
 * megapixels, with 32 000 junctions of preset match, took 285 MB.
 *
 * ASJ_ERROR_ARGUMENT   context, image or result is NULL
 * ASJ_ERROR_IMAGE      data NULL, unknown format, side < 1, stride shorter than a row or, times the height, beyond PTRDIFF_MAX;
 *                      `white` negative, NaN or infinite; floats that are NaN or infinite
 * ASJ_ERROR_LIMIT      more than ASJ_MAX_SIDE or ASJ_MAX_PIXELS, also of the upsampled image with first_octave -1
 * ASJ_ERROR_OPTION     an option out of range
 * ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED, ASJ_ERROR_DEVICE
 * asj_context_message() then says which and why. Thread safety: one call at a time per context. */
ASJ_API asj_status asj_detect(asj_context *context, const asj_image *image, const asj_detect_options *options,
                              asj_detection **result);

/* The same into a result of an earlier call, for streams of images: its memory is used again. `*result` may be NULL: it is then
 * made. After the first images of a size such a stream allocates nothing, neither for the context, which keeps its scratch memory,
 * nor for the result, unless an image holds half as many candidates or junctions again as any before it.
 * The arrays of the earlier result are overwritten: to keep the junctions of the last image beside those of this one, take turns
 * with two results. On failure *result is still the caller's, but empty; or NULL, if it was. */
ASJ_API asj_status asj_detect_into(asj_context *context, const asj_image *image, const asj_detect_options *options,
                                   asj_detection **result);

/* Where junctions are looked for. Zero = everywhere. */
typedef struct asj_region {
    const asj_image *mask;       /* gray8, of the size of the image: no junction where it is 0. NULL = none. Only read, and only
                                  * during the call; its white level means nothing */
    int32_t x, y, width, height; /* px: only junctions in this part of the image, which must lie within it; all 0 = everywhere */
    uint64_t reserved[4];        /* zero */
} asj_region;

/* asj_detect_into() in a part of the image. A junction is where the pixel is that its location rounds to; beyond the border of the
 * image, the nearest pixel of it. Pixels outside the region speak for or against junctions inside as ever, branches may leave it,
 * and as many tests count as without it: what is found is what the whole image gives, less what lies outside. (Lengths and weak
 * junctions at its border may differ, where a junction outside is not there to end a branch at or to compete with.) Time: step 1
 * stays, step 2 is that of the rows of the rectangle, all others that of the junctions inside.
 * `region` NULL = everywhere. Errors as asj_detect(), and
 * ASJ_ERROR_ARGUMENT   the rectangle leaves the image or is empty; a mask that is not gray8, or not of the image's size
 * ASJ_ERROR_OPTION     also a reserved field of the region that is not zero
 * ASJ_ERROR_IMAGE      also a mask without data, or with a stride shorter than a row */
ASJ_API asj_status asj_detect_region(asj_context *context, const asj_image *image, const asj_region *region,
                                     const asj_detect_options *options, asj_detection **result);

/* Does ahead what the first asj_detect() with these options and an image of this size would do once: makes tables, allocates what
 * depends on the size, compiles the kernels of the device. Lists of what an image shows come with the image. It detects the
 * junctions of a test picture of that size, so it takes as long as that. `options` NULL = preset `default`. Never needed; errors
 * and threads as asj_detect(). */
ASJ_API asj_status asj_prepare(asj_context *context, const asj_detect_options *options, int32_t width, int32_t height);

/* Frees a result and sets the pointer to NULL. NULL and a pointer to NULL are fine. */
ASJ_API void asj_detection_free(asj_detection **result);

/* Step 6 alone, for junctions from elsewhere (a file, another detector): every pair of branches of a junction that opens by at
 * least `minimum_opening` degrees and at most 180 minus that, in order; never one within 1e-6 rad of parallel.
 * Writes at most `capacity` L-junctions and returns how many there are in all (10 for each junction at most), so a first call with
 * capacity 0 tells the size. Junctions with a branch_count outside 0 .. ASJ_MAX_BRANCHES are passed over. */
ASJ_API size_t asj_decompose(const asj_junction *junctions, size_t junction_count, double minimum_opening,
                             asj_l_junction *l_junctions, size_t capacity);

#ifdef __cplusplus
}
#endif
#endif
