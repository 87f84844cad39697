#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Completions of the command line for a shell, from the options that asj-cli itself lists:
# completions.sh bash|zsh|fish ASJ_CLI > FILE
set -eu
shell=$1 cli=$2
case $shell in bash | zsh | fish) ;; *)
    echo 'bash, zsh or fish?' >&2
    exit 2
    ;;
esac

# command, name, letter, argument, help; an argument is words (a|b), a file (FILE, DIR) or something that is not completed
for command in detect match; do
    "$cli" "$command" --list-options | awk -v command="$command" '{ print command "\t" $0 }'
done | awk -F '\t' -v shell="$shell" '
function words(argument) {
    gsub(/\|/, " ", argument)
    return argument
}
function kind(argument) {
    if (argument == "")
        return "none"
    if (argument ~ /\|/ || argument == "matching")
        return "words"
    return argument == "FILE" || argument == "DIR" ? "file" : "other"
}
function plain(text) { # no character that a shell would take for its own
    gsub(/\047/, "", text)
    gsub(/\[|\]|:|\\|`|\$|"/, " ", text)
    return text
}
{
    n[$1]++
    name[$1, n[$1]] = $2; letter[$1, n[$1]] = $3; argument[$1, n[$1]] = $4; help[$1, n[$1]] = plain($5)
}
function bash(    c, i, j, all, k) {
    print "# bash completion of asj-cli; made by scripts/completions.sh"
    print "_asj_cli()\n{"
    print "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} words="
    print "    COMPREPLY=()"
    print "    if [ \"$COMP_CWORD\" = 1 ]; then"
    print "        COMPREPLY=($(compgen -W \047detect match devices --help --version\047 -- \"$word\"))"
    print "        return\n    fi"
    print "    case \"$command $before\" in"
    for (c = 1; c <= 2; c++)
        for (i = 1; i <= n[commands[c]]; i++) {
            k = kind(argument[commands[c], i])
            if (k == "none")
                continue
            printf "    \"%s --%s\"", commands[c], name[commands[c], i]
            if (letter[commands[c], i] != "")
                printf " | \"%s -%s\"", commands[c], letter[commands[c], i]
            if (k == "words")
                printf ") COMPREPLY=($(compgen -W \047%s\047 -- \"$word\")) && return ;;\n", words(argument[commands[c], i])
            else
                print k == "file" ? ") COMPREPLY=($(compgen -f -- \"$word\")) && return ;;" : ") return ;;"
        }
    print "    esac"
    print "    case $command in"
    for (c = 1; c <= 2; c++) {
        all = "--help --advanced"
        for (i = 1; i <= n[commands[c]]; i++)
            all = all " --" name[commands[c], i]
        print "    " commands[c] ") words=\047" all "\047 ;;"
    }
    print "    *) words=--help ;;\n    esac"
    print "    case $word in\n    -*) COMPREPLY=($(compgen -W \"$words\" -- \"$word\")) ;;"
    print "    *) COMPREPLY=($(compgen -f -- \"$word\")) ;;\n    esac\n}"
    print "complete -o filenames -F _asj_cli asj-cli"
}
function zsh(    c, i, k, option, what) {
    print "#compdef asj-cli\n# zsh completion of asj-cli; made by scripts/completions.sh"
    print "_asj_cli()\n{"
    print "    if (( CURRENT == 2 )); then"
    print "        compadd detect match devices --help --version\n        return\n    fi"
    print "    local command=$words[2]\n    shift words\n    (( CURRENT-- ))\n    case $command in"
    for (c = 1; c <= 2; c++) {
        print "    " commands[c] ")\n        _arguments -s \\"
        print "            \047--help[show how to use this command]\047 \047--advanced[with --help, every option]\047 \\"
        for (i = 1; i <= n[commands[c]]; i++) {
            k = kind(argument[commands[c], i])
            what = k == "none" ? "" : k == "file" ? ":file:_files" : ":value:"
            if (k == "words")
                what = ":word:(" words(argument[commands[c], i]) ")"
            option = "[" help[commands[c], i] "]" what
            if (letter[commands[c], i] != "")
                print "            \047-" letter[commands[c], i] option "\047 \\"
            print "            \047--" name[commands[c], i] option "\047 \\"
        }
        print "            \047*:image:_files\047\n        ;;"
    }
    print "    esac\n}\n_asj_cli \"$@\""
}
function fish(    c, i, k, line) {
    print "# fish completion of asj-cli; made by scripts/completions.sh"
    print "complete -c asj-cli -n __fish_use_subcommand -x -a \047detect match devices\047"
    for (c = 1; c <= 2; c++)
        for (i = 1; i <= n[commands[c]]; i++) {
            k = kind(argument[commands[c], i])
            line = "complete -c asj-cli -n \047__fish_seen_subcommand_from " commands[c] "\047 -l " name[commands[c], i]
            if (letter[commands[c], i] != "")
                line = line " -s " letter[commands[c], i]
            if (k == "words")
                line = line " -x -a \047" words(argument[commands[c], i]) "\047"
            else
                line = line (k == "file" ? " -r -F" : k == "other" ? " -x" : "")
            print line " -d \047" help[commands[c], i] "\047"
        }
}
END {
    commands[1] = "detect"; commands[2] = "match"
    if (n["detect"] < 10 || n["match"] < 10)
        exit 1
    if (shell == "bash") bash(); else if (shell == "zsh") zsh(); else fish()
}'
