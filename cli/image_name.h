/* SPDX-License-Identifier: BSD-2-Clause */
/* The image that a JSON file of junctions was made of. */
#ifndef ASJ_CLI_IMAGE_NAME_H
#define ASJ_CLI_IMAGE_NAME_H

#include <stddef.h>

/* Its name as `asj-cli detect` wrote it; 0 = the file does not tell. */
int cli_image_name_read(const char *path, char *name, size_t size);

/* Whether it is the name of `other` and not of `own`: in full, or without folders where that does not settle it. */
int cli_image_name_is_of(const char *name, const char *other, const char *own);

#endif
