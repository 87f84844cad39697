/* SPDX-License-Identifier: BSD-2-Clause */
/* Where rendered rooms seen from far apart lose what their geometry needs, stage by stage.
 *
 *     wide_stages [--first N] [--last N] [--common SHARE] [--draw N] [--threads N]
 *
 * Pairs of seeds --first (0) to --last (99) that have at least --common (1/3) of the images in common, with cameras. Counted are
 * places of image 1 (two of one pair of images are counted once when they are less than 5 px apart):
 *
 *     room       corners of the room's surfaces that both images show
 *     seen       places with an L-junction whose point of the room image 2 shows, too
 *     both       .. and where image 2 has an L-junction within NEAR px
 *     listed     .. that is among the best 16 of either
 *     aligned    .. and whose aligned point lies within RIGHT px of the true one
 *     affine     .. and whose map agrees with the true epipolar geometry (within three standard deviations)
 *     prior      sum of the probabilities that those have before any geometry
 *     explained  sum of the probabilities of right candidates under the true motion, refined
 *
 * then the angle from the true rotation to the nearest one that the images' directions allow (and how many those are), log10 NFA
 * of the true motion, refined and with planes, likewise with all that the candidates allow around it, how far its rotation has
 * moved from the true one by that (degrees), and what the estimation says: status, model, log10 NFA, that of its strongest rival,
 * sums of the probabilities of right candidates and of all under its geometry, and the error of its pose. */
#define _POSIX_C_SOURCE 200809L

#include "core/angle.h"
#include "geometry/estimate.h"
#include "geometry/evidence.h"
#include "geometry/motions.h"
#include "geometry/pairs.h"
#include "geometry/planes.h"
#include "geometry/posterior.h"
#include "geometry/small_matrix.h"
#include "match/align.h"
#include "match/consensus.h"
#include "match/geometry_candidate.h"
#include "match/image_features.h"
#include "match/match_options.h"
#include "match/prior.h"
#include "match/room_directions.h"
#include "match/shown_pictures.h"
#include "match/support.h"
#include "match/wide_shortlist.h"
#include "wide_pair.h"

#include <asj/asj.h>

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SHORTLIST 16  /* two_view.c */
#define CLUSTER 5.0   /* px: likewise */
#define NEAR 6.0      /* px */
#define RIGHT 4.0     /* px */
#define AROUND 2.0    /* px: corners lie on borders of surfaces */
#define TRUE_ROUNDS 8

typedef struct settings {
    long first, last, draw;
    double common;
    asj_context *context;
} settings;

typedef struct stage {
    uint8_t *pixels[2];
    asj_image images[2];
    asj_detection *found[2];
    asj_image_features features[2];
    asj_match_options options;
    asj_match_run run;
    asj_geometry_candidate *given;
    double *probability, *colours, *branches;
    asj_geometry_hints hints;
    asj_shown_pictures shown;
    uint32_t *place[2];
    uint8_t *right;   /* of each candidate: its aligned point is right; 2 = its map too */
} stage;

static void *get(size_t count, size_t size)
{
    void *p = calloc(count ? count : 1, size);
    if (!p) {
        fputs("wide_stages: no memory\n", stderr);
        exit(1);
    }
    return p;
}

/* --- the matcher's steps ------------------------------------------------------------------------------------------------------ */

static asj_status make_side(const settings *set, const synth_wide_pair *pair, int v, stage *s)
{
    const double f = pair->cameras[v].focal;
    asj_detect_options options;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    s->pixels[v] = synth_wide_picture(pair, v);
    s->images[v] = (asj_image){s->pixels[v], ASJ_FORMAT_RGB8, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT, 0, 0};
    s->options.geometry.cameras[v] = (asj_camera){f, f, 0.5 * (SYNTH_WIDE_WIDTH - 1), 0.5 * (SYNTH_WIDE_HEIGHT - 1)};
    s->options.geometry.widths[v] = SYNTH_WIDE_WIDTH;
    s->options.geometry.heights[v] = SYNTH_WIDE_HEIGHT;
    asj_status status = asj_detect(set->context, &s->images[v], &options, &s->found[v]);
    if (status == ASJ_OK)
        status = asj_image_features_create(set->context, &s->options, &s->images[v], s->found[v]->junctions,
                                           s->found[v]->junction_count, v + 1, 0, &s->features[v]);
    if (status == ASJ_OK)
        status = asj_image_features_add_colours(set->context, &s->images[v], &s->features[v]);
    return status;
}

