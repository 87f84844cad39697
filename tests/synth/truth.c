/* SPDX-License-Identifier: BSD-2-Clause */
/* Three steps: cut the edges into pieces (cut_*), join pieces in points (build_graph), walk along straight lines (walk).
 * Tolerances: points closer than SNAP are one; a line may deviate by LINE across while it is walked. Both are far below what any
 * detector can see and far above rounding. */
#include "truth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define SNAP 1e-3     /* px */
#define LINE 1e-2     /* px */
#define BESIDE 2e-3   /* px from an edge to where its two sides are looked at */
#define DEGREE 24     /* most pieces in one point */

typedef struct piece {
    synth_point a, b;
    double contrast;
    int32_t node_a, node_b;
} piece;

typedef struct pieces {
    piece *items;
    int32_t count, capacity;
    int32_t failed;
} pieces;

typedef struct node {
    synth_point at;
    int32_t piece[DEGREE];
    int32_t degree;
    int32_t at_border;
} node;

typedef struct graph {
    const pieces *list;
    node *nodes;
    int32_t count;
    int32_t width, height;
} graph;

double synth_angle_distance(double a, double b)
{
    const double d = fmod(fabs(a - b), 2.0 * PI);
    return d > PI ? 2.0 * PI - d : d;
}

static double length_of(synth_point a, synth_point b)
{
    return hypot(b.x - a.x, b.y - a.y);
}

static synth_point along(synth_point a, synth_point b, double t)
{
    const synth_point p = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
    return p;
}

/* ---- cutting ---- */

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Liang-Barsky: the part of ab inside the image. 0 when there is none. */
static int clip_to_image(synth_point *a, synth_point *b, int32_t width, int32_t height)
{
    const double dx = b->x - a->x, dy = b->y - a->y;
    const double p[4] = {-dx, dx, -dy, dy};
    const double q[4] = {a->x + 0.5, width - 0.5 - a->x, a->y + 0.5, height - 0.5 - a->y};
    double t0 = 0.0, t1 = 1.0;
    for (int i = 0; i < 4; i++) {
        if (p[i] == 0.0) {
            if (q[i] < 0.0)
                return 0;
        } else if (p[i] < 0.0) {
            t0 = fmax(t0, q[i] / p[i]);
        } else {
            t1 = fmin(t1, q[i] / p[i]);
        }
    }
    if (t0 >= t1)
        return 0;
    const synth_point start = along(*a, *b, t0), end = along(*a, *b, t1);
    *a = start;
    *b = end;
    return 1;
}

/* Parameters on ab where cd touches or crosses it: up to three. */
static int32_t meet(synth_point a, synth_point b, synth_point c, synth_point d, double *t)
{
    const double length = length_of(a, b), ux = (b.x - a.x) / length, uy = (b.y - a.y) / length;
    const double tc = (c.x - a.x) * ux + (c.y - a.y) * uy, sc = (c.y - a.y) * ux - (c.x - a.x) * uy;
    const double td = (d.x - a.x) * ux + (d.y - a.y) * uy, sd = (d.y - a.y) * ux - (d.x - a.x) * uy;
    int32_t count = 0;
    if (fabs(sc) < SNAP && tc > 0.0 && tc < length)
        t[count++] = tc / length;
    if (fabs(sd) < SNAP && td > 0.0 && td < length)
        t[count++] = td / length;
    if ((sc > 0.0) != (sd > 0.0) && fabs(sc - sd) > SNAP) {
        const double cross = tc + sc / (sc - sd) * (td - tc);
        if (cross > 0.0 && cross < length)
            t[count++] = cross / length;
    }
    return count;
}

static void add_piece(pieces *list, synth_point a, synth_point b, double contrast)
{
    if (list->count == list->capacity) {
        const int32_t capacity = list->capacity ? 2 * list->capacity : 256;
        piece *grown = realloc(list->items, (size_t)capacity * sizeof *grown);
        if (!grown) {
            list->failed = 1;
            return;
        }
        list->items = grown;
        list->capacity = capacity;
    }
    const piece item = {a, b, contrast, -1, -1};
    list->items[list->count++] = item;
}

static double step_across(const synth_scene *scene, synth_point a, synth_point b)
{
    const double length = length_of(a, b), nx = -(b.y - a.y) / length * BESIDE, ny = (b.x - a.x) / length * BESIDE;
    const synth_point m = along(a, b, 0.5);
    return fabs(synth_scene_gray(scene, m.x + nx, m.y + ny) - synth_scene_gray(scene, m.x - nx, m.y - ny));
}

