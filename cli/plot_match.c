/* SPDX-License-Identifier: BSD-2-Clause */
/* Every match has one colour for its junctions, branches and line, given in order of place in the first photograph: from left to
 * right when the second one stands beside it, else from top to bottom. So lines that run close together differ in colour, and a
 * match in the wrong place stands out among neighbours of other colours. Branch b is darker than branch a. What a geometry rejected
 * is grey, below everything else. Where nothing matches, all L-junctions stand in grey: was there anything to match? */
#include "plot_match.h"
#include "interrupt.h"
#include "plot_color.h"
#include "plot_epipolar.h"
#include "plot_photo.h"
#include "plot_surface.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define FULL_TURN 6.283185307179586
#define LEGEND_HEIGHT 2.4 /* in font sizes */
#define DARKER 0.55       /* share of the colour that branch b keeps */
#define SCREEN 1.5        /* width to height that `auto` aims at */
#define LARGEST_AREA 6.4e7
#define STUB 12.0         /* px that are drawn of a branch where nothing matches */

enum { EPIPOLAR_LINES = 60 }; /* more hide the photographs; --help and the manual page say how many */

/* A match as it is drawn: in each image a place, where the line ends, and one or two strokes. */
typedef struct pair {
    double place[2][2];
    double stroke[2][2][4]; /* image, branch: x y x y */
    int strokes;
    int32_t dots;
    size_t rank;            /* in order of place */
} pair;

typedef struct drawing {
    const cli_plot_match_content *content;
    const cli_plot_match_style *style;
    pair *pairs;
    size_t count, rejected;
    cli_epipolar_pair *across; /* epipolar lines, of which some are drawn */
    size_t across_count;
    int32_t beside;
    double scale, line, font;
    int32_t widths[2], heights[2]; /* of the photographs in the plot */
    int32_t left[2], top[2];
    int32_t width, height, legend_height;
} drawing;

static void set_stroke(double stroke[4], float x, float y, float ex, float ey)
{
    stroke[0] = (double)x;
    stroke[1] = (double)y;
    stroke[2] = (double)ex;
    stroke[3] = (double)ey;
}

static void pair_of_match(const asj_junction_match *m, pair *p)
{
    set_stroke(p->stroke[0][0], m->x1, m->y1, m->ax1, m->ay1);
    set_stroke(p->stroke[0][1], m->x1, m->y1, m->bx1, m->by1);
    set_stroke(p->stroke[1][0], m->x2, m->y2, m->ax2, m->ay2);
    set_stroke(p->stroke[1][1], m->x2, m->y2, m->bx2, m->by2);
    for (int v = 0; v < 2; v++)
        for (int i = 0; i < 2; i++)
            p->place[v][i] = p->stroke[v][0][i];
    p->strokes = 2;
    p->dots = 1;
}

/* The line goes from middle to middle. */
static void pair_of_segment(const asj_segment_match *s, pair *p)
{
    set_stroke(p->stroke[0][0], s->x1, s->y1, s->ex1, s->ey1);
    set_stroke(p->stroke[1][0], s->x2, s->y2, s->ex2, s->ey2);
    for (int v = 0; v < 2; v++)
        for (int i = 0; i < 2; i++)
            p->place[v][i] = 0.5 * (p->stroke[v][0][i] + p->stroke[v][0][i + 2]);
    p->strokes = 1;
    p->dots = 0;
}

static int compare_numbers(double a, double b)
{
    return a < b ? -1 : a > b;
}

static int by_x(const void *a, const void *b)
{
    const pair *p = *(pair *const *)a, *q = *(pair *const *)b;
    int order = compare_numbers(p->place[0][0], q->place[0][0]);
    return order ? order : compare_numbers(p->place[0][1], q->place[0][1]);
}

static int by_y(const void *a, const void *b)
{
    const pair *p = *(pair *const *)a, *q = *(pair *const *)b;
    int order = compare_numbers(p->place[0][1], q->place[0][1]);
    return order ? order : compare_numbers(p->place[0][0], q->place[0][0]);
}