static void cluster(const asj_l_junctions *in, uint32_t *place)
{
    for (uint32_t p = 0; p < in->location_count; p++) {
        place[p] = p;
        for (uint32_t q = p; q-- > 0 && in->location_x[p] - in->location_x[q] < CLUSTER;)
            if (hypot(in->location_x[p] - in->location_x[q], in->location_y[p] - in->location_y[q]) < CLUSTER &&
                !asj_is_guest_location(in, q)) {
                place[p] = place[q];
                break;
            }
    }
}

static asj_status make_candidates(stage *s)
{
    asj_status status = asj_wide_shortlist(&s->run);
    if (status == ASJ_OK)
        status = asj_align_candidates(&s->run, &s->run.candidates);
    if (status == ASJ_OK)
        status = asj_support_find(&s->run);
    if (status == ASJ_OK)
        status = asj_consensus(&s->run);
    if (status != ASJ_OK)
        return status;
    const size_t count = s->run.candidates.count;
    s->given = get(count, sizeof *s->given);
    s->probability = get(count, sizeof *s->probability);
    s->colours = get(count, sizeof *s->colours);
    s->branches = get(ASJ_BRANCH_NUMBERS * count, sizeof *s->branches);
    s->right = get(count, 1);
    status = asj_candidate_priors(&s->run, s->probability, s->colours);
    for (int v = 0; v < 2; v++) {
        s->place[v] = get(s->run.image[v]->l_junctions.location_count, sizeof *s->place[v]);
        cluster(&s->run.image[v]->l_junctions, s->place[v]);
    }
    if (status == ASJ_OK)
        status = asj_room_directions(s->run.context, s->run.image, s->options.geometry.cameras, s->hints.directions);
    if (status == ASJ_OK)
        status = asj_show_pictures(&s->run, &s->shown, s->hints.pictures);
    size_t kept = 0;
    for (size_t k = 0; k < count; k++) {
        const asj_candidate *c = &s->run.candidates.list[k];
        if (!asj_keeps_area(c->map.to))
            continue;
        s->given[kept] = asj_candidate_for_geometry(&s->run, c, s->probability[k]);
        s->given[kept].place1 = s->place[0][s->given[kept].place1];
        s->given[kept].place2 = s->place[1][s->given[kept].place2];
        asj_candidate_branches(&s->run, c, &s->branches[ASJ_BRANCH_NUMBERS * kept]);
        s->run.candidates.list[kept] = *c;
        s->colours[kept++] = s->colours[k];
    }
    s->run.candidates.count = kept;
    s->hints.colours = s->colours;
    s->hints.branches = s->branches;
    return status;
}

/* --- what is true ------------------------------------------------------------------------------------------------------------- */

/* Does what is seen around (x1, y1) appear within `near` px of (x2, y2)? x2 = NAN: anywhere. */
static int is_right(const synth_wide_pair *pair, double x1, double y1, double x2, double y2, double near)
{
    for (int j = -2; j <= 2; j++)
        for (int i = -2; i <= 2; i++) {
            synth_point p;
            if (i * i + j * j > 4 || !synth_room_transfer(&pair->room, &pair->cameras[0], x1 + i * AROUND / 2,
                                                          y1 + j * AROUND / 2, &pair->cameras[1], &p))
                continue;
            if (isnan(x2) || hypot(p.x - x2, p.y - y2) <= near)
                return 1;
        }
    return 0;
}

/* Angle and scale of the map against the true epipolar lines (likelihood.c). */
static int map_agrees(const double f[9], const asj_geometry_candidate *c, const asj_geometry_options *o)
{
    const double n2x = f[0] * c->x1 + f[1] * c->y1 + f[2], n2y = f[3] * c->x1 + f[4] * c->y1 + f[5];
    const double n1x = f[0] * c->x2 + f[3] * c->y2 + f[6], n1y = f[1] * c->x2 + f[4] * c->y2 + f[7];
    const double mx = c->affine[0] * n2x + c->affine[2] * n2y, my = c->affine[1] * n2x + c->affine[3] * n2y;
    const double angle = atan2(my * n1x - mx * n1y, -(mx * n1x + my * n1y));
    return fabs(angle) < 3 * o->angle_sd * ASJ_DEGREE && fabs(log(hypot(mx, my) / hypot(n1x, n1y))) < 3 * o->scale_sd;
}

