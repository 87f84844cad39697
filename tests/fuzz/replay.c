/* SPDX-License-Identifier: BSD-2-Clause */
/* Runs a harness without libFuzzer: replay FOLDER CHANGES. Every file of the folder as it is, then CHANGES times a file with some
 * bytes changed, cut or repeated, the same ones every time. */
#define _POSIX_C_SOURCE 200809L
#include "fuzz.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_FILES = 256, MOST_BYTES = 65536 };

typedef struct seed {
    char name[256];
    uint8_t *bytes;
    size_t size;
} seed;

static int compare(const void *a, const void *b)
{
    return strcmp(((const seed *)a)->name, ((const seed *)b)->name);
}

static size_t read_seeds(const char *folder, seed *seeds)
{
    DIR *listing = opendir(folder);
    struct dirent *entry;
    size_t count = 0;

    while (listing && count < MOST_FILES && (entry = readdir(listing)) != NULL) {
        char path[1024];
        FILE *file;
        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        snprintf(seeds[count].name, sizeof seeds[count].name, "%s", entry->d_name);
        file = fopen(path, "rb");
        seeds[count].bytes = malloc(MOST_BYTES);
        fuzz_check(file && seeds[count].bytes, path);
        seeds[count].size = fread(seeds[count].bytes, 1, MOST_BYTES, file);
        fclose(file);
        count++;
    }
    if (listing)
        closedir(listing);
    qsort(seeds, count, sizeof *seeds, compare);
    return count;
}

/* Knuth's generator of 64 bits (TAOCP 3.3.4, table 1, line 26): its upper half. */
static uint32_t next_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 32);
}

static size_t change(uint8_t *bytes, size_t size, uint64_t *state)
{
    uint32_t changes = 1 + next_random(state) % 8;
    while (changes-- && size > 1) {
        size_t at = next_random(state) % size, length = next_random(state) % (size - at);
        switch (next_random(state) % 6) {
        case 0: bytes[at] = (uint8_t)next_random(state); break;
        case 1: bytes[at] ^= (uint8_t)(1u << next_random(state) % 8); break;
        case 2: bytes[at] = (uint8_t)(next_random(state) % 2 ? 255 : 0); break;
        case 3: size = at + 1; break;
        case 4: memmove(bytes + at, bytes + size - length, length); break;
        default: memset(bytes + at, bytes[at], length < 8 ? length : 8); break;
        }
    }
    return size;
}

int main(int count, char **arguments)
{
    static seed seeds[MOST_FILES];
    static uint8_t bytes[MOST_BYTES];
    uint64_t state = 1;
    size_t files, i;
    long changes;

    if (count != 3)
        return 2;
    changes = strtol(arguments[2], NULL, 10);
    files = read_seeds(arguments[1], seeds);
    fuzz_check(files > 0, "no files to replay");
    for (i = 0; i < files; i++)
        LLVMFuzzerTestOneInput(seeds[i].bytes, seeds[i].size);
    for (; changes > 0; changes--) {
        const seed *one = &seeds[next_random(&state) % files];
        memcpy(bytes, one->bytes, one->size);
        LLVMFuzzerTestOneInput(bytes, change(bytes, one->size, &state));
    }
    printf("%lu files\n", (unsigned long)files);
    for (i = 0; i < files; i++)
        free(seeds[i].bytes);
    return 0;
}
