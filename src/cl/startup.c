/* SPDX-License-Identifier: BSD-2-Clause */
/* The lock of startup.h. */
#define _POSIX_C_SOURCE 200809L
#include "startup.h"

#include <pthread.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

/* A plain lock that no thread takes twice: neither call can fail. */
void asj_cl_startup_begin(void)
{
    pthread_mutex_lock(&lock);
}

void asj_cl_startup_end(void)
{
    pthread_mutex_unlock(&lock);
}
