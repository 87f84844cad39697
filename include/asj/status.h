/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_STATUS_H
#define ASJ_STATUS_H

#include <stddef.h>
#include <stdint.h>

#ifndef ASJ_API
#if defined(_WIN32) && defined(ASJ_BUILD_SHARED)
#define ASJ_API __declspec(dllexport)
#elif defined(__GNUC__)
#define ASJ_API __attribute__((visibility("default")))
#else
#define ASJ_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* What a function reports. 0 is success, everything else is negative, leaves nothing half done and leaks nothing:
 * a pointer to a result that would have been made is NULL, an earlier result that was to be used again (asj_detect_into()) is
 * empty, other outputs are as they were (but for asj_local_field()). */
typedef int32_t asj_status;
enum {
    ASJ_OK = 0,
    ASJ_ERROR_ARGUMENT = -1,    /* a null pointer, or arguments that contradict each other */
    ASJ_ERROR_OPTION = -2,      /* an option that does not exist, is out of range, or is not a number */
    ASJ_ERROR_IMAGE = -3,       /* an image view that cannot be: no data, no size, a stride too short or too long, unknown format,
                                 * a white level that is none, NaN, infinity */
    ASJ_ERROR_LIMIT = -4,       /* larger than a documented limit (image side, number of pixels, file size, ..) */
    ASJ_ERROR_MEMORY = -5,      /* the allocator returned NULL */
    ASJ_ERROR_CANCELLED = -6,   /* the progress callback asked to stop */
    ASJ_ERROR_DEVICE = -7,      /* an explicitly requested back end or device is not there, or failed */
    ASJ_ERROR_FILE = -8,        /* a file cannot be opened, read, written or renamed (libasj-io) */
    ASJ_ERROR_FORMAT = -9,      /* a file was read but its content is damaged or not what it should be (libasj-io) */
    ASJ_ERROR_UNSUPPORTED = -10 /* this build lacks the part that would be needed (an image format, say) */
};

/* One line of English for a status, without a full stop; "unknown status" for a number that is none.
 * A static string. Thread safety: any thread, any time. */
ASJ_API const char *asj_status_string(asj_status status);

#ifdef __cplusplus
}
#endif
#endif
