/* SPDX-License-Identifier: BSD-2-Clause */
/* Texts that become options: KEY=VALUE, a line each, for the detector, the matcher and the context. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

static void check_round_trip(const asj_detect_options *options)
{
    size_t i;
    for (i = 0; i < asj_detect_option_count(); i++) {
        asj_detect_options copy = *options;
        char text[64], again[64];
        const char *key = asj_detect_option(i)->key;
        fuzz_check(asj_detect_options_get(options, key, text, sizeof text) == ASJ_OK, "an option that cannot be told");
        fuzz_check(asj_detect_options_set(&copy, key, text, NULL, 0) == ASJ_OK, "an option that is not taken back");
        fuzz_check(asj_detect_options_get(&copy, key, again, sizeof again) == ASJ_OK && !strcmp(text, again),
                   "an option that changes by being told");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1), *line, *next, message[64];
    asj_detect_options detect;
    asj_match_options match;

    fuzz_check(text != NULL, "no memory");
    memcpy(text, data, size);
    text[size] = '\0';
    asj_detect_options_init(&detect);
    asj_match_options_init(&match);
    for (line = text; line; line = next) {
        char *equal;
        next = strchr(line, '\n');
        if (next)
            *next++ = '\0';
        equal = strchr(line, '=');
        if (!equal)
            continue;
        *equal = '\0';
        asj_detect_options_set(&detect, line, equal + 1, message, sizeof message);
        asj_match_options_set(&match, line, equal + 1, message, sizeof message);
    }
    check_round_trip(&detect);
    free(text);
    return 0;
}
