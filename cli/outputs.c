/* SPDX-License-Identifier: BSD-2-Clause */
/* Names of result files, and which of them would collide. */
#include "outputs.h"
#include "message.h"
#include "platform.h"

#include <asj/io.h>

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void cli_outputs_free(cli_outputs *outputs)
{
    for (size_t i = 0; i < outputs->count; i++) {
        free(outputs->of[i].junctions);
        free(outputs->of[i].plot);
    }
    free(outputs->of);
    free(outputs->of_all);
    outputs->of = NULL;
    outputs->of_all = NULL;
    outputs->count = 0;
}

static char *copy(const char *text)
{
    size_t size = strlen(text) + 1;
    char *result = malloc(size);
    return result ? memcpy(result, text, size) : NULL;
}

/* The next folder of a path up to `end`, but for the root, . and .. ; NULL = there is none left. *at goes on behind it. */
static const char *next_folder(const char **at, const char *end, size_t *size)
{
    while (*at < end) {
        const char *name = *at;
        while (*at < end && !cli_is_separator(**at))
            ++*at;
        *size = (size_t)(*at - name);
        if (*at < end)
            ++*at;
        if (*size > 0 && !(*size == 1 && name[0] == '.') && !(*size == 2 && name[0] == '.' && name[1] == '.'))
            return name;
    }
    return NULL;
}

/* Appends the folders of a path, which ends with a separator. */
static size_t append_folders(char *to, const char *path, size_t length)
{
    size_t n = 0, size;
    for (const char *at = path, *name; (name = next_folder(&at, path + length, &size)) != NULL; n += size + 1) {
        memcpy(to + n, name, size);
        to[n + size] = '/';
    }
    return n;
}

/* Whether results of these two images would lie in the same folder. */
static int same_folders(const char *one, const char *other)
{
    const char *ends[2] = {cli_base_name(one), cli_base_name(other)}, *a, *b;
    size_t size_a = 0, size_b = 0;
    do {
        a = next_folder(&one, ends[0], &size_a);
        b = next_folder(&other, ends[1], &size_b);
    } while (a && b && size_a == size_b && memcmp(a, b, size_a) == 0);
    return !a && !b;
}

/* DIR, with keep_folders the folders of the image, its name without last extension, "." and an extension. */
static char *name_in(const cli_detect_arguments *arguments, const char *image, const char *extension)
{
    size_t end = strlen(image);
    while (end > 0 && cli_is_separator(image[end - 1]))
        end--;
    size_t start = end;
    while (start > 0 && !cli_is_separator(image[start - 1]))
        start--;
    size_t dot = end;
    while (dot > start && image[dot - 1] != '.')
        dot--;
    size_t length = dot > start + 1 ? dot - 1 - start : end - start;
    size_t n = strlen(arguments->out_dir), size = n + 1 + end + 1 + strlen(extension) + 1;
    char *path = malloc(size);
    if (!path)
        return NULL;
    memcpy(path, arguments->out_dir, n);
    path[n++] = '/';
    if (arguments->keep_folders)
        n += append_folders(path + n, image, start);
    snprintf(path + n, size - n, "%.*s.%s", (int)length, image + start, extension);
    return path;
}

/* 0 = no memory */
static int name_outputs(const cli_detect_arguments *arguments, cli_outputs *outputs)
{
    static const char *const plot_extensions[] = {"plot.png", "plot.svg", "plot.pdf"};
    const int of_all = cli_detect_file_format(arguments) == CLI_FILE_JSON_LINES;
    if (of_all && !(outputs->of_all = copy(arguments->output ? arguments->output : "-")))
        return 0;
    for (size_t i = 0; i < outputs->count; i++) {
        cli_output *output = &outputs->of[i];
        if (arguments->out_dir) {
            const char *image = arguments->images.names[i];
            output->junctions = name_in(arguments, image, cli_detect_extension(arguments));
            if (arguments->plot)
                output->plot = name_in(arguments, image, plot_extensions[arguments->plot_format]);
        } else {
            if (!of_all && (arguments->output || !arguments->plot))
                output->junctions = copy(arguments->output ? arguments->output : "-");
            if (arguments->plot)
                output->plot = copy(arguments->plot);
        }
        if ((!output->junctions && !of_all && (arguments->out_dir || arguments->output)) || (!output->plot && arguments->plot))
            return 0;
    }
    return 1;
}

