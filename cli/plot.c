/* SPDX-License-Identifier: BSD-2-Clause */
/* The plot of detect: branches, or straight edges, over the photograph, then the junctions as dots. */
#include "plot.h"
#include "interrupt.h"
#include "plot_color.h"
#include "plot_direction.h"
#include "plot_photo.h"
#include "plot_surface.h"

#include <math.h>
#include <stdio.h>

#define FULL_TURN 6.283185307179586
#define LEGEND_HEIGHT 2.4 /* in font sizes, like all lengths of the legend */
#define LEGEND_WIDTH 40
#define LOOSE_GRAY 0.62 /* of branches that are part of no edge, or run to no vanishing point */
#define RING 4.0        /* radius of a vanishing point, widths of a line */

/* Sizes in units of the plot: pixels of a PNG, points of a PDF. The image is above, a strip with the legend below. */
typedef struct cli_plot_layout {
    double scale;         /* units for one pixel of the image */
    int32_t width;
    int32_t image_height;
    int32_t legend_height; /* 0 = too narrow for a legend */
    double line;          /* width of a branch */
    double font;          /* size of the text */
} cli_plot_layout;

/* What the drawing on the surface needs. */
typedef struct drawing {
    cli_plot_layout layout;
    const cli_plot_scene *scene;
    const cli_plot_style *style;
} drawing;

static void lay_out(const asj_image *image, double scale, cli_plot_layout *layout)
{
    if (scale <= 0)
        scale = cli_plot_natural_scale(image->width, image->height);
    layout->scale = scale;
    layout->width = (int32_t)fmax(1, floor(image->width * scale + 0.5));
    layout->image_height = (int32_t)fmax(1, floor(image->height * scale + 0.5));
    layout->line = fmax(1, sqrt((double)layout->width * layout->image_height) / 500);
    layout->font = fmax(10, 8 * layout->line);
    layout->legend_height = layout->width >= LEGEND_WIDTH * layout->font ? (int32_t)ceil(LEGEND_HEIGHT * layout->font) : 0;
}

static void set_color(cairo_t *cairo, cli_color color)
{
    cairo_set_source_rgb(cairo, color.red, color.green, color.blue);
}

/* Pixel centres lie at integers, so the image starts at -0.5. */
static double place(const cli_plot_layout *layout, double coordinate)
{
    return (coordinate + 0.5) * layout->scale;
}

static void draw_line(cairo_t *cairo, const cli_plot_layout *layout, double x1, double y1, double x2, double y2)
{
    cairo_move_to(cairo, place(layout, x1), place(layout, y1));
    cairo_line_to(cairo, place(layout, x2), place(layout, y2));
    cairo_stroke(cairo);
}

static const cli_color loose = {LOOSE_GRAY, LOOSE_GRAY, LOOSE_GRAY};

static cli_color direction_color(int32_t number)
{
    return number < 0 ? loose : cli_branch_color(number);
}

static int32_t direction_of_branch(const drawing *d, const asj_junction *junction, const asj_branch *branch)
{
    return cli_direction_of(d->scene->directions, (double)junction->x, (double)junction->y, (double)branch->angle);
}

static int32_t direction_of_segment(const drawing *d, const asj_segment *s)
{
    const double dx = (double)s->x2 - (double)s->x1, dy = (double)s->y2 - (double)s->y1;
    return cli_direction_of(d->scene->directions, (double)s->x1 + dx / 2, (double)s->y1 + dy / 2, atan2(dy, dx));
}

static cli_color branch_color(const drawing *d, const asj_junction *junction, int32_t number)
{
    const asj_branch *branch = &junction->branches[number];
    switch (d->style->color) {
    case CLI_PLOT_COLOR_BRANCH: return cli_branch_color(number);
    case CLI_PLOT_COLOR_EDGE: return loose;
    case CLI_PLOT_COLOR_DIRECTION: return direction_color(direction_of_branch(d, junction, branch));
    default: return cli_ramp_color((double)branch->log10_nfa);
    }
}

static void draw_branches(cairo_t *cairo, const drawing *d, const asj_junction *junction)
{
    for (int32_t i = 0; i < junction->branch_count; i++) {
        const asj_branch *branch = &junction->branches[i];
        double x = (double)junction->x + (double)branch->length * cos((double)branch->angle);
        double y = (double)junction->y + (double)branch->length * sin((double)branch->angle);
        set_color(cairo, branch_color(d, junction, i));
        draw_line(cairo, &d->layout, (double)junction->x, (double)junction->y, x, y);
    }
}

