/* SPDX-License-Identifier: BSD-2-Clause */
/* .asjf: files of features. The library makes and reads the bytes; here they become files. */
#define _POSIX_C_SOURCE 200809L
#include "input.h"

#include <asj/io.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const unsigned char magic[] = {0x89, 'A', 'S', 'J', 'F'}; /* as much as tells the format; the rest is the library's */

int asj_input_is_features(const asj_input *head)
{
    return head->size >= sizeof magic && !memcmp(head->bytes, magic, sizeof magic);
}

static const char *is_no_features(const asj_input *head)
{
    return asj_input_is_features(head) ? NULL : "not a file of features (.asjf)";
}

int32_t asj_features_probe(const char *path)
{
    unsigned char head[sizeof magic];
    struct stat facts;
    FILE *file;
    int32_t found;
    if (!path || stat(path, &facts) || !S_ISREG(facts.st_mode)) /* what is read from a pipe is gone */
        return 0;
    file = fopen(path, "rb");
    if (!file)
        return 0;
    found = fread(head, 1, sizeof head, file) == sizeof head && !memcmp(head, magic, sizeof magic);
    fclose(file);
    return found;
}

asj_status asj_features_read(asj_context *context, const char *path, asj_features **features, char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, path);
    asj_input input;
    asj_status status;

    if (features)
        *features = NULL;
    if (!context || !path || !features)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no context, no path or no place for the features");
    status = asj_input_read(&input, is_no_features, &message);
    if (status != ASJ_OK)
        return status;
    status = asj_features_load(context, input.bytes, input.size, features);
    free(input.bytes);
    return status == ASJ_OK ? status : asj_message_fail(&message, status, "%s", asj_context_message(context));
}

asj_status asj_features_write(const char *path, const asj_features *features, char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, path);
    const size_t size = asj_features_save(features, NULL, 0);
    asj_output *output;
    asj_status status;
    void *bytes;

    if (!path || !features)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no path or no features");
    if (size > ASJ_INPUT_MAX_BYTES)
        return asj_message_fail(&message, ASJ_ERROR_LIMIT, "the features are %zu bytes, too many for a file", size);
    bytes = malloc(size);
    if (!bytes)
        return asj_message_fail(&message, ASJ_ERROR_MEMORY, "out of memory for %zu bytes of features", size);
    asj_features_save(features, bytes, size);
    status = asj_output_begin(path, &output, text, text_size);
    if (status == ASJ_OK) {
        asj_output_write(output, bytes, size);
        status = asj_output_commit(&output, text, text_size);
    }
    free(bytes);
    return status;
}
