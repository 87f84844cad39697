/* SPDX-License-Identifier: BSD-2-Clause */
/* Detects and matches every pair of photographs of a folder and writes the matches as CSV files.
 *
 *     match_pairs [options] PAIRS OUT [LINES]
 *
 * PAIRS/<name>/1.png and 2.png give OUT/<name>.csv, one line for each match: columns
 * x1,y1,ax1,ay1,bx1,by1,x2,y2,ax2,ay2,bx2,by2, as a scoring program reads them, and what else is known. LINES/<name>.csv: the
 * segment matches, location left empty.
 *
 *     --preset paper         both presets of the library: detection and matching
 *     --detect KEY=VALUE     a detector option          --match KEY=VALUE    a matcher option
 *     --junctions SUFFIX     PAIRS/<name>/1<SUFFIX> and 2<SUFFIX> are read instead of detecting (".authors.asj")
 *     --plain                the detector's preset default instead of match
 *     --threads N            default: as many as processors */
#define _POSIX_C_SOURCE 200809L
#include "photograph.h"

#include <asj/io.h>
#include <asj/match.h>

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct job {
    const char *pairs, *out, *lines, *junctions;
    asj_detect_options detect;
    asj_match_options match;
    asj_context *context;
} job;

/* Junctions of one image, from the detector or a file. */
typedef struct corners {
    photograph picture;
    asj_detection *detection;
    asj_junction_file *file;
    const asj_junction *junctions;
    uint32_t count;
} corners;

static int load(const job *j, const char *name, int number, corners *c)
{
    char path[4096], message[512];
    memset(c, 0, sizeof *c);
    snprintf(path, sizeof path, "%s/%s/%d.png", j->pairs, name, number);
    if (photograph_read(path, &c->picture) != 0)
        return -1;
    if (!j->junctions) {
        c->detection = photograph_detect(j->context, &j->detect, c->picture.pixels, c->picture.width, c->picture.height);
        if (!c->detection)
            return -1;
        c->junctions = c->detection->junctions;
        c->count = c->detection->junction_count;
        return 0;
    }
    snprintf(path, sizeof path, "%s/%s/%d%s", j->pairs, name, number, j->junctions);
    if (asj_junctions_read(path, &c->file, message, sizeof message) != ASJ_OK) {
        fprintf(stderr, "match_pairs: %s\n", message);
        return -1;
    }
    c->junctions = c->file->junctions;
    c->count = c->file->junction_count;
    return 0;
}

static void unload(corners *c)
{
    asj_detection_free(&c->detection);
    asj_junction_file_free(&c->file);
    photograph_free(&c->picture);
}

static FILE *create(const char *folder, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.csv", folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        perror(path);
    return file;
}

static int write_matches(const job *j, const char *name, const asj_match_result *r)
{
    FILE *f = create(j->out, name);
    if (!f)
        return -1;
    fprintf(f, "i,j,x1,y1,ax1,ay1,bx1,by1,x2,y2,ax2,ay2,bx2,by2,distance,ratio,similarity,support,end_a,end_b\n");
    for (uint32_t n = 0; n < r->match_count; n++) {
        const asj_junction_match *m = &r->matches[n];
        fprintf(f, "%u,%u,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.5f,%.3f,%.4f,%.3f,%d,%d\n", m->l1, m->l2,
                (double)m->x1, (double)m->y1, (double)m->ax1, (double)m->ay1, (double)m->bx1, (double)m->by1,
                (double)m->x2, (double)m->y2, (double)m->ax2, (double)m->ay2, (double)m->bx2, (double)m->by2,
                (double)m->distance, (double)m->ratio, (double)m->similarity, (double)m->support, (int)m->end_a, (int)m->end_b);
    }
    return fclose(f);
}

static int write_lines(const job *j, const char *name, const asj_match_result *r)
{
    FILE *f = create(j->lines, name);
    size_t count = asj_match_segments(r, ASJ_END_INNER, NULL, 0);
    asj_segment_match *s = malloc((count + 1) * sizeof *s);
    if (!f || !s) {
        free(s);
        return -1;
    }
    asj_match_segments(r, ASJ_END_INNER, s, count);
    fprintf(f, "x1,y1,ax1,ay1,bx1,by1,x2,y2,ax2,ay2,bx2,by2\n");
    for (size_t n = 0; n < count; n++)
        fprintf(f, ",,%.3f,%.3f,%.3f,%.3f,,,%.3f,%.3f,%.3f,%.3f\n", (double)s[n].x1, (double)s[n].y1, (double)s[n].ex1,
                (double)s[n].ey1, (double)s[n].x2, (double)s[n].y2, (double)s[n].ex2, (double)s[n].ey2);
    free(s);
    return fclose(f);
}

