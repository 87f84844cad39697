/* SPDX-License-Identifier: BSD-2-Clause */
/* libasj-io: files for libasj. A second library, so that the core needs no file format. Everything here may be called from any
 * thread; nothing is kept between calls. */
#ifndef ASJ_IO_H
#define ASJ_IO_H

#include <asj/detect.h>
#include <asj/image.h>
#include <asj/junction.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Every function below that can fail takes `message` (may be NULL) with room for `message_size` bytes, and on failure writes one
 * line there that names the file and the cause. 512 bytes are plenty. */

/* Default limit on the pixels of an image file: 256 megapixels. A file that declares more is refused before its pixels are
 * decoded. */
#define ASJ_IO_DEFAULT_MAX_PIXELS 268435456

/* An image read from a file; it owns its pixels. */
typedef struct asj_image_file {
    asj_image image;     /* view of the pixels: GRAY8, GRAY16, RGB8 or RGBA8; BGR8 or GRAY_FLOAT from OpenCV */
    int32_t orientation; /* the EXIF orientation (1 .. 8) that was applied: the view is upright. 1 = none */
    int32_t reserved[3];
} asj_image_file;

/* Reads an image. PNG through libpng (1 to 16 bits, palette, alpha, interlaced; eXIf orientation respected); every other format
 * through OpenCV's imgcodecs when the library was built with it (asj_io_has_opencv()). The content decides, not the name.
 * Transparency is ignored: the stored colours count. max_pixels 0 = ASJ_IO_DEFAULT_MAX_PIXELS.
 * On success the caller owns *file until asj_image_file_free().
 * ASJ_ERROR_ARGUMENT     path or file is NULL
 * ASJ_ERROR_FILE         missing, a directory, unreadable
 * ASJ_ERROR_FORMAT       empty, not an image, truncated, damaged (a wrong PNG checksum included)
 * ASJ_ERROR_LIMIT        more than max_pixels
 * ASJ_ERROR_UNSUPPORTED  a format that this build cannot read
 * ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_image_file_read(const char *path, uint64_t max_pixels, asj_image_file **file,
                                       char *message, size_t message_size);
ASJ_API void asj_image_file_free(asj_image_file **file);

/* Writes a GRAY8, GRAY16, RGB8 or RGBA8 view as PNG. The file appears whole or not at all.
 * ASJ_ERROR_ARGUMENT, ASJ_ERROR_IMAGE (other formats, bad view), ASJ_ERROR_FILE, ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_png_write(const char *path, const asj_image *image, char *message, size_t message_size);

/* 1 when formats other than PNG can be read. */
ASJ_API int32_t asj_io_has_opencv(void);

/* Formats of junction files. */
enum {
    ASJ_FILE_ASJ = 0,       /* .asj text, decomposed: one record of two branches for each L-junction (README.md, "File formats") */
    ASJ_FILE_ASJ_WHOLE = 1, /* .asj text with whole junctions of two to five branches */
    ASJ_FILE_JSON = 2,      /* schema "asj-junctions-1": everything, with options, version, back end and times */
    ASJ_FILE_CSV = 3        /* a header, then one line a branch: junction,x,y,scale,log10_nfa,branch,angle,length,... */
};

/* What is written. Only `detection` is needed. */
typedef struct asj_detection_report {
    const asj_detection *detection;
    const asj_detect_options *options; /* JSON: the options used; NULL = left out */
    const char *image_name;            /* JSON: NULL = left out */
    uint64_t reserved[4];              /* zero */
} asj_detection_report;

/* Writes junctions; path "-" is standard output. The file appears whole or not at all: it is written beside its place under
 * another name and renamed at the end.
 * ASJ_ERROR_ARGUMENT, ASJ_ERROR_FILE (cannot create, disk full, cannot rename), ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_junctions_write(const char *path, int32_t file_format, const asj_detection_report *report,
                                       char *message, size_t message_size);

/* Junctions read from a file. The arrays belong to it. */
typedef struct asj_junction_file {
    const asj_junction *junctions;
    uint32_t junction_count;
    int32_t width, height; /* of the image; 0 when the file does not say (.asj) */
    int32_t reserved[5];
} asj_junction_file;

/* Reads .asj text or this library's JSON; the content decides which. Angles are brought into [0, 2 pi) and branches into order of
 * angle. The message names the line.
 * ASJ_ERROR_ARGUMENT, ASJ_ERROR_FILE, ASJ_ERROR_MEMORY
 * ASJ_ERROR_FORMAT  wrong counts, NaN, infinity, negative lengths, more than ASJ_MAX_BRANCHES branches, text after the end
 * ASJ_ERROR_LIMIT   more than 2^24 junctions */
ASJ_API asj_status asj_junctions_read(const char *path, asj_junction_file **file, char *message, size_t message_size);
ASJ_API void asj_junction_file_free(asj_junction_file **file);

#ifdef __cplusplus
}
#endif
#endif
