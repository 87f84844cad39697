/* SPDX-License-Identifier: BSD-2-Clause */
/* Lines of JSON for all images of a run. */
#include "json_lines.h"
#include "message.h"

int cli_json_lines_begin(cli_json_lines *lines, cli_session *session, const char *path)
{
    char message[CLI_MESSAGE_SIZE];
    *lines = (cli_json_lines){.path = path};
    const asj_status status = asj_output_begin(path, &lines->output, message, sizeof message);
    return status == ASJ_OK ? CLI_SUCCESS : cli_session_fail(session, path, message, status);
}

/* A report that was refused has left the output as it was; after all else what follows would not be read. */
static void note(cli_json_lines *lines, asj_status status)
{
    lines->count += status == ASJ_OK;
    lines->short_of_memory |= status == ASJ_ERROR_MEMORY;
    lines->broken |= status == ASJ_ERROR_FILE || status == ASJ_ERROR_MEMORY;
}

asj_status cli_json_lines_add(cli_json_lines *lines, const asj_detection_report *report, char *message, size_t message_size)
{
    const asj_status status = asj_junctions_write_line(lines->output, report, message, message_size);
    note(lines, status);
    return status;
}

void cli_json_lines_add_failure(cli_json_lines *lines, const char *image, const char *cause)
{
    note(lines, asj_junctions_write_failed_line(lines->output, image, cause, NULL, 0));
}

int cli_json_lines_end(cli_json_lines *lines, cli_session *session, int keep)
{
    char message[CLI_MESSAGE_SIZE];
    if (!keep || lines->short_of_memory) { /* which was said with its line */
        asj_output_abort(&lines->output);
        return keep ? CLI_FAILED : CLI_SUCCESS;
    }
    const asj_status status = asj_output_commit(&lines->output, message, sizeof message);
    return status == ASJ_OK ? CLI_SUCCESS : cli_session_fail(session, lines->path, message, status);
}
