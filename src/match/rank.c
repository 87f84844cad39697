/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, short lists: the best partners of every L-junction, among all pairs.
 *
 * Rows are worked through in blocks, the columns of a row in tiles. From each tile the best partners of its row are kept, from each
 * block, row after row, those of all columns: memory for the full matrix is never needed, and a pair that is on neither list cannot
 * come on one later. So only pairs are compared whose bound says that they may be better than the last ones on the lists of
 * both (product_bound.c); blocks and tiles start small, for lists to compare with.
 *
 * Where it is known about where partners lie (expected.c) pairs that lie elsewhere are not compared, and tiles that hold no other
 * pairs of a block are not looked at: so L-junctions had better come in an order in which neighbours are near. */
#include "describe.h"
#include "expected_columns.h"
#include "induced_score.h"
#include "product_bound.h"
#include "shortlist.h"
#include "core/lowest_bit.h"
#include "core/threads.h"

#include <string.h>

#define FIRST_ROWS 8
#define MOST_ROWS 64
#define FIRST_FRAMES 16 /* the frames of one L-junction at least */
#define MOST_FRAMES 256
#define MOST_BLOCKS (MOST_FRAMES / ASJ_BOUND_LANES + 1) /* of bound vectors that a tile lies in */
#define LEAST_OFFERS 16384 /* for a thread */

/* All that the two passes over a block share. */
typedef struct table {
    const asj_match_run *run;
    const asj_ops *ops;
    const asj_image_features *image1, *image2;
    int32_t limit, length;       /* of a list, of a patch */
    asj_partner *rows, *columns; /* `limit` for each L-junction of image 1 and of image 2 */
    int32_t *scores;             /* MOST_ROWS x count2; ASJ_NO_PARTNER also where the pair cannot come on a list */
    int16_t *left, *right;       /* bound vectors; NULL: every pair is compared */
    int32_t *least;              /* of each frame of image 2: the threshold of its L-junction's list, */
    uint32_t *owner;             /* and that L-junction */
    asj_induced_squares squares; /* the paper's patches */
    struct tile *tiles;          /* of the L-junctions of image 2 */
    uint32_t tile_count;
    uint8_t *met;                /* MOST_ROWS for each tile: whether that row has been compared with one of it */
    asj_expected_columns columns_expected; /* of image 2, where it is known where partners lie */
} table;

/* L-junctions first .. end - 1 of image 2. */
typedef struct tile {
    uint32_t first, end;
    asj_box box;   /* around them */
    int32_t asked; /* may one of them be a partner of a row of the block? */
} tile;

/* Inserts into a list that falls; the earlier of equals stays first. */
static void offer(asj_partner *list, int32_t limit, int32_t score, uint32_t index)
{
    if (score <= list[limit - 1].score)
        return;
    int32_t k = limit - 1;
    for (; k > 0 && list[k - 1].score < score; k--)
        list[k] = list[k - 1];
    list[k] = (asj_partner){score, index};
}

/* Below what a product is not worth looking for. */
static int32_t threshold(const asj_partner *list, int32_t limit)
{
    const int32_t score = list[limit - 1].score;
    return score > ASJ_BOUND_LEAST ? score : ASJ_BOUND_LEAST;
}

static int32_t products_do(const asj_match_options *options)
{
    return options->patches == ASJ_PATCHES_CANONICAL && asj_patch_units(options);
}

/* --- unit vectors: the pair of frames with the largest product is the best -------------------------------------------------- */

/* Which frames first .. end - 1 of image 2, and of these those `among` which asj_bound_above() is told to look, to compare with
 * frame f of image 1, whose L-junction's list has the threshold `most`. */
static int32_t find_frames(const table *t, uint32_t f, uint32_t first, uint32_t end, const uint32_t *among, int32_t most,
                           int32_t *frames)
{
    int32_t count = 0;
    if (t->left)
        return t->ops->bound->above(t->left + (size_t)f * ASJ_BOUND_LENGTH, t->right, t->least, most, (int32_t)first, (int32_t)end,
                                    among, frames);
    for (uint32_t g = first; g < end; g++)
        if (!among || asj_bound_is_among(among, (int32_t)first, (int32_t)g))
            frames[count++] = (int32_t)g;
    return count;
}

/* May L-junctions i of image 1 and j of image 2 be partners? */
static int is_expected(const table *t, uint32_t i, uint32_t j)
{
    return !t->run->expected || asj_may_be_partners(t->run->expected, i, j);
}

