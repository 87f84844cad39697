/* SPDX-License-Identifier: BSD-2-Clause */
/* libasj-io: files for libasj. A second library, so that the core needs no file format. Everything here may be called from any
 * thread; nothing is kept between calls. */
#ifndef ASJ_IO_H
#define ASJ_IO_H

#include <asj/detect.h>
#include <asj/features.h>
#include <asj/image.h>
#include <asj/junction.h>
#include <asj/match.h>
#include <asj/segments.h>
#include <asj/vanishing.h>

#ifdef __cplusplus
extern "C" {
#endif

/* `message` of the functions below may be NULL, or has room for `message_size` bytes: on failure one line is written there, which
 * names the file and the cause. 512 bytes are plenty. */

/* Default limit on the pixels of an image file: 268 megapixels (2^28 pixels). A file that declares more is refused before its
 * pixels are decoded. */
#define ASJ_IO_DEFAULT_MAX_PIXELS 268435456

/* What a focal length from EXIF data rests on. */
enum {
    ASJ_EXIF_FOCAL_NONE = 0,    /* there is none */
    ASJ_EXIF_FOCAL_FILM = 1,    /* the focal length of the same view on 35 mm film, in whole mm */
    ASJ_EXIF_FOCAL_PLANE = 2,   /* the focal length, and the resolution on the focal plane */
    ASJ_EXIF_FOCAL_UNUSABLE = 3 /* the EXIF data are damaged, their focal length cannot be, or the picture was cut since,
                                 * or made smaller without their resolution */
};

/* An image read from a file; it owns its pixels. */
typedef struct asj_image_file {
    asj_image image;     /* view of the pixels: GRAY8, GRAY16, RGB8, BGR8 or GRAY_FLOAT */
    int32_t orientation; /* the EXIF orientation (1 .. 8) that was applied: the view is upright. 1 = none */
    int32_t focal_source;/* ASJ_EXIF_FOCAL_... */
    float focal_length;  /* px of `image`, from EXIF data; 0 = not known */
    int32_t has_more;    /* 1 = the file holds further pictures, which are not read: pages of a TIFF, frames of a PNG, views of a
                          * JPEG (MPO), pictures one after the other of a PNM */
} asj_image_file;

/* Reads an image: PNG (1 to 16 bits, palette, alpha, interlaced) and PNM (PBM, PGM, PPM, PAM, PFM) always; JPEG, TIFF, WebP, JPEG
 * 2000, HEIF, AVIF, BMP, Sun raster and Radiance HDR where the library was built with their readers (asj_io_image_formats()). The
 * content of the file decides which reader it gets, not its name. max_pixels 0 = ASJ_IO_DEFAULT_MAX_PIXELS. Of a file with several
 * pictures the first is read (has_more).
 *
 * Upright: the EXIF orientation of PNG, JPEG, TIFF and WebP is applied, so that coordinates are those of the picture as viewers
 * show it; HEIF and AVIF are turned and cropped as their own properties say. Transparency is ignored: the stored colours count.
 * 16-bit colour becomes GRAY16 and colour in floats GRAY_FLOAT, by the luma weights of image.h; floats are as stored, with 1.0 as
 * white.
 *
 * Focal length: from the EXIF data of PNG, JPEG and WebP where the library was built with libexif, and of TIFF. EXIF data that
 * cannot be read are no error.
 *
 * Damage: PNG is checked to the last checksum. A JPEG without its end marker is refused, and so is one whose compressed data the
 * decoder finds damaged, unless all that it found are surplus bytes at the end. Other formats are refused when they are truncated
 * or their decoder reports an error.
 * Size: a file that declares more than max_pixels, or a side longer than ASJ_MAX_SIDE, is refused before memory for its pixels is
 * taken. What is no image is known by its first 64 KiB, and read no further.
 * Processes: HEIF and AVIF are decoded by the program asj-io-heif, BMP, Sun raster and Radiance HDR by asj-io-opencv, which is
 * started for the one file and has ended when the call returns; its memory and time are limited by the size that the file declares.
 * Nothing else starts a process, and nothing is ever written to standard error.
 *
 * On success the caller owns *file until asj_image_file_free().
 * ASJ_ERROR_ARGUMENT     path or file is NULL
 * ASJ_ERROR_FILE         missing, a directory, unreadable
 * ASJ_ERROR_FORMAT       empty, not an image, no pixels, truncated, damaged (a wrong PNG checksum included)
 * ASJ_ERROR_LIMIT        more than max_pixels, a side longer than ASJ_MAX_SIDE, a file longer than 2^31 - 1 bytes, a JPEG of more
 *                        than 100 scans, a TIFF with a tile far larger than the image
 * ASJ_ERROR_UNSUPPORTED  an image format that this build cannot read; of one that it can, TIFF with samples or compression that
 *                        are not read, moving WebP, unusual JPEG 2000, HEIF or AVIF whose codec is missing; or the format's program
 *                        is not installed
 * ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_image_file_read(const char *path, uint64_t max_pixels, asj_image_file **file,
                                       char *message, size_t message_size);

/* Frees it and sets the pointer to NULL. NULL and a pointer to NULL are fine. Any thread. */
ASJ_API void asj_image_file_free(asj_image_file **file);

/* Writes a view as PNG, 8 or 16 bits as it is, but without alpha and without `white`, which PNG has no place for: set it again in
 * what is read back. The file appears whole or not at all.
 * ASJ_ERROR_ARGUMENT, ASJ_ERROR_IMAGE (floats, bad view), ASJ_ERROR_FILE, ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_png_write(const char *path, const asj_image *image, char *message, size_t message_size);

/* The formats that this build reads: "PNG, PNM, JPEG, ...". */
ASJ_API const char *asj_io_image_formats(void);

/* An output file that appears whole or not at all: it is written beside its place under another name and renamed by
 * asj_output_commit(). So a file that was there before stays until then, and stays for good when anything fails. "-" and
 * /dev/stdout are standard output; that, pipes and devices are written directly. A protected file is not replaced, a symbolic link
 * is followed, even to a file that is not there yet, and the permissions of a file that was there before are kept, where root
 * writes it its owner, too. A process that is killed in between leaves a file named .asj-NUMBER-NUMBER.tmp. What has been
 * committed is with the system, not on the disk: who fears for the power calls fsync() on file and folder. Under Windows a
 * symbolic link is replaced, and NUL and consoles are what is written directly. Thread safety: one thread at a time per output. */
typedef struct asj_output asj_output;

/* The absolute path of the file that an output of this path creates or replaces: folders resolved, symbolic links followed. So two
 * paths are one file when their targets are the same text. For what is no regular file the text means nothing.
 * ASJ_ERROR_ARGUMENT: a NULL pointer; ASJ_ERROR_FILE: the folder is missing, or target_size bytes are too few; ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_output_target(const char *path, char *target, size_t target_size);

/* On success the caller owns *output until commit or abort.
 * ASJ_ERROR_ARGUMENT  path or output is NULL
 * ASJ_ERROR_FILE      the folder is missing or protected, path is a directory, ...
 * ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_output_begin(const char *path, asj_output **output, char *message, size_t message_size);

/* Adds bytes, or a text without its final zero. ASJ_ERROR_ARGUMENT: a NULL pointer; ASJ_ERROR_FILE: this or an earlier write
 * failed (asj_output_commit() will fail too, and say why: the result here may be ignored). */
ASJ_API asj_status asj_output_write(asj_output *output, const void *data, size_t size);
ASJ_API asj_status asj_output_text(asj_output *output, const char *text);

/* Ends the output, and gives the file its name if every byte was written. *output is NULL afterwards, whatever happened.
 * ASJ_ERROR_ARGUMENT  no output
 * ASJ_ERROR_FILE      a write failed (disk full, ...), or the file cannot be renamed: nothing is left behind */
ASJ_API asj_status asj_output_commit(asj_output **output, char *message, size_t message_size);

/* Ends the output and leaves no file. NULL and a pointer to NULL are fine. */
ASJ_API void asj_output_abort(asj_output **output);

/* Formats of junction files: asj-formats(5). Numbers have a decimal point whatever the locale. In JSON and CSV they
 * read back to the same float; .asj has six decimals, as the paper's authors' program writes them. */
enum {
    ASJ_FILE_ASJ = 0,       /* .asj text, decomposed: one record of two branches for each L-junction (asj-formats(5)) */
    ASJ_FILE_ASJ_WHOLE = 1, /* .asj text with whole junctions of two to five branches */
    ASJ_FILE_JSON = 2,      /* schema "asj-junctions-1": everything, with options, version, back end and times */
    ASJ_FILE_CSV = 3        /* a header, then one line a branch: junction,x,y,scale,log10_nfa,location_sd,octave,branch,
                             * angle,length,strength,branch_log10_nfa,angle_sd,width,length_sd,end,to_junction,to_branch,
                             * edge_log10_nfa; the last three are empty where the branch is part of no edge. Of segments: x1,y1,x2,
                             * y2,sd1,sd2,end1,end2,junction1,junction2,log10_nfa,junction,branch,branches */
};

/* What is written. Only `detection` is needed. */
typedef struct asj_detection_report {
    const asj_detection *detection;
    const asj_detect_options *options; /* JSON: the options used; NULL = left out */
    const char *image_name;            /* JSON: NULL = left out */
    const asj_vanishing_points *vanishing_points; /* JSON: NULL = left out */
    const asj_segment_list *segments;  /* straight edges, each once: CSV has them in place of the branches, JSON beside them; NULL =
                                        * left out */
    uint64_t reserved[2];              /* zero */
} asj_detection_report;

/* Writes junctions as asj_output_begin() and asj_output_commit() do.
 * ASJ_ERROR_ARGUMENT  a NULL pointer, no such file format, or a detection that no reader would take: a junction that cannot be
 *                     (asj_junction_check()) or has fewer than two branches, NaN or infinity, an L-junction, edge or segment of a
 *                     junction or branch that is not there, a branch of two edges; JSON: options with NaN or infinity, a width or
 *                     height that is not 1 .. ASJ_MAX_SIDE. (Readers of JSON refuse a location more than ASJ_MAX_OUTSIDE px outside
 *                     of the image, too, and edges of branches that stand in no order of angle.)
 * ASJ_ERROR_OPTION    a reserved field of the report that is not zero
 * ASJ_ERROR_FILE      cannot create, disk full, cannot rename
 * ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_junctions_write(const char *path, int32_t file_format, const asj_detection_report *report,
                                       char *message, size_t message_size);

/* JSON lines, for very many images in one file: adds one line to an output, the object of ASJ_FILE_JSON without white space and
 * without its options and timing, which repeat. Whole lines are handed on at once, for who reads standard output or a pipe. The
 * caller keeps the output, and commits or aborts it. Nothing is written where the report is refused, and other lines may follow.
 * ASJ_ERROR_ARGUMENT  a NULL pointer, or a detection that asj_junctions_write() refuses as JSON
 * ASJ_ERROR_OPTION    a reserved field of the report that is not zero
 * ASJ_ERROR_FILE      this or an earlier write failed; no message: asj_output_commit() will fail too, and say why
 * ASJ_ERROR_MEMORY    where that is within the line, asj_output_commit() will fail too */
ASJ_API asj_status asj_junctions_write_line(asj_output *output, const asj_detection_report *report,
                                            char *message, size_t message_size);

/* The line of an image without a detection: {"schema": "asj-junctions-1", "image": {"name": ...}, "error": cause}. Both texts have
 * bytes that are no UTF-8 replaced. The rest is as above; ASJ_ERROR_ARGUMENT is a NULL pointer. */
ASJ_API asj_status asj_junctions_write_failed_line(asj_output *output, const char *image_name, const char *cause,
                                                   char *message, size_t message_size);

/* Line segments of matches (asj_match_report.lines). */
enum {
    ASJ_LINES_NONE = 0,
    ASJ_LINES_BRANCHES = 1, /* asj_match_segments() */
    ASJ_LINES_JOINED = 2    /* these, those of one edge as one: asj_join_segment_matches() */
};

/* What is written of a match. Only `result` is needed. */
typedef struct asj_match_report {
    const asj_match_result *result;
    int32_t lines;                       /* ASJ_LINES_...: line segments; CSV has them in place of the matches, JSON beside them */
    int32_t minimum_end;                 /* ASJ_END_...: line segments whose ends are less sure are left out */
    const asj_match_options *options;    /* JSON: the options used; NULL = left out */
    const asj_detect_options *detect_options; /* JSON: those of the detector; NULL = left out */
    const char *image_names[2];          /* JSON: NULL = left out */
    const char *junction_names[2];       /* JSON: files that the junctions were read from; NULL = left out */
    int32_t widths[2], heights[2];       /* JSON: of the images; 0 = left out */
    double stretch[2];                   /* JSON: of asj_match_images(), along x and y; 0 = left out */
    uint64_t reserved[2];                /* zero */
} asj_match_report;

/* Writes matches as asj_output_begin() and asj_output_commit() do. file_format:
 * ASJ_FILE_CSV   the header i,j,x1,y1,ax1,ay1,bx1,by1,x2,y2,ax2,ay2,bx2,by2,distance,ratio,h11,h12,h13,h21,h22,h23, then one
 *                line a match: L-junctions, location and both branch ends in image 1 and in image 2, distance, ratio ("inf" when
 *                there is no second best), affine map with nine digits. A line segment has no location (x1, y1, x2, y2 are
 *                empty), and its ends are a and b; the other columns are those of the match that it comes from.
 * ASJ_FILE_JSON  schema "asj-matches-1": everything, with options, version, back end and times. A ratio without a second best
 *                is null.
 * ASJ_ERROR_ARGUMENT  a NULL pointer, another file format, `lines` that are none of these, with lines a `minimum_end` that is
 *                     none, or a result that no reader would take: NaN or infinity, an L-junction that is not there
 * ASJ_ERROR_OPTION    a reserved field of the report that is not zero
 * ASJ_ERROR_FILE      cannot create, disk full, cannot rename
 * ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_matches_write(const char *path, int32_t file_format, const asj_match_report *report,
                                     char *message, size_t message_size);

/* Junctions read from a file. The arrays belong to it and are NULL when empty. */
typedef struct asj_junction_file {
    const asj_junction *junctions;
    const uint32_t *lines;         /* for each junction the line of the file where it begins, from 1: for messages */
    uint32_t junction_count;
    int32_t width, height;         /* of the image; 0 when the file does not say (.asj) */
    uint32_t edge_count;           /* JSON only */
    const asj_edge *edges;         /* in the order of the file */
    int32_t reserved[2];
} asj_junction_file;

/* Reads .asj text, as this library or the paper's authors' program writes it, or this library's JSON; the content decides which. A
 * byte order mark of UTF-8 before it is passed over.
 * Angles are brought into [0, 2 pi) and branches into order of angle. What .asj does not say (log10 NFA of a branch, uncertainties)
 * is 0. Repeated junctions stay as they are. On success the caller owns *file until asj_junction_file_free().
 * On failure the message names file, line and cause.
 * ASJ_ERROR_ARGUMENT  path or file is NULL
 * ASJ_ERROR_FILE      missing, a directory, unreadable
 * ASJ_ERROR_FORMAT    empty, not such a file, wrong counts, a junction that cannot be (asj_junction_check(), its angles brought
 *                     into range before) or has fewer than two branches, text after the end; .asj: no newline at the end;
 *                     JSON: a location more than ASJ_MAX_OUTSIDE px outside the image, edges of branches that are not there,
 *                     stand in no order of angle or are part of two edges
 * ASJ_ERROR_LIMIT     more than 2^24 junctions, a file longer than 2^31 - 1 bytes
 * ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_junctions_read(const char *path, asj_junction_file **file, char *message, size_t message_size);

/* Frees it and sets the pointer to NULL. NULL and a pointer to NULL are fine. Any thread. */
ASJ_API void asj_junction_file_free(asj_junction_file **file);

/* Features of an image as a file: asj-formats(5), .asjf. Written as asj_output_begin() and asj_output_commit() do.
 * ASJ_ERROR_ARGUMENT  a NULL pointer
 * ASJ_ERROR_LIMIT     more than 2^31 - 1 bytes: millions of L-junctions with colours
 * ASJ_ERROR_FILE      cannot create, disk full, cannot rename
 * ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_features_write(const char *path, const asj_features *features, char *message, size_t message_size);

/* Reads them back. The context computes what is not in the file. On success the caller owns *features until asj_features_free().
 * ASJ_ERROR_ARGUMENT  a NULL pointer
 * ASJ_ERROR_FILE      missing, a directory, unreadable
 * ASJ_ERROR_FORMAT, ASJ_ERROR_UNSUPPORTED, ASJ_ERROR_LIMIT, ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED, ASJ_ERROR_DEVICE
 *                     as asj_features_load(); a file longer than 2^31 - 1 bytes */
ASJ_API asj_status asj_features_read(asj_context *context, const char *path, asj_features **features,
                                     char *message, size_t message_size);

/* 1 when the file begins as a file of features does, whatever its name; 0 when it does not, cannot be read, or is no regular
 * file. */
ASJ_API int32_t asj_features_probe(const char *path);

#ifdef __cplusplus
}
#endif
#endif
