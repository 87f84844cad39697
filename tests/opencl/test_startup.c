/* SPDX-License-Identifier: BSD-2-Clause */
/* Threads that all begin with OpenCL at once, in a new process each time: test_startup PROCESSES. The headers promise that contexts
 * and lists of devices may be made in any thread at any time. */
#define _POSIX_C_SOURCE 200809L
#include <asj/asj.h>

#include <errno.h>
#include <pthread.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

enum { THREADS = 8 };

extern char **environ;

static pthread_barrier_t together;

/* NULL when all went well. */
static void *begin(void *user)
{
    const int number = *(const int *)user;
    asj_device_list *devices = NULL;
    asj_context *context = NULL;
    asj_status status;
    pthread_barrier_wait(&together);
    if (number % 2 == 0) {
        status = asj_device_list_create(NULL, &devices);
        asj_device_list_free(&devices);
    } else {
        status = asj_context_create(NULL, &context);
        asj_context_free(&context);
    }
    return status == ASJ_OK ? NULL : user;
}

static int begin_together(void)
{
    pthread_t threads[THREADS];
    int numbers[THREADS], failed = 0;
    if (pthread_barrier_init(&together, NULL, THREADS))
        return 1;
    for (int i = 0; i < THREADS; i++) {
        numbers[i] = i;
        if (pthread_create(&threads[i], NULL, begin, &numbers[i]))
            abort();
    }
    for (int i = 0; i < THREADS; i++) {
        void *result;
        failed |= pthread_join(threads[i], &result) || result;
    }
    pthread_barrier_destroy(&together);
    return failed;
}

static int run(char *program)
{
    char *arguments[] = {program, NULL};
    pid_t process;
    int state = 0;
    if (posix_spawn(&process, program, NULL, NULL, arguments, environ))
        return 0;
    while (waitpid(process, &state, 0) < 0)
        if (errno != EINTR)
            return 0;
    if (WIFSIGNALED(state))
        printf("ended by signal %d\n", WTERMSIG(state));
    return WIFEXITED(state) && WEXITSTATUS(state) == 0;
}

int main(int count, char **arguments)
{
    int good = 0, processes = count > 1 ? atoi(arguments[1]) : 0;
    if (!processes)
        return begin_together();
    for (int i = 0; i < processes; i++)
        good += run(arguments[0]);
    printf("%d of %d processes started well\n", good, processes);
    return good == processes ? 0 : 1;
}