/* The true motion as a model, refined. */
static void true_model(const synth_wide_pair *pair, const stage *s, const asj_pairs *set, asj_adjust_scratch *scratch,
                       asj_model *m)
{
    memset(m, 0, sizeof *m);
    m->kind = ASJ_GEOMETRY_ESSENTIAL;
    m->parameters = 5;
    memcpy(m->cameras, s->options.geometry.cameras, sizeof m->cameras);
    synth_relative_pose(&pair->cameras[0], &pair->cameras[1], m->rotation, m->translation);
    asj_model_complete(m);
    asj_model start = *m;
    asj_adjust_like(set, m, &start, TRUE_ROUNDS, scratch);
    m->evidence = asj_log_evidence(set, m, scratch);
    asj_add_planes(set, m, scratch);
    asj_model last = *m;
    asj_adjust(set, &last, TRUE_ROUNDS, scratch);
    last.evidence = asj_log_evidence(set, &last, scratch);
    if (last.evidence > m->evidence)
        *m = last;
}

static double turn_between(const double a[9], const double b[9])
{
    double trace = 0;
    for (int k = 0; k < 9; k++)
        trace += a[k] * b[k];
    return acos(fmax(-1, fmin(1, (trace - 1) / 2))) / ASJ_DEGREE;
}

/* --- the table ---------------------------------------------------------------------------------------------------------------- */

typedef struct counts {
    int room, seen, both, listed, aligned, affine;
    double prior;
} counts;

static void count_places(const synth_wide_pair *pair, stage *s, counts *n)
{
    const asj_l_junctions *in1 = &s->run.image[0]->l_junctions, *in2 = &s->run.image[1]->l_junctions;
    double f[9];
    uint8_t *flags = get(in1->location_count, 1); /* 1 listed, 2 aligned, 4 affine */
    synth_fundamental(&pair->cameras[0], &pair->cameras[1], f);
    for (size_t k = 0; k < s->run.candidates.count; k++) {
        const asj_geometry_candidate *c = &s->given[k];
        const uint32_t i = in1->location[s->run.candidates.list[k].i], j = in2->location[s->run.candidates.list[k].j];
        uint8_t *flag = &flags[s->place[0][i]];
        if (is_right(pair, in1->location_x[i], in1->location_y[i], in2->location_x[j], in2->location_y[j], NEAR))
            *flag |= 1;
        if (is_right(pair, c->x1, c->y1, c->x2, c->y2, RIGHT)) {
            s->right[k] = 1;
            *flag |= 3;
            if (map_agrees(f, c, &s->options.geometry)) {
                *flag |= 4;
                s->right[k] = 2;
                n->prior += c->probability;
            }
        }
    }
    n->room = pair->corners;
    for (uint32_t p = 0; p < in1->location_count; p++) {
        if (s->place[0][p] != p || asj_is_guest_location(in1, p))
            continue;
        const double x = in1->location_x[p], y = in1->location_y[p];
        int both = 0;
        for (uint32_t q = 0; q < in2->location_count && !both; q++)
            both = !asj_is_guest_location(in2, q) && is_right(pair, x, y, in2->location_x[q], in2->location_y[q], NEAR);
        n->seen += is_right(pair, x, y, NAN, NAN, 0);
        n->both += both;
        n->listed += flags[p] & 1;
        n->aligned += flags[p] >> 1 & 1;
        n->affine += flags[p] >> 2 & 1;
    }
    free(flags);
}

static double pose_error(const synth_wide_pair *pair, const asj_geometry *g)
{
    const synth_pose_error off = synth_pose_off(&pair->cameras[0], &pair->cameras[1], g->rotation, g->translation);
    return fmax(off.rotation, off.translation);
}

static asj_status tell(const settings *set, const synth_wide_pair *pair, stage *s, const counts *n)
{
    asj_memory *memory = &set->context->memory;
    asj_pairs pairs;
    asj_model m;
    asj_judge judge;
    asj_geometry g;
    double explained = 0, nearest = 180, right = 0, all = 0;
    asj_status status = asj_pairs_create(set->context, s->given, s->run.candidates.count, &s->hints, &s->options.geometry, &pairs);
    asj_adjust_scratch *scratch = asj_adjust_scratches_create(memory, &pairs, set->context->threads);
    if (status != ASJ_OK || !scratch)
        return ASJ_ERROR_MEMORY;
    true_model(pair, s, &pairs, &scratch[0], &m);
    double *probability = get((size_t)pairs.count, sizeof *probability);
    asj_probabilities(&pairs, &m.view, 1, &scratch[0].score, probability);
    for (int32_t k = 0; k < pairs.count; k++)
        explained += s->right[pairs.list[k].source] ? probability[k] : 0;
    double rotation[9], t[3];
    synth_relative_pose(&pair->cameras[0], &pair->cameras[1], rotation, t);
    for (int32_t k = 0; k < pairs.rotation_count; k++)
        nearest = fmin(nearest, turn_between(rotation, pairs.rotations[k].matrix));
    const double evidence = m.evidence, off = turn_between(rotation, m.rotation);
    asj_settle(set->context, &pairs, 1, scratch, &m);
    status = asj_estimate_with_hints(set->context, s->given, s->run.candidates.count, &s->hints, &s->options.geometry,
                                     s->probability, &judge, &g);
    for (size_t k = 0; k < s->run.candidates.count; k++) {
        right += s->right[k] ? s->probability[k] : 0;
        all += s->probability[k];
    }
    printf("%5lu %5.2f %5d %5d %5d %6d %7d %6d %6.2f %9.1f %6.1f %3d ", (unsigned long)pair->seed, pair->common, n->room, n->seen,
           n->both, n->listed, n->aligned, n->affine, n->prior, explained, nearest, pairs.rotation_count);
    printf(" %7.1f %7.1f %5.1f  %-10s %-11s", -evidence / log(10), -fmax(evidence, m.evidence) / log(10), off,
           asj_geometry_status_name(g.status), asj_geometry_model_name(g.model));
    printf(" %9.1f %9.1f %6.1f %6.1f %6.1f\n", g.log10_nfa, g.rival_log10_nfa, right, all, pose_error(pair, &g));
    fflush(stdout);
    free(probability);
    asj_adjust_scratches_free(memory, scratch, set->context->threads);
    asj_pairs_free(memory, &pairs);
    return status;
}

