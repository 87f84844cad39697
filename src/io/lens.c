/* SPDX-License-Identifier: BSD-2-Clause */
/* Focal length in px from what EXIF says.
 *
 * 35 mm film is 36 x 24 mm, and equal views are those of equal diagonals (CIPA DCG-001, 3.3), so with the sides w, h of the picture
 *
 *     f = film_mm sqrt(w^2 + h^2) / sqrt(36^2 + 24^2).
 *
 * Else f = mm (pixels per mm of the focal plane) times how much smaller the picture has become since: its longer side over the one
 * that EXIF tells. The first is a whole number of mm, so it is off by up to 2 % at 26 mm; it goes first because what programs write
 * as the second is wrong more often.
 *
 * A program that makes a picture smaller may tell the new size and leave the resolution of the focal plane, which then is that of a
 * picture several times as large: 640 px by 5315 an inch are a sensor 3.1 mm wide, behind a lens of 18 mm, and the focal length is
 * 507 px in place of 3767. Nothing says how much smaller it has become, but no sensor that states its resolution is smaller than
 * SMALLEST, or than SMALLEST_OF_LONG (one inch, nominally) behind LONG mm and more: what is is not believed. Compact cameras at the
 * far end of their zoom are given up with that, resized pictures of large sensors above SMALLEST_OF_LONG stay unnoticed.
 *
 * A picture whose sides have another ratio than those that EXIF tells was cut; then its size says nothing of its focal length. */
#include "lens.h"

#include <asj/io.h>

#include <math.h>

#define FILM_DIAGONAL 43.26661530556787 /* mm */
#define SAME_RATIO 0.01
#define SHORTEST 0.2 /* of the longer side: an angle of view of 136 degrees .. */
#define LONGEST 50.0 /* .. and of 1.1 */
#define SMALLEST 4.0          /* mm, the longer side of a sensor, */
#define SMALLEST_OF_LONG 13.0 /* .. and where the focal length is at least */
#define LONG 14.0             /* mm: such lenses are made for larger sensors */

static double per_mm(const asj_lens *lens)
{
    switch (lens->unit) {
    case 2: return lens->per_unit / 25.4;
    case 3: return lens->per_unit / 10;
    case 4: return lens->per_unit;
    case 5: return lens->per_unit * 1000;
    default: return 0;
    }
}

/* Can the focal plane be as large as that? longer: px, of the picture that all was said of. */
static int32_t is_sensor(const asj_lens *lens, double longer)
{
    return longer / per_mm(lens) >= (lens->mm >= LONG ? SMALLEST_OF_LONG : SMALLEST);
}

double asj_lens_focal(const asj_lens *lens, int32_t width, int32_t height, int32_t *source)
{
    const double longer = width > height ? width : height, shorter = width > height ? height : width;
    const double was_longer = fmax(lens->width, lens->height), was_shorter = fmin(lens->width, lens->height);
    const int by_film = lens->film_mm > 0, by_plane = lens->mm > 0 && per_mm(lens) > 0;
    const int is_cut = was_shorter > 0 && fabs(was_longer * shorter / (was_shorter * longer) - 1) > SAME_RATIO;
    const double smaller = was_longer > 0 ? longer / was_longer : 1;
    const double focal = by_film ? lens->film_mm * hypot(longer, shorter) / FILM_DIAGONAL : lens->mm * per_mm(lens) * smaller;
    *source = ASJ_EXIF_FOCAL_NONE;
    if (!by_film && !by_plane) {
        *source = lens->is_damaged ? ASJ_EXIF_FOCAL_UNUSABLE : ASJ_EXIF_FOCAL_NONE;
        return 0;
    }
    const int can_be = (by_film || is_sensor(lens, longer / smaller)) && focal >= SHORTEST * longer && focal <= LONGEST * longer;
    if (is_cut || !can_be) {
        *source = ASJ_EXIF_FOCAL_UNUSABLE;
        return 0;
    }
    *source = by_film ? ASJ_EXIF_FOCAL_FILM : ASJ_EXIF_FOCAL_PLANE;
    return focal;
}
