/* SPDX-License-Identifier: BSD-2-Clause */
/* Headers of the "portable" formats of Netpbm: PBM, PGM and PPM (P1 to P6), PAM (P7), and PFM with floats (Pf, PF). */
#ifndef ASJ_IO_PNM_HEADER_H
#define ASJ_IO_PNM_HEADER_H

#include "input.h"

typedef struct asj_pnm_header {
    int type;               /* '1' .. '7', 'f', 'F' */
    uint64_t width, height;
    uint32_t samples;       /* a pixel: 1, 3, or those of PAM */
    uint32_t most;          /* the sample value that is white; 0 for floats */
    int is_text;            /* samples are decimal numbers */
    int is_little_endian;   /* of floats */
    size_t pixels;          /* where they begin */
} asj_pnm_header;

/* 0 when it is none, or makes no sense. */
int asj_pnm_read_header(const asj_input *input, asj_pnm_header *header);

/* The next number, past blanks and comments; 0 when there is none below 10^9. */
int asj_pnm_number(const asj_input *input, size_t *at, uint64_t *number);

#endif
