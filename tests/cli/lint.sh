#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Manual pages without a complaint: lint.sh PAGE... Pages refer to each other and need not be installed for that.
set -u
mandoc -T lint -W warning "$@" || exit 1
mandoc -T lint -W style "$@" | grep -v 'referenced manual not found: Xr asj-' && exit 1
exit 0
