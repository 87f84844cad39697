/* SPDX-License-Identifier: BSD-2-Clause */
/* What the head and the structure of an image file say, of all formats, before a decoder sees it. */
#include "fuzz.h"

#include "image_probe.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    asj_image_probe probe;
    unsigned char *bytes = malloc(size ? size : 1); /* ends where the file ends */
    if (!bytes)
        return 0;
    if (size)
        memcpy(bytes, data, size);
    const asj_input input = {bytes, size};
    asj_probe_image(&input, &probe);
    fuzz_check((probe.kind == ASJ_KIND_UNKNOWN) == (probe.name == NULL), "a kind and a name that do not fit");
    fuzz_check(probe.orientation >= 1 && probe.orientation <= 8, "an orientation that EXIF does not know");
    fuzz_check(probe.codestream <= size, "a codestream behind the end");
    free(bytes);
    return 0;
}
