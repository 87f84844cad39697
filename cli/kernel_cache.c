/* SPDX-License-Identifier: BSD-2-Clause */
/* Compiled OpenCL kernels as files, written under another name first. */
#define _POSIX_C_SOURCE 200809L
#include "kernel_cache.h"

#include <asj/io.h>

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* 0 when the path is too long, or the folder is not absolute: the XDG base directory specification says to ignore it then. */
static int join(char path[CLI_CACHE_PATH], const char *folder, const char *name)
{
    if (!folder || folder[0] != '/')
        return 0;
    const int length = snprintf(path, CLI_CACHE_PATH, "%s/%s", folder, name);
    return length > 0 && length < CLI_CACHE_PATH;
}

/* Reads what fits. A file that is being replaced stays the one that was opened. */
static size_t read_entry(int file, void *data, size_t capacity)
{
    struct stat facts;
    if (fstat(file, &facts) != 0 || !S_ISREG(facts.st_mode) || facts.st_size <= 0)
        return 0;
    const size_t size = (size_t)facts.st_size;
    size_t have = 0;
    while (size <= capacity && have < size) {
        const ssize_t more = read(file, (char *)data + have, size - have);
        if (more <= 0)
            return 0;
        have += (size_t)more;
    }
    return size;
}

static size_t get(void *user, const char *key, void *data, size_t capacity)
{
    const cli_kernel_cache *cache = user;
    char path[CLI_CACHE_PATH];
    if (!join(path, cache->folder, key))
        return 0;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0)
        return 0;
    const size_t size = read_entry(file, data, capacity);
    close(file);
    return size;
}

/* Whole or not at all, so that programs that run at the same time never see a part. */
static void put(void *user, const char *key, const void *data, size_t size)
{
    const cli_kernel_cache *cache = user;
    char path[CLI_CACHE_PATH];
    asj_output *output = NULL;
    struct stat facts;
    if (!join(path, cache->folder, key))
        return;
    mkdir(cache->base, 0700);
    mkdir(cache->folder, 0700);
    if (lstat(path, &facts) == 0 && !S_ISREG(facts.st_mode)) /* a pipe would be waited for */
        return;
    if (asj_output_begin(path, &output, NULL, 0) != ASJ_OK)
        return;
    if (asj_output_write(output, data, size) == ASJ_OK)
        asj_output_commit(&output, NULL, 0);
    asj_output_abort(&output);
}

void cli_kernel_cache_init(cli_kernel_cache *cache, asj_kernel_cache *callbacks)
{
    const char *base = getenv("XDG_CACHE_HOME");
    memset(cache, 0, sizeof *cache);
    callbacks->get = get;
    callbacks->put = put;
    callbacks->user = cache;
    if (base && base[0] == '/' && strlen(base) < sizeof cache->base)
        memcpy(cache->base, base, strlen(base) + 1);
    else if (!join(cache->base, getenv("HOME"), ".cache"))
        cache->base[0] = '\0';
    if (!join(cache->folder, cache->base, "asj"))
        cache->folder[0] = '\0';
}