/* Cuts ab at the sorted parameters and keeps what can be seen; without a scene everything can. */
static void cut_at(const synth_scene *scene, double min_contrast, synth_point a, synth_point b, double *t, int32_t count,
                   pieces *list)
{
    const double length = length_of(a, b);
    qsort(t, (size_t)count, sizeof *t, compare_doubles);
    double from = 0.0;
    for (int32_t i = 0; i <= count; i++) {
        double to = i < count ? t[i] : 1.0;
        if ((to - from) * length < SNAP)
            continue;
        if (i < count && (1.0 - to) * length < SNAP)
            to = 1.0;
        const synth_point start = along(a, b, from), end = along(a, b, to);
        const double contrast = scene ? step_across(scene, start, end) : 0.0;
        if (!scene || contrast >= min_contrast)
            add_piece(list, start, end, contrast);
        from = to;
        if (to >= 1.0)
            break;
    }
}

static void cut_polygon_edge(const synth_scene *scene, double min_contrast, synth_point a, synth_point b, double *t, pieces *list)
{
    int32_t count = 0;
    if (!clip_to_image(&a, &b, scene->width, scene->height) || length_of(a, b) < SNAP)
        return;
    for (int32_t i = 0; i < scene->count; i++) {
        const synth_polygon *other = &scene->polygons[i];
        for (int32_t k = 0; k < other->count; k++)
            count += meet(a, b, other->corners[k], other->corners[(k + 1) % other->count], t + count);
    }
    cut_at(scene, min_contrast, a, b, t, count, list);
}

/* ---- joining ---- */

static int32_t node_at(graph *g, synth_point p)
{
    for (int32_t i = 0; i < g->count; i++)
        if (fabs(g->nodes[i].at.x - p.x) < 2.0 * SNAP && fabs(g->nodes[i].at.y - p.y) < 2.0 * SNAP)
            return i;
    node *n = &g->nodes[g->count];
    memset(n, 0, sizeof *n);
    n->at = p;
    n->at_border = p.x < -0.5 + SNAP || p.y < -0.5 + SNAP || p.x > g->width - 0.5 - SNAP || p.y > g->height - 0.5 - SNAP;
    return g->count++;
}

static int32_t other_end(const piece *p, int32_t from)
{
    return p->node_a == from ? p->node_b : p->node_a;
}

/* A piece that two polygons share is there twice: the second is dropped. */
static int joined_already(const graph *g, int32_t a, int32_t b)
{
    for (int32_t i = 0; i < g->nodes[a].degree; i++)
        if (other_end(&g->list->items[g->nodes[a].piece[i]], a) == b)
            return 1;
    return 0;
}

static int build_graph(pieces *list, graph *g)
{
    g->list = list;
    g->count = 0;
    g->nodes = malloc((2 * (size_t)list->count + 1) * sizeof *g->nodes);
    if (!g->nodes)
        return -1;
    for (int32_t i = 0; i < list->count; i++) {
        piece *p = &list->items[i];
        p->node_a = node_at(g, p->a);
        p->node_b = node_at(g, p->b);
        node *a = &g->nodes[p->node_a], *b = &g->nodes[p->node_b];
        if (a == b || joined_already(g, p->node_a, p->node_b) || a->degree == DEGREE || b->degree == DEGREE)
            continue;
        a->piece[a->degree++] = i;
        b->piece[b->degree++] = i;
    }
    return 0;
}

/* ---- walking ---- */

/* The piece that continues the line from `origin` along the unit vector (ux, uy) beyond node `at`; -1 when it ends there. */
static int32_t straight_on(const graph *g, synth_point origin, double ux, double uy, int32_t at, int32_t came_by)
{
    const node *n = &g->nodes[at];
    const double here = (n->at.x - origin.x) * ux + (n->at.y - origin.y) * uy;
    for (int32_t i = 0; i < n->degree; i++) {
        if (n->piece[i] == came_by)
            continue;
        const synth_point far_end = g->nodes[other_end(&g->list->items[n->piece[i]], at)].at;
        const double t = (far_end.x - origin.x) * ux + (far_end.y - origin.y) * uy;
        const double s = (far_end.y - origin.y) * ux - (far_end.x - origin.x) * uy;
        if (t > here && fabs(s) < fmin(LINE, 0.1 * (t - here)))
            return n->piece[i];
    }
    return -1;
}

/* Two pieces that run straight through and nothing else. */
static int is_junction(const graph *g, int32_t at)
{
    const node *n = &g->nodes[at];
    if (n->degree < 2 || n->at_border)
        return 0;
    if (n->degree > 2)
        return 1;
    const synth_point p = g->nodes[other_end(&g->list->items[n->piece[0]], at)].at;
    const double length = length_of(p, n->at);
    return straight_on(g, p, (n->at.x - p.x) / length, (n->at.y - p.y) / length, at, n->piece[0]) < 0;
}

