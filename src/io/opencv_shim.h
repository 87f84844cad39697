/* SPDX-License-Identifier: BSD-2-Clause */
/* OpenCV's image decoders behind a C interface: the only C++ of the project. */
#ifndef ASJ_IO_OPENCV_SHIM_H
#define ASJ_IO_OPENCV_SHIM_H

#include <asj/status.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ASJ_OPENCV_U8, ASJ_OPENCV_U16, ASJ_OPENCV_F32, ASJ_OPENCV_F64, ASJ_OPENCV_OTHER };

typedef struct asj_opencv_image {
    void *matrix; /* keeps the pixels alive */
    const unsigned char *pixels;
    size_t stride;
    int32_t width, height;
    int32_t channels; /* in the order blue, green, red */
    int32_t sample;   /* ASJ_OPENCV_... */
} asj_opencv_image;

/* Decodes bytes from memory, or the file at `path` when that is not NULL. The depth and the number of colours stay; alpha goes;
 * EXIF orientation is not applied. ASJ_OK: release the image afterwards. ASJ_ERROR_FORMAT, ASJ_ERROR_MEMORY: `cause`, which has
 * room for cause_size bytes, says more or is empty. Never throws and prints nothing.
 *
 * OpenCV and the decoders below it write what they complain about to standard error and offer no other way to hear it. So, while
 * this function runs, standard error of the process goes into a pipe that is read here; a complaint about damaged data makes
 * the call fail. Calls from several threads wait for each other. */
asj_status asj_opencv_decode(const unsigned char *bytes, size_t size, const char *path, asj_opencv_image *image,
                             char *cause, size_t cause_size);
void asj_opencv_release(asj_opencv_image *image);

#ifdef __cplusplus
}
#endif
#endif
