/* SPDX-License-Identifier: BSD-2-Clause */
/* The pool of a context, and loops on it. See threads.h. */
#ifdef __linux__
#define _GNU_SOURCE /* sched_getaffinity() */
#else
#define _POSIX_C_SOURCE 200809L
#endif
#include "threads.h"

#define PARTS_PER_THREAD 8 /* when the loop does not say */

/* What is left of a loop. */
typedef struct queue {
    asj_loop loop;
    const void *data;
    int64_t count, at_once;
    size_t next; /* part that nobody has taken */
} queue;

#ifdef ASJ_HAVE_THREADS
#define TAKE(next) __atomic_fetch_add(&(next), 1, __ATOMIC_RELAXED)
#else
#define TAKE(next) ((next)++)
#endif

/* Does parts of the loop until none is left. */
static void work(queue *q, int32_t thread, int32_t caller)
{
    for (;;) {
        const int64_t first = (int64_t)TAKE(q->next) * q->at_once;
        if (first >= q->count)
            return;
        const int64_t end = q->count - first < q->at_once ? q->count : first + q->at_once;
        const asj_part part = {first, end, thread, caller};
        q->loop(q->data, &part);
    }
}

#ifdef ASJ_HAVE_THREADS

#include <pthread.h>
#include <sched.h>
#include <unistd.h>
#ifndef _WIN32
#include <signal.h>
#endif

#define STACK (1 << 20) /* bytes: the deepest loop needs a few dozen kB */
#define SPIN 0.3        /* ms: how long one who has nothing to do looks for more before falling asleep; the gaps between the loops
                         * of a call are shorter. On two idle cores 0.02 makes two threads 1.2 times as slow, on busy ones 0.3
                         * costs nothing that can be measured (tests/benchmark/busy). */

typedef struct asj_pool {
    pthread_mutex_t mutex;
    pthread_cond_t wake, done; /* for workers; for the calling thread */
    int busy;                  /* in a loop: one that comes now is inside of it */
    /* Under the mutex: */
    queue *queue;              /* the loop; NULL = none, or nobody may begin any more */
    int32_t places, begun;     /* how many workers may still begin, and have begun */
    int32_t asleep, stop;
    /* Changed under the mutex, read without it: */
    int32_t running;           /* workers that have begun and not ended */
    uint32_t loops;            /* how many there have been */
    /* Of the calling thread: */
    pthread_t caller;
    int32_t workers, most;     /* how many have been made, and how many there can be */
    pid_t process;
    pthread_t thread[ASJ_MAX_THREADS];
} asj_pool;

static void relax(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

/* Until another loop has come, for a short while. */
static void spin_for_loop(const asj_pool *pool, uint32_t loops)
{
    const double end = asj_clock_ms() + SPIN;
    while (__atomic_load_n(&pool->loops, __ATOMIC_ACQUIRE) == loops && asj_clock_ms() < end)
        relax();
}

/* Until all that have begun have ended, for a short while. */
static void spin_for_end(const asj_pool *pool)
{
    const double end = asj_clock_ms() + SPIN;
    while (__atomic_load_n(&pool->running, __ATOMIC_ACQUIRE) > 0 && asj_clock_ms() < end)
        relax();
}

/* Takes part in the loop that there is. With the mutex, which is free meanwhile. */
static void join(asj_pool *pool)
{
    queue *q = pool->queue;
    const int32_t number = ++pool->begun;
    pool->places--;
    __atomic_fetch_add(&pool->running, 1, __ATOMIC_RELAXED);
    pthread_mutex_unlock(&pool->mutex);
    work(q, number, 0);
    pthread_mutex_lock(&pool->mutex);
    pool->places = 0; /* all parts are taken */
    if (__atomic_sub_fetch(&pool->running, 1, __ATOMIC_RELEASE) == 0)
        pthread_cond_signal(&pool->done);
}

static void *run_worker(void *argument)
{
    asj_pool *pool = argument;
    pthread_mutex_lock(&pool->mutex);
    while (!pool->stop) {
        if (pool->queue && pool->places > 0) {
            join(pool);
            const uint32_t loops = pool->loops;
            pthread_mutex_unlock(&pool->mutex);
            spin_for_loop(pool, loops);
            pthread_mutex_lock(&pool->mutex);
        } else {
            pool->asleep++;
            pthread_cond_wait(&pool->wake, &pool->mutex);
            pool->asleep--;
        }
    }
    pthread_mutex_unlock(&pool->mutex);
    return NULL;
}

static void start(asj_pool *pool)
{
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_cond_init(&pool->done, NULL);
    pool->queue = NULL;
    pool->running = pool->asleep = pool->workers = 0;
    pool->most = ASJ_MAX_THREADS;
    pool->process = getpid();
}

/* What threads begin with. Signals go to the program's own threads: Windows has none that go to threads. */
#ifdef _WIN32
typedef int signals;

static void hold_signals(signals *before)
{
    *before = 0;
}

static void release_signals(const signals *before)
{
    (void)before;
}
#else
typedef sigset_t signals;

static void hold_signals(signals *before)
{
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, before);
}

static void release_signals(const signals *before)
{
    pthread_sigmask(SIG_SETMASK, before, NULL);
}
#endif