/* From junction to junction. Edges meet at junctions only, so their order does not matter. */
static void draw_edges(cairo_t *cairo, const cli_plot_layout *layout, const asj_detection *detection)
{
    cairo_set_line_width(cairo, 1.5 * layout->line);
    for (uint32_t i = 0; i < detection->edge_count; i++) {
        const asj_edge *edge = &detection->edges[i];
        const asj_junction *a = &detection->junctions[edge->junction_a], *b = &detection->junctions[edge->junction_b];
        set_color(cairo, cli_ramp_color((double)edge->log10_nfa));
        draw_line(cairo, layout, (double)a->x, (double)a->y, (double)b->x, (double)b->y);
    }
}

/* The longest come first in a list, and last, on top, in a plot. */
static void draw_segments(cairo_t *cairo, const drawing *d)
{
    const asj_segment_list *segments = d->scene->segments;
    const int by_direction = d->style->color == CLI_PLOT_COLOR_DIRECTION;
    cairo_set_line_width(cairo, 1.5 * d->layout.line);
    for (uint32_t i = segments->count; i-- > 0;) {
        const asj_segment *s = &segments->segments[i];
        set_color(cairo, by_direction ? direction_color(direction_of_segment(d, s)) : cli_ramp_color((double)s->log10_nfa));
        draw_line(cairo, &d->layout, (double)s->x1, (double)s->y1, (double)s->x2, (double)s->y2);
    }
}

/* Rings where the image has them in it. */
static void draw_vanishing_points(cairo_t *cairo, const drawing *d)
{
    const cli_plot_layout *layout = &d->layout;
    for (int32_t n = 0; n < d->scene->directions->count; n++) {
        double at[2];
        if (!cli_vanishing_place(d->scene->directions, n, at))
            continue;
        cairo_new_path(cairo);
        cairo_arc(cairo, place(layout, at[0]), place(layout, at[1]), RING * layout->line, 0, FULL_TURN);
        cairo_set_line_width(cairo, 2.5 * layout->line);
        cairo_set_source_rgb(cairo, 1, 1, 1);
        cairo_stroke_preserve(cairo);
        cairo_set_line_width(cairo, 1.5 * layout->line);
        set_color(cairo, direction_color(n));
        cairo_stroke(cairo);
    }
}

static void draw_dot(cairo_t *cairo, const cli_plot_layout *layout, const asj_junction *junction)
{
    double x = place(layout, (double)junction->x), y = place(layout, (double)junction->y);
    cairo_arc(cairo, x, y, 1.8 * layout->line, 0, FULL_TURN);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_fill(cairo);
    cairo_arc(cairo, x, y, 1.3 * layout->line, 0, FULL_TURN);
    cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
    cairo_fill(cairo);
}

/* The surest come first in a detection, and last, on top, in a plot. */
static void draw_junctions(cairo_t *cairo, const drawing *d)
{
    const cli_plot_layout *layout = &d->layout;
    const asj_detection *detection = d->scene->detection;
    cairo_save(cairo);
    cairo_rectangle(cairo, 0, 0, layout->width, layout->image_height);
    cairo_clip(cairo);
    cairo_set_line_width(cairo, layout->line);
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_BUTT); /* ends where the branch ends */
    if (d->scene->segments)
        draw_segments(cairo, d);
    else
        for (uint32_t i = detection->junction_count; i-- > 0;)
            draw_branches(cairo, d, &detection->junctions[i]);
    if (d->style->color == CLI_PLOT_COLOR_EDGE)
        draw_edges(cairo, layout, detection);
    for (uint32_t i = detection->junction_count; i-- > 0;)
        draw_dot(cairo, layout, &detection->junctions[i]);
    if (d->style->color == CLI_PLOT_COLOR_DIRECTION)
        draw_vanishing_points(cairo, d);
    cairo_restore(cairo);
}

static void draw_text(cairo_t *cairo, double x, double y, const char *text)
{
    cairo_set_source_rgb(cairo, 0.2, 0.2, 0.2);
    cairo_move_to(cairo, x, y);
    cairo_show_text(cairo, text);
}

