/* SPDX-License-Identifier: BSD-2-Clause */
/* libOpenCL by dlopen(), and its functions by name. */
#define _POSIX_C_SOURCE 200809L
#include "loader.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

#ifndef RTLD_NODELETE
#define RTLD_NODELETE 0
#endif

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
