#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# A C program that takes the address of every function that public headers declare: it links only if all of them are there.
# addresses.sh INCLUDED HEADER... > FILE.c      (INCLUDED: "asj/asj.h" or "asj/io.h")
here=$(dirname "$0")
included=$1
shift
echo "#include <$included>"
echo '#include <stdio.h>'
echo 'typedef void function(void);'
echo 'int main(void)'
echo '{'
echo '    int found = 0;'
sh "$here/functions.sh" "$@" | while read -r name; do
    echo "    { function *volatile p = (function *)$name; found += p != 0; }"
done
printf '%s\n' '    printf("%d functions\n", found);'
echo "    return found == $(sh "$here/functions.sh" "$@" | wc -l) && found > 5 ? 0 : 1;"
echo '}'