static void draw_ramp(cairo_t *cairo, double x, double y, double width, double height)
{
    enum { STEPS = 64 };
    cairo_pattern_t *ramp = cairo_pattern_create_linear(x, 0, x + width, 0);
    for (int i = 0; i <= STEPS; i++) {
        double t = (double)i / STEPS;
        cli_color color = cli_ramp_color(CLI_RAMP_UNSURE + t * (CLI_RAMP_SURE - CLI_RAMP_UNSURE));
        cairo_pattern_add_color_stop_rgb(ramp, t, color.red, color.green, color.blue);
    }
    cairo_rectangle(cairo, x, y, width, height);
    cairo_set_source(cairo, ramp);
    cairo_fill(cairo);
    cairo_pattern_destroy(ramp);
}

/* How many of what the plot shows. */
static void count_text(const drawing *d, char *text, size_t size)
{
    const int edges = d->style->color == CLI_PLOT_COLOR_EDGE;
    const asj_segment_list *segments = d->scene->segments;
    const asj_detection *detection = d->scene->detection;
    const unsigned long count = segments ? segments->count : edges ? detection->edge_count : detection->junction_count;
    const char *name = segments ? "line" : edges ? "edge" : "junction";
    snprintf(text, size, "%lu %s%s", count, name, count == 1 ? "" : "s");
}

/* `count` colours with their numbers from 1 on, beside what they are of. */
static void draw_numbers(cairo_t *cairo, const cli_plot_layout *layout, double base, const char *name, int32_t count)
{
    const double em = layout->font, middle = base - 0.35 * em;
    draw_text(cairo, 10.5 * em, base, name);
    cairo_set_line_width(cairo, 2 * layout->line);
    for (int32_t i = 0; i < count; i++) {
        const double x = (16 + 3 * i) * em;
        char text[16];
        snprintf(text, sizeof text, "%d", (int)i + 1);
        draw_text(cairo, x, base, text);
        set_color(cairo, cli_branch_color(i));
        cairo_move_to(cairo, x + 0.9 * em, middle);
        cairo_line_to(cairo, x + 2.2 * em, middle);
        cairo_stroke(cairo);
    }
}

/* What is grey, where there is room to say so. */
static void draw_loose(cairo_t *cairo, const cli_plot_layout *layout, double x, double base, const char *name)
{
    const double em = layout->font, middle = base - 0.35 * em;
    if (layout->width < x + 7 * em)
        return;
    cairo_set_line_width(cairo, 2 * layout->line);
    set_color(cairo, loose);
    cairo_move_to(cairo, x, middle);
    cairo_line_to(cairo, x + 1.3 * em, middle);
    cairo_stroke(cairo);
    draw_text(cairo, x + 2 * em, base, name);
}

static void draw_legend(cairo_t *cairo, const drawing *d)
{
    const cli_plot_layout *layout = &d->layout;
    char text[64];
    double em = layout->font, base = layout->image_height + 1.55 * em, middle = base - 0.35 * em;
    /* the font inside cairo: the same on every machine, and there is always one */
    cairo_select_font_face(cairo, "@cairo:", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, em);
    count_text(d, text, sizeof text);
    draw_text(cairo, 0.8 * em, base, text);
    if (d->style->color == CLI_PLOT_COLOR_BRANCH) {
        draw_numbers(cairo, layout, base, "branch", ASJ_MAX_BRANCHES);
    } else if (d->style->color == CLI_PLOT_COLOR_DIRECTION) {
        const int32_t count = d->scene->directions->count;
        draw_numbers(cairo, layout, base, "direction", count);
        draw_loose(cairo, layout, (16 + 3 * count) * em, base, "none");
    } else {
        draw_text(cairo, 10.5 * em, base, "barely");
        draw_ramp(cairo, 14.4 * em, middle - 0.35 * em, 8 * em, 0.7 * em);
        snprintf(text, sizeof text, "sure   (log10 NFA %g to %g)", CLI_RAMP_UNSURE, CLI_RAMP_SURE);
        draw_text(cairo, 23 * em, base, text);
        if (d->style->color == CLI_PLOT_COLOR_EDGE)
            draw_loose(cairo, layout, 40 * em, base, "no edge");
    }
}

static void draw(cairo_t *cairo, void *user)
{
    const drawing *d = user;
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    if (d->style->background != CLI_PLOT_WHITE)
        cli_plot_photo(cairo, d->scene->image, d->style->background, d->layout.scale, d->layout.width, d->layout.image_height);
    draw_junctions(cairo, d);
    if (d->layout.legend_height > 0)
        draw_legend(cairo, d);
}

