/* SPDX-License-Identifier: BSD-2-Clause */
/* Two views of a page that lies flat, from low above: what the tests of asj_match_images() look at. */
#ifndef ASJ_TESTS_UNIT_MATCH_PAGES_H
#define ASJ_TESTS_UNIT_MATCH_PAGES_H

#include "unit_test.h"

#include <asj/asj.h>

enum { PAGE_WIDTH = 420, PAGE_HEIGHT = 200 };

/* Patches of a page, and half their sides. */
typedef struct pages_print {
    int count;
    double least, most;
} pages_print;
extern const pages_print pages_large_print, pages_small_print;

typedef struct pages {
    uint8_t *pixels[2];
    asj_image images[2];
} pages;

/* Where a point of the page, -1 .. 1 along both axes, is seen, px. */
synth_point pages_seen(double u, double v, int view);

/* State of a group of tests: pages of large print. */
int pages_set_up(void **state);
int pages_tear_down(void **state);

/* One view, to be freed. */
uint8_t *pages_draw(const pages_print *print, int view);

/* As they are, or stretched; not upsampled. */
asj_match_result *pages_look(asj_context *context, const asj_image images[2], const asj_stretch *stretch, int32_t model);

/* How many matches are within 3 px of what the page says. */
uint32_t pages_count_right(const asj_match_result *r);

/* The parts of a match agree with each other: the map takes one location to the other, and lists name the same places. */
void pages_expect_consistent(const asj_match_result *r);

void pages_expect_equal(const asj_match_result *a, const asj_match_result *b);

#endif
