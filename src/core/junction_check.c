/* SPDX-License-Identifier: BSD-2-Clause */
/* What a junction may be: of callers, from files and into files alike. */
#include "context.h"
#include "number_text.h"

#include <asj/junction.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

typedef struct fault_text {
    char *text;
    size_t size;
} fault_text;

static ASJ_PRINTF(2, 3) asj_status fault(const fault_text *to, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (to->text && to->size)
        vsnprintf(to->text, to->size, format, arguments);
    va_end(arguments);
    return ASJ_ERROR_ARGUMENT;
}

static asj_status check_branch(const asj_branch *branch, int32_t b, const fault_text *to)
{
    if (branch->end < ASJ_BRANCH_END_UNKNOWN || branch->end > ASJ_BRANCH_END_BORDER)
        return fault(to, "a branch %d with an end of kind %d", (int)b, (int)branch->end);
    if (!(branch->length >= 0 && branch->length <= ASJ_MAX_BRANCH_LENGTH))
        return fault(to, "a branch %d with a length of %s px, not 0 .. %d", (int)b, ASJ_TEXT((double)branch->length),
                     (int)ASJ_MAX_BRANCH_LENGTH);
    if (!(fabsf(branch->angle) <= ASJ_MAX_BRANCH_ANGLE))
        return fault(to, "a branch %d with an angle of %s", (int)b, ASJ_TEXT((double)branch->angle));
    if (!isfinite(branch->strength) || !isfinite(branch->log10_nfa) || !isfinite(branch->angle_sd) || !isfinite(branch->width) ||
        !isfinite(branch->length_sd))
        return fault(to, "a branch %d with NaN or infinity", (int)b);
    return ASJ_OK;
}

asj_status asj_junction_check(const asj_junction *junction, char *message, size_t message_size)
{
    const fault_text to = {message, message_size};
    asj_status status = ASJ_OK;
    if (message && message_size)
        *message = 0;
    if (!junction)
        return ASJ_ERROR_ARGUMENT;
    if (!isfinite(junction->x) || !isfinite(junction->y) || !isfinite(junction->log10_nfa) || !isfinite(junction->location_sd))
        return fault(&to, "NaN or infinity");
    if (!(junction->scale >= 0) || isinf(junction->scale))
        return fault(&to, "a scale of %s px", ASJ_TEXT((double)junction->scale));
    if (junction->octave < ASJ_LEAST_OCTAVE || junction->octave > ASJ_LARGEST_OCTAVE)
        return fault(&to, "octave %d", (int)junction->octave);
    if (junction->branch_count < 0 || junction->branch_count > ASJ_MAX_BRANCHES)
        return fault(&to, "%d branches", (int)junction->branch_count);
    for (int32_t b = 0; b < junction->branch_count && status == ASJ_OK; b++)
        status = check_branch(&junction->branches[b], b, &to);
    return status;
}
