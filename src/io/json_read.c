/* SPDX-License-Identifier: BSD-2-Clause */
/* JSON of schema "asj-junctions-1": json_write.c. The outer object and the list of junctions are walked here, what is not needed is
 * passed over, and every other value is parsed by jansson, so that memory does not grow with the file and each junction's line is
 * known. */
#include "c_locale.h"
#include "json_skip.h"
#include "junction_formats.h"
#include "junction_graph.h"

#include <jansson.h>
#include <string.h>

#define SCHEMA "asj-junctions-1"

typedef struct json_reader {
    const char *next, *end;
    size_t line; /* of `next`, from 1 */
    const asj_message *message;
    asj_junction_list *list;
    int has_schema, has_image, has_junctions, has_edges;
    size_t sizeless; /* line of an image without a size, which only a line of an image that failed may have; 0 = none */
    json_t *error;   /* why it failed */
    size_t error_line;
} json_reader;

static char skip_space(json_reader *reader)
{
    for (; reader->next < reader->end; reader->next++) {
        if (*reader->next == '\n')
            reader->line++;
        else if (*reader->next != ' ' && *reader->next != '\t' && *reader->next != '\r')
            return *reader->next;
    }
    return '\0';
}

/* Passes over `wanted`, or fails. */
static asj_status expect(json_reader *reader, char wanted)
{
    char found = skip_space(reader);
    if (reader->next == reader->end)
        return asj_line_fail(reader->message, reader->line, "damaged JSON: the file ends where '%c' should follow", wanted);
    if (found != wanted)
        return asj_line_fail(reader->message, reader->line, "damaged JSON: expected '%c'", wanted);
    reader->next++;
    return ASJ_OK;
}

/* Passes over a ',' and sets *more, or over `close` and clears it. */
static asj_status expect_more(json_reader *reader, char close, int *more)
{
    if (skip_space(reader) == ',') {
        reader->next++;
        *more = 1;
        return ASJ_OK;
    }
    *more = 0;
    return expect(reader, close);
}

/* Passes over everything up to `stop`. */
static void go_to(json_reader *reader, const char *stop)
{
    for (; reader->next < stop; reader->next++)
        reader->line += *reader->next == '\n';
}

/* Where the next value ends. */
static asj_status find_end(json_reader *reader, const char **value_end)
{
    const char *stop;

    skip_space(reader);
    if (reader->next == reader->end)
        return asj_line_fail(reader->message, reader->line, "damaged JSON: the file ends where a value should follow");
    *value_end = asj_json_skip(reader->next, reader->end, &stop);
    if (*value_end)
        return ASJ_OK;
    go_to(reader, stop);
    return asj_line_fail(reader->message, reader->line, "damaged JSON: %s",
                         stop == reader->end ? "the file ends inside a value" : "a value that breaks off");
}

/* Jansson's own form of a value can be 25 times as long as its text. */
enum { LONGEST_VALUE = 1 << 20 };

/* Whether memory ran out. Jansson says so, or nothing, or takes a string that it has no room for for no token; what is none does
 * not come as far as this (find_end()). */
static int is_of_memory(const json_error_t *error)
{
    static const char no_token[] = "invalid token";
    return json_error_code(error) == json_error_out_of_memory || error->text[0] == '\0' ||
           !strncmp(error->text, no_token, sizeof no_token - 1);
}

/* Parses one value; the caller lets go of it. */
static asj_status read_value(json_reader *reader, json_t **value)
{
    const char *stop;
    json_error_t error;
    asj_status status = find_end(reader, &stop);

    if (status != ASJ_OK)
        return status;
    if (stop - reader->next > LONGEST_VALUE)
        return asj_line_fail(reader->message, reader->line, "a value longer than %d bytes", LONGEST_VALUE);
    *value = json_loadb(reader->next, (size_t)(stop - reader->next),
                        JSON_DECODE_ANY | JSON_DISABLE_EOF_CHECK | JSON_REJECT_DUPLICATES, &error);
    if (!*value) {
        if (is_of_memory(&error))
            return asj_message_fail(reader->message, ASJ_ERROR_MEMORY, "out of memory for JSON");
        return asj_line_fail(reader->message, reader->line + (size_t)(error.line > 0 ? error.line - 1 : 0), "damaged JSON: %s",
                             error.text);
    }
    go_to(reader, stop);
    return ASJ_OK;
}