static int compare_planned(const void *a, const void *b)
{
    return strcmp(((const cli_planned *)a)->target, ((const cli_planned *)b)->target);
}

/* What each output will be, so that two spellings of one file are seen to be the same. 0 = no memory */
static int find_targets(cli_planned *outputs, size_t count)
{
    enum { LONGEST = 8192 };
    char *target = malloc(LONGEST);
    int good = target != NULL;
    for (size_t i = 0; i < count && good; i++) {
        int found = asj_output_target(outputs[i].path, target, LONGEST) == ASJ_OK; /* else it cannot be written anyway */
        outputs[i].target = copy(found ? target : outputs[i].path);
        good = outputs[i].target != NULL;
    }
    free(target);
    return good;
}

static int compare_identity(const void *a, const void *b)
{
    const cli_identity *p = a, *q = b;
    if (p->device != q->device)
        return p->device < q->device ? -1 : 1;
    return p->number == q->number ? 0 : p->number < q->number ? -1 : 1;
}

static size_t list_planned(const cli_detect_arguments *arguments, const cli_outputs *outputs, cli_planned *list)
{
    size_t n = 0;
    if (outputs->of_all && strcmp(outputs->of_all, "-") != 0)
        list[n++] = (cli_planned){outputs->of_all, "all images", NULL}; /* beside which only one image has a plot */
    for (size_t i = 0; i < outputs->count; i++) {
        if (outputs->of[i].junctions && strcmp(outputs->of[i].junctions, "-") != 0)
            list[n++] = (cli_planned){outputs->of[i].junctions, arguments->images.names[i], NULL};
        if (outputs->of[i].plot)
            list[n++] = (cli_planned){outputs->of[i].plot, arguments->images.names[i], NULL};
    }
    return n;
}

static size_t identify(const char *const *paths, size_t count, cli_identity *list)
{
    size_t n = 0;
    for (size_t i = 0; i < count; i++)
        n += (size_t)cli_identify(paths[i], &list[n]);
    qsort(list, n, sizeof *list, compare_identity);
    return n;
}

static int check_against(const char *command, const char *hint, const cli_planned *outputs, size_t output_count,
                         const cli_identity *inputs, size_t input_count)
{
    cli_identity existing;
    for (size_t i = 1; i < output_count; i++)
        if (strcmp(outputs[i - 1].target, outputs[i].target) == 0)
            return cli_usage_error(command, "%s: would be written twice, for %s and for %s%s", outputs[i].path,
                                   outputs[i - 1].purpose, outputs[i].purpose,
                                   same_folders(outputs[i - 1].purpose, outputs[i].purpose) ? "" : hint);
    for (size_t i = 0; i < output_count; i++)
        if (input_count > 0 && cli_identify(outputs[i].path, &existing) &&
            bsearch(&existing, inputs, input_count, sizeof *inputs, compare_identity))
            return cli_usage_error(command, "%s: is an input file, and would be overwritten", outputs[i].path);
    return CLI_SUCCESS;
}

/* Whether the folder that a file is to lie in is there, and the file is none. */
static int check_folder(const char *path)
{
    if (*path == '\0') {
        cli_error("cannot create a file without a name");
        return CLI_FAILED;
    }
    const size_t length = (size_t)(cli_base_name(path) - path);
    char *folder = length > 0 ? copy(path) : NULL;
    if (length > 0 && !folder) {
        cli_error("out of memory");
        return CLI_FAILED;
    }
    if (folder)
        folder[length] = '\0';
    const int error = folder && !cli_is_folder(folder) ? ENOENT : cli_is_folder(path) ? EISDIR : 0;
    if (error)
        cli_error("%s: cannot create: %s", path, strerror(error));
    free(folder);
    return error ? CLI_FAILED : CLI_SUCCESS;
}

