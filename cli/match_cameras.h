/* SPDX-License-Identifier: BSD-2-Clause */
/* Which cameras the geometry of a match is told: the command line's, or those of the EXIF data. */
#ifndef ASJ_CLI_MATCH_CAMERAS_H
#define ASJ_CLI_MATCH_CAMERAS_H

#include "match_arguments.h"
#include "match_input.h"

/* Fills the model and the cameras; says what came from EXIF data. CLI_SUCCESS, CLI_USAGE after saying what is
 * missing, or CLI_FAILED after saying which camera cannot be that of its image. */
int cli_match_cameras(const cli_match_arguments *arguments, const cli_match_input inputs[2], asj_geometry_options *options);

#endif
