/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CONTEXT_H
#define ASJ_CONTEXT_H

#include <asj/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Where the data-parallel steps run. The results are the same everywhere. */
enum {
    ASJ_BACKEND_AUTO = 0,  /* an OpenCL GPU when there is one, else the CPU; never a CPU through OpenCL, which is slower. When the
                            * device fails, that image is done once more on the CPU, with one line of log (a warning); after
                            * three failures the context stays on the CPU. */
    ASJ_BACKEND_CPU = 1,   /* always there */
    ASJ_BACKEND_OPENCL = 2 /* an OpenCL device of any type, or ASJ_ERROR_DEVICE; failures of the device are errors */
};

/* Vector instructions of the processor. The results are the same with all of them. */
enum {
    ASJ_SIMD_AUTO = 0,      /* the best that this processor and this build have */
    ASJ_SIMD_REFERENCE = 1, /* none: the portable C of each step, which is its definition */
    ASJ_SIMD_SSE2 = 2,      /* x86 */
    ASJ_SIMD_AVX2 = 3,
    ASJ_SIMD_AVX512 = 4,    /* F, BW and VL */
    ASJ_SIMD_NEON = 5,      /* 64-bit ARM */
    ASJ_SIMD_VECTORS = 6,   /* any processor: what gcc or clang make of vectors, for those that have no form of their own */
    ASJ_SIMD_COUNT = 7
};

/* "auto", "reference", "sse2", ...; "unknown" outside the range. A static string. */
ASJ_API const char *asj_simd_name(int32_t simd);

enum { ASJ_LOG_ERROR = 0, ASJ_LOG_WARNING = 1, ASJ_LOG_INFO = 2, ASJ_LOG_DEBUG = 3 };

/* Steps of the pipeline, in order: names for progress reports, stage times and dumps. */
enum {
    ASJ_STAGE_GRADIENT = 0,   /* image -> normalised gradient */
    ASJ_STAGE_CANDIDATES = 1, /* local junction field -> pixels worth a junction test */
    ASJ_STAGE_ISOTROPIC = 2,  /* a-contrario test of isotropic junctions at the candidates */
    ASJ_STAGE_LOCATE = 3,     /* line fits: sub-pixel location, edge artefacts rejected, duplicates suppressed */
    ASJ_STAGE_SCAN = 4,       /* branch lengths by the ray test */
    ASJ_STAGE_REFINE = 5,     /* orientations, branch validation, final suppression */
    ASJ_STAGE_DECOMPOSE = 6,  /* L-junctions */
    ASJ_STAGE_PATCHES = 7,    /* matching: canonical or induced patches */
    ASJ_STAGE_DISTANCES = 8,  /* matching: all pairs */
    ASJ_STAGE_ALIGN = 9,      /* matching: affine maps refined on the images */
    ASJ_STAGE_ASSIGN = 10,    /* matching: ratio test, mutual check */
    ASJ_STAGE_COUNT = 11
};

/* "gradient", "candidates", ...; "unknown" outside the range. A static string. */
ASJ_API const char *asj_stage_name(int32_t stage);

/* Memory. Both functions or neither: asj_context_options_init() leaves the C library's here, so replace both. `allocate` returns at
 * least `size` bytes aligned for any C type, or NULL; `release` takes what `allocate` gave (never NULL). They are called from the
 * thread that calls the library only. */
typedef struct asj_allocator {
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *memory);
    void *user;
} asj_allocator;

/* One line of text without a newline, valid during the call. Called from the thread that calls the library. */
typedef void (*asj_log_callback)(void *user, int32_t level, const char *message);

/* Progress of the current call: stage (ASJ_STAGE_...) and how much of the whole call is done, in [0, 1], never falling.
 * Called from the thread that calls the library, a few dozen times a call, and every 50 ms or so where a step takes longer (at 12
 * megapixels up to 160 ms in detection, 500 ms where 1.6 million pairs are candidates). Return 0 to go on, anything else to stop:
 * the call then returns ASJ_ERROR_CANCELLED, within some milliseconds. asj_find_segments(), asj_find_vanishing_points() and
 * asj_geometry_estimate() cannot tell how much is done, and say 0. */
typedef int32_t (*asj_progress_callback)(void *user, int32_t stage, double done);

