#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Completions name every option, in files that the shells take, and bash completes by them: completions.sh ASJ_CLI ROOT
set -u
cli=$1 script=$2/scripts/completions.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for shell in bash zsh fish; do
    sh "$script" $shell "$cli" > "$work/$shell" || exit 1
    for command in detect match; do
        "$cli" $command --list-options | cut -f 1 > "$work/names"
        [ "$(wc -l < "$work/names")" -gt 30 ] || { echo "$command has hardly any options"; exit 1; }
        while IFS= read -r name; do
            grep -qE -e "(--|-l )$name([^a-z-]|\$)" "$work/$shell" || { echo "$shell: no --$name"; exit 1; }
        done < "$work/names"
    done
    ! command -v $shell > /dev/null || $shell -n "$work/$shell" || exit 1
done
command -v bash > /dev/null || { echo 'SKIPPED: no bash'; exit 77; }

completes() { # EXPECTED WORD...: what bash offers for the last word
    expected=$1
    shift
    found=$(bash -c '. "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _asj_cli; echo ${COMPREPLY[*]}' "$work/bash" "$@")
    [ "$found" = "$expected" ] || { echo "$* <tab>: '$found' instead of '$expected'"; exit 1; }
}
cd "$work" && : > photo.png
completes detect asj-cli det
completes "json jsonl" asj-cli detect -f j
completes "json jsonl" asj-cli detect --format j
completes "--plot --plot-color --plot-background --plot-scale" asj-cli detect --plot
completes --guided-rounds asj-cli match --guided
completes "line_fit search" asj-cli detect --refinement ""
completes photo.png asj-cli detect -q ph
completes photo.png asj-cli detect -o ph
completes "" asj-cli detect --epsilon p