/* A number of an object. `required` = 0: 0 when it is not there. */
static asj_status read_member(const json_reader *reader, size_t line, const json_t *object, const char *key, int required,
                              float *number)
{
    const json_t *value = json_object_get(object, key);
    *number = 0;
    if (!value && !required)
        return ASJ_OK;
    if (!json_is_number(value) || !asj_fits_float(json_number_value(value)))
        return asj_line_fail(reader->message, line, "\"%s\" is missing or no number of reasonable size", key);
    *number = (float)json_number_value(value);
    return ASJ_OK;
}

typedef struct member {
    const char *key;
    int required;
    float *number;
} member;

static asj_status read_members(const json_reader *reader, size_t line, const json_t *object, const member *members, size_t count)
{
    asj_status status = ASJ_OK;
    size_t i;
    if (!json_is_object(object))
        return asj_line_fail(reader->message, line, "a junction or branch is no object");
    for (i = 0; i < count && status == ASJ_OK; i++)
        status = read_member(reader, line, object, members[i].key, members[i].required, members[i].number);
    return status;
}

static asj_status read_branch(const json_reader *reader, size_t line, const json_t *object, asj_branch *branch)
{
    const member members[] = {{"angle", 1, &branch->angle},         {"length", 1, &branch->length},
                              {"strength", 0, &branch->strength},   {"log10_nfa", 0, &branch->log10_nfa},
                              {"angle_sd", 0, &branch->angle_sd},   {"width", 0, &branch->width},
                              {"length_sd", 0, &branch->length_sd}};
    asj_status status = read_members(reader, line, object, members, sizeof members / sizeof members[0]);
    const json_t *end = json_object_get(object, "end");
    if (status != ASJ_OK)
        return status;
    branch->end = !end ? ASJ_BRANCH_END_UNKNOWN : json_is_string(end) ? asj_end_of_word(json_string_value(end)) : -1;
    if (branch->end < 0)
        return asj_line_fail(reader->message, line, "\"end\" of a branch is no kind of end");
    asj_set_angle(branch, (double)branch->angle);
    return ASJ_OK;
}

static asj_status read_junction(const json_reader *reader, size_t line, const json_t *object)
{
    static const asj_junction none = {0};
    asj_junction junction = none;
    float octave = 0;
    const member members[] = {{"x", 1, &junction.x},         {"y", 1, &junction.y},
                              {"scale", 0, &junction.scale}, {"log10_nfa", 0, &junction.log10_nfa},
                              {"location_sd", 0, &junction.location_sd}, {"octave", 0, &octave}};
    asj_status status = read_members(reader, line, object, members, sizeof members / sizeof members[0]);
    const json_t *branches = json_object_get(object, "branches");
    size_t count = json_array_size(branches), b;

    if (status != ASJ_OK)
        return status;
    if (!(octave >= ASJ_LEAST_OCTAVE && octave <= ASJ_LARGEST_OCTAVE && octave == (float)(int32_t)octave))
        return asj_line_fail(reader->message, line, "\"octave\" must be a whole number from %d to %d", ASJ_LEAST_OCTAVE,
                             ASJ_LARGEST_OCTAVE);
    junction.octave = (int32_t)octave;
    if (count < 2 || count > ASJ_MAX_BRANCHES)
        return asj_line_fail(reader->message, line, "a junction must have \"branches\", 2 to %d of them", ASJ_MAX_BRANCHES);
    junction.branch_count = (int32_t)count;
    for (b = 0; b < count && status == ASJ_OK; b++)
        status = read_branch(reader, line, json_array_get(branches, b), &junction.branches[b]);
    return status == ASJ_OK ? asj_junction_list_add(reader->list, &junction, line, reader->message) : status;
}

