/* SPDX-License-Identifier: BSD-2-Clause */
/* Where an output is written: a file of a new name beside the target, which takes its place when all is written. */
#include "place.h"
#include "place_system.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define NAMES 10000

/* A new file beside the target. -1 with errno set when that fails. */
static int create_temporary(asj_output_place *place)
{
    const size_t folder = asj_system_folder(place->target), size = folder + 64;
    place->temporary = malloc(size);
    if (!place->temporary)
        return -1;
    memcpy(place->temporary, place->target, folder);
    for (unsigned number = 0; number < NAMES; number++) {
        snprintf(place->temporary + folder, size - folder, ".asj-%ld-%u.tmp", asj_system_process(), number);
        const int file = asj_system_create(place->temporary);
        if (file >= 0)
            return file;
        if (errno != EEXIST)
            break;
    }
    const int error = errno;
    free(place->temporary); /* not ours: never to be removed */
    place->temporary = NULL;
    errno = error;
    return -1;
}

FILE *asj_place_open(asj_output_place *place, const char *path)
{
    int file = asj_system_open(path, &place->target);
    if (file < 0 && place->target) {
        file = create_temporary(place);
        if (file >= 0)
            asj_system_permit(file, place->target);
    }
    FILE *stream = file >= 0 ? asj_system_stream(file) : NULL;
    if (file >= 0 && !stream) {
        const int error = errno;
        asj_system_close(file);
        errno = error;
    }
    return stream;
}

int asj_place_keep(asj_output_place *place)
{
    if (!place->temporary)
        return 0;
    if (asj_system_replace(place->temporary, place->target))
        return errno;
    free(place->temporary); /* it has the final name now */
    place->temporary = NULL;
    return 0;
}

void asj_place_free(asj_output_place *place)
{
    if (place->temporary)
        asj_system_remove(place->temporary);
    free(place->temporary);
    free(place->target);
}
