/* SPDX-License-Identifier: BSD-2-Clause */
/* FX,FY,CX,CY: a pin-hole camera in px. */
#include "camera.h"
#include "common.h"
#include "message.h"
#include "parse.h"

#include <string.h>

int cli_take_camera(const char *command, const char *name, const char *text, asj_camera *camera)
{
    char copy[256], *at = copy;
    double values[4];
    if (strlen(text) < sizeof copy) {
        int count = 0;
        strcpy(copy, text);
        while (at && count < 4) {
            char *comma = strchr(at, ',');
            if (comma)
                *comma = 0;
            if (!cli_parse_number(at, count < 2 ? 1 : -CLI_LONGEST_FOCAL, CLI_LONGEST_FOCAL, &values[count]))
                break;
            count++;
            at = comma ? comma + 1 : NULL;
        }
        if (count == 4 && !at) {
            *camera = (asj_camera){values[0], values[1], values[2], values[3]};
            return CLI_SUCCESS;
        }
    }
    return cli_usage_error(command, "--%s: '%s' is not FX,FY,CX,CY in px, with focal lengths of 1 to %g", name, text,
                           (double)CLI_LONGEST_FOCAL);
}