static asj_status fail_second(const json_reader *reader, const char *key)
{
    return asj_line_fail(reader->message, reader->line, "\"%s\" stands here a second time", key);
}

/* An index of an edge; -1 when it is none. */
static json_int_t read_index(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    const json_int_t index = json_integer_value(value);
    return json_is_integer(value) && index >= 0 && index < (json_int_t)ASJ_JUNCTIONS_MAX ? index : -1;
}

static asj_status read_edge(const json_reader *reader, size_t line, const json_t *object)
{
    static const asj_edge none = {0};
    asj_edge edge = none;
    const json_int_t from = read_index(object, "junction_a"), to = read_index(object, "junction_b");
    const json_int_t one = read_index(object, "branch_a"), other = read_index(object, "branch_b");
    const member members[] = {{"log10_nfa", 0, &edge.log10_nfa}};
    asj_status status = read_members(reader, line, object, members, 1);

    if (status != ASJ_OK)
        return status;
    if (from < 0 || to < 0 || one < 0 || other < 0 || one >= ASJ_MAX_BRANCHES || other >= ASJ_MAX_BRANCHES)
        return asj_line_fail(reader->message, line, "an edge needs two junctions and their branches");
    edge.junction_a = (uint32_t)from;
    edge.junction_b = (uint32_t)to;
    edge.branch_a = (uint16_t)one;
    edge.branch_b = (uint16_t)other;
    return asj_junction_list_add_edge(reader->list, &edge, line, reader->message);
}

/* A list of junctions or of edges. */
static asj_status read_list(json_reader *reader, asj_status (*read)(const json_reader *, size_t, const json_t *), const char *key,
                            int *has)
{
    asj_status status = expect(reader, '[');
    int more = 1;

    if (status == ASJ_OK && *has)
        return fail_second(reader, key);
    *has = 1;
    if (status == ASJ_OK && skip_space(reader) == ']')
        return expect(reader, ']');
    while (status == ASJ_OK && more) {
        json_t *value = NULL;
        size_t line;
        skip_space(reader);
        line = reader->line;
        status = read_value(reader, &value);
        if (status == ASJ_OK)
            status = read(reader, line, value);
        json_decref(value);
        if (status == ASJ_OK)
            status = expect_more(reader, ']', &more);
    }
    return status;
}

static asj_status read_schema(json_reader *reader, const json_t *value)
{
    if (reader->has_schema)
        return fail_second(reader, "schema");
    reader->has_schema = 1;
    if (!json_is_string(value) || strcmp(json_string_value(value), SCHEMA))
        return asj_line_fail(reader->message, reader->line, "\"schema\" is not \"" SCHEMA "\"");
    return ASJ_OK;
}

static asj_status fail_size(const json_reader *reader, size_t line)
{
    return asj_line_fail(reader->message, line, "\"image\" needs a \"width\" and a \"height\" from 1 to %d", ASJ_MAX_SIDE);
}

static asj_status read_image(json_reader *reader, const json_t *value)
{
    json_int_t width = json_integer_value(json_object_get(value, "width"));
    json_int_t height = json_integer_value(json_object_get(value, "height"));

    if (reader->has_image)
        return fail_second(reader, "image");
    reader->has_image = 1;
    if (json_is_object(value) && !json_object_get(value, "width") && !json_object_get(value, "height")) {
        reader->sizeless = reader->line;
        return ASJ_OK;
    }
    if (width < 1 || height < 1 || width > ASJ_MAX_SIDE || height > ASJ_MAX_SIDE)
        return fail_size(reader, reader->line);
    reader->list->width = (int32_t)width;
    reader->list->height = (int32_t)height;
    return ASJ_OK;
}

