/* SPDX-License-Identifier: BSD-2-Clause */
/* libOpenCL by dlopen(), and its functions by name. */
#if defined(__linux__) && !defined(_GNU_SOURCE)
#define _GNU_SOURCE /* dl_iterate_phdr() */
#endif
#define _POSIX_C_SOURCE 200809L
#include "loader.h"

#include <dlfcn.h>
#ifdef __linux__
#include <link.h>
#endif
#include <stdio.h>
#include <string.h>

#ifndef RTLD_NODELETE
#define RTLD_NODELETE 0
#endif

#ifdef __linux__
static int names_a_loader(struct dl_phdr_info *object, size_t size, void *unused)
{
    (void)size, (void)unused;
    for (size_t i = 0; i < object->dlpi_phnum; i++)
        if (object->dlpi_phdr[i].p_type == PT_INTERP)
            return 1;
    return 0;
}
#endif

/* Whether a dynamic loader is at work in this process. In a fully static program there is none; dlopen() of the GNU C library
 * works there all the same, but brings a second C library along, and drivers crash in it. Where there is a loader, the program
 * names it (PT_INTERP), or the C library does. */
static int has_dynamic_loader(void)
{
#ifdef __linux__
    return dl_iterate_phdr(names_a_loader, NULL);
#else
    return 1;
#endif
}

static void *open_library(const char *path, const char **name, char *message, size_t message_size)
{
    static const char *const names[] = {
#ifdef __APPLE__
        "/System/Library/Frameworks/OpenCL.framework/OpenCL",
#endif
        "libOpenCL.so.1", "libOpenCL.so"};
    void *library = NULL;
    for (size_t i = 0; !library && i < (path ? 1 : sizeof names / sizeof names[0]); i++) {
        *name = path ? path : names[i];
        library = dlopen(*name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (!library && i == 0) {
            const char *why = dlerror();
            snprintf(message, message_size, "no OpenCL library: %s", why ? why : *name);
        }
    }
    return library;
}

int asj_cl_load(const char *path, asj_cl_api *api, char *message, size_t message_size)
{
    const char *name = NULL;
    memset(api, 0, sizeof *api);
    if (!has_dynamic_loader()) {
        snprintf(message, message_size, "no OpenCL library: this program is linked statically, without a dynamic loader");
        return 0;
    }
    void *library = open_library(path, &name, message, message_size);
    if (!library)
        return 0;
    /* C has no cast from data to functions; POSIX promises that the bytes are the same */
    void *symbol;
#define LOOK_UP(result, function, parameters)                                                 \
    symbol = dlsym(library, "cl" #function);                                                  \
    if (!symbol) {                                                                            \
        snprintf(message, message_size, "the OpenCL library %s has no cl" #function, name);   \
        dlclose(library);                                                                     \
        return 0;                                                                             \
    }                                                                                         \
    memcpy(&api->function, &symbol, sizeof symbol);
    ASJ_CL_FUNCTIONS(LOOK_UP)
#undef LOOK_UP
    api->library = library;
    return 1;
}

void asj_cl_unload(asj_cl_api *api)
{
    if (api->library)
        dlclose(api->library);
    memset(api, 0, sizeof *api);
}
