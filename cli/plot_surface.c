/* SPDX-License-Identifier: BSD-2-Clause */
/* Plot files: a drawing on a surface of each format, and its bytes in an output of libasj-io. */
#include "plot_surface.h"
#include "plot_format.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST_SURFACE = 32767 };

/* cairo knows no titles: they go in front of the last line of an SVG. */
#define SVG_END "</svg>\n"
enum { END = sizeof SVG_END - 1, FIRST_ROOM = 65536 };

/* The whole file, in memory: the drawing library may end the process, and no output is begun while it runs. */
typedef struct stream {
    unsigned char *bytes;
    size_t count, room;
    int out_of_memory;
    int (*stopped)(void);
} stream;

static cairo_status_t write_stream(void *user, const unsigned char *data, unsigned size)
{
    stream *s = user;
    if (s->stopped && s->stopped())
        return CAIRO_STATUS_WRITE_ERROR;
    if (size > s->room - s->count) {
        size_t room = s->room > 0 ? s->room : FIRST_ROOM;
        while (room - s->count < size && room <= SIZE_MAX / 2)
            room *= 2;
        unsigned char *more = room - s->count < size ? NULL : realloc(s->bytes, room);
        if (!more) {
            s->out_of_memory = 1;
            return CAIRO_STATUS_WRITE_ERROR;
        }
        s->bytes = more;
        s->room = room;
    }
    if (size > 0)
        memcpy(s->bytes + s->count, data, size);
    s->count += size;
    return CAIRO_STATUS_SUCCESS;
}

/* The file with the titles in it. */
static void put_stream(const stream *s, int32_t format, const cli_plot_content *content, asj_output *output)
{
    const int titles = format == CLI_PLOT_SVG && content->annotate && s->count >= END &&
                       memcmp(s->bytes + s->count - END, SVG_END, END) == 0;
    const size_t before = titles ? s->count - END : s->count;
    asj_output_write(output, s->bytes, before);
    if (!titles)
        return;
    asj_output_text(output, "<g fill=\"none\" stroke=\"none\">\n");
    content->annotate(output, content->user);
    asj_output_text(output, "</g>\n" SVG_END);
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

static cairo_status_t draw_on(stream *to, int32_t format, int32_t width, int32_t height, const cli_plot_content *content)
{
    cairo_surface_t *surface = create_surface(to, format, width, height);
    cairo_t *cairo = cairo_create(surface);
    content->draw(cairo, content->user);
    cairo_status_t status = cairo_status(cairo);
    cairo_destroy(cairo);
    if (status == CAIRO_STATUS_SUCCESS && format == CLI_PLOT_PNG)
        status = cairo_surface_write_to_png_stream(surface, write_stream, to);
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS)
        status = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    return status;
}

/* Makes the file of what was drawn, unless that failed. */
static asj_status put_file(const char *path, int32_t format, const stream *drawn, cairo_status_t status,
                           const cli_plot_content *content, char *message, size_t message_size)
{
    asj_output *output = NULL;
    if (content->stopped && content->stopped()) {
        snprintf(message, message_size, "interrupted");
        return ASJ_ERROR_CANCELLED;
    }
    if (status != CAIRO_STATUS_SUCCESS) {
        const int memory = drawn->out_of_memory || status == CAIRO_STATUS_NO_MEMORY;
        snprintf(message, message_size, "cannot draw: %s", memory ? "out of memory" : cairo_status_to_string(status));
        return memory ? ASJ_ERROR_MEMORY : ASJ_ERROR_FILE;
    }
    const asj_status begun = asj_output_begin(path, &output, message, message_size);
    if (begun != ASJ_OK)
        return begun;
    put_stream(drawn, format, content, output);
    return asj_output_commit(&output, message, message_size); /* after a write error this fails too, and says why */
}

asj_status cli_plot_file(const char *path, int32_t format, int32_t width, int32_t height, const cli_plot_content *content,
                         char *message, size_t message_size)
{
    stream to = {.stopped = content->stopped};
    if (format == CLI_PLOT_PNG && (width > LARGEST_SURFACE || height > LARGEST_SURFACE)) {
        snprintf(message, message_size, "a plot of %d x %d pixels is too large: take a smaller --plot-scale", (int)width,
                 (int)height);
        return ASJ_ERROR_LIMIT;
    }
    const cairo_status_t drawn = draw_on(&to, format, width, height, content);
    const asj_status status = put_file(path, format, &to, drawn, content, message, message_size);
    free(to.bytes);
    return status;
}