/* What a dump hands out: a plane of the pipeline, or a list of points. Valid during the call only. An image that is done once more
 * because the device failed (ASJ_BACKEND_AUTO) hands out everything once more. Each octave hands out everything in its own pixels,
 * the finest first; with colours the luma's first, then those of red against green and of blue against yellow; with three_sizes all
 * of that of the image, then of its smaller and its larger copy. */
enum {
    ASJ_DUMP_PLANE_U16 = 1, /* width x height uint16_t, row by row, `stride` elements apart */
    ASJ_DUMP_PLANE_I16 = 2, /* the same, int16_t */
    ASJ_DUMP_POINTS = 3     /* `count` times two int32_t: x, y */
};
typedef struct asj_dump {
    int32_t stage;    /* ASJ_STAGE_... */
    int32_t kind;     /* ASJ_DUMP_... */
    const char *name; /* "gray", "gradient_x", "gradient_y", "candidates", "isotropic"; what is left of these after each decision:
                       * "opening", "guessed", "distinct", "fitted", "apart", "located", "validated" (and not hidden by a
                       * better one); "junctions". What a better one hid that fails later gets a second choice, and is in the last
                       * two only */
    const void *data;
    int32_t width;    /* planes */
    int32_t height;
    ptrdiff_t stride; /* planes: elements from row to row */
    size_t count;     /* points */
    double unit;      /* planes: multiply a sample by it to get grey levels ("gray") or normalised units */
} asj_dump;
typedef void (*asj_dump_callback)(void *user, const asj_dump *dump);

/* A store of compiled kernels, which saves their compilation at the next start. Either function may be NULL. They are called from
 * the thread that calls the library. The library checks what it gets: entries may be damaged, cut, or of another device.
 * `key` is a short text of letters, digits, '-', '_' and '.', different for every device, driver and source.
 * get  returns the size of the entry, 0 when there is none, and copies the entry when it fits into `capacity` bytes
 * put  stores `size` bytes, or does not: failures are no concern of the library. Not called for PoCL, which has a store of its own
 *      and would compile everything twice */
typedef struct asj_kernel_cache {
    size_t (*get)(void *user, const char *key, void *data, size_t capacity);
    void (*put)(void *user, const char *key, const void *data, size_t size);
    void *user;
} asj_kernel_cache;

/* Threads of the caller's own, for programs that have a pool already. Calls task(job, number) once for each number 0 .. count - 1,
 * on any threads, at once or one after the other, and returns when all have returned. The tasks take their work from one queue, so
 * one that begins late finds nothing left to do and returns at once, and what a pool that is full or closing leaves undone is done
 * by the calling thread when the callback has returned. `count` is at most the number of threads of the context. Tasks need 32 kB
 * of stack; the calling thread needs 64 kB, and 128 kB where two-view geometry is asked for.
 * Called from the thread that calls the library, a few dozen times a call. Progress is reported in the middle of a step only while
 * a task runs on that thread. A library that was built without threads does not call it. */
typedef void (*asj_parallel_task)(void *job, int32_t number);
typedef void (*asj_parallel_callback)(void *user, int32_t count, asj_parallel_task task, void *job);

#define ASJ_MAX_THREADS 256 /* of a context */

/* How a context is made. Fill it with asj_context_options_init() and change what you need: fields added later take their
 * defaults from there; what is reserved and not zero is refused (ASJ_ERROR_OPTION). */
typedef struct asj_context_options {
    int32_t backend;                /* ASJ_BACKEND_..., default auto */
    int32_t threads;                /* threads of the CPU path, 0 .. ASJ_MAX_THREADS; default 0 = as many as processors. The
                                     * results do not depend on it. Each takes memory of its own, about 1 MB (detect.h). 1 when the
                                     * library was built without threads. */
    const char *device;             /* which OpenCL device: its number in asj_device_list, "gpu", "cpu", "accelerator", or a part
                                     * of its name or its platform's, upper or lower case; the first that can be used is taken.
                                     * Default NULL = any, GPUs first. ASJ_BACKEND_AUTO looks at GPUs only. */
    asj_allocator allocator;        /* default: malloc and free */
    asj_log_callback log;           /* default NULL = silence */
    void *log_user;
    int32_t log_level;              /* ASJ_LOG_...: most detailed level wanted, default ASJ_LOG_WARNING */
    int32_t simd;                   /* ASJ_SIMD_...: forces the form of what the CPU does, for comparisons; default auto. */
    asj_progress_callback progress; /* default NULL */
    void *progress_user;
    asj_dump_callback dump;         /* default NULL; costs nothing when NULL */
    void *dump_user;
    asj_kernel_cache kernel_cache;  /* default: none */
    asj_parallel_callback parallel; /* default NULL = threads of the context's own, which sleep between loops */
    void *parallel_user;
    uint64_t reserved[11];          /* zero */
} asj_context_options;

