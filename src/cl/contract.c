/* SPDX-License-Identifier: BSD-2-Clause */
/* kernels/contract.h against the steps whose numbers it repeats: a difference does not compile. */
#include "kernels/contract.h"
#include "detect/field.h"
#include "detect/gradient.h"
#include "detect/ray_walk.h"
#include "detect/sector_runs.h"
#include "match/patch.h"
#include "match/shortlist.h"

#include <stddef.h>

#define SAME(name, number, other) typedef char name##_differs[(number) == (other) ? 1 : -1]

SAME(margin, MARGIN, ASJ_MARGIN);
SAME(lanes, LANES, ASJ_LANES);
SAME(branches, MAX_BRANCHES, ASJ_MAX_BRANCHES);
SAME(run, RUN, ASJ_SECTOR_RUN);

SAME(gradient_one, GRADIENT_ONE, ASJ_GRADIENT_ONE);
SAME(gradient_sigma, GRADIENT_SIGMA, ASJ_GRADIENT_SIGMA);
/* round(256 / (sigma_0 L)), L = ASJ_GRADIENT_LIMIT = 7 / 2 */
SAME(gradient_limit, GRADIENT_LIMIT, (2 * 256 * 20000 + 7 * GRADIENT_SIGMA) / (2 * 7 * GRADIENT_SIGMA));

SAME(field_offsets, FIELD_MAX_OFFSETS, ASJ_FIELD_MAX_OFFSETS);
SAME(field_sectors, SCAN_MAX_SECTORS, ASJ_FIELD_MAX_SECTORS);
SAME(field_branches, SCAN_BRANCHES, ASJ_FIELD_BRANCHES);

SAME(scan_table_radius, SCAN_TABLE_RADIUS, ASJ_SCAN_TABLE_RADIUS);
SAME(scan_table_width, SCAN_TABLE_WIDTH, ASJ_SCAN_TABLE_WIDTH);
SAME(scan_units, SCAN_UNITS, sizeof((asj_scan *)0)->unit / sizeof((asj_scan *)0)->unit[0]);
SAME(scan_reopen, SCAN_REOPEN, ASJ_RAY_REOPEN);
SAME(scan_stride, SCAN_STRIDE, ASJ_RAY_STRIDE);
SAME(scan_plain, SCAN_PLAIN, ASJ_RAY_PLAIN);
SAME(scan_ray_size, sizeof(scan_ray), 72);

SAME(patch_levels, PATCH_LEVELS, ASJ_PYRAMID_LEVELS);
SAME(patch_grid_bits, PATCH_GRID_BITS, ASJ_GRID_BITS);
SAME(patch_unit_one, PATCH_UNIT_ONE, ASJ_UNIT_ONE);
SAME(patch_gray_one, PATCH_GRAY_ONE, ASJ_GRAY_ONE);
SAME(patch_grid_size, sizeof(patch_grid), sizeof(asj_patch_grid));
SAME(patch_grid_level, offsetof(patch_grid, level), offsetof(asj_patch_grid, level));
SAME(patch_grid_x, offsetof(patch_grid, x), offsetof(asj_patch_grid, x));
SAME(patch_grid_y, offsetof(patch_grid, y), offsetof(asj_patch_grid, y));
SAME(patch_grid_ax, offsetof(patch_grid, ax), offsetof(asj_patch_grid, ax));
SAME(patch_grid_ay, offsetof(patch_grid, ay), offsetof(asj_patch_grid, ay));
SAME(patch_grid_bx, offsetof(patch_grid, bx), offsetof(asj_patch_grid, bx));
SAME(patch_grid_by, offsetof(patch_grid, by), offsetof(asj_patch_grid, by));

SAME(no_partner, NO_PARTNER, ASJ_NO_PARTNER);
