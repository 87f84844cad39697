/* SPDX-License-Identifier: BSD-2-Clause */
/* What the JSON writers share. The frame of a file is written as text and each value in it by jansson, one after the other, so that
 * memory does not grow with the result. */
#ifndef ASJ_IO_JSON_OUTPUT_H
#define ASJ_IO_JSON_OUTPUT_H

#include <asj/io.h>

#include <jansson.h>

/* Nine digits give every float back. */
#define ASJ_JSON_FLOATS (JSON_COMPACT | JSON_REAL_PRECISION(9))

typedef struct asj_json_output {
    asj_output *output;
    int out_of_memory;
    int compact; /* without white space, which is in no key: one line */
} asj_json_output;

/* Writes text of the frame. */
void asj_json_text(asj_json_output *json, const char *text);

/* Writes a value after some text of the frame, and lets go of it. NULL: jansson had no memory for it. */
void asj_json_put(asj_json_output *json, const char *before, json_t *value, size_t flags);

/* The list or the object with the value in it, which it owns then; NULL, and nothing is left of either, when there is no memory. */
json_t *asj_json_append(json_t *list, json_t *value);
json_t *asj_json_set(json_t *object, const char *key, json_t *value);

/* A file name need not be UTF-8, JSON must be: other bytes become '?'. */
json_t *asj_json_name(const char *name);

/* "cpu", "opencl", "unknown" */
const char *asj_json_backend(int32_t backend);

/* {"total_ms": ..., "stages": {...}} with the stages first .. last; to be written with JSON_REAL_PRECISION(15). */
json_t *asj_json_timing(double total_ms, const double *stage_ms, int32_t first, int32_t last);

json_t *asj_json_l_junction(const asj_l_junction *pair);

#endif
