/* SPDX-License-Identifier: BSD-2-Clause */
/* Two-view geometry on rendered rooms seen from far apart, whose cameras are known.
 *
 *     wide_rooms [--check] [--held-out] [--unrelated] [--no-cameras | --find-focal | --focal-error E] [--focal-sd S]
 *                [--stretch X,Y | --as-they-are] [--first-octave N] [--first N] [--last N] [--threads N] [--draw N] [--seed N]
 *                [--near | --turned] [--poses] [--colours yes|no]
 *
 * Pairs of seeds --first (0) to --last (99): status, model, log10 NFA, pose error (the larger of rotation and direction of
 * translation, degrees) and matches within 4 px of their epipolar lines. Then the area under the curve of recall over error up to
 * 1, 2, 5, 10 and 20 degrees, how many of the pairs with a third in common were accepted, and how many of the accepted are wrong by
 * more than 3 degrees. --held-out: seeds that nothing was tuned on. --unrelated: image 1 of a seed with image 2 of the next one.
 * Pairs are looked at by asj_match_images(), automatically as asj-cli match does (0,0) or with the --stretch that is given;
 * --as-they-are: by asj_detect() and asj_match(), which look once.
 * --focal-error: cameras are given with focal lengths that are too long by E (0.05: by 5 %). --focal-sd: how well they are told
 * to be known (0).
 * --near: the cameras are 1 to 15 degrees apart. --turned: they stand in one place; error: of the rotation, and no pose is right,
 * since there is no direction of a translation. --draw: another draw of the images' noise. --seed: of the samples. --poses: log10
 * NFA of the strongest rival, how well the pictures agree (asj_geometry), and how far rotation and translation are out, in brackets
 * as told (the largest standard deviation of either). --colours: the detector always looks at them, or asj_match_images() never.
 * --check: exit 1 when fewer poses (--turned: rotations) are right, within 3 degrees, than below, or more are wrong, or too many
 * matches are; of cameras whose focal length is found a few poses may be, for what is not known of it. */
#define _POSIX_C_SOURCE 200809L
#include "wide_pair.h"

#include <asj/asj.h>

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE (3.14159265358979323846 / 180.0)
#define MOST 10000
#define NEAR 4.0 /* px */

static const double least_right = 0.50, least_turned = 0.90; /* of --check: share of all pairs */
static const double least_matches = 0.90;                    /* and of the matches of those that are accepted */
static const int most_wrong = 0, most_wrong_with_focal = 2, most_far_off = 0;

typedef struct settings {
    int check, near, turned, held_out, unrelated, no_cameras, find_focal, first_octave, poses, as_they_are, colours, no_colours;
    long first, last, draw, seed;
    double focal_error, focal_sd;
    asj_stretch stretch;
    asj_context *context;
} settings;

typedef struct tally {
    double errors[MOST], focals[MOST]; /* relative error of those that were found */
    int focal_count, pairs, accepted, with_pose, turns, wrong, far_off, common, common_accepted;
    uint32_t matches, right_matches; /* of those that are accepted */
} tally;

static int take_picture(const synth_wide_pair *pair, int which, uint8_t **pixels, asj_image *image)
{
    *pixels = synth_wide_picture(pair, which);
    *image = (asj_image){*pixels, ASJ_FORMAT_RGB8, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT, 0, 0};
    return *pixels ? 0 : -1;
}

static asj_detect_options detect_options_of(const settings *set)
{
    asj_detect_options options;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    options.first_octave = set->first_octave;
    options.colours = set->colours;
    return options;
}

static asj_match_options match_options_of(const settings *set, const synth_wide_pair *const pairs[2])
{
    asj_match_options options;
    asj_match_options_init(&options);
    options.look_at_colours = !set->no_colours;
    options.geometry.model = ASJ_GEOMETRY_AUTO;
    options.geometry.find_focal = set->find_focal;
    options.geometry.focal_sd = set->focal_sd;
    options.geometry.seed = (uint64_t)set->seed;
    for (int v = 0; v < 2 && !set->no_cameras && !set->find_focal; v++) {
        const double f = pairs[v]->cameras[v].focal * (1 + set->focal_error);
        options.geometry.cameras[v] = (asj_camera){f, f, 0.5 * (SYNTH_WIDE_WIDTH - 1), 0.5 * (SYNTH_WIDE_HEIGHT - 1)};
    }
    return options;
}