/* 0 = no memory */
static int make_pairs(drawing *d)
{
    const cli_plot_match_content *content = d->content;
    d->count = content->segments ? content->segment_count : content->result->match_count;
    d->pairs = calloc(d->count + 1, sizeof *d->pairs);
    pair **order = calloc(d->count + 1, sizeof(pair *));
    for (size_t k = 0; d->pairs && order && k < d->count; k++) {
        order[k] = &d->pairs[k];
        if (content->segments)
            pair_of_segment(&content->segments[k], order[k]);
        else
            pair_of_match(&content->result->matches[k], order[k]);
    }
    int made = d->pairs && order;
    if (made)
        qsort(order, d->count, sizeof(pair *), d->beside ? by_x : by_y);
    for (size_t k = 0; made && k < d->count; k++)
        order[k]->rank = k;
    free(order);
    return made;
}

static int32_t scaled(int32_t side, double scale)
{
    return (int32_t)fmax(1, floor(side * scale + 0.5));
}

static double largest(double a, double b)
{
    return a > b ? a : b;
}

static int choose_beside(const drawing *d)
{
    const asj_image *p = d->content->images[0], *q = d->content->images[1];
    if (d->style->layout != CLI_LAYOUT_AUTO)
        return d->style->layout == CLI_LAYOUT_BESIDE;
    double beside = largest((double)p->width + q->width, SCREEN * largest(p->height, q->height));
    double below = largest(largest(p->width, q->width), SCREEN * ((double)p->height + q->height));
    return beside <= below;
}

static double choose_scale(const drawing *d)
{
    const asj_image *p = d->content->images[0], *q = d->content->images[1];
    if (d->style->scale > 0)
        return d->style->scale;
    double natural = cli_plot_natural_scale((int32_t)largest(p->width, q->width), (int32_t)largest(p->height, q->height));
    double side = d->beside ? (double)p->width + q->width : (double)p->height + q->height;
    const double areas = (double)p->width * p->height + (double)q->width * q->height;
    const double area = side * largest(d->beside ? p->height : p->width, d->beside ? q->height : q->width);
    /* a long one beside a high one: mostly nothing */
    natural = fmin(natural, sqrt(fmax(LARGEST_AREA, 2 * areas) / area));
    return fmin(natural, 0.95 * CLI_PLOT_LARGEST_SIDE / side); /* the rest is for the gap and the legend */
}

static void lay_out(drawing *d)
{
    d->beside = choose_beside(d);
    d->scale = choose_scale(d);
    for (int v = 0; v < 2; v++) {
        d->widths[v] = scaled(d->content->images[v]->width, d->scale);
        d->heights[v] = scaled(d->content->images[v]->height, d->scale);
    }
    d->line = fmax(1, sqrt(fmax((double)d->widths[0] * d->heights[0], (double)d->widths[1] * d->heights[1])) / 450);
    d->font = fmax(10, 8 * d->line);
    int32_t gap = (int32_t)ceil(6 * d->line);
    d->left[1] = d->beside ? d->widths[0] + gap : 0;
    d->top[1] = d->beside ? 0 : d->heights[0] + gap;
    d->width = (int32_t)largest(d->widths[0], d->left[1] + d->widths[1]);
    d->height = (int32_t)largest(d->heights[0], d->top[1] + d->heights[1]);
    d->legend_height = d->width >= 20 * d->font ? (int32_t)ceil(LEGEND_HEIGHT * d->font) : 0;
}

/* Pixel centres lie at integers, so the images start at -0.5. */
static double to_x(const drawing *d, int v, double x)
{
    return d->left[v] + (x + 0.5) * d->scale;
}

static double to_y(const drawing *d, int v, double y)
{
    return d->top[v] + (y + 0.5) * d->scale;
}

static void set_color(cairo_t *cairo, const drawing *d, const pair *p, double strength, double alpha)
{
    cli_color color = cli_order_color(d->count > 1 ? (double)p->rank / (double)(d->count - 1) : 0);
    cairo_set_source_rgba(cairo, strength * color.red, strength * color.green, strength * color.blue, alpha);
}

