/* SPDX-License-Identifier: BSD-2-Clause */
/* .asj text: text_write.c describes it. One item a line, fields apart by blanks; empty lines are passed over. Every line has an
 * end: of a file that is cut within its last number what is left may be another number. */
#include "junction_formats.h"

#include "number.h"

#include <string.h>

#define MAX_FIELDS 5

typedef struct text_field {
    const char *text;
    size_t length;
} text_field;

typedef struct text_reader {
    const char *next, *end;
    size_t line; /* of the fields below, from 1 */
    text_field fields[MAX_FIELDS];
    size_t field_count; /* MAX_FIELDS = that many or more */
    int line_is_whole;  /* it has its end */
    const asj_message *message;
} text_reader;

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static void split(text_reader *reader, const char *line, const char *line_end)
{
    reader->field_count = 0;
    while (line < line_end && reader->field_count < MAX_FIELDS) {
        text_field *field = &reader->fields[reader->field_count];
        while (line < line_end && is_blank(*line))
            line++;
        field->text = line;
        while (line < line_end && !is_blank(*line))
            line++;
        field->length = (size_t)(line - field->text);
        reader->field_count += field->length > 0;
    }
}

/* Splits the next line that is not empty. 0 at the end of the file. */
static int next_line(text_reader *reader)
{
    while (reader->next < reader->end) {
        const char *line = reader->next;
        const char *line_end = memchr(line, '\n', (size_t)(reader->end - line));
        reader->next = line_end ? line_end + 1 : reader->end;
        reader->line++;
        split(reader, line, line_end ? line_end : reader->end);
        if (reader->field_count) {
            reader->line_is_whole = line_end != NULL;
            return 1;
        }
    }
    return 0;
}

enum { MOST_SHOWN = 40 }; /* bytes of a damaged field that are told */

/* A field as it may stand in a message: of a damaged file it may be anything. */
static const char *shown(const text_field *field, char text[MOST_SHOWN + 1])
{
    const size_t length = field->length < MOST_SHOWN ? field->length : MOST_SHOWN;
    size_t i;
    for (i = 0; i < length; i++)
        text[i] = field->text[i] < ' ' || field->text[i] > '~' ? '?' : field->text[i];
    text[length] = '\0';
    return text;
}

/* The next line as `count` numbers; `what` says what they are. */
static asj_status read_numbers(text_reader *reader, double *numbers, size_t count, const char *what)
{
    size_t i;
    if (!next_line(reader))
        return asj_line_fail(reader->message, reader->line, "the file ends where '%s' should follow", what);
    if (reader->field_count != count)
        return asj_line_fail(reader->message, reader->line, "expected '%s'", what);
    for (i = 0; i < count; i++) {
        const text_field *field = &reader->fields[i];
        char text[MOST_SHOWN + 1];
        if (!asj_number_parse(field->text, field->length, &numbers[i]) || !asj_fits_float(numbers[i]))
            return asj_line_fail(reader->message, reader->line, "'%s' is no finite number ('%s')", shown(field, text), what);
    }
    return ASJ_OK;
}

static asj_status read_count(text_reader *reader, long long *count)
{
    const text_field *field = &reader->fields[0];
    if (!next_line(reader))
        return asj_line_fail(reader->message, 1, "no number of junctions");
    if (reader->field_count != 1 || !asj_number_parse_integer(field->text, field->length, count) || *count < 0)
        return asj_line_fail(reader->message, reader->line, "not a junction file: the first line must be the number of junctions");
    if (*count > (long long)ASJ_JUNCTIONS_MAX)
        return asj_message_fail(reader->message, ASJ_ERROR_LIMIT, "line %zu: %lld junctions are more than %u", reader->line, *count,
                                ASJ_JUNCTIONS_MAX);
    return ASJ_OK;
}

static asj_status read_branches(text_reader *reader, asj_junction *junction)
{
    double numbers[3];
    int32_t b;
    for (b = 0; b < junction->branch_count; b++) {
        asj_status status = read_numbers(reader, numbers, 3, "theta strength length");
        if (status != ASJ_OK)
            return status;
        if (numbers[2] < 0)
            return asj_line_fail(reader->message, reader->line, "a branch of negative length");
        asj_set_angle(&junction->branches[b], numbers[0]);
        junction->branches[b].strength = (float)numbers[1];
        junction->branches[b].length = (float)numbers[2];
    }
    return ASJ_OK;
}

static asj_status read_junction(text_reader *reader, asj_junction_list *list)
{
    static const asj_junction none = {0};
    asj_junction junction = none;
    double place[2], head[4];
    long long branches;
    size_t line;
    asj_status status = read_numbers(reader, place, 2, "x y");

    line = reader->line;
    if (status == ASJ_OK)
        status = read_numbers(reader, head, 4, "M scale r_d logNFA");
    if (status != ASJ_OK)
        return status;
    if (!asj_number_parse_integer(reader->fields[0].text, reader->fields[0].length, &branches) || branches < 2 ||
        branches > ASJ_MAX_BRANCHES)
        return asj_line_fail(reader->message, reader->line, "the number of branches must be 2 to %d", ASJ_MAX_BRANCHES);
    if (head[1] < 0 || head[2] < 0)
        return asj_line_fail(reader->message, reader->line, "a negative scale");
    junction.x = (float)place[0];
    junction.y = (float)place[1];
    junction.scale = (float)head[1];
    junction.log10_nfa = (float)head[3];
    junction.branch_count = (int32_t)branches;
    status = read_branches(reader, &junction);
    return status == ASJ_OK ? asj_junction_list_add(list, &junction, line, reader->message) : status;
}

asj_status asj_read_text(const asj_input *input, asj_junction_list *list, const asj_message *message)
{
    static const text_reader start = {0};
    text_reader reader = start;
    long long count = 0, i;
    asj_status status;

    reader.next = (const char *)input->bytes;
    reader.end = reader.next + input->size;
    reader.message = message;
    status = read_count(&reader, &count);
    for (i = 0; i < count && status == ASJ_OK; i++)
        status = read_junction(&reader, list);
    if (status == ASJ_OK && next_line(&reader))
        status = asj_line_fail(message, reader.line, "text after the last of %lld junctions", count);
    if (status == ASJ_OK && !reader.line_is_whole)
        status = asj_line_fail(message, reader.line, "the file ends within its last line: it was cut, or lacks the newline there");
    return status;
}
