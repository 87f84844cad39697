/* SPDX-License-Identifier: BSD-2-Clause */
/* Junction files, text and JSON. What is read can be written, and then read to the same. */
#include "fuzz.h"

#include <asj/io.h>

#include <stdlib.h>
#include <string.h>

static void check_junction(const asj_junction *junction)
{
    int32_t b;
    fuzz_check(junction->branch_count >= 2 && junction->branch_count <= ASJ_MAX_BRANCHES, "a branch count out of range");
    fuzz_check(junction->x - junction->x == 0 && junction->y - junction->y == 0, "a location that is not finite");
    for (b = 0; b < junction->branch_count; b++) {
        const asj_branch *branch = &junction->branches[b];
        fuzz_check(branch->angle >= 0 && branch->angle < 6.2831855f && branch->length >= 0, "a branch out of range");
        fuzz_check(!b || branch[-1].angle <= branch->angle, "branches out of order");
    }
}

/* Whatever was read has straight edges, or is refused. */
static void find_segments(const asj_junction_file *file)
{
    asj_segment_list *list = NULL;
    const asj_status status = asj_find_segments(fuzz_context(), file->junctions, file->junction_count, file->edges,
                                                file->edge_count, &list);
    fuzz_check(status == ASJ_OK || status == ASJ_ERROR_ARGUMENT, "segments fail");
    fuzz_check((status == ASJ_OK) == (list != NULL), "a status and a list that do not fit");
    asj_segment_list_free(&list);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    asj_junction_file *file = NULL;
    char message[256] = "";
    asj_status status = asj_junctions_read(fuzz_file(data, size), &file, message, sizeof message);
    uint32_t i;

    fuzz_check((status == ASJ_OK) == (file != NULL), "a status and a result that do not fit");
    fuzz_check((status == ASJ_OK) == !*message, "a status and a message that do not fit");
    for (i = 0; file && i < file->junction_count; i++)
        check_junction(&file->junctions[i]);
    if (file)
        find_segments(file);
    asj_junction_file_free(&file);
    return 0;
}