static void draw_photos(cairo_t *cairo, const drawing *d)
{
    for (int v = 0; v < 2; v++) {
        cairo_save(cairo);
        cairo_translate(cairo, d->left[v], d->top[v]);
        if (d->style->background != CLI_PLOT_WHITE)
            cli_plot_photo(cairo, d->content->images[v], d->style->background, d->scale, d->widths[v], d->heights[v]);
        else { /* where the photographs would be */
            cairo_set_source_rgb(cairo, 0.8, 0.8, 0.8);
            cairo_set_line_width(cairo, 1);
            cairo_rectangle(cairo, 0.5, 0.5, d->widths[v] - 1, d->heights[v] - 1);
            cairo_stroke(cairo);
        }
        cairo_restore(cairo);
    }
}

/* The more lines, the thinner and paler: 5 are read one by one, of 500 the flow. */
static void draw_lines(cairo_t *cairo, const drawing *d)
{
    double alpha = fmin(0.9, fmax(0.22, 5 / sqrt((double)d->count + 1)));
    cairo_set_line_width(cairo, fmax(0.6, (d->count > 60 ? 0.6 : 0.9) * d->line));
    for (size_t k = d->count; k-- > 0;) {
        const pair *p = &d->pairs[k];
        set_color(cairo, d, p, 1, alpha);
        cairo_move_to(cairo, to_x(d, 0, p->place[0][0]), to_y(d, 0, p->place[0][1]));
        cairo_line_to(cairo, to_x(d, 1, p->place[1][0]), to_y(d, 1, p->place[1][1]));
        cairo_stroke(cairo);
    }
}

static void draw_stroke(cairo_t *cairo, const drawing *d, int v, const double stroke[4])
{
    cairo_move_to(cairo, to_x(d, v, stroke[0]), to_y(d, v, stroke[1]));
    cairo_line_to(cairo, to_x(d, v, stroke[2]), to_y(d, v, stroke[3]));
    cairo_stroke(cairo);
}

/* Grey, with their lines. */
static void draw_rejected(cairo_t *cairo, const drawing *d)
{
    cairo_set_source_rgba(cairo, 0.45, 0.45, 0.45, 0.8);
    for (size_t k = 0; k < d->rejected; k++) {
        pair p;
        pair_of_match(&d->content->result->rejected[k], &p);
        cairo_set_line_width(cairo, d->line);
        for (int b = 0; b < 4; b++)
            draw_stroke(cairo, d, b % 2, p.stroke[b % 2][b / 2]);
        if (d->style->without_lines)
            continue;
        cairo_set_line_width(cairo, 0.5 * d->line);
        cairo_move_to(cairo, to_x(d, 0, p.place[0][0]), to_y(d, 0, p.place[0][1]));
        cairo_line_to(cairo, to_x(d, 1, p.place[1][0]), to_y(d, 1, p.place[1][1]));
        cairo_stroke(cairo);
    }
}

static double stub_end(double from, double to, double length)
{
    return length > STUB ? from + (to - from) * STUB / length : to;
}

/* Grey, the L-junctions of one image, with the beginnings of their branches: there are hundreds. */
static void draw_unmatched(cairo_t *cairo, const drawing *d, int v)
{
    cairo_save(cairo);
    cairo_rectangle(cairo, d->left[v], d->top[v], d->widths[v], d->heights[v]);
    cairo_clip(cairo);
    cairo_set_source_rgb(cairo, 0.4, 0.4, 0.4);
    const asj_match_result *result = d->content->result;
    for (uint32_t k = 0; k < (v == 0 ? result->l_junction_count1 : result->l_junction_count2); k++) {
        const asj_l_junction *l = v == 0 ? &result->l_junctions1[k] : &result->l_junctions2[k];
        const double x = (double)l->x, y = (double)l->y;
        const double ends[2][2] = {{(double)l->ax, (double)l->ay}, {(double)l->bx, (double)l->by}};
        cairo_set_line_width(cairo, d->line);
        for (int32_t b = 0; b < 2; b++) {
            const double length = hypot(ends[b][0] - x, ends[b][1] - y);
            draw_stroke(cairo, d, v, (double[]){x, y, stub_end(x, ends[b][0], length), stub_end(y, ends[b][1], length)});
        }
        cairo_arc(cairo, to_x(d, v, x), to_y(d, v, y), 1.7 * d->line, 0, FULL_TURN);
        cairo_fill(cairo);
    }
    cairo_restore(cairo);
}

