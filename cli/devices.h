/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_DEVICES_H
#define ASJ_CLI_DEVICES_H

#include "parse.h"

/* `asj-cli devices`: returns the exit code. */
int cli_devices(int argc, char **argv, const cli_other *other);

#endif