/* The value of a key of the outer object. */
static asj_status read_entry(json_reader *reader, const char *key)
{
    json_t *value = NULL;
    asj_status status;

    if (!strcmp(key, "junctions"))
        return read_list(reader, read_junction, key, &reader->has_junctions);
    if (!strcmp(key, "edges"))
        return read_list(reader, read_edge, key, &reader->has_edges);
    const int is_error = !strcmp(key, "error") && !reader->error && skip_space(reader) == '"';
    if (strcmp(key, "schema") && strcmp(key, "image") && !is_error) {
        const char *stop;
        status = find_end(reader, &stop);
        if (status == ASJ_OK)
            go_to(reader, stop);
        return status;
    }
    status = read_value(reader, &value);
    if (status == ASJ_OK && is_error) {
        reader->error = json_incref(value);
        reader->error_line = reader->line;
    } else if (status == ASJ_OK)
        status = strcmp(key, "schema") ? read_image(reader, value) : read_schema(reader, value);
    json_decref(value);
    return status;
}

static asj_status read_object(json_reader *reader)
{
    asj_status status = expect(reader, '{');
    int more = 1;

    if (status == ASJ_OK && skip_space(reader) == '}') {
        status = expect(reader, '}');
        more = 0;
    }
    while (status == ASJ_OK && more) {
        json_t *key = NULL;
        status = read_value(reader, &key);
        if (status == ASJ_OK && !json_is_string(key))
            status = asj_line_fail(reader->message, reader->line, "damaged JSON: expected a key");
        if (status == ASJ_OK)
            status = expect(reader, ':');
        if (status == ASJ_OK)
            status = read_entry(reader, json_string_value(key));
        json_decref(key);
        if (status == ASJ_OK)
            status = expect_more(reader, '}', &more);
    }
    if (status == ASJ_OK && (skip_space(reader) || reader->next < reader->end))
        status = asj_line_fail(reader->message, reader->line, "text after the end%s",
                               skip_space(reader) == '{' ? ": of lines of JSON, which are an image each, a file may have one" : "");
    return status;
}

static asj_status check_locations(const json_reader *reader)
{
    const asj_junction_list *list = reader->list;
    size_t i;
    for (i = 0; list->width && i < list->count; i++) {
        const asj_junction *j = &list->junctions[i];
        if (!(j->x >= -ASJ_MAX_OUTSIDE && j->y >= -ASJ_MAX_OUTSIDE && j->x <= (float)(list->width - 1 + ASJ_MAX_OUTSIDE) &&
              j->y <= (float)(list->height - 1 + ASJ_MAX_OUTSIDE)))
            return asj_line_fail(reader->message, list->lines[i], "a junction outside the image of %d x %d pixels",
                                 (int)list->width, (int)list->height);
    }
    return ASJ_OK;
}

/* What asj_junctions_write_failed_line() writes in place of junctions, and what nobody writes. */
static asj_status check_failure(const json_reader *reader)
{
    if (reader->has_schema && !reader->has_junctions && reader->error)
        return asj_line_fail(reader->message, reader->error_line, "no junctions, but why the image has none: %s",
                             json_string_value(reader->error));
    return reader->sizeless ? fail_size(reader, reader->sizeless) : ASJ_OK;
}

asj_status asj_read_json(const asj_input *input, asj_junction_list *list, const asj_message *message)
{
    json_reader reader = {.next = (const char *)input->bytes, .end = (const char *)input->bytes + input->size, .line = 1,
                          .message = message, .list = list};
    asj_c_locale locale;
    asj_status status = asj_c_locale_begin(&locale, message);

    if (status != ASJ_OK)
        return status;
    status = read_object(&reader);
    asj_c_locale_end(&locale);
    if (status == ASJ_OK)
        status = check_failure(&reader);
    json_decref(reader.error);
    if (status == ASJ_OK && (!reader.has_schema || !reader.has_junctions))
        status = asj_line_fail(message, reader.line, "not a junction file: no \"schema\" or no \"junctions\"");
    if (status == ASJ_OK)
        status = check_locations(&reader);
    return status == ASJ_OK ? asj_junction_list_check_edges(list, message) : status;
}