static int shows_epipolar_lines(const drawing *d)
{
    const asj_geometry *g = &d->content->result->geometry;
    return d->style->epipolar && g->status == ASJ_GEOMETRY_ACCEPTED && g->model != ASJ_GEOMETRY_HOMOGRAPHY;
}

/* Of a match, or of the first ends of a line segment, which show the same thing; middles do so from one side only. The best match
 * comes first in a result, and its lines are drawn. 0 = no memory */
static int make_epipolar_lines(drawing *d)
{
    const asj_geometry *g = &d->content->result->geometry;
    d->across = calloc(d->count + 1, sizeof *d->across);
    for (size_t k = 0; d->across && k < d->count; k++) {
        cli_epipolar_pair *lines = &d->across[d->across_count];
        int meets = 1;
        for (int v = 0; v < 2; v++) {
            const double *from = d->pairs[k].stroke[1 - v][0];
            const asj_image *image = d->content->images[v];
            meets = meets && cli_epipolar_line(g, v, from[0], from[1], image->width, image->height, lines->ends[v]);
        }
        lines->match = k;
        d->across_count += meets ? 1 : 0;
    }
    if (d->across)
        cli_epipolar_spread(d->across, d->across_count, EPIPOLAR_LINES);
    return d->across != NULL;
}

/* In the colour of the match. */
static void draw_epipolar_lines(cairo_t *cairo, const drawing *d)
{
    cairo_set_line_width(cairo, 0.7 * d->line);
    for (size_t k = 0; k < d->across_count; k++)
        for (int v = 0; v < 2 && d->across[k].distance < 0; v++) {
            set_color(cairo, d, &d->pairs[d->across[k].match], 1, 0.55);
            draw_stroke(cairo, d, v, d->across[k].ends[v]);
        }
}

static void draw_dot(cairo_t *cairo, const drawing *d, int v, const pair *p)
{
    double x = to_x(d, v, p->place[v][0]), y = to_y(d, v, p->place[v][1]);
    cairo_arc(cairo, x, y, 2.4 * d->line, 0, FULL_TURN);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_fill(cairo);
    cairo_arc(cairo, x, y, 1.7 * d->line, 0, FULL_TURN);
    set_color(cairo, d, p, DARKER, 1);
    cairo_fill(cairo);
}

/* The best match comes first in a result, and last, on top, in a plot. */
static void draw_pairs(cairo_t *cairo, const drawing *d, int v)
{
    cairo_save(cairo);
    cairo_rectangle(cairo, d->left[v], d->top[v], d->widths[v], d->heights[v]);
    cairo_clip(cairo);
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_BUTT); /* ends where the branch ends */
    for (size_t k = d->count; k-- > 0;)
        for (int b = 0; b < d->pairs[k].strokes; b++) {
            cairo_set_line_width(cairo, 1.5 * d->line);
            set_color(cairo, d, &d->pairs[k], b ? DARKER : 1, 1);
            draw_stroke(cairo, d, v, d->pairs[k].stroke[v][b]);
        }
    for (size_t k = d->count; k-- > 0;)
        if (d->pairs[k].dots)
            draw_dot(cairo, d, v, &d->pairs[k]);
    cairo_restore(cairo);
}

