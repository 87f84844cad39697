/* SPDX-License-Identifier: BSD-2-Clause */
#include "measure.h"
#include "render.h"
#include "room.h"

#include <stdlib.h>
#include <string.h>

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double measure_median(double *values, int32_t count)
{
    qsort(values, (size_t)count, sizeof *values, ascending);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

uint8_t *measure_room(int32_t index, int32_t width, int32_t height)
{
    synth_room room;
    synth_view view;
    uint8_t *pixels = NULL;
    const synth_camera camera = synth_room_camera(index, width, height);
    if (synth_room_make(&room) != 0)
        return NULL;
    if (synth_view_make(&room, &camera, 1.0, &view) == 0) {
        pixels = synth_photograph(&view.scene, 0.9, 2.0, (uint64_t)index + 1);
        synth_view_free(&view);
    }
    synth_room_free(&room);
    return pixels;
}

asj_context *measure_context(int32_t threads)
{
    asj_context_options how;
    asj_context *context = NULL;
    asj_context_options_init(&how);
    how.backend = ASJ_BACKEND_CPU;
    how.threads = threads;
    return asj_context_create(&how, &context) == ASJ_OK ? context : NULL;
}

int measure_number(const char *text, long lowest, long highest, int32_t *value)
{
    char *end;
    const long number = strtol(text, &end, 10);
    *value = (int32_t)number;
    return *text && !*end && number >= lowest && number <= highest ? 0 : -1;
}

const char *measure_key_value(const char *text, char key[64])
{
    const char *equals = strchr(text, '=');
    if (!equals || equals - text >= 64)
        return NULL;
    memcpy(key, text, (size_t)(equals - text));
    key[equals - text] = 0;
    return equals + 1;
}