/* Fills in the defaults. NULL is left alone. */
ASJ_API void asj_context_options_init(asj_context_options *options);

/* Everything that lives from call to call: tables, scratch memory, threads, device. A context serves one thread at a time; several
 * contexts may run at once, and there is no state outside them but a lock under which OpenCL starts. About 1 MB, plus scratch
 * memory of the detector and the matcher, which is kept for the next call: a detection or matching that does what the one
 * before did allocates nothing but its result, and, in the matcher, its lists of 4 MB and more. What several calls in a row had no
 * use for is given back. Without an allocator of the caller's smaller blocks share up to four pages of 2 MB once an image has 0.6
 * megapixels.
 * Threads, one less than `threads`, are made by the first call that is worth them; when the system gives fewer, these do. They
 * sleep when there is no call, block all signals, and end in asj_context_free(). The child of a fork() that did not come in the
 * middle of a call may go on with a context that has no device, and makes threads of its own.
 * The functions in the options may not use the context that calls them. Log, progress, dump and kernel cache that try get
 * ASJ_ERROR_ARGUMENT, and asj_context_free() leaves it alone; allocator and parallel are not watched. They return to the library:
 * what leaves one otherwise (an exception of C++, a panic of Rust, longjmp()) must be caught in it, since the call cannot be ended
 * so; progress ends one by what it returns. */
typedef struct asj_context asj_context;

/* Makes a context. `options` NULL = the defaults. On success the caller owns *context until asj_context_free().
 * ASJ_ERROR_ARGUMENT  context is NULL, or only one of the allocator's functions is given
 * ASJ_ERROR_OPTION    backend, threads, simd or log_level out of range, a reserved field that is not zero: the log says which
 * ASJ_ERROR_MEMORY
 * ASJ_ERROR_DEVICE    ASJ_BACKEND_OPENCL, and there is no such device: the log has the reason of each, one line for each; or vector
 *                     instructions (simd) that this processor or this build lacks: the log says which of both */
ASJ_API asj_status asj_context_create(const asj_context_options *options, asj_context **context);

/* Frees a context and sets the pointer to NULL. NULL and a pointer to NULL are fine. Results made with the context stay valid
 * as long as its allocator does: any thread may read them, several at once, and any thread may free one with its _free(), whatever
 * their context does meanwhile; that calls the allocator's release() in that thread. Functions without a context (names, options,
 * asj_decompose(), asj_match_segments(), asj_join_segment_matches()) are for any thread at any time, too. */
ASJ_API void asj_context_free(asj_context **context);

/* What went wrong in the context's last failed call, with names and numbers; "" before the first failure. Valid until the next
 * call with this context. A call from a hook that is refused is a failed call, too, though the one around it succeeds. For a NULL
 * context a fixed text: a call without a context leaves no message anywhere. */
ASJ_API const char *asj_context_message(const asj_context *context);

/* Number of threads that the CPU path uses. 0 for a NULL context. */
ASJ_API int32_t asj_context_threads(const asj_context *context);

/* The vector instructions that the CPU path uses: ASJ_SIMD_..., never auto. ASJ_SIMD_AUTO for a NULL context. */
ASJ_API int32_t asj_context_simd(const asj_context *context);

/* Bytes that the context holds at the moment, and the most it has held since it was made; results, which are the caller's, and
 * what OpenCL holds apart. Either pointer may be NULL. */
ASJ_API void asj_context_memory(const asj_context *context, uint64_t *now, uint64_t *peak);

#ifdef __cplusplus
}
#endif
#endif
