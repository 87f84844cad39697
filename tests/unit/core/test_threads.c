/* SPDX-License-Identifier: BSD-2-Clause */
/* The pool of a context. pthread_create() is wrapped by the linker, so that threads fail to come or come late. */
#define _POSIX_C_SOURCE 200809L
#include "core/threads.h"
#include "core/watch.h"
#include "unit_test.h"

#include <time.h>

#define MOST 5000

/* How often each item was done, how many loops went wrong in a thread's number, and which numbers are at work. */
typedef struct tally {
    int32_t done[MOST];
    int32_t threads, wrong, working[256];
    int64_t at_once;
} tally;

static void sleep_ms(int ms)
{
    const struct timespec pause = {ms / 1000, ms % 1000 * 1000000L};
    nanosleep(&pause, NULL);
}

static void count(const void *data, const asj_part *part)
{
    tally *t = *(tally *const *)data;
    if (part->thread < 0 || part->thread >= t->threads || part->end - part->first > t->at_once || part->first >= part->end ||
        __atomic_fetch_add(&t->working[part->thread], 1, __ATOMIC_RELAXED) != 0)
        __atomic_fetch_add(&t->wrong, 1, __ATOMIC_RELAXED);
    for (int64_t i = part->first; i < part->end; i++)
        __atomic_fetch_add(&t->done[i], 1, __ATOMIC_RELAXED);
    __atomic_fetch_sub(&t->working[part->thread], 1, __ATOMIC_RELAXED);
}

/* 1 = every item once, and nothing wrong. */
static int runs_all(const asj_context *context, int32_t threads, int32_t items, int64_t at_once)
{
    static const tally none;
    tally t = none, *data = &t;
    t.threads = threads;
    t.at_once = at_once > 0 ? at_once : items;
    asj_parallel(context, threads, items, at_once, count, &data);
    int good = t.wrong == 0;
    for (int32_t i = 0; i < MOST; i++)
        good = good && t.done[i] == (i < items);
    return good;
}

static void test_all_once(void **state)
{
    static const int32_t items[] = {0, 1, 2, 7, 64, MOST};
    unit_fixture *f = *state;
    for (int32_t threads = 1; threads <= 9; threads += 2)
        for (size_t i = 0; i < UNIT_COUNT(items); i++)
            for (int64_t at_once = 0; at_once <= 3; at_once++)
                assert_true(runs_all(f->context, threads, items[i], at_once));
    for (int repeat = 0; repeat < 2000; repeat++)
        assert_true(runs_all(f->context, 3, 10, 1));
}

static void test_worth(void **state)
{
    unit_fixture *f = *state;
    f->context->threads = 4;
    assert_int_equal(asj_threads_for(f->context, 0, 10), 1);
    assert_int_equal(asj_threads_for(f->context, 19, 10), 1);
    assert_int_equal(asj_threads_for(f->context, 20, 10), 2);
    assert_int_equal(asj_threads_for(f->context, 39, 10), 3);
    assert_int_equal(asj_threads_for(f->context, INT64_MAX, 10), 4);
    f->context->threads = 1;
    assert_int_equal(asj_threads_for(f->context, INT64_MAX, 10), 1);
}

/* ---- a loop inside of a loop ---- */

typedef struct nest {
    const asj_context *context;
    int32_t *done; /* 20 inner items for each outer one */
    int32_t *wrong;
    const asj_part *outer;
} nest;

static void inner(const void *data, const asj_part *part)
{
    const nest *n = data;
    if (part->thread != 0 || part->caller != n->outer->caller)
        __atomic_fetch_add(n->wrong, 1, __ATOMIC_RELAXED);
    for (int64_t i = part->first; i < part->end; i++)
        n->done[i]++;
}

static void outer(const void *data, const asj_part *part)
{
    const nest *all = data;
    for (int64_t i = part->first; i < part->end; i++) {
        const nest own = {all->context, all->done + 20 * i, all->wrong, part};
        asj_parallel(all->context, 4, 20, 3, inner, &own);
    }
}