static int match_pair(const job *j, const char *name)
{
    corners c[2];
    asj_match_result *r = NULL;
    int failed = load(j, name, 1, &c[0]);
    if (failed == 0)
        failed = load(j, name, 2, &c[1]);
    else
        memset(&c[1], 0, sizeof c[1]);
    if (failed == 0) {
        const asj_image image1 = {c[0].picture.pixels, ASJ_FORMAT_GRAY8, c[0].picture.width, c[0].picture.height, 0, 0};
        const asj_image image2 = {c[1].picture.pixels, ASJ_FORMAT_GRAY8, c[1].picture.width, c[1].picture.height, 0, 0};
        failed = asj_match(j->context, &image1, c[0].junctions, c[0].count, &image2, c[1].junctions, c[1].count, &j->match, &r);
        if (failed)
            fprintf(stderr, "match_pairs: %s: %s\n", name, asj_context_message(j->context));
    }
    if (failed == 0) {
        printf("%-24s %5u %5u L-junctions %5u matches %8.1f ms"
               " (patches %.1f, distances %.1f, align %.1f, assign %.1f; %llu candidates)\n",
               name, r->l_junction_count1, r->l_junction_count2, r->match_count, r->total_ms, r->stage_ms[ASJ_STAGE_PATCHES],
               r->stage_ms[ASJ_STAGE_DISTANCES], r->stage_ms[ASJ_STAGE_ALIGN], r->stage_ms[ASJ_STAGE_ASSIGN],
               (unsigned long long)r->candidates);
        failed = write_matches(j, name, r);
        if (failed == 0 && j->lines)
            failed = write_lines(j, name, r);
    }
    asj_match_result_free(&r);
    unload(&c[0]);
    unload(&c[1]);
    return failed;
}

static int set_match(asj_match_options *options, const char *text)
{
    char key[64], message[256];
    const char *equals = strchr(text, '=');
    if (!equals || (size_t)(equals - text) >= sizeof key) {
        fprintf(stderr, "match_pairs: '%s' is not KEY=VALUE\n", text);
        return -1;
    }
    memcpy(key, text, (size_t)(equals - text));
    key[equals - text] = '\0';
    const asj_status status = asj_match_options_set(options, key, equals + 1, message, sizeof message);
    if (*message)
        fprintf(stderr, "match_pairs: %s\n", message);
    return status == ASJ_OK ? 0 : -1;
}

/* Returns the index of the first argument that is no option, or -1. */
static int parse(int count, char **arguments, job *j, asj_context_options *context)
{
    int n = 1;
    asj_detect_options_preset(&j->detect, ASJ_PRESET_MATCH);
    asj_match_options_init(&j->match);
    for (; n < count && strncmp(arguments[n], "--", 2) == 0; n++) {
        const char *name = arguments[n], *value = n + 1 < count ? arguments[n + 1] : "";
        if (strcmp(name, "--plain") == 0) {
            asj_detect_options_init(&j->detect);
            continue;
        }
        n++;
        if (strcmp(name, "--preset") == 0 && strcmp(value, "paper") == 0) {
            asj_detect_options_preset(&j->detect, ASJ_PRESET_PAPER);
            asj_match_options_preset(&j->match, ASJ_PRESET_PAPER);
        } else if (strcmp(name, "--detect") == 0) {
            if (photograph_option(&j->detect, value) != 0)
                return -1;
        } else if (strcmp(name, "--match") == 0) {
            if (set_match(&j->match, value) != 0)
                return -1;
        } else if (strcmp(name, "--junctions") == 0) {
            j->junctions = value;
        } else if (strcmp(name, "--threads") == 0) {
            context->threads = (int32_t)strtol(value, NULL, 10);
        } else {
            return -1;
        }
    }
    return n + 2 == count || n + 3 == count ? n : -1;
}

int main(int count, char **arguments)
{
    job j;
    asj_context_options context;
    memset(&j, 0, sizeof j);
    asj_context_options_init(&context);
    int n = parse(count, arguments, &j, &context), failed = 0;
    if (n < 0) {
        fprintf(stderr, "usage: match_pairs [--preset paper] [--detect KEY=VALUE] [--match KEY=VALUE]"
                        " [--junctions SUFFIX] [--plain]"
                        " [--threads N] PAIRS OUT [LINES]\n");
        return 2;
    }
    j.pairs = arguments[n];
    j.out = arguments[n + 1];
    j.lines = n + 2 < count ? arguments[n + 2] : NULL;
    mkdir(j.out, 0777);
    if (j.lines)
        mkdir(j.lines, 0777);
    struct dirent **names = NULL;
    int total = scandir(j.pairs, &names, NULL, alphasort);
    if (total < 0 || asj_context_create(&context, &j.context) != ASJ_OK) {
        perror(j.pairs);
        return 1;
    }
    for (int k = 0; k < total; k++) {
        if (names[k]->d_name[0] != '.')
            failed |= match_pair(&j, names[k]->d_name) != 0;
        free(names[k]);
    }
    free(names);
    asj_context_free(&j.context);
    return failed;
}
