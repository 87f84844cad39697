/* SPDX-License-Identifier: BSD-2-Clause */
/* Output files that appear whole or not at all: written under another name in the same folder, renamed at the end. What is no
 * regular file (standard output, a pipe, a device) cannot be renamed over and is written directly. */
#include "output.h"

#include "message.h"
#include "place.h"
#include "place_system.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct asj_output {
    FILE *stream;
    int error;  /* errno of the first failed write, or 0 */
    char *path; /* as the caller gave it, for messages */
    asj_output_place place;
};

static void output_free(asj_output *output)
{
    asj_place_free(&output->place);
    free(output->path);
    free(output);
}

asj_status asj_output_target(const char *path, char *target, size_t target_size)
{
    if (!path || !target)
        return ASJ_ERROR_ARGUMENT;
    return asj_system_resolve(path, target, target_size);
}

asj_status asj_output_begin(const char *path, asj_output **output, char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, path);
    asj_output *opened;
    const size_t path_size = path ? strlen(path) + 1 : 0;

    if (output)
        *output = NULL;
    if (!path || !output)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no path or no place for the output");
    if (!*path)
        return asj_message_fail(&message, ASJ_ERROR_FILE, "an empty path names no file");
    opened = calloc(1, sizeof *opened);
    if (!opened || !(opened->path = malloc(path_size))) {
        free(opened);
        return asj_message_fail(&message, ASJ_ERROR_MEMORY, "out of memory");
    }
    memcpy(opened->path, path, path_size);
    errno = 0;
    opened->stream = asj_place_open(&opened->place, path);
    if (!opened->stream) {
        const int error = errno ? errno : ENOMEM;
        output_free(opened);
        return asj_message_errno(&message, error, "cannot create");
    }
    *output = opened;
    return ASJ_OK;
}

asj_status asj_output_write(asj_output *output, const void *data, size_t size)
{
    if (!output || (!data && size))
        return ASJ_ERROR_ARGUMENT;
    if (output->error)
        return ASJ_ERROR_FILE;
    errno = 0;
    if (fwrite(data, 1, size, output->stream) != size) {
        output->error = errno ? errno : EIO;
        return ASJ_ERROR_FILE;
    }
    return ASJ_OK;
}

asj_status asj_output_text(asj_output *output, const char *text)
{
    return text ? asj_output_write(output, text, strlen(text)) : ASJ_ERROR_ARGUMENT;
}

const char *asj_output_path(const asj_output *output)
{
    return output->path;
}

asj_status asj_output_flush(asj_output *output)
{
    errno = 0;
    if (!output->error && fflush(output->stream))
        output->error = errno ? errno : EIO;
    return output->error ? ASJ_ERROR_FILE : ASJ_OK;
}

void asj_output_spoil(asj_output *output, int error)
{
    if (!output->error)
        output->error = error;
}

asj_status asj_output_commit(asj_output **output, char *text, size_t text_size)
{
    asj_output *ending = output ? *output : NULL;
    asj_message message = asj_message_start(text, text_size, ending ? ending->path : NULL);
    asj_status status = ASJ_OK;

    if (!ending)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no output to commit");
    *output = NULL;
    errno = 0;
    if (fclose(ending->stream) && !ending->error)
        ending->error = errno ? errno : EIO;
    if (ending->error) {
        status = asj_message_errno(&message, ending->error, "cannot write");
    } else {
        const int error = asj_place_keep(&ending->place);
        if (error)
            status = asj_message_errno(&message, error, "cannot rename into place");
    }
    output_free(ending);
    return status;
}

void asj_output_abort(asj_output **output)
{
    if (!output || !*output)
        return;
    fclose((*output)->stream);
    output_free(*output);
    *output = NULL;
}
