#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Names of the functions that public headers declare, one a line, sorted.  functions.sh HEADER...
cat "$@" | tr '\n' ' ' | grep -o 'ASJ_API [^(;#"]*[ *]asj_[a-z0-9_]*(' | sed 's/($//; s/.*[ *]//' | sort -u