/* The frames of L-junctions of a tile that may be partners of i. Returns whether there are any. */
static int find_expected(const table *t, uint32_t i, const tile *columns, uint32_t among[MOST_BLOCKS])
{
    const uint32_t *first_frame = t->image2->l_junctions.first_frame, start = first_frame[columns->first];
    int any = 0;
    if (!asj_boxes_meet(&t->run->expected->boxes[0][i], &columns->box))
        return 0;
    memset(among, 0, MOST_BLOCKS * sizeof *among);
    for (uint32_t j = columns->first; j < columns->end; j += ASJ_EXPECTED_AT_ONCE) {
        const uint32_t rest = columns->end - j, some = rest < ASJ_EXPECTED_AT_ONCE ? rest : ASJ_EXPECTED_AT_ONCE;
        uint64_t bits = asj_expected_among(&t->columns_expected, t->run->expected, i, j, some);
        while (bits) { /* those in a row at once */
            const uint32_t from = asj_lowest_bit(bits);
            const uint32_t run = ~(bits >> from) ? asj_lowest_bit(~(bits >> from)) : ASJ_EXPECTED_AT_ONCE;
            const uint32_t g = first_frame[j + from], end = first_frame[j + from + run];
            asj_bound_add(among, (int32_t)start, (int32_t)g, (int32_t)end);
            any |= g < end;
            bits &= from + run < ASJ_EXPECTED_AT_ONCE ? ~(uint64_t)0 << (from + run) : 0;
        }
    }
    return any;
}

/* Products of frame f of image 1 and some of image 2. */
static void multiply(const table *t, uint32_t f, const int32_t *frames, int32_t count, int32_t *products)
{
    int32_t patches[MOST_FRAMES];
    for (int32_t k = 0; k < count; k++)
        patches[k] = (int32_t)asj_patch_number(t->image2, (uint32_t)frames[k]);
    t->ops->patch->products(asj_patch_at(t->image1, f, t->length), t->image2->patches, t->length, patches, count, products);
}

/* A tile of image 2 against L-junction i. Returns whether any two were compared: else there are no scores. */
static uint8_t multiply_tile(const table *t, uint32_t i, const tile *columns, int32_t *scores)
{
    const asj_l_junctions *c1 = &t->image1->l_junctions, *c2 = &t->image2->l_junctions;
    const uint32_t first = columns->first, end = columns->end, start = c2->first_frame[first], stop = c2->first_frame[end];
    asj_partner *list = t->rows + (size_t)i * (size_t)t->limit;
    int32_t frames[MOST_FRAMES], products[MOST_FRAMES], compared = 0;
    uint32_t expected[MOST_BLOCKS];
    if (t->run->expected && !find_expected(t, i, columns, expected))
        return 0;
    for (uint32_t j = first; j < end; j++)
        scores[j] = ASJ_NO_PARTNER;
    for (uint32_t f = c1->first_frame[i]; f < c1->first_frame[i + 1]; f++) {
        if (!t->image1->usable[f])
            continue;
        const int32_t count = find_frames(t, f, start, stop, t->run->expected ? expected : NULL, threshold(list, t->limit), frames);
        multiply(t, f, frames, count, products);
        for (int32_t k = 0; k < count; k++) {
            int32_t *best = &scores[t->owner[frames[k]]];
            if (products[k] > *best && t->image2->usable[frames[k]])
                *best = products[k];
        }
        compared += count;
    }
    for (uint32_t j = first; j < end && compared; j++)
        offer(list, t->limit, scores[j], j);
    return compared > 0;
}

/* Of a block of rows that begins with first_row those from `from` to end - 1, a tile of all of them before the next: its bounds and
 * patches stay in the cache. */
static void multiply_rows(const table *t, uint32_t first_row, uint32_t from, uint32_t end)
{
    for (uint32_t n = 0; n < t->tile_count; n++)
        for (uint32_t r = from; r < end && t->tiles[n].asked; r++)
            t->met[(size_t)n * MOST_ROWS + r] = multiply_tile(t, first_row + r, &t->tiles[n],
                                                              t->scores + (size_t)r * t->image2->l_junctions.count);
}

/* Around L-junctions first .. end - 1 of image 2. */
static asj_box box_around(const asj_expected *expected, uint32_t first, uint32_t end)
{
    asj_box box = asj_box_empty();
    for (uint32_t j = first; j < end; j++) {
        const asj_point *p = &expected->points[1][j];
        asj_box_join(&box, &(asj_box){p->x, p->y, p->x, p->y});
    }
    return box;
}