int cli_check_folders(const cli_planned *outputs, size_t output_count)
{
    int result = CLI_SUCCESS;
    for (size_t i = 0; i < output_count; i++)
        if (check_folder(outputs[i].path) != CLI_SUCCESS)
            result = CLI_FAILED;
    return result;
}

int cli_check_collisions(const char *command, const char *hint, cli_planned *outputs, size_t output_count,
                         const char *const *inputs, size_t input_count)
{
    cli_identity *list = calloc(input_count + 1, sizeof *list);
    int result = CLI_FAILED;
    if (!list || !find_targets(outputs, output_count)) {
        cli_error("out of memory");
    } else {
        if (output_count > 1)
            qsort(outputs, output_count, sizeof *outputs, compare_planned);
        result = check_against(command, hint, outputs, output_count, list, identify(inputs, input_count, list));
    }
    for (size_t i = 0; i < output_count; i++)
        free(outputs[i].target);
    free(list);
    return result;
}

/* Makes the folder, and those above it, where they are missing. */
static int make_folder(const char *path)
{
    char *part = copy(path);
    if (!part) {
        cli_error("out of memory");
        return CLI_FAILED;
    }
    errno = 0;
    for (char *end = part; *end; end++) {
        const char separator = *end;
        if (cli_is_separator(separator) && end > part) {
            *end = '\0';
            cli_make_one_folder(part);
            *end = separator;
        }
    }
    const int made = cli_make_one_folder(part) == 0 || errno == EEXIST, error = errno;
    free(part);
    if (cli_is_folder(path))
        return CLI_SUCCESS;
    cli_file_error(path, made ? "not a folder" : strerror(error));
    return CLI_FAILED;
}

/* The folders that results of `detect` lie in. */
static int make_folders(const cli_detect_arguments *arguments, const cli_planned *outputs, size_t count)
{
    int result = make_folder(arguments->out_dir);
    for (size_t i = 0; i < count && result == CLI_SUCCESS && arguments->keep_folders; i++) {
        char *folder = copy(outputs[i].path);
        if (!folder) {
            cli_error("out of memory");
            return CLI_FAILED;
        }
        folder[cli_base_name(folder) - folder - 1] = '\0';
        if (!cli_is_folder(folder))
            result = make_folder(folder);
        free(folder);
    }
    return result;
}

/* Every file that is read: a list of images is one, and a result in its place would end later runs. */
static size_t list_inputs(const cli_detect_arguments *arguments, const char **inputs)
{
    size_t n = arguments->images.count;
    memcpy(inputs, arguments->images.names, n * sizeof *inputs);
    if (arguments->region.mask)
        inputs[n++] = arguments->region.mask;
    if (arguments->files_from && strcmp(arguments->files_from, "-") != 0)
        inputs[n++] = arguments->files_from;
    return n;
}

int cli_outputs_plan(const cli_detect_arguments *arguments, cli_outputs *outputs)
{
    int result = CLI_FAILED;
    outputs->count = 0;
    outputs->of = calloc(arguments->images.count, sizeof *outputs->of);
    cli_planned *list = calloc(2 * arguments->images.count, sizeof *list);
    const char **inputs = calloc(arguments->images.count + 2, sizeof *inputs);
    const size_t input_count = inputs ? list_inputs(arguments, inputs) : 0;
    if (outputs->of)
        outputs->count = arguments->images.count;
    if (!outputs->of || !list || !inputs || !name_outputs(arguments, outputs)) {
        cli_error("out of memory");
    } else {
        const size_t planned = list_planned(arguments, outputs, list);
        const char *hint = arguments->out_dir && !arguments->keep_folders ? " (--keep-folders tells folders apart)" : "";
        result = cli_check_collisions("detect", hint, list, planned, inputs, input_count);
        if (result == CLI_SUCCESS)
            result = arguments->out_dir ? make_folders(arguments, list, planned) : cli_check_folders(list, planned);
    }
    free(inputs);
    free(list);
    return result;
}