static synth_true_branch walk(const graph *g, int32_t start, int32_t first)
{
    synth_true_branch branch = {0.0, 0.0, 0.0, HUGE_VAL, g->list->items[first].contrast, -1, 0};
    const synth_point origin = g->nodes[start].at;
    int32_t at = other_end(&g->list->items[first], start), by = first;
    /* The direction of the longest stretch so far: the first piece alone may be short. */
    while (by >= 0) {
        const piece *p = &g->list->items[by];
        const synth_point end = g->nodes[at].at;
        const double length = length_of(origin, end), ux = (end.x - origin.x) / length, uy = (end.y - origin.y) / length;
        branch.contrast += p->contrast * (length - branch.length);
        branch.weakest = fmin(branch.weakest, p->contrast);
        branch.length = length;
        branch.angle = atan2(uy, ux);
        by = straight_on(g, origin, ux, uy, at, by);
        if (by >= 0 && is_junction(g, at))
            branch.passes++;
        if (by >= 0)
            at = other_end(&g->list->items[by], at);
    }
    branch.passes++;
    branch.contrast /= branch.length;
    branch.angle += branch.angle < 0.0 ? 2.0 * PI : 0.0;
    branch.at_border = g->nodes[at].at_border;
    return branch;
}

static int compare_branches(const void *a, const void *b)
{
    return compare_doubles(&((const synth_true_branch *)a)->angle, &((const synth_true_branch *)b)->angle);
}

static int collect(const graph *g, synth_truth *truth)
{
    truth->count = 0;
    truth->junctions = malloc(((size_t)g->count + 1) * sizeof *truth->junctions);
    if (!truth->junctions)
        return -1;
    for (int32_t i = 0; i < g->count; i++) {
        if (!is_junction(g, i))
            continue;
        synth_true_junction *junction = &truth->junctions[truth->count++];
        memset(junction, 0, sizeof *junction);
        junction->x = g->nodes[i].at.x;
        junction->y = g->nodes[i].at.y;
        for (int32_t k = 0; k < g->nodes[i].degree && k < SYNTH_MAX_BRANCHES; k++)
            junction->branches[junction->branch_count++] = walk(g, i, g->nodes[i].piece[k]);
        qsort(junction->branches, (size_t)junction->branch_count, sizeof junction->branches[0], compare_branches);
    }
    return 0;
}

static int finish(pieces *list, int32_t width, int32_t height, synth_truth *truth)
{
    graph g = {list, NULL, 0, width, height};
    const int result = !list->failed && build_graph(list, &g) == 0 && collect(&g, truth) == 0 ? 0 : -1;
    free(g.nodes);
    free(list->items);
    return result;
}

int synth_truth_of_scene(const synth_scene *scene, double min_contrast, synth_truth *truth)
{
    memset(truth, 0, sizeof *truth);
    if (scene->failed)
        return -1;
    size_t edges = 1;
    for (int32_t i = 0; i < scene->count; i++)
        edges += (size_t)scene->polygons[i].count;
    double *t = malloc(3 * edges * sizeof *t);
    if (!t)
        return -1;
    pieces list = {NULL, 0, 0, 0};
    for (int32_t i = 0; i < scene->count; i++) {
        const synth_polygon *polygon = &scene->polygons[i];
        for (int32_t k = 0; k < polygon->count; k++)
            cut_polygon_edge(scene, min_contrast, polygon->corners[k], polygon->corners[(k + 1) % polygon->count], t, &list);
    }
    free(t);
    return finish(&list, scene->width, scene->height, truth);
}

int synth_truth_of_lines(const synth_point *ends, int32_t count, int32_t width, int32_t height, synth_truth *truth)
{
    memset(truth, 0, sizeof *truth);
    double *t = malloc((3 * (size_t)count + 1) * sizeof *t);
    if (!t)
        return -1;
    pieces list = {NULL, 0, 0, 0};
    for (int32_t i = 0; i < count; i++) {
        int32_t cuts = 0;
        for (int32_t k = 0; k < count; k++)
            if (k != i)
                cuts += meet(ends[2 * i], ends[2 * i + 1], ends[2 * k], ends[2 * k + 1], t + cuts);
        cut_at(NULL, 0.0, ends[2 * i], ends[2 * i + 1], t, cuts, &list);
    }
    free(t);
    return finish(&list, width, height, truth);
}

void synth_truth_free(synth_truth *truth)
{
    free(truth->junctions);
    memset(truth, 0, sizeof *truth);
}

double synth_truth_opening(const synth_true_junction *junction, double margin, double min_length, double min_contrast)
{
    double best = 0.0;
    for (int32_t i = 0; i < junction->branch_count; i++)
        for (int32_t k = i + 1; k < junction->branch_count; k++) {
            const synth_true_branch *a = &junction->branches[i], *b = &junction->branches[k];
            const double opening = synth_angle_distance(a->angle, b->angle);
            if (opening >= margin && opening <= PI - margin && fmin(a->length, b->length) >= min_length &&
                fmin(a->near_step, b->near_step) >= min_contrast)
                best = fmax(best, opening);
        }
    return best;
}
