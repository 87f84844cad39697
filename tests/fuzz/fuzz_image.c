/* SPDX-License-Identifier: BSD-2-Clause */
/* Image files. HEIF, BMP, Sun raster and Radiance HDR are left out: they start a process each. */
#include "fuzz.h"

#include <asj/io.h>

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    asj_image_file *file = NULL;
    char message[256] = "";
    asj_status status;

    if (size > 8 && !memcmp(data + 4, "ftyp", 4))
        return 0;
    if (size > 2 && (!memcmp(data, "BM", 2) || !memcmp(data, "#?", 2) || !memcmp(data, "\x59\xa6", 2)))
        return 0;
    status = asj_image_file_read(fuzz_file(data, size), 1 << 20, &file, message, sizeof message);
    fuzz_check((status == ASJ_OK) == (file != NULL), "a status and a result that do not fit");
    fuzz_check((status == ASJ_OK) == !*message, "a status and a message that do not fit");
    fuzz_check(status == ASJ_OK || status == ASJ_ERROR_FORMAT || status == ASJ_ERROR_LIMIT || status == ASJ_ERROR_UNSUPPORTED ||
               status == ASJ_ERROR_MEMORY, "a status that is not documented");
    if (file) { /* every pixel is there */
        const unsigned char *pixels = file->image.data;
        volatile unsigned sum = 0;
        size_t count = (size_t)file->image.width * (size_t)file->image.height, i;
        for (i = 0; i < count; i++)
            sum += pixels[i];
        (void)sum; /* set and never asked for, says clang */
    }
    asj_image_file_free(&file);
    return 0;
}