/* What a program does that detects and matches by itself. */
static int match_as_they_are(const settings *set, const asj_image images[2], const asj_match_options *options,
                             asj_match_result **result)
{
    const asj_detect_options detect_options = detect_options_of(set);
    asj_detection *found[2] = {NULL, NULL};
    int failed = 0;
    for (int v = 0; v < 2 && !failed; v++)
        failed = asj_detect(set->context, &images[v], &detect_options, &found[v]) != ASJ_OK;
    if (!failed)
        failed = asj_match(set->context, &images[0], found[0]->junctions, found[0]->junction_count, &images[1], found[1]->junctions,
                           found[1]->junction_count, options, result) != ASJ_OK;
    asj_detection_free(&found[0]);
    asj_detection_free(&found[1]);
    return failed;
}

/* A camera that only turns. */
static double turn_error(const asj_geometry *g, const synth_wide_pair *pair)
{
    if (g->status != ASJ_GEOMETRY_ACCEPTED || !(g->has_pose || g->only_turns))
        return 180;
    return synth_pose_off(&pair->cameras[0], &pair->cameras[1], g->rotation, g->translation).rotation;
}

static double pose_error(const asj_geometry *g, const synth_wide_pair *pair)
{
    if (g->status != ASJ_GEOMETRY_ACCEPTED || !g->has_pose)
        return 180;
    const synth_pose_error off = synth_pose_off(&pair->cameras[0], &pair->cameras[1], g->rotation, g->translation);
    return fmax(off.rotation, off.translation);
}

/* The largest standard deviation of a direction in a block of the told covariance, degrees: by the power method. */
static double told_sd(const double covariance[36], int first)
{
    double v[3] = {0.6, 0.5, 0.4}, length = 0;
    for (int round = 0; round < 60; round++) {
        double w[3] = {0, 0, 0};
        for (int k = 0; k < 9; k++)
            w[k / 3] += covariance[6 * (first + k / 3) + first + k % 3] * v[k % 3];
        length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
        for (int k = 0; k < 3 && length > 0; k++)
            v[k] = w[k] / length;
    }
    return sqrt(length) / DEGREE;
}

/* Rotation and direction of the translation one by one. */
static void print_pose(const asj_geometry *g, const synth_wide_pair *pair)
{
    const synth_pose_error off = synth_pose_off(&pair->cameras[0], &pair->cameras[1], g->rotation, g->translation);
    printf("  rotation %.2f (%.2f) translation %.2f (%.2f)", off.rotation, told_sd(g->covariance, 0), off.translation,
           told_sd(g->covariance, 3));
}

/* How far the second location is from the epipolar line or, where the camera only turns, from its place, px. */
static double off(const settings *set, const synth_wide_pair *pair, const double f[9], const asj_junction_match *m)
{
    synth_point image;
    if (!set->turned)
        return synth_off_epipolar_line(f, (double)m->x1, (double)m->y1, (double)m->x2, (double)m->y2);
    if (!synth_room_transfer(&pair->room, &pair->cameras[0], (double)m->x1, (double)m->y1, &pair->cameras[1], &image))
        return 1e9;
    return hypot(image.x - (double)m->x2, image.y - (double)m->y2);
}

static uint32_t count_right(const settings *set, const asj_match_result *result, const synth_wide_pair *pair)
{
    double f[9];
    uint32_t right = 0;
    synth_fundamental(&pair->cameras[0], &pair->cameras[1], f);
    for (uint32_t k = 0; k < result->match_count; k++)
        right += off(set, pair, f, &result->matches[k]) < NEAR;
    return right;
}

