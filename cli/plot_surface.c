/* SPDX-License-Identifier: BSD-2-Clause */
/* Plot files: a drawing on a surface of each format, streamed into an output of libasj-io. */
#include "plot_surface.h"
#include "plot_format.h"

#include <asj/io.h>

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <stdio.h>

enum { LARGEST_SURFACE = 32767 };

static cairo_status_t write_stream(void *output, const unsigned char *data, unsigned size)
{
    return asj_output_write(output, data, size) == ASJ_OK ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

static cairo_surface_t *create_surface(asj_output *output, int32_t format, int32_t width, int32_t height)
{
    cairo_surface_t *surface;
    switch (format) {
    case CLI_PLOT_SVG:
        surface = cairo_svg_surface_create_for_stream(write_stream, output, width, height);
        cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
        return surface;
    case CLI_PLOT_PDF:
        surface = cairo_pdf_surface_create_for_stream(write_stream, output, width, height);
        /* the same input gives the same file */
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
        return surface;
    default:
        return cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    }
}

static cairo_status_t draw_on(asj_output *output, int32_t format, int32_t width, int32_t height,
                              void (*draw)(cairo_t *cairo, void *user), void *user)
{
    cairo_surface_t *surface = create_surface(output, format, width, height);
    cairo_t *cairo = cairo_create(surface);
    draw(cairo, user);
    cairo_status_t status = cairo_status(cairo);
    cairo_destroy(cairo);
    if (status == CAIRO_STATUS_SUCCESS && format == CLI_PLOT_PNG)
        status = cairo_surface_write_to_png_stream(surface, write_stream, output);
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS)
        status = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    return status;
}

asj_status cli_plot_file(const char *path, int32_t format, int32_t width, int32_t height, void (*draw)(cairo_t *cairo, void *user),
                         void *user, char *message, size_t message_size)
{
    asj_output *output = NULL;
    if (format == CLI_PLOT_PNG && (width > LARGEST_SURFACE || height > LARGEST_SURFACE)) {
        snprintf(message, message_size, "a plot of %d x %d pixels is too large: take a smaller --plot-scale", (int)width,
                 (int)height);
        return ASJ_ERROR_LIMIT;
    }
    asj_status status = asj_output_begin(path, &output, message, message_size);
    if (status != ASJ_OK)
        return status;
    cairo_status_t drawn = draw_on(output, format, width, height, draw, user);
    /* after a write error committing fails too, and says why */
    if (drawn == CAIRO_STATUS_SUCCESS || drawn == CAIRO_STATUS_WRITE_ERROR)
        return asj_output_commit(&output, message, message_size);
    asj_output_abort(&output);
    snprintf(message, message_size, "cannot draw: %s", cairo_status_to_string(drawn));
    return drawn == CAIRO_STATUS_NO_MEMORY ? ASJ_ERROR_MEMORY : ASJ_ERROR_FILE;
}
