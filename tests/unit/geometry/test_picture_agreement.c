/* SPDX-License-Identifier: BSD-2-Clause */
/* src/geometry/picture_agreement.c: of looks that are made by hand, about 1 where the pictures are the same, 0 where they are any,
 * and what it is drawn to where they know nothing. (Of geometries: test_ambiguity.c.) */
#include "unit_test.h"

#include "geometry/picture_agreement.h"

#define USUAL 0.6
#define LITTLE 8.0

static asj_picture_look look;

/* A wall of `columns` x `rows` cells near matches whose brightness differs by up to `contrast`; in image 2 a share of `wrong` is
 * another wall's. */
static void make_wall(int32_t columns, int32_t rows, double contrast, double wrong, double noise)
{
    synth_random random;
    synth_random_seed(&random, 3);
    memset(&look, 0, sizeof look);
    look.channel_count = 3;
    for (int32_t n = 0; n < ASJ_CELLS; n++)
        look.cells[n].plane = -1;
    for (int32_t c = 0; c < 3; c++) {
        look.offset[c] = 0.3 * c;
        look.slope[c] = 1.1;
    }
    for (int32_t y = 0; y < rows; y++)
        for (int32_t x = 0; x < columns; x++) {
            const int32_t n = y * ASJ_CELLS_ALONG + x;
            look.cells[n].plane = 0;
            look.cells[n].is_near = 1;
            for (int32_t c = 0; c < 3; c++) {
                const double first = synth_random_between(&random, 4, 4 + contrast);
                const double second = (1 - wrong) * first + wrong * synth_random_between(&random, 4, 4 + contrast);
                const double off = 1.1 * (second - first) + synth_random_between(&random, -noise, noise);
                look.brightness[c][n][0] = first;
                look.brightness[c][n][1] = 0.3 * c + 1.1 * first + off;
                look.cells[n].difference += fabs(off) / 3;
            }
        }
}

static void same_pictures_agree_and_others_do_not(void **state)
{
    (void)state;
    make_wall(20, 20, 1, 0, 0.01);
    const double same = asj_pictures_agreement(&look).share;
    make_wall(20, 20, 1, 1, 0.01);
    const double other = asj_pictures_agreement(&look).share;
    make_wall(20, 20, 1, 0.5, 0.01);
    const double half = asj_pictures_agreement(&look).share;
    print_message("agreement %.2f, half %.2f, other %.2f\n", same, half, other);
    assert_true(same > 0.95 && same < 1.09);
    assert_true(fabs(other) < 0.12);
    assert_true(half > other + 0.1 && half < same - 0.1);
}

static void bare_walls_say_nothing(void **state)
{
    (void)state;
    make_wall(20, 20, 0, 0, 0);
    assert_true(fabs(asj_pictures_agreement(&look).share - USUAL) < 1e-9);
    make_wall(0, 0, 1, 0, 0);
    assert_true(fabs(asj_pictures_agreement(&look).share - USUAL) < 1e-9);
    make_wall(3, 3, 1, 1, 0.01); /* too few to compare with */
    assert_true(fabs(asj_pictures_agreement(&look).share - USUAL) < 1e-9);
}

/* Against a naive evaluation, with planes beside each other and cells that are far from matches. */
static void it_is_what_it_is_said_to_be(void **state)
{
    double said = 0, known = 0;
    (void)state;
    make_wall(31, 23, 0.8, 0.3, 0.02);
    for (int32_t n = 0; n < ASJ_CELLS; n++) {
        look.cells[n].plane += look.cells[n].plane == 0 && n % ASJ_CELLS_ALONG > 12;
        look.cells[n].is_near = look.cells[n].is_near && n % 7 > 1;
    }
    for (int32_t block = 0; block < ASJ_CELLS; block++) {
        const int32_t left = block % ASJ_CELLS_ALONG, top = block / ASJ_CELLS_ALONG;
        double d = 0, k = 0;
        int32_t cells = 0;
        if (left % 2 || top % 2)
            continue;
        for (int32_t n = 0; n < ASJ_CELLS; n++) {
            const int32_t x = n % ASJ_CELLS_ALONG, y = n / ASJ_CELLS_ALONG;
            double sum = 0;
            int32_t count = 0;
            if (x / 2 != left / 2 || y / 2 != top / 2 || !look.cells[n].is_near)
                continue;
            for (int32_t o = 0; o < ASJ_CELLS; o++) {
                const int32_t dx = o % ASJ_CELLS_ALONG - x, dy = o / ASJ_CELLS_ALONG - y;
                const double far = sqrt((double)(dx * dx + dy * dy));
                if (look.cells[o].plane != look.cells[n].plane || far < 2.2 || far > 8.9)
                    continue;
                for (int32_t c = 0; c < 3; c++)
                    sum += fabs(look.brightness[c][o][1] - look.offset[c] - look.slope[c] * look.brightness[c][n][0]) / 3;
                count++;
            }
            if (count < 6)
                continue;
            d += log((sum / count + 0.02) / (look.cells[n].difference + 0.02));
            k += log((sum / count + 0.02) / (1.3 * 0.02));
            cells++;
        }
        said += cells ? d / cells : 0;
        known += cells ? k / cells : 0;
    }
    assert_true(known > 50 && fabs(asj_pictures_agreement(&look).known - known) < 1e-9);
    assert_true(fabs(asj_pictures_agreement(&look).share - (said + USUAL * LITTLE) / (known + LITTLE)) < 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_pictures_agree_and_others_do_not),
        cmocka_unit_test(bare_walls_say_nothing),
        cmocka_unit_test(it_is_what_it_is_said_to_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