static void count(const settings *set, const synth_wide_pair *pair, const asj_match_result *result, tally *sum)
{
    const asj_geometry *g = &result->geometry;
    const int accepted = g->status == ASJ_GEOMETRY_ACCEPTED;
    const double error = set->unrelated ? 180 : (set->turned ? turn_error : pose_error)(g, pair);
    const int is_wrong = set->turned || error > 3;
    sum->errors[sum->pairs++] = error;
    sum->accepted += accepted;
    const uint32_t right = set->unrelated ? 0 : count_right(set, result, pair);
    sum->matches += accepted ? result->match_count : 0;
    sum->right_matches += accepted ? right : 0;
    sum->with_pose += accepted && g->has_pose;
    sum->turns += accepted && g->only_turns && error < 3;
    sum->wrong += accepted && g->has_pose && is_wrong;
    sum->far_off += accepted && g->has_pose && error > 30;
    if (accepted && g->focal_sd > 0)
        sum->focals[sum->focal_count++] = fabs(g->cameras[0].fx / pair->cameras[0].focal - 1);
    sum->common += pair->common >= 1.0 / 3;
    sum->common_accepted += pair->common >= 1.0 / 3 && accepted;
    printf("%-7lu angle %2.0f scale %4.2f common %4.2f  %-10s %-11s log10 NFA %7.1f error %6.1f  matches %3u / %3u  %.0f ms",
           (unsigned long)pair->seed, pair->angle, pair->scale, pair->common, asj_geometry_status_name(g->status),
           asj_geometry_model_name(g->model), g->log10_nfa, error, (unsigned)right,
           (unsigned)result->match_count, result->total_ms);
    if (g->focal_sd > 0)
        printf("  focal length %.0f (%.0f), sd %.3f", g->cameras[0].fx, pair->cameras[0].focal, g->focal_sd);
    if (set->poses && g->has_rival)
        printf("  second %.1f", g->rival_log10_nfa);
    if (set->poses && g->picture_agreement > 0)
        printf("  agreement %.2f", g->picture_agreement);
    if (set->poses && accepted && (g->has_pose || g->only_turns))
        print_pose(g, pair);
    puts("");
    fflush(stdout);
}

static int match(const settings *set, const synth_wide_pair *first, const synth_wide_pair *second, tally *sum)
{
    const synth_wide_pair *const pairs[2] = {first, second};
    const asj_match_options options = match_options_of(set, pairs);
    const asj_detect_options detect_options = detect_options_of(set);
    uint8_t *pixels[2] = {NULL, NULL};
    asj_image images[2];
    asj_match_result *result = NULL;
    int failed = 0;
    for (int v = 0; v < 2 && !failed; v++)
        failed = take_picture(pairs[v], v, &pixels[v], &images[v]);
    if (!failed && set->as_they_are)
        failed = match_as_they_are(set, images, &options, &result);
    else if (!failed)
        failed = asj_match_images(set->context, &images[0], &images[1], &set->stretch, &detect_options, &options, &result)
                 != ASJ_OK;
    if (!failed)
        count(set, first, result, sum);
    asj_match_result_free(&result);
    free(pixels[0]);
    free(pixels[1]);
    return failed;
}