static void draw_legend(cairo_t *cairo, const drawing *d)
{
    char text[200], rejected[40] = "";
    const char *what[] = {"matches", "match", "line segments", "line segment"};
    const char *name = what[(d->content->segments ? 2 : 0) + (d->count == 1 ? 1 : 0)];
    const char *order = d->beside ? "left to right" : "top to bottom";
    const char *lines = !shows_epipolar_lines(d) ? "" :
                        d->across_count > EPIPOLAR_LINES ? "; across: some epipolar lines" : "; across: epipolar lines";
    unsigned long count = (unsigned long)d->count;
    /* the font inside cairo: the same on every machine, and there is always one */
    cairo_select_font_face(cairo, "@cairo:", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, d->font);
    cairo_set_source_rgb(cairo, 0.2, 0.2, 0.2);
    if (d->rejected > 0)
        snprintf(rejected, sizeof rejected, "; grey: %lu rejected", (unsigned long)d->rejected);
    const asj_match_result *result = d->content->result;
    const unsigned long found[2] = {(unsigned long)result->l_junction_count1, (unsigned long)result->l_junction_count2};
    if (d->count == 0 && found[0] + found[1] > 0 && d->width >= 40 * d->font)
        snprintf(text, sizeof text, "0 %s%s; grey: the L-junctions, %lu and %lu", name, rejected, found[0], found[1]);
    else if (d->width >= (56 + (d->rejected ? 10 : 0) + (*lines ? 16 : 0)) * d->font && d->count > 1)
        snprintf(text, sizeof text, "%lu %s   one colour each, by place in the first photograph, %s%s%s%s", count, name, order,
                 d->content->segments ? "" : "; branch b is darker", lines, rejected);
    else
        snprintf(text, sizeof text, "%lu %s%s", count, name, rejected);
    cairo_move_to(cairo, 0.8 * d->font, d->height + 1.55 * d->font);
    cairo_show_text(cairo, text);
}

static void draw(cairo_t *cairo, void *user)
{
    const drawing *d = user;
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    draw_photos(cairo, d);
    for (int v = 0; v < 2 && d->count == 0; v++)
        draw_unmatched(cairo, d, v);
    draw_rejected(cairo, d);
    if (shows_epipolar_lines(d))
        draw_epipolar_lines(cairo, d);
    if (!d->style->without_lines)
        draw_lines(cairo, d);
    draw_pairs(cairo, d, 0);
    draw_pairs(cairo, d, 1);
    if (d->legend_height > 0)
        draw_legend(cairo, d);
}

/* What a browser says of the things under its pointer. */
static void annotate(asj_output *output, void *user)
{
    const drawing *d = user;
    const char *name = d->content->segments ? "segment" : "match";
    char text[512];
    for (size_t k = 0; k < d->count; k++) {
        const pair *p = &d->pairs[k];
        const unsigned long number = (unsigned long)k + 1;
        snprintf(text, sizeof text, "<g id=\"%s-%lu\"><title>%s %lu: %.1f, %.1f and %.1f, %.1f</title>\n", name, number, name,
                 number, p->place[0][0], p->place[0][1], p->place[1][0], p->place[1][1]);
        asj_output_text(output, text);
        for (int v = 0; v < 2; v++)
            cli_plot_hot_dot(output, to_x(d, v, p->place[v][0]), to_y(d, v, p->place[v][1]), 3 * d->line);
        for (int b = 0; b < 2 * p->strokes; b++) {
            const double *s = p->stroke[b % 2][b / 2];
            cli_plot_hot_line(output, to_x(d, b % 2, s[0]), to_y(d, b % 2, s[1]), to_x(d, b % 2, s[2]), to_y(d, b % 2, s[3]),
                              3 * d->line);
        }
        asj_output_text(output, "</g>\n");
    }
}

asj_status cli_plot_match(const char *path, int32_t format, const cli_plot_match_content *content,
                          const cli_plot_match_style *style, char *message, size_t message_size)
{
    drawing d = {.content = content, .style = style};
    d.rejected = content->segments ? 0 : content->result->rejected_count;
    lay_out(&d);
    asj_status status = ASJ_ERROR_MEMORY;
    if (make_pairs(&d) && (!shows_epipolar_lines(&d) || make_epipolar_lines(&d)))
        status = cli_plot_file(path, format, d.width, d.height + d.legend_height,
                               &(cli_plot_content){draw, annotate, &d, cli_interrupted}, message, message_size);
    free(d.across);
    free(d.pairs);
    return status;
}