#define DIRECTION_SIZE 24

/* ", direction 2" for the second one, where directions are shown. */
static void describe_direction(const drawing *d, int32_t number, char text[DIRECTION_SIZE])
{
    text[0] = '\0';
    if (d->style->color == CLI_PLOT_COLOR_DIRECTION && number >= 0)
        snprintf(text, DIRECTION_SIZE, ", direction %d", (int)number + 1);
}

/* What a browser says of a branch, a straight edge or a junction under its pointer. */
static void annotate_branches(asj_output *output, const drawing *d, const asj_junction *junction, unsigned long number)
{
    const cli_plot_layout *layout = &d->layout;
    char text[256], direction[DIRECTION_SIZE];
    const double x = place(layout, (double)junction->x), y = place(layout, (double)junction->y);
    for (int32_t i = 0; i < junction->branch_count; i++) {
        const asj_branch *branch = &junction->branches[i];
        const double length = (double)branch->length * layout->scale, degrees = (double)branch->angle * 360 / FULL_TURN;
        describe_direction(d, direction_of_branch(d, junction, branch), direction);
        snprintf(text, sizeof text,
                 "<g id=\"junction-%lu-branch-%d\"><title>junction %lu, branch %d: %.1f degrees, %.1f px, log10 NFA %.1f%s</title>"
                 "\n", number, (int)i + 1, number, (int)i + 1, degrees, (double)branch->length, (double)branch->log10_nfa,
                 direction);
        asj_output_text(output, text);
        cli_plot_hot_line(output, x, y, x + length * cos((double)branch->angle), y + length * sin((double)branch->angle),
                          2 * layout->line);
        asj_output_text(output, "</g>\n");
    }
}

static void annotate_segment(asj_output *output, const drawing *d, const asj_segment *s, unsigned long number)
{
    const cli_plot_layout *layout = &d->layout;
    char text[256], direction[DIRECTION_SIZE];
    describe_direction(d, direction_of_segment(d, s), direction);
    const double length = hypot((double)s->x2 - (double)s->x1, (double)s->y2 - (double)s->y1);
    snprintf(text, sizeof text, "<g id=\"line-%lu\"><title>line %lu: %.1f px, log10 NFA %.1f%s</title>\n", number, number, length,
             (double)s->log10_nfa, direction);
    asj_output_text(output, text);
    cli_plot_hot_line(output, place(layout, (double)s->x1), place(layout, (double)s->y1), place(layout, (double)s->x2),
                      place(layout, (double)s->y2), 2 * layout->line);
    asj_output_text(output, "</g>\n");
}

static void annotate_dot(asj_output *output, const cli_plot_layout *layout, const asj_junction *junction, unsigned long number)
{
    char text[256];
    snprintf(text, sizeof text, "<g id=\"junction-%lu\"><title>junction %lu: %.1f, %.1f, %d branches, log10 NFA %.1f</title>\n",
             number, number, (double)junction->x, (double)junction->y, (int)junction->branch_count, (double)junction->log10_nfa);
    asj_output_text(output, text);
    cli_plot_hot_dot(output, place(layout, (double)junction->x), place(layout, (double)junction->y), 3 * layout->line);
    asj_output_text(output, "</g>\n");
}

static void annotate(asj_output *output, void *user)
{
    const drawing *d = user;
    const asj_segment_list *segments = d->scene->segments;
    const asj_detection *detection = d->scene->detection;
    for (uint32_t i = segments ? segments->count : 0; i-- > 0;)
        annotate_segment(output, d, &segments->segments[i], (unsigned long)i + 1);
    for (uint32_t i = detection->junction_count; i-- > 0;) {
        if (!segments)
            annotate_branches(output, d, &detection->junctions[i], (unsigned long)i + 1);
        annotate_dot(output, &d->layout, &detection->junctions[i], (unsigned long)i + 1);
    }
}

asj_status cli_plot_write(const char *path, int32_t format, const cli_plot_scene *scene, const cli_plot_style *style,
                          char *message, size_t message_size)
{
    drawing d = {.scene = scene, .style = style};
    lay_out(scene->image, style->scale, &d.layout);
    return cli_plot_file(path, format, d.layout.width, d.layout.image_height + d.layout.legend_height,
                         &(cli_plot_content){draw, annotate, &d, cli_interrupted}, message, message_size);
}
