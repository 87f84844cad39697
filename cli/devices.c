/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli devices: the list of OpenCL devices as a table. */
#include "devices.h"
#include "message.h"

#include <asj/device.h>

#include <stdio.h>
#include <string.h>

static const char help[] =
    "Usage: asj-cli devices\n"
    "\n"
    "Lists the OpenCL devices, what can be used and why the rest cannot, and where --backend auto and\n"
    "--backend opencl would compute. The results are the same everywhere.\n"
    "\n"
    "--device takes the number of a device, gpu, cpu or accelerator, or a part of a name.\n";

static void print_device(uint32_t index, const asj_device *device)
{
    if (!*device->name) {
        printf("%2u  no device of the platform %s: %s\n", (unsigned)index, device->platform, device->reason);
        return;
    }
    printf("%2u  %s (%s)\n", (unsigned)index, device->name, asj_device_type_name(device->type));
    printf("    platform: %s, %s, driver %s\n", device->platform, device->version, device->driver);
    printf("    %d compute units, %.1f GB, %.0f kB for a work-group\n", (int)device->compute_units,
           (double)device->global_memory * 1e-9, (double)device->local_memory * 1e-3);
    if (device->usable)
        printf("    can be used\n");
    else
        printf("    cannot be used: %s\n", device->reason);
}

/* Makes a context to see what the library decides. */
static void print_choice(const char *name, int32_t backend)
{
    asj_context_options options;
    asj_context *context = NULL;
    asj_context_options_init(&options);
    options.backend = backend;
    const asj_status status = asj_context_create(&options, &context);
    printf("--backend %-7s", name);
    if (status != ASJ_OK)
        printf("nothing: %s\n", asj_status_string(status));
    else if (asj_context_backend(context) == ASJ_BACKEND_OPENCL)
        printf("%s\n", asj_context_device(context));
    else
        printf("the CPU without OpenCL, %d thread%s, %s\n", (int)asj_context_threads(context),
               asj_context_threads(context) == 1 ? "" : "s", asj_simd_name(asj_context_simd(context)));
    asj_context_free(&context);
}

static int print_list(void)
{
    asj_device_list *list = NULL;
    const asj_status status = asj_device_list_create(NULL, &list);
    if (status != ASJ_OK) {
        cli_error("%s", asj_status_string(status));
        return CLI_FAILED;
    }
    for (uint32_t i = 0; i < list->count; i++)
        print_device(i, &list->devices[i]);
    if (list->count == 0)
        printf("no OpenCL devices: %s\n", list->message);
    printf("\n");
    print_choice("auto", ASJ_BACKEND_AUTO);
    print_choice("cpu", ASJ_BACKEND_CPU);
    print_choice("opencl", ASJ_BACKEND_OPENCL);
    asj_device_list_free(&list);
    return CLI_SUCCESS;
}

int cli_devices(int argc, char **argv, const cli_other *other)
{
    (void)other;
    if (argc == 1)
        return print_list();
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        fputs(help, stdout);
        return CLI_SUCCESS;
    }
    return cli_usage_error("devices", "it takes no '%s'", argv[1]);
}