static int by_size(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* Percent: the mean of the recall, which rises linearly between errors, from 0 to `limit` degrees. */
static double area(const double *errors, int count, double limit)
{
    double sum = 0, x = 0, y = 0;
    for (int k = 0; k < count && errors[k] < limit; k++) {
        const double next = (k + 1.0) / count;
        sum += (errors[k] - x) * (y + next) / 2;
        x = errors[k];
        y = next;
    }
    return count ? 100 * (sum + (limit - x) * y) / limit : 0;
}

static int report(const settings *set, tally *sum)
{
    static const double limits[] = {1, 2, 5, 10, 20};
    qsort(sum->errors, (size_t)sum->pairs, sizeof *sum->errors, by_size);
    if (set->turned)
        printf("%d cameras only turn and are told to, within 3 degrees\n", sum->turns);
    printf("%d pairs: AUC at 1, 2, 5, 10, 20 degrees", sum->pairs);
    for (size_t k = 0; k < sizeof limits / sizeof limits[0]; k++)
        printf(" %.1f", area(sum->errors, sum->pairs, limits[k]));
    printf("; accepted %d, of those with a third in common %d of %d; with a pose %d, of these off by more than 3 degrees %d, "
           "30 degrees %d; of the matches of the accepted right %u of %u\n", sum->accepted, sum->common_accepted, sum->common,
           sum->with_pose, sum->wrong, sum->far_off, (unsigned)sum->right_matches, (unsigned)sum->matches);
    qsort(sum->focals, (size_t)sum->focal_count, sizeof *sum->focals, by_size);
    if (sum->focal_count > 0)
        printf("focal lengths found %d: error median %.1f %%, three quarters within %.1f %%, largest %.1f %%\n", sum->focal_count,
               100 * sum->focals[sum->focal_count / 2], 100 * sum->focals[3 * sum->focal_count / 4],
               100 * sum->focals[sum->focal_count - 1]);
    if (!set->check)
        return 0;
    const int right = set->turned ? sum->turns : sum->with_pose - sum->wrong;
    const int most = set->find_focal || set->focal_sd > 0 ? most_wrong_with_focal : most_wrong;
    const double least = set->turned ? least_turned : least_right;
    return right >= least * sum->pairs && sum->wrong <= most && sum->far_off <= most_far_off &&
           sum->right_matches >= least_matches * sum->matches ? 0 : 1;
}

static int run(const settings *set)
{
    static tally sum;
    const uint64_t start = set->held_out ? SYNTH_WIDE_HELD_OUT : 0;
    synth_wide_pair last;
    int have_last = 0, failed = 0;
    for (long seed = set->first; seed <= set->last && sum.pairs < MOST && !failed; seed++) {
        synth_wide_pair pair;
        if ((set->near ? synth_near_pair_make : set->turned ? synth_turned_pair_make : synth_wide_pair_make)
            (&pair, start + (uint64_t)seed) != 0)
            continue; /* no such viewpoints in this room */
        for (int v = 0; v < 2; v++)
            pair.exposures[v].noise_seed += 1000003 * (uint64_t)set->draw;
        if (!set->unrelated) {
            failed = match(set, &pair, &pair, &sum);
            synth_wide_pair_free(&pair);
            continue;
        }
        if (have_last) {
            failed = match(set, &last, &pair, &sum);
            synth_wide_pair_free(&last);
        }
        last = pair;
        have_last = 1;
    }
    if (have_last)
        synth_wide_pair_free(&last);
    if (failed) {
        fprintf(stderr, "wide_rooms: %s\n", asj_context_message(set->context));
        return 1;
    }
    return report(set, &sum);
}

static int usage(void)
{
    fputs("usage: wide_rooms [--check] [--held-out] [--unrelated] [--no-cameras | --find-focal | --focal-error E] "
          "[--focal-sd S] [--stretch X,Y | --as-they-are] [--first-octave N] [--first N] [--last N] [--threads N] [--draw N] "
          "[--seed N] [--near | --turned] [--poses] [--colours yes|no]\n", stderr);
    return 2;
}

int main(int argc, char **argv)
{
    static const struct option longs[] = {{"check", 0, NULL, 'c'}, {"held-out", 0, NULL, 'h'}, {"unrelated", 0, NULL, 'u'},
                                          {"no-cameras", 0, NULL, 'n'}, {"stretch", 1, NULL, 's'}, {"as-they-are", 0, NULL, 'a'},
                                          {"first-octave", 1, NULL, '1'}, {"find-focal", 0, NULL, 'o'},
                                          {"focal-error", 1, NULL, 'F'}, {"focal-sd", 1, NULL, 'S'},
                                          {"first", 1, NULL, 'f'}, {"last", 1, NULL, 'l'},
                                          {"threads", 1, NULL, 't'}, {"draw", 1, NULL, 'd'}, {"seed", 1, NULL, 'e'},
                                          {"poses", 0, NULL, 'p'}, {"near", 0, NULL, 'r'}, {"turned", 0, NULL, 'w'},
                                          {"colours", 1, NULL, 'C'},
                                          {NULL, 0, NULL, 0}};
    settings set = {.last = 99, .seed = 1};
    asj_context_options how;
    int c;
    asj_context_options_init(&how);
    while ((c = getopt_long(argc, argv, "", longs, NULL)) != -1)
        switch (c) {
        case 'c': set.check = 1; break;
        case 'h': set.held_out = 1; break;
        case 'u': set.unrelated = 1; break;
        case 'n': set.no_cameras = 1; break;
        case 'o': set.find_focal = 1; break;
        case 'S': set.focal_sd = strtod(optarg, NULL); break;
        case 'F': set.focal_error = strtod(optarg, NULL); break;
        case 's':
            if (sscanf(optarg, "%lf,%lf", &set.stretch.x, &set.stretch.y) != 2)
                return usage();
            break;
        case 'a': set.as_they_are = 1; break;
        case '1': set.first_octave = (int)strtol(optarg, NULL, 10); break;
        case 'f': set.first = strtol(optarg, NULL, 10); break;
        case 'l': set.last = strtol(optarg, NULL, 10); break;
        case 'd': set.draw = strtol(optarg, NULL, 10); break;
        case 'e': set.seed = strtol(optarg, NULL, 10); break;
        case 'p': set.poses = 1; break;
        case 'r': set.near = 1; break;
        case 'w': set.turned = 1; break;
        case 'C':
            set.colours = strcmp(optarg, "yes") == 0;
            set.no_colours = strcmp(optarg, "no") == 0;
            if (!set.colours && !set.no_colours)
                return usage();
            break;
        case 't': how.threads = (int32_t)strtol(optarg, NULL, 10); break;
        default: return usage();
        }
    if (asj_context_create(&how, &set.context) != ASJ_OK)
        return 1;
    const int result = run(&set);
    asj_context_free(&set.context);
    return result;
}
