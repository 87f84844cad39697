/* SPDX-License-Identifier: BSD-2-Clause */
/* What the detector keeps on the device: made when first needed, freed with the context. */
#include "detect.h"
#include "state.h"

asj_status asj_cl_detect_get(asj_context *context, struct asj_cl_detect **detect)
{
    if (!context->cl->detect)
        context->cl->detect = asj_allocate_zero(&context->memory, 1, sizeof *context->cl->detect);
    *detect = context->cl->detect;
    return *detect ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the detector's state on the device");
}

void asj_cl_free_detect(asj_context *context)
{
    struct asj_cl_detect *detect = context->cl->detect;
    if (!detect)
        return;
    asj_cl_buffer *const buffers[] = {&detect->gray,  &detect->norms,      &detect->gradient_x, &detect->gradient_y,
                                      &detect->masks, &detect->candidates, &detect->peaks};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        asj_cl_release(context, buffers[i]);
    asj_cl_table_free(context, &detect->field_table);
    asj_cl_table_free(context, &detect->isotropic_table);
    asj_release(&context->memory, detect->host_candidates.memory);
    asj_release(&context->memory, detect->host_peaks.memory);
    asj_release(&context->memory, detect);
    context->cl->detect = NULL;
}
