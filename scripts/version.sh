#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Prints MAJOR.MINOR.PATCH from include/asj/version.h, the only place where the version stands.
set -eu
header="$(dirname "$0")/../include/asj/version.h"
sed -n 's/^#define ASJ_VERSION_[MP][A-Z]* \([0-9][0-9]*\)$/\1/p' "$header" | paste -sd. -