static void test_nested(void **state)
{
    unit_fixture *f = *state;
    int32_t done[200 * 20] = {0}, wrong = 0;
    const nest all = {f->context, done, &wrong, NULL};
    asj_parallel(f->context, 4, 200, 1, outer, &all);
    assert_int_equal(wrong, 0);
    for (int32_t i = 0; i < 200 * 20; i++)
        assert_int_equal(done[i], 1);
}

/* ---- the caller stops a loop ---- */

typedef struct stopping {
    asj_watch watch;
    int32_t begun;
} stopping;

static void wait_each(const void *data, const asj_part *part)
{
    stopping *s = *(stopping *const *)data;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(&s->watch, part); i++) {
        __atomic_fetch_add(&s->begun, 1, __ATOMIC_RELAXED);
        sleep_ms(2);
    }
}

static int32_t stop_at_once(void *user, int32_t stage, double done)
{
    (void)stage;
    (void)done;
    ++*(int *)user;
    return 1;
}

/* How many of 2000 items are begun before the caller is asked and stops the loop, which would take over a second. */
static int32_t begun_until_stopped(unit_fixture *f)
{
    stopping s = {.begun = 0}, *data = &s;
    int asked = 0;
    f->context->options.progress = stop_at_once;
    f->context->options.progress_user = &asked;
    f->context->asked_ms = asj_clock_ms();
    asj_watch_start(&s.watch, f->context, ASJ_STAGE_SCAN);
    asj_parallel(f->context, 3, 2000, 1, wait_each, &data);
    f->context->options.progress = NULL;
    assert_int_equal(asj_watch_end(&s.watch), ASJ_ERROR_CANCELLED);
    assert_int_equal(asked, 1);
    return s.begun;
}

/* On a machine that has other work the first item may last until the caller is to be asked: then once more. */
static void test_cancel(void **state)
{
    unit_fixture *f = *state;
    int32_t begun = 0;
    for (int attempt = 0; attempt < 100 && begun < 2; attempt++)
        begun = begun_until_stopped(f);
    assert_in_range(begun, 2, 1000);
}

/* How many loops of 10 ms, one after the other, are done before the caller is asked and stops them; 100 = never. */
static int loops_until_stopped(unit_fixture *f)
{
    stopping s = {.begun = 0}, *data = &s;
    int asked = 0, loops = 0;
    f->context->options.progress = stop_at_once;
    f->context->options.progress_user = &asked;
    f->context->asked_ms = asj_clock_ms();
    do {
        asj_watch_start(&s.watch, f->context, ASJ_STAGE_SCAN);
        asj_parallel(f->context, 1, 5, 1, wait_each, &data);
    } while (asj_watch_end(&s.watch) == ASJ_OK && ++loops < 100);
    f->context->options.progress = NULL;
    return asked == 1 ? loops : 100;
}

/* None of them lasts until the caller is to be asked, all together do. On a machine that has other work one may: then once more. */
static void test_cancel_between(void **state)
{
    unit_fixture *f = *state;
    int loops = 0;
    for (int attempt = 0; attempt < 100 && loops == 0; attempt++)
        loops = loops_until_stopped(f);
    assert_in_range(loops, 1, 99);
}

/* ---- what only a build with threads has ---- */

#ifdef ASJ_HAVE_THREADS

#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

static int32_t refused_from = -1; /* number of the call of pthread_create() that fails, and those after it; -1 = none */
static int32_t created;
static int held; /* a thread that is made does not begin while this is 1 */
static struct { void *(*start)(void *); void *argument; } late;

int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument);

static void *start_late(void *argument)
{
    (void)argument;
    while (__atomic_load_n(&held, __ATOMIC_ACQUIRE))
        sleep_ms(1);
    return late.start(late.argument);
}

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument)
{
    if (refused_from >= 0 && created++ >= refused_from)
        return 11; /* EAGAIN */
    if (!__atomic_load_n(&held, __ATOMIC_ACQUIRE))
        return __real_pthread_create(thread, attributes, start, argument);
    late.start = start;
    late.argument = argument;
    return __real_pthread_create(thread, attributes, start_late, NULL);
}