static asj_status one_pair(const settings *set, const synth_wide_pair *pair)
{
    static stage s;
    counts n = {0};
    asj_status status = ASJ_OK;
    memset(&s, 0, sizeof s);
    asj_match_options_init(&s.options);
    s.options.shortlist = SHORTLIST;
    s.options.geometry.model = ASJ_GEOMETRY_AUTO;
    for (int v = 0; v < 2 && status == ASJ_OK; v++)
        status = make_side(set, pair, v, &s);
    s.run = (asj_match_run){.context = set->context, .options = &s.options, .image = {&s.features[0], &s.features[1]}};
    if (status == ASJ_OK)
        status = make_candidates(&s);
    if (status == ASJ_OK) {
        count_places(pair, &s, &n);
        status = tell(set, pair, &s, &n);
    }
    asj_release(&set->context->memory, s.run.candidates.list);
    asj_wide_shortlist_free(&s.run);
    asj_support_free(&set->context->memory, &s.run.support);
    asj_shown_pictures_free(&set->context->memory, &s.shown);
    free(s.given);
    free(s.probability);
    free(s.colours);
    free(s.branches);
    free(s.right);
    for (int v = 0; v < 2; v++) {
        free(s.place[v]);
        asj_image_features_free(&set->context->memory, &s.features[v]);
        asj_detection_free(&s.found[v]);
        free(s.pixels[v]);
    }
    return status;
}

int main(int argc, char **argv)
{
    static const struct option longs[] = {{"first", 1, NULL, 'f'}, {"last", 1, NULL, 'l'}, {"common", 1, NULL, 'c'},
                                          {"draw", 1, NULL, 'd'}, {"threads", 1, NULL, 't'}, {NULL, 0, NULL, 0}};
    settings set = {.last = 99, .common = 1.0 / 3};
    asj_context_options how;
    int c;
    asj_context_options_init(&how);
    while ((c = getopt_long(argc, argv, "", longs, NULL)) != -1)
        switch (c) {
        case 'f': set.first = strtol(optarg, NULL, 10); break;
        case 'l': set.last = strtol(optarg, NULL, 10); break;
        case 'c': set.common = strtod(optarg, NULL); break;
        case 'd': set.draw = strtol(optarg, NULL, 10); break;
        case 't': how.threads = (int32_t)strtol(optarg, NULL, 10); break;
        default:
            fputs("usage: wide_stages [--first N] [--last N] [--common SHARE] [--draw N] [--threads N]\n", stderr);
            return 2;
        }
    if (asj_context_create(&how, &set.context) != ASJ_OK)
        return 1;
    puts(" seed common room  seen  both listed aligned affine  prior explained directions      true settled   off  "
         "status     model       log10 NFA    second  right    all  error");
    for (long seed = set.first; seed <= set.last; seed++) {
        synth_wide_pair pair;
        if (synth_wide_pair_make(&pair, (uint64_t)seed) != 0)
            continue; /* no such viewpoints in this room */
        for (int v = 0; v < 2; v++)
            pair.exposures[v].noise_seed += 1000003 * (uint64_t)set.draw;
        const int failed = pair.common >= set.common && one_pair(&set, &pair) != ASJ_OK;
        synth_wide_pair_free(&pair);
        if (failed) {
            fprintf(stderr, "wide_stages: %s\n", asj_context_message(set.context));
            return 1;
        }
    }
    asj_context_free(&set.context);
    return 0;
}
