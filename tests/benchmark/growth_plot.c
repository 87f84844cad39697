/* SPDX-License-Identifier: BSD-2-Clause */
#include "growth_plot.h"
#include "plot_format.h"
#include "plot_surface.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define WIDTH 900
#define HEIGHT 680
#define LEFT 70     /* of a panel: room for numbers */
#define RIGHT 20
#define TOP 40
#define BOTTOM 50

typedef struct axes {
    double x, y, width, height;        /* of the panel's inside */
    double x_low, x_high, y_low, y_high; /* whole powers of ten */
} axes;

static double to_x(const axes *a, double x)
{
    return a->x + a->width * (log10(x) - a->x_low) / (a->x_high - a->x_low);
}

static double to_y(const axes *a, double y)
{
    return a->y + a->height * (1 - (log10(y) - a->y_low) / (a->y_high - a->y_low));
}

static void range(const double *values, int32_t count, double *low, double *high)
{
    *low = *high = log10(values[0]);
    for (int32_t i = 1; i < count; i++) {
        *low = fmin(*low, log10(values[i]));
        *high = fmax(*high, log10(values[i]));
    }
    *low = floor(*low + 1e-9);
    *high = fmax(ceil(*high - 1e-9), *low + 1);
}

static void text(cairo_t *cairo, double x, double y, double align, const char *line)
{
    cairo_text_extents_t size;
    cairo_text_extents(cairo, line, &size);
    cairo_move_to(cairo, x - align * size.x_advance, y);
    cairo_show_text(cairo, line);
}

static void line(cairo_t *cairo, double x0, double y0, double x1, double y1)
{
    cairo_move_to(cairo, x0, y0);
    cairo_line_to(cairo, x1, y1);
    cairo_stroke(cairo);
}

static void draw_grid(cairo_t *cairo, const axes *a)
{
    char number[32];
    cairo_set_line_width(cairo, 1);
    for (double power = a->x_low; power <= a->x_high; power++) {
        const double x = a->x + a->width * (power - a->x_low) / (a->x_high - a->x_low);
        snprintf(number, sizeof number, "%g", pow(10, power));
        cairo_set_source_rgb(cairo, 0.85, 0.85, 0.85);
        line(cairo, x, a->y, x, a->y + a->height);
        cairo_set_source_rgb(cairo, 0, 0, 0);
        text(cairo, x, a->y + a->height + 16, 0.5, number);
    }
    for (double power = a->y_low; power <= a->y_high; power++) {
        const double y = a->y + a->height * (1 - (power - a->y_low) / (a->y_high - a->y_low));
        snprintf(number, sizeof number, "%g", pow(10, power));
        cairo_set_source_rgb(cairo, 0.85, 0.85, 0.85);
        line(cairo, a->x, y, a->x + a->width, y);
        cairo_set_source_rgb(cairo, 0, 0, 0);
        text(cairo, a->x - 6, y + 4, 1, number);
    }
}

static void draw_labels(cairo_t *cairo, const axes *a, const growth_curve *curve, double exponent)
{
    char fitted[64];
    snprintf(fitted, sizeof fitted, "exponent %.2f", exponent);
    cairo_set_source_rgb(cairo, 0, 0, 0);
    text(cairo, a->x + a->width / 2, a->y - 14, 0.5, curve->title);
    text(cairo, a->x + a->width / 2, a->y + a->height + 34, 0.5, curve->x_label);
    text(cairo, a->x + 8, a->y + 16, 0, curve->y_label);
    cairo_set_source_rgb(cairo, 0.8, 0.3, 0.1);
    text(cairo, a->x + 8, a->y + 32, 0, fitted);
}

static void draw_curve(cairo_t *cairo, const axes *a, const growth_curve *curve)
{
    static const double dashes[] = {5, 4};
    const double first = curve->x[0], last = curve->x[curve->count - 1];
    double factor, exponent;
    growth_fit(curve, 0, &factor, &exponent);
    draw_grid(cairo, a);
    cairo_save(cairo);
    cairo_rectangle(cairo, a->x, a->y, a->width, a->height);
    cairo_clip(cairo);
    cairo_set_source_rgb(cairo, 0.8, 0.3, 0.1);
    cairo_set_dash(cairo, dashes, 2, 0);
    line(cairo, to_x(a, first), to_y(a, factor * pow(first, exponent)), to_x(a, last), to_y(a, factor * pow(last, exponent)));
    cairo_restore(cairo);
    cairo_set_source_rgb(cairo, 0.1, 0.3, 0.7);
    cairo_set_line_width(cairo, 1.5);
    for (int32_t i = 0; i < curve->count; i++)
        cairo_line_to(cairo, to_x(a, curve->x[i]), to_y(a, curve->y[i]));
    cairo_stroke(cairo);
    for (int32_t i = 0; i < curve->count; i++) {
        cairo_arc(cairo, to_x(a, curve->x[i]), to_y(a, curve->y[i]), 3, 0, 6.2832);
        cairo_fill(cairo);
    }
    draw_labels(cairo, a, curve, exponent);
}

static void draw(cairo_t *cairo, void *user)
{
    const growth_curve *curves = user;
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_select_font_face(cairo, "@cairo:", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL); /* the one inside cairo */
    cairo_set_font_size(cairo, 12);
    for (int i = 0; i < 4; i++) {
        axes a = {.x = WIDTH / 2 * (i % 2) + LEFT, .y = HEIGHT / 2 * (i / 2) + TOP,
                  .width = WIDTH / 2 - LEFT - RIGHT, .height = HEIGHT / 2 - TOP - BOTTOM};
        range(curves[i].x, curves[i].count, &a.x_low, &a.x_high);
        range(curves[i].y, curves[i].count, &a.y_low, &a.y_high);
        draw_curve(cairo, &a, &curves[i]);
    }
}

int growth_plot(const char *path, const growth_curve curves[4])
{
    static const char *const ends[] = {"png", "svg", "pdf"}; /* in the order of CLI_PLOT_... */
    growth_curve copy[4];
    char message[512];
    const char *dot = strrchr(path, '.');
    int32_t format = 0;
    while (format < 3 && (!dot || strcmp(dot + 1, ends[format]) != 0))
        format++;
    if (format == 3) {
        fprintf(stderr, "growth: %s: the name does not end in .png, .svg or .pdf\n", path);
        return -1;
    }
    memcpy(copy, curves, sizeof copy);
    const cli_plot_content content = {.draw = draw, .user = copy};
    if (cli_plot_file(path, format, WIDTH, HEIGHT, &content, message, sizeof message) == ASJ_OK)
        return 0;
    fprintf(stderr, "growth: %s\n", message);
    return -1;
}
