#!/bin/sh
# Prints MAJOR.MINOR.PATCH from include/asj/version.h, the only place where the version stands.
set -eu
header="$(dirname "$0")/../include/asj/version.h"
sed -n 's/^#define ASJ_VERSION_\(MAJOR\|MINOR\|PATCH\) \([0-9][0-9]*\)$/\2/p' "$header" | paste -sd. -
