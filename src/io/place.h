/* SPDX-License-Identifier: BSD-2-Clause */
/* Where an output is written: place.c over one of two systems, place_posix.c and place_windows.c. */
#ifndef ASJ_IO_PLACE_H
#define ASJ_IO_PLACE_H

#include <stdio.h>

typedef struct asj_output_place {
    char *target;    /* what is replaced at the end: absolute or as given, symbolic links followed */
    char *temporary; /* what is written; NULL = the target itself */
} asj_output_place;

/* Opens what will be written for `path` (include/asj/io.h tells what that is), bytes as they are. `place` is all zero before, and
 * asj_place_free() comes after, whether this fails or not: NULL with errno set, 0 = no memory. */
FILE *asj_place_open(asj_output_place *place, const char *path);

/* Gives what was written and closed its final name. 0, or an errno. */
int asj_place_keep(asj_output_place *place);

/* What was not kept is removed. */
void asj_place_free(asj_output_place *place);

#endif
