/* SPDX-License-Identifier: BSD-2-Clause */
/* Names of images, more than a command line holds. */
#ifndef ASJ_CLI_IMAGE_LIST_H
#define ASJ_CLI_IMAGE_LIST_H

#include <stddef.h>

typedef struct cli_image_list {
    char **names; /* in `text`, and those of the command line, where they are */
    size_t count;
    char *text;
} cli_image_list;

/* The `given` names of the command line, then those in a file ("-": standard input; NULL: none): one a line, or, where there is a
 * zero byte, one before each of these, as `find -print0` writes them. CLI_SUCCESS, or CLI_FAILED after saying why.
 * cli_image_list_free() in every case. */
int cli_image_list_make(char **given, size_t given_count, const char *file, cli_image_list *list);
void cli_image_list_free(cli_image_list *list);

#endif
