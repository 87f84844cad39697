/* SPDX-License-Identifier: BSD-2-Clause */
/* Reads plots. */
#include "plot_pixels.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

asj_image_file *read_plot(const char *path)
{
    char message[512] = "";
    asj_image_file *file = NULL;
    if (asj_image_file_read(path, 0, &file, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    assert_int_equal(file->image.format, ASJ_FORMAT_RGB8);
    return file;
}

const unsigned char *plot_pixel(const asj_image_file *plot, int x, int y)
{
    assert_in_range(x, 0, plot->image.width - 1);
    assert_in_range(y, 0, plot->image.height - 1);
    return (const unsigned char *)plot->image.data + 3 * ((ptrdiff_t)y * plot->image.width + x);
}

int is_colored(const unsigned char *color)
{
    int low = color[0] < color[1] ? color[0] : color[1], high = color[0] > color[1] ? color[0] : color[1];
    low = color[2] < low ? color[2] : low;
    high = color[2] > high ? color[2] : high;
    return high - low > 60;
}
