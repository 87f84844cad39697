/* SPDX-License-Identifier: BSD-2-Clause */
/* Plot files: a drawing on a surface of each format, streamed into an output of libasj-io. */
#include "plot_surface.h"
#include "plot_format.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <stdio.h>
#include <string.h>

enum { LARGEST_SURFACE = 32767 };

/* cairo knows no titles: they go in front of the last line of an SVG, so the end of what was written is kept back. */
#define SVG_END "</svg>\n"
enum { KEPT = sizeof SVG_END - 1 };

typedef struct stream {
    asj_output *output;
    unsigned char kept[KEPT];
    size_t keep, count; /* how many bytes to keep back, and how many there are */
    int (*stopped)(void);
} stream;

static cairo_status_t write_stream(void *user, const unsigned char *data, unsigned size)
{
    stream *s = user;
    asj_status status = ASJ_OK;
    if (s->stopped && s->stopped())
        return CAIRO_STATUS_WRITE_ERROR;
    for (; s->keep > 0 && size > 0 && status == ASJ_OK; data++, size--) {
        if (size > KEPT && s->count == 0) { /* in one piece what is not the end in any case */
            status = asj_output_write(s->output, data, size - KEPT);
            data += size - KEPT;
            size = KEPT;
        }
        if (s->count == KEPT) {
            if (status == ASJ_OK)
                status = asj_output_write(s->output, s->kept, 1);
            memmove(s->kept, s->kept + 1, --s->count);
        }
        s->kept[s->count++] = *data;
    }
    if (s->keep == 0)
        status = asj_output_write(s->output, data, size);
    return status == ASJ_OK ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

/* What was kept back, with the titles in front of it. */
static void end_stream(stream *s, const cli_plot_content *content)
{
    const int whole = s->count == KEPT && memcmp(s->kept, SVG_END, KEPT) == 0;
    if (whole) {
        asj_output_text(s->output, "<g fill=\"none\" stroke=\"none\">\n");
        content->annotate(s->output, content->user);
        asj_output_text(s->output, "</g>\n");
    }
    asj_output_write(s->output, s->kept, s->count);
}

void cli_plot_hot_dot(asj_output *output, double x, double y, double radius)
{
    char text[160];
    snprintf(text, sizeof text, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" pointer-events=\"all\"/>\n", x, y, radius);
    asj_output_text(output, text);
}

void cli_plot_hot_line(asj_output *output, double x1, double y1, double x2, double y2, double width)
{
    char text[240];
    snprintf(text, sizeof text,
             "<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" stroke-width=\"%.2f\" pointer-events=\"stroke\"/>\n", x1, y1,
             x2, y2, width);
    asj_output_text(output, text);
}

static cairo_surface_t *create_surface(stream *output, int32_t format, int32_t width, int32_t height)
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

static cairo_status_t draw_on(asj_output *output, int32_t format, int32_t width, int32_t height, const cli_plot_content *content)
{
    stream to = {.output = output, .keep = format == CLI_PLOT_SVG && content->annotate ? KEPT : 0,
                 .stopped = content->stopped};
    cairo_surface_t *surface = create_surface(&to, format, width, height);
    cairo_t *cairo = cairo_create(surface);
    content->draw(cairo, content->user);
    cairo_status_t status = cairo_status(cairo);
    cairo_destroy(cairo);
    if (status == CAIRO_STATUS_SUCCESS && format == CLI_PLOT_PNG)
        status = cairo_surface_write_to_png_stream(surface, write_stream, &to);
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS)
        status = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    if (to.keep > 0)
        end_stream(&to, content);
    return status;
}

asj_status cli_plot_file(const char *path, int32_t format, int32_t width, int32_t height, const cli_plot_content *content,
                         char *message, size_t message_size)
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
    cairo_status_t drawn = draw_on(output, format, width, height, content);
    if (content->stopped && content->stopped()) {
        asj_output_abort(&output);
        snprintf(message, message_size, "interrupted");
        return ASJ_ERROR_CANCELLED;
    }
    /* after a write error committing fails too, and says why */
    if (drawn == CAIRO_STATUS_SUCCESS || drawn == CAIRO_STATUS_WRITE_ERROR)
        return asj_output_commit(&output, message, message_size);
    asj_output_abort(&output);
    snprintf(message, message_size, "cannot draw: %s", cairo_status_to_string(drawn));
    return drawn == CAIRO_STATUS_NO_MEMORY ? ASJ_ERROR_MEMORY : ASJ_ERROR_FILE;
}
