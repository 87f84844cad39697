/* SPDX-License-Identifier: BSD-2-Clause */
/* Junction files: reads the bytes, chooses the reader by content. */
#include "image_probe.h"
#include "junction_formats.h"

#include <stdlib.h>
#include <string.h>

typedef struct owned_junctions {
    asj_junction_file file; /* what the caller sees: first */
    asj_junction_list list;
} owned_junctions;

static int looks_like_json(const asj_input *input)
{
    size_t i = 0;
    while (i < input->size && strchr(" \t\r\n", input->bytes[i] ? input->bytes[i] : 'x'))
        i++;
    return i < input->size && (input->bytes[i] == '{' || input->bytes[i] == '[');
}

static int begins_with(const asj_input *input, const char *text)
{
    const size_t size = strlen(text);
    return input->size >= size && !memcmp(input->bytes, text, size);
}

/* What lies at hand in place of a junction file is named, since a line of it means nothing to who has taken the wrong one. */
static const char *is_no_junctions(const asj_input *head)
{
    if (asj_input_is_features(head))
        return "features of an image, not its junctions";
    if (asj_probe_kind(head) != ASJ_KIND_UNKNOWN)
        return "an image, not its junctions";
    if (begins_with(head, "\xff\xfe") || begins_with(head, "\xfe\xff"))
        return "text as UTF-16, which the > of PowerShell writes, not as UTF-8";
    if (memchr(head->bytes, 0, head->size))
        return "not text: it has a byte of value 0";
    if (begins_with(head, "junction,x,y,") || begins_with(head, "x1,y1,x2,y2,"))
        return "CSV, which is not read back: .asj and JSON are";
    return NULL;
}

/* Without the byte order mark that editors on Windows put before UTF-8. */
static asj_input without_mark(const asj_input *input)
{
    static const char mark[] = "\xef\xbb\xbf";
    asj_input rest = *input;
    if (begins_with(input, mark)) {
        rest.bytes += sizeof mark - 1;
        rest.size -= sizeof mark - 1;
    }
    return rest;
}

static void publish(owned_junctions *owned)
{
    owned->file.junctions = owned->list.junctions;
    owned->file.lines = owned->list.lines;
    owned->file.junction_count = (uint32_t)owned->list.count;
    owned->file.width = owned->list.width;
    owned->file.height = owned->list.height;
    owned->file.edges = owned->list.edges;
    owned->file.edge_count = (uint32_t)owned->list.edge_count;
}

asj_status asj_junctions_read(const char *path, asj_junction_file **file, char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, path);
    owned_junctions *owned;
    asj_junction_file *result;
    asj_input input, text_input;
    asj_status status;

    if (file)
        *file = NULL;
    if (!path || !file)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no path or no place for the junctions");
    status = asj_input_read(&input, is_no_junctions, &message);
    if (status != ASJ_OK)
        return status;
    text_input = without_mark(&input);
    owned = calloc(1, sizeof *owned);
    if (!owned)
        status = asj_message_fail(&message, ASJ_ERROR_MEMORY, "out of memory");
    else
        status = (looks_like_json(&text_input) ? asj_read_json : asj_read_text)(&text_input, &owned->list, &message);
    free(input.bytes);
    if (!owned)
        return status;
    publish(owned);
    result = &owned->file;
    if (status == ASJ_OK)
        *file = result;
    else
        asj_junction_file_free(&result);
    return status;
}

void asj_junction_file_free(asj_junction_file **file)
{
    owned_junctions *owned;
    if (!file || !*file)
        return;
    owned = (owned_junctions *)(void *)*file;
    free(owned->list.junctions);
    free(owned->list.lines);
    free(owned->list.edges);
    free(owned->list.edge_lines);
    free(owned);
    *file = NULL;
}
