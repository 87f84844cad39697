/* SPDX-License-Identifier: BSD-2-Clause */
/* Options of both commands, the context that they ask for, and its log. */
#include "common.h"
#include "message.h"
#include "platform.h"

#include <asj/image.h>
#include <asj/io.h>

#include <string.h>

enum { BACKEND, DEVICE, THREADS, SIMD, MAX_MEGAPIXELS, WHITE, TIME, QUIET };

#define LEAST_WHITE 1e-6

const cli_option cli_common_options[] = {
    {BACKEND, 0, "backend", "auto|cpu|opencl",
     "where to compute; auto (the default): an OpenCL GPU when there is one, else the CPU; the results do not depend on it"},
    {DEVICE, 0, "device", "SPEC",
     "this OpenCL device: its number in 'asj-cli devices', gpu, cpu, accelerator, or a part of its name; implies --backend opencl"},
    {THREADS, 0, "threads", "N",
     "threads on the CPU, 0 .. 256; 0 (the default) is one for each processor; the results do not depend on it"},
    {SIMD, 0, "simd", "auto|reference|sse2|avx2|avx512|neon|vectors",
     "vector instructions of the CPU, for comparisons; auto (the default): the best that it has; the results do not depend on it"},
    {MAX_MEGAPIXELS, 0, "max-megapixels", "N", "refuse larger images before they are decoded (default 268, at most 536)"},
    {WHITE, 0, "white", "N",
     "the sample value that means white, of images of 16 bits with no brighter samples and of floats: 1023 or 4095 for cameras of "
     "10 or 12 bits; default: 65535, 1 in floats"},
    {TIME, 0, "time", NULL, "print how long each stage took"},
    {QUIET, 'q', "quiet", NULL, "print nothing but errors (and what was asked for)"},
};
const size_t cli_common_option_count = sizeof cli_common_options / sizeof cli_common_options[0];

void cli_common_init(cli_common *common, const char *command)
{
    memset(common, 0, sizeof *common);
    common->command = command;
    common->backend = ASJ_BACKEND_AUTO;
    common->max_pixels = ASJ_IO_DEFAULT_MAX_PIXELS;
}

static int take_backend(cli_common *common, const char *text)
{
    static const char *const words[] = {"auto", "cpu", "opencl", NULL}; /* in the order of ASJ_BACKEND_... */
    int word = cli_find_word(words, text);
    if (word < 0)
        return cli_usage_error(common->command, "--backend: '%s' is not auto, cpu or opencl", text);
    common->backend = word;
    return CLI_SUCCESS;
}

static int take_threads(cli_common *common, const char *text)
{
    double number;
    if (!cli_parse_number(text, 0, ASJ_MAX_THREADS, &number) || strspn(text, "0123456789") != strlen(text))
        return cli_usage_error(common->command, "--threads: '%s' is not a whole number in 0 .. %d", text, ASJ_MAX_THREADS);
    common->threads = (int32_t)number;
    return CLI_SUCCESS;
}

static int take_simd(cli_common *common, const char *text)
{
    for (int32_t simd = 0; simd < ASJ_SIMD_COUNT; simd++)
        if (strcmp(text, asj_simd_name(simd)) == 0) {
            common->simd = simd;
            return CLI_SUCCESS;
        }
    return cli_usage_error(common->command, "--simd: '%s' is not auto, reference, sse2, avx2, avx512, neon or vectors", text);
}

static int take_max_megapixels(cli_common *common, const char *text)
{
    double number;
    if (!cli_parse_number(text, 1e-6, ASJ_MAX_PIXELS / 1e6, &number))
        return cli_usage_error(common->command, "--max-megapixels: '%s' is not a number in 0.000001 .. %d", text,
                               CLI_LARGEST_MEGAPIXELS);
    common->max_pixels = (uint64_t)(number * 1e6 + 0.5);
    return CLI_SUCCESS;
}

static int take_white(cli_common *common, const char *text)
{
    if (!cli_parse_number(text, LEAST_WHITE, CLI_LARGEST_WHITE, &common->white))
        return cli_usage_error(common->command, "--white: '%s' is not a number in %g .. %g", text, LEAST_WHITE, CLI_LARGEST_WHITE);
    return CLI_SUCCESS;
}

int cli_common_take(void *target, int id, const char *text)
{
    cli_common *common = target;
    switch (id) {
    case BACKEND: return take_backend(common, text);
    case DEVICE: common->device = text; break;
    case THREADS: return take_threads(common, text);
    case SIMD: return take_simd(common, text);
    case MAX_MEGAPIXELS: return take_max_megapixels(common, text);
    case WHITE: return take_white(common, text);
    case TIME: common->time = 1; break;
    default: common->quiet = 1; break;
    }
    return CLI_SUCCESS;
}

/* An error of a call with an open context is left out here: whoever made the call prints asj_context_message(), which says the
 * same. */
static void print_log(void *user, int32_t level, const char *message)
{
    cli_session *session = user;
    if (level == ASJ_LOG_ERROR && session->context)
        return;
    cli_progress_clear(&session->progress);
    cli_error(level == ASJ_LOG_WARNING ? "warning: %s" : "%s", message);
    session->errors += level == ASJ_LOG_ERROR;
}

int cli_common_check(cli_common *common)
{
    if (common->device && common->backend == ASJ_BACKEND_CPU)
        return cli_usage_error(common->command, "--device is an OpenCL device, and --backend cpu excludes those");
    if (common->device)
        common->backend = ASJ_BACKEND_OPENCL;
    return CLI_SUCCESS;
}

static int32_t report_progress(void *user, int32_t stage, double done)
{
    cli_session *session = user;
    return cli_progress_report(&session->progress, stage, done);
}

int cli_session_open(cli_session *session, const cli_common *common, size_t image_count)
{
    asj_context_options options;
    memset(session, 0, sizeof *session);
    cli_progress_init(&session->progress, common->quiet, image_count);
    asj_context_options_init(&options);
    options.backend = common->backend;
    options.threads = common->threads;
    options.simd = common->simd;
    options.device = common->device;
    options.log = print_log;
    options.log_user = session;
    options.log_level = common->quiet ? ASJ_LOG_ERROR : ASJ_LOG_WARNING;
    options.progress = report_progress;
    options.progress_user = session;
    cli_kernel_cache_init(&session->cache, &options.kernel_cache);
    asj_status status = asj_context_create(&options, &session->context);
    if (status == ASJ_OK)
        return CLI_SUCCESS;
    if (session->errors == 0)
        cli_error("%s%s", common->backend == ASJ_BACKEND_OPENCL ? "--backend opencl: " : "", asj_status_string(status));
    return CLI_FAILED;
}

void cli_session_close(cli_session *session)
{
    cli_progress_clear(&session->progress);
    asj_context_free(&session->context);
}

int cli_session_fail(cli_session *session, const char *path, const char *message, asj_status status)
{
    cli_progress_clear(&session->progress);
    if (strcmp(path, "-") == 0) {
        if (status == ASJ_ERROR_FILE && cli_output_is_closed())
            return CLI_FAILED; /* as other programs do: there is nobody to tell */
        path = "standard output";
        message += strncmp(message, "-: ", 3) == 0 ? 3 : 0;
    }
    message = *message ? message : asj_status_string(status);
    cli_file_message(path, message, session->failure, sizeof session->failure);
    cli_file_error(path, message);
    return CLI_FAILED;
}
