/* SPDX-License-Identifier: BSD-2-Clause */
/* What place.c asks of the system. */
#ifndef ASJ_IO_PLACE_SYSTEM_H
#define ASJ_IO_PLACE_SYSTEM_H

#include <asj/status.h>

#include <stddef.h>
#include <stdio.h>

/* Every function that returns an int: -1, with errno set, when it fails. */

/* Opens `path` itself where it is an open file, a device or a pipe. A file that is to be written whole or not at all is not opened:
 * -1, and `target`, which is NULL before, names it (free() it): absolute or as given, symbolic links followed. */
int asj_system_open(const char *path, char **target);

/* Gives an open file the owner and the permissions of another, where that is there and it can be done. */
void asj_system_permit(int file, const char *as);

/* Opens a file that must not be there, which no other program inherits, with the permissions that new files get. */
int asj_system_create(const char *path);

/* Puts a file in the place of another one, in one step. */
int asj_system_replace(const char *from, const char *to);

int asj_system_remove(const char *path);
int asj_system_close(int file);
FILE *asj_system_stream(int file);
long asj_system_process(void);

/* asj_output_target() with arguments that were looked at. */
asj_status asj_system_resolve(const char *path, char *target, size_t target_size);

/* The number of bytes of the folder that `path` begins with, the separator included. */
size_t asj_system_folder(const char *path);

#endif