/* Divides the columns. Returns how many tiles there are. */
static uint32_t find_tiles(const table *t)
{
    const asj_l_junctions *c2 = &t->image2->l_junctions;
    const asj_expected *expected = t->run->expected;
    uint32_t count = 0;
    for (uint32_t first = 0, end; first < c2->count; first = end) {
        const uint32_t start = c2->first_frame[first], wanted = FIRST_FRAMES + start / 2;
        const uint32_t most = wanted < MOST_FRAMES ? wanted : MOST_FRAMES;
        for (end = first + 1; end < c2->count && c2->first_frame[end + 1] - start <= most; end++)
            ;
        t->tiles[count++] = (tile){first, end, expected ? box_around(expected, first, end) : asj_box_empty(), 1};
    }
    return count;
}

/* Which tiles a block of rows asks. */
static void ask_tiles(const table *t, int64_t first, int64_t end)
{
    const asj_expected *e = t->run->expected;
    asj_box box = asj_box_empty();
    if (!e || !products_do(t->run->options))
        return;
    for (int64_t i = first; i < end; i++)
        asj_box_join(&box, &e->boxes[0][i]);
    for (uint32_t n = 0; n < t->tile_count; n++)
        t->tiles[n].asked = asj_boxes_meet(&box, &t->tiles[n].box);
}

/* --- others ----------------------------------------------------------------------------------------------------------------- */

/* The best score of a row, and the best of partners at another location. */
typedef struct two_best {
    int32_t best, second;
    uint32_t location; /* of the best */
} two_best;

static void remember(two_best *row, int32_t score, uint32_t location)
{
    if (score > row->best) {
        row->second = location != row->location ? row->best : row->second;
        row->best = score;
        row->location = location;
    } else if (location != row->location && score > row->second) {
        row->second = score;
    }
}

/* When nothing but the ratio test reads the lists (assign.c), from image 1's side alone, a pair says something only if its row has
 * not two better ones at different locations: of these one at least is the location's second best or better. */
static int32_t two_suffice(const asj_match_options *o)
{
    return !o->mutual && o->separation == 0 && o->neighbours == 0 && o->align_iterations == 0 &&
           o->geometry.model == ASJ_GEOMETRY_NONE;
}

static void score_row(const table *t, uint32_t i, int32_t *scores)
{
    const asj_l_junctions *c2 = &t->image2->l_junctions;
    const size_t limit = (size_t)t->limit;
    const int32_t two = two_suffice(t->run->options);
    two_best row = {ASJ_NO_PARTNER, ASJ_NO_PARTNER, UINT32_MAX};
    asj_partner *list = t->rows + i * limit;
    for (uint32_t j = 0; j < c2->count; j++) {
        const int32_t mine = list[limit - 1].score, theirs = t->columns[(j + 1) * limit - 1].score;
        const int32_t needed = two ? row.second : mine < theirs ? mine : theirs;
        scores[j] = is_expected(t, i, j) ? asj_induced_score(t->run, &t->squares, i, j, needed) : ASJ_NO_PARTNER;
        offer(list, t->limit, scores[j], j);
        if (two)
            remember(&row, scores[j], c2->location[j]);
    }
}

/* --- blocks of rows --------------------------------------------------------------------------------------------------------- */

/* Rows of the block that begins with `first` offer themselves to column j. */
static void offer_rows(const table *t, int64_t first, const uint8_t *rows, uint32_t count, uint32_t j)
{
    const asj_l_junctions *c2 = &t->image2->l_junctions;
    asj_partner *list = t->columns + (size_t)j * (size_t)t->limit;
    for (uint32_t n = 0; n < count; n++)
        offer(list, t->limit, t->scores[(size_t)rows[n] * c2->count + j], (uint32_t)(first + rows[n]));
    for (uint32_t g = c2->first_frame[j]; g < c2->first_frame[j + 1]; g++)
        t->least[g] = threshold(list, t->limit);
}

/* Rows first .. end - 1 of the table. */
typedef struct job {
    const table *t;
    int64_t first, end;
} job;

static void score_rows(const void *data, const asj_part *part)
{
    const job *j = data;
    const int64_t count2 = j->t->image2->l_junctions.count;
    if (products_do(j->t->run->options)) {
        multiply_rows(j->t, (uint32_t)j->first, (uint32_t)part->first, (uint32_t)part->end);
        return;
    }
    for (int64_t i = part->first; i < part->end; i++)
        score_row(j->t, (uint32_t)(j->first + i), j->t->scores + i * count2);
}

/* Which rows of the block tile n has scores of. Returns how many. */
static uint32_t find_met(const job *j, int64_t n, uint8_t rows[MOST_ROWS])
{
    const uint8_t *met = j->t->met + n * MOST_ROWS;
    const int products = products_do(j->t->run->options);
    uint32_t count = 0;
    for (int64_t r = 0; r < j->end - j->first; r++)
        if (!products || met[r])
            rows[count++] = (uint8_t)r;
    return count;
}