static void test_made_when_needed(void **state)
{
    unit_counter counter;
    asj_context *context = unit_context(&counter, 4);
    (void)state;
    assert_int_equal(asj_pool_workers(context), 0);
    assert_true(runs_all(context, 4, 10, 10)); /* one part */
    assert_int_equal(asj_pool_workers(context), 0);
    assert_true(runs_all(context, 3, 10, 1));
    assert_int_equal(asj_pool_workers(context), 2);
    assert_true(runs_all(context, 4, 10, 1));
    assert_int_equal(asj_pool_workers(context), 3);
    unit_context_free(&counter, &context);
}

static void test_no_threads_to_be_had(void **state)
{
    (void)state;
    for (refused_from = 0; refused_from < 3; refused_from++) {
        unit_counter counter;
        asj_context *context = unit_context(&counter, 4);
        created = 0;
        for (int repeat = 0; repeat < 3; repeat++)
            assert_true(runs_all(context, 4, 1000, 1));
        assert_int_equal(asj_pool_workers(context), refused_from);
        assert_int_equal(created, refused_from + 1); /* asked once */
        unit_context_free(&counter, &context);
    }
    refused_from = -1;
}

/* Who has not begun is not waited for: this ends. */
static void test_late_thread(void **state)
{
    unit_counter counter;
    asj_context *context = unit_context(&counter, 2);
    (void)state;
    held = 1;
    for (int repeat = 0; repeat < 10; repeat++)
        assert_true(runs_all(context, 2, 1000, 1));
    assert_int_equal(asj_pool_workers(context), 1);
    __atomic_store_n(&held, 0, __ATOMIC_RELEASE);
    assert_true(runs_all(context, 2, 1000, 1));
    unit_context_free(&counter, &context);
}

static void *run_many(void *argument)
{
    int *good = argument;
    asj_context *context = NULL;
    asj_context_options options;
    asj_context_options_init(&options);
    options.threads = 3;
    *good = asj_context_create(&options, &context) == ASJ_OK;
    for (int repeat = 0; *good && repeat < 300; repeat++)
        *good = runs_all(context, 3, 500, 7);
    asj_context_free(&context);
    return NULL;
}

static void test_two_contexts(void **state)
{
    pthread_t threads[2];
    int good[2] = {0, 0};
    (void)state;
    for (int i = 0; i < 2; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, run_many, &good[i]), 0);
    for (int i = 0; i < 2; i++)
        pthread_join(threads[i], NULL);
    assert_true(good[0] && good[1]);
}

/* Its threads sleep: a quarter of a second costs no time of the processor. */
static void test_sleeps(void **state)
{
    unit_fixture *f = *state;
    assert_true(runs_all(f->context, 4, 100, 1));
    const clock_t before = clock();
    sleep_ms(250);
    assert_true((double)(clock() - before) / CLOCKS_PER_SEC < 0.1);
}

/* Which threads take parts. */
typedef struct crowd {
    pthread_mutex_t mutex;
    pthread_t who[8];
    int count;
} crowd;

static int threads_that_hold_signals;

static void join_crowd(const void *data, const asj_part *part)
{
    crowd *c = *(crowd *const *)data;
    int known = 0;
    (void)part;
    sigset_t held_back;
    pthread_sigmask(SIG_BLOCK, NULL, &held_back);
    pthread_mutex_lock(&c->mutex);
    for (int k = 0; k < c->count; k++)
        known = known || pthread_equal(c->who[k], pthread_self());
    if (!known && c->count < 8) {
        c->who[c->count++] = pthread_self();
        threads_that_hold_signals += sigismember(&held_back, SIGINT) == 1 && sigismember(&held_back, SIGUSR2) == 1;
    }
    pthread_mutex_unlock(&c->mutex);
    sleep_ms(5);
}

static int threads_that_work(const asj_context *context, int32_t threads)
{
    crowd c = {.count = 0}, *data = &c;
    threads_that_hold_signals = 0;
    pthread_mutex_init(&c.mutex, NULL);
    asj_parallel(context, threads, 40, 1, join_crowd, &data);
    pthread_mutex_destroy(&c.mutex);
    return c.count;
}

/* Signals go to the program's own threads: those of a context hold back all of them. */
static void test_signals(void **state)
{
    unit_fixture *f = *state;
    const int threads = threads_that_work(f->context, 3);
    assert_in_range(threads, 2, 3);
    assert_int_equal(threads_that_hold_signals, threads - 1);
}

