/* SPDX-License-Identifier: BSD-2-Clause */
/* The lens in an EXIF block, through libexif. Its directories refer to each other by offsets, which anyone can write: libexif keeps
 * within the block, and to a depth and a number of entries; a block is 64 KiB at most, as JPEG has it. It complains to a log of the
 * caller's and to nothing else. */
#include "lens.h"

#include <libexif/exif-data.h>
#include <libexif/exif-log.h>
#include <libexif/exif-utils.h>

#include <stdlib.h>
#include <string.h>

enum { LONGEST_BLOCK = 65533 - 6 }; /* EXIF 2.3, 4.5.4: one APP1 segment, less its name */
enum { NO_UNIT = 6 };               /* of lens.c: what a file says may be any number */

static void on_log(ExifLog *log, ExifLogCode code, const char *domain, const char *format, va_list arguments, void *data)
{
    asj_lens *lens = data;
    (void)log;
    (void)domain;
    (void)format;
    (void)arguments;
    if (code == EXIF_LOG_CODE_CORRUPT_DATA)
        lens->is_damaged = 1;
}

/* A number above 0; 0 when it is not there, or is none. */
static double number(ExifData *exif, ExifTag tag)
{
    ExifEntry *entry = exif_content_get_entry(exif->ifd[EXIF_IFD_EXIF], tag);
    const ExifByteOrder order = exif_data_get_byte_order(exif);
    if (!entry || entry->components < 1 || entry->size < exif_format_get_size(entry->format))
        return 0;
    if (entry->format == EXIF_FORMAT_SHORT)
        return exif_get_short(entry->data, order);
    if (entry->format == EXIF_FORMAT_LONG)
        return exif_get_long(entry->data, order);
    if (entry->format == EXIF_FORMAT_RATIONAL) {
        const ExifRational r = exif_get_rational(entry->data, order);
        return r.denominator > 0 ? (double)r.numerator / r.denominator : 0;
    }
    return 0;
}

void asj_exif_lens(const unsigned char *block, size_t size, asj_lens *lens)
{
    static const unsigned char name[6] = {'E', 'x', 'i', 'f', 0, 0}; /* libexif wants a segment, with its name */
    ExifData *exif = NULL;
    ExifLog *log = NULL;
    unsigned char *segment = NULL;
    memset(lens, 0, sizeof *lens);
    if (size > LONGEST_BLOCK)
        size = LONGEST_BLOCK;
    segment = malloc(sizeof name + size);
    exif = exif_data_new();
    log = exif_log_new();
    if (segment && exif && log) {
        memcpy(segment, name, sizeof name);
        memcpy(segment + sizeof name, block, size);
        exif_log_set_func(log, on_log, lens);
        exif_data_log(exif, log);
        exif_data_unset_option(exif, EXIF_DATA_OPTION_FOLLOW_SPECIFICATION); /* which makes up what is missing */
        exif_data_load_data(exif, segment, (unsigned)(sizeof name + size));
        lens->film_mm = number(exif, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM);
        lens->mm = number(exif, EXIF_TAG_FOCAL_LENGTH);
        lens->per_unit = number(exif, EXIF_TAG_FOCAL_PLANE_X_RESOLUTION);
        const double unit = number(exif, EXIF_TAG_FOCAL_PLANE_RESOLUTION_UNIT);
        lens->unit = unit < NO_UNIT ? (int32_t)unit : NO_UNIT;
        lens->width = number(exif, EXIF_TAG_PIXEL_X_DIMENSION);
        lens->height = number(exif, EXIF_TAG_PIXEL_Y_DIMENSION);
        if (lens->per_unit > 0 && lens->unit == 0)
            lens->unit = 2; /* EXIF 2.3, 4.6.5: an inch when it is not said */
    }
    if (exif)
        exif_data_unref(exif);
    if (log)
        exif_log_unref(log);
    free(segment);
}