static void offer_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end; n++) {
        const tile *columns = &j->t->tiles[n];
        uint8_t rows[MOST_ROWS];
        const uint32_t count = columns->asked ? find_met(j, n, rows) : 0;
        for (uint32_t column = columns->first; column < columns->end && count > 0; column++)
            offer_rows(j->t, j->first, rows, count, column);
    }
}

static asj_status work(const table *t)
{
    asj_context *context = t->run->context;
    const int64_t count1 = t->image1->l_junctions.count, count2 = t->image2->l_junctions.count;
    for (int64_t first = 0, end; first < count1; first = end) {
        const int64_t wanted = FIRST_ROWS + first / 4;
        end = first + (wanted < MOST_ROWS ? wanted : MOST_ROWS);
        end = end < count1 ? end : count1;
        const job j = {t, first, end};
        ask_tiles(t, first, end);
        asj_parallel(context, context->threads, end - first, products_do(t->run->options) ? 0 : 1, score_rows, &j);
        asj_parallel(context, asj_threads_for(context, (end - first) * count2, LEAST_OFFERS), t->tile_count, 0, offer_some, &j);
        asj_status status = asj_progress(context, ASJ_STAGE_DISTANCES, 0.2 + 0.4 * (double)end / (double)count1);
        if (status != ASJ_OK)
            return status;
    }
    return ASJ_OK;
}

static asj_status prepare(table *t)
{
    asj_context *context = t->run->context;
    asj_memory *memory = &context->memory;
    const asj_l_junctions *c2 = &t->image2->l_junctions;
    const size_t padded = (size_t)asj_bound_blocks(c2->frame_count) * ASJ_BOUND_LANES;
    t->scores = asj_allocate(memory, MOST_ROWS * (size_t)c2->count, sizeof *t->scores);
    t->least = asj_allocate_zero(memory, padded, sizeof *t->least);
    t->owner = asj_allocate(memory, c2->frame_count, sizeof *t->owner);
    t->tiles = asj_allocate(memory, c2->count, sizeof *t->tiles);
    if (!t->scores || !t->least || !t->owner || !t->tiles)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the distances of %u L-junctions", (unsigned)c2->count);
    if (t->run->expected) {
        const asj_status known = asj_expected_columns_create(context, t->run->expected, c2->count, &t->columns_expected);
        if (known != ASJ_OK)
            return known;
    }
    const asj_status squares = asj_induced_squares_create(t->run, &t->squares);
    if (squares != ASJ_OK)
        return squares;
    t->tile_count = find_tiles(t);
    t->met = asj_allocate(memory, t->tile_count, MOST_ROWS * sizeof *t->met);
    if (!t->met)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the distances of %u L-junctions", (unsigned)c2->count);
    for (uint32_t g = 0; g < c2->frame_count; g++)
        t->least[g] = ASJ_BOUND_LEAST;
    for (uint32_t j = 0; j < c2->count; j++)
        for (uint32_t g = c2->first_frame[j]; g < c2->first_frame[j + 1]; g++)
            t->owner[g] = j;
    if (!products_do(t->run->options) || t->run->options->descriptor != ASJ_DESCRIPTOR_RAW)
        return ASJ_OK;
    const asj_status status = asj_bound_left(context, t->run->options, t->image1, &t->left);
    return status == ASJ_OK ? asj_bound_right(context, t->run->options, t->image2, &t->right) : status;
}

asj_status asj_rank_partners(const asj_match_run *run, asj_partner *rows, asj_partner *columns)
{
    asj_memory *memory = &run->context->memory;
    table t = {.run = run, .ops = run->context->ops, .image1 = run->image[0], .image2 = run->image[1],
               .limit = run->options->shortlist, .length = asj_patch_length(run->options), .rows = rows, .columns = columns};
    asj_status status = prepare(&t);
    if (status == ASJ_OK)
        status = work(&t);
    asj_release_much(memory, t.scores);
    asj_release_much(memory, t.least);
    asj_release_much(memory, t.owner);
    asj_release_much(memory, t.tiles);
    asj_release(memory, t.met);
    asj_expected_columns_free(memory, &t.columns_expected);
    asj_release_much(memory, t.left);
    asj_release_much(memory, t.right);
    asj_induced_squares_free(memory, &t.squares);
    return status;
}

const asj_rank_ops asj_rank_reference = {.partners = asj_rank_partners};