/* A child goes on with the context, and frees it. */
static void test_fork(void **state)
{
    unit_counter counter;
    asj_context *context = unit_context(&counter, 3);
    (void)state;
    assert_true(runs_all(context, 3, 100, 1));
    const pid_t child = fork();
    if (child == 0) {
        const int good = runs_all(context, 3, 100, 1) && asj_pool_workers(context) == 2 && threads_that_work(context, 3) > 1;
        asj_context_free(&context);
        _exit(good ? 0 : 1);
    }
    int status = -1;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    assert_true(runs_all(context, 3, 100, 1));
    unit_context_free(&counter, &context);
}

/* ---- threads of the user's own ---- */

typedef struct own_pool {
    int calls, most, threaded;
} own_pool;

typedef struct own_task {
    asj_parallel_task task;
    void *job;
    int32_t number;
} own_task;

static void *run_own(void *argument)
{
    const own_task *t = argument;
    t->task(t->job, t->number);
    return NULL;
}

static void run_on_own(void *user, int32_t tasks, asj_parallel_task task, void *job)
{
    own_pool *pool = user;
    pthread_t threads[8];
    own_task list[8];
    pool->calls++;
    pool->most = tasks > pool->most ? tasks : pool->most;
    for (int32_t i = tasks - 1; i >= 0; i--) { /* any order */
        list[i] = (own_task){task, job, i};
        if (!pool->threaded || pthread_create(&threads[i], NULL, run_own, &list[i]) != 0)
            run_own(&list[i]);
    }
    for (int32_t i = 0; i < tasks && pool->threaded; i++)
        pthread_join(threads[i], NULL);
}

/* A context of four threads of the user's. */
static asj_context *with_pool(asj_parallel_callback parallel, void *user)
{
    asj_context_options options;
    asj_context *context = NULL;
    asj_context_options_init(&options);
    options.threads = 4;
    options.parallel = parallel;
    options.parallel_user = user;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    return context;
}

static void test_own_threads(void **state)
{
    (void)state;
    for (int threaded = 0; threaded < 2; threaded++) {
        own_pool pool = {0, 0, threaded};
        asj_context *context = with_pool(run_on_own, &pool);
        assert_true(runs_all(context, 4, 1, 1));
        assert_int_equal(pool.calls, 0);
        for (int32_t items = 2; items < 50; items += 7)
            assert_true(runs_all(context, 4, items, 1));
        assert_int_equal(pool.calls, 7);
        assert_int_equal(pool.most, 4);
        assert_int_equal(asj_pool_workers(context), 0);
        asj_context_free(&context);
    }
}

/* Pools that run no task, or one, or all with numbers that are none: everything is done once all the same, by threads that do not
 * share a number. */
static void run_some(void *user, int32_t tasks, asj_parallel_task task, void *job)
{
    const int *which = user;
    for (int32_t i = 0; i < (*which == 0 ? 0 : *which == 1 ? 1 : 3 * tasks); i++)
        task(job, *which == 1 ? tasks - 1 : 1000 - 7 * i);
}

static void test_pool_that_leaves_work(void **state)
{
    (void)state;
    for (int which = 0; which < 3; which++) {
        asj_context *context = with_pool(run_some, &which);
        for (int32_t items = 1; items < 50; items += 7)
            assert_true(runs_all(context, 4, items, 1));
        asj_context_free(&context);
    }
}

#define MORE_TESTS                                                                                                                 \
    cmocka_unit_test(test_made_when_needed), cmocka_unit_test(test_no_threads_to_be_had), cmocka_unit_test(test_late_thread),      \
        cmocka_unit_test(test_two_contexts), cmocka_unit_test(test_sleeps), cmocka_unit_test(test_fork),                           \
        cmocka_unit_test(test_signals),                                                                                            \
        cmocka_unit_test(test_own_threads), cmocka_unit_test(test_pool_that_leaves_work),
#else
#define MORE_TESTS
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        MORE_TESTS cmocka_unit_test(test_all_once), cmocka_unit_test(test_worth), cmocka_unit_test(test_nested),
        cmocka_unit_test(test_cancel),
        cmocka_unit_test(test_cancel_between),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