/* Workers until there are `wanted`, as far as the system gives them. */
static void make_workers(asj_pool *pool, int32_t wanted)
{
    pthread_attr_t attributes;
    signals before;
    if (wanted > pool->most)
        wanted = pool->most;
    if (pool->workers >= wanted || pthread_attr_init(&attributes) != 0)
        return;
    pthread_attr_setstacksize(&attributes, STACK);
    hold_signals(&before);
    while (pool->workers < wanted && pthread_create(&pool->thread[pool->workers], &attributes, run_worker, pool) == 0)
        pool->workers++;
    if (pool->workers < wanted)
        pool->most = pool->workers; /* not asked again */
    release_signals(&before);
    pthread_attr_destroy(&attributes);
}

static void share(asj_pool *pool, int32_t threads, queue *q)
{
    if (pool->process != getpid()) /* the child of a fork() has no workers, and what they held stays as it was */
        start(pool);
    make_workers(pool, threads - 1);
    pthread_mutex_lock(&pool->mutex);
    pool->queue = q;
    pool->places = threads - 1;
    pool->begun = 0;
    __atomic_fetch_add(&pool->loops, 1, __ATOMIC_RELEASE);
    const int32_t wake = pool->asleep < threads - 1 ? pool->asleep : threads - 1;
    pthread_mutex_unlock(&pool->mutex);
    for (int32_t i = 0; i < wake; i++)
        pthread_cond_signal(&pool->wake);
    work(q, 0, 1);
    pthread_mutex_lock(&pool->mutex);
    pool->queue = NULL;
    if (pool->running > 0) {
        pthread_mutex_unlock(&pool->mutex);
        spin_for_end(pool);
        pthread_mutex_lock(&pool->mutex);
        while (pool->running > 0)
            pthread_cond_wait(&pool->done, &pool->mutex);
    }
    pthread_mutex_unlock(&pool->mutex);
}

static void free_pool(asj_memory *memory, void *state)
{
    asj_pool *pool = state;
    if (pool->process == getpid()) {
        pthread_mutex_lock(&pool->mutex);
        pool->stop = 1;
        pthread_mutex_unlock(&pool->mutex);
        pthread_cond_broadcast(&pool->wake);
        for (int32_t i = 0; i < pool->workers; i++)
            pthread_join(pool->thread[i], NULL);
        pthread_cond_destroy(&pool->done);
        pthread_cond_destroy(&pool->wake);
        pthread_mutex_destroy(&pool->mutex);
    }
    asj_release(memory, pool);
}

asj_status asj_pool_open(asj_context *context)
{
    asj_pool *pool = asj_allocate_zero(&context->memory, 1, sizeof *pool);
    if (!pool)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for threads");
    start(pool);
    context->pool = (asj_kept){pool, free_pool};
    return ASJ_OK;
}

int32_t asj_pool_workers(const asj_context *context)
{
    const asj_pool *pool = context->pool.state;
    return pool->workers;
}

static int is_caller(const asj_pool *pool)
{
    return pthread_equal(pthread_self(), pool->caller) != 0;
}

/* On threads of the user's own, one task for each. A task has the number in which it begins, whatever the pool calls it: two with
 * one number would share scratch. */
typedef struct tasks {
    queue *queue;
    const asj_pool *pool;
    int32_t threads;
    int32_t next;
} tasks;

static void run_task(void *job, int32_t number)
{
    tasks *t = job;
    const int32_t own = TAKE(t->next);
    (void)number;
    if (own < t->threads)
        work(t->queue, own, is_caller(t->pool));
}

static void run(const asj_context *context, int32_t threads, queue *q)
{
    asj_pool *pool = context->pool.state;
    if (pool->busy || threads < 2) {
        work(q, 0, !pool->busy || is_caller(pool));
        return;
    }
    pool->busy = 1;
    pool->caller = pthread_self();
    if (context->options.parallel) {
        tasks t = {q, pool, threads, 0};
        context->options.parallel(context->options.parallel_user, threads, run_task, &t);
        work(q, 0, 1); /* what a pool has left that is full, or is closing */
    } else {
        share(pool, threads, q);
    }
    pool->busy = 0;
}

int32_t asj_thread_count(int32_t wanted)
{
    long count = 0;
#ifdef __linux__
    cpu_set_t allowed;
    if (wanted <= 0 && sched_getaffinity(0, sizeof allowed, &allowed) == 0)
        count = CPU_COUNT(&allowed);
#endif
#ifdef _WIN32
    if (wanted <= 0)
        count = pthread_num_processors_np();
#else
    if (count <= 0)
        count = sysconf(_SC_NPROCESSORS_ONLN);
#endif
    return wanted > 0 ? wanted : count < 1 ? 1 : count > ASJ_MAX_THREADS ? ASJ_MAX_THREADS : (int32_t)count;
}

#else

asj_status asj_pool_open(asj_context *context)
{
    (void)context;
    return ASJ_OK;
}

int32_t asj_pool_workers(const asj_context *context)
{
    (void)context;
    return 0;
}

static void run(const asj_context *context, int32_t threads, queue *q)
{
    (void)context;
    (void)threads;
    work(q, 0, 1);
}

int32_t asj_thread_count(int32_t wanted)
{
    (void)wanted;
    return 1;
}

#endif

void asj_parallel(const asj_context *context, int32_t threads, int64_t count, int64_t at_once, asj_loop loop, const void *data)
{
    if (at_once <= 0)
        at_once = threads < 2 ? count : count / ((int64_t)threads * PARTS_PER_THREAD);
    queue q = {loop, data, count, at_once > 0 ? at_once : 1, 0};
    const int64_t parts = (count + q.at_once - 1) / q.at_once;
    run(context, parts < threads ? (int32_t)parts : threads, &q);
}
