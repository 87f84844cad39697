/* SPDX-License-Identifier: BSD-2-Clause */
/* In place of plot.c where there is no cairo. */
#include "plot.h"

#include <stdio.h>

int cli_plot_available(void)
{
    return 0;
}

asj_status cli_plot_write(const char *path, int32_t format, const asj_image *image, const asj_detection *detection,
                          const cli_plot_style *style, char *message, size_t message_size)
{
    (void)path;
    (void)format;
    (void)image;
    (void)detection;
    (void)style;
    snprintf(message, message_size, "this build cannot plot (it was made without cairo)");
    return ASJ_ERROR_UNSUPPORTED;
}
