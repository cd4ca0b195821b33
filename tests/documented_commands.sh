#!/usr/bin/env bash
# Checks every `./run.sh ...` and `loopbench ...` command of the pages and configs against the program: the
# subcommand and all its options exist, and so do the configs it names.
# Usage: documented_commands.sh LOOPBENCH ROOT
set -euo pipefail
loopbench=$1 root=$2
cd "$root"
failures=0 checked=0
declare -A help_of
fail() { printf '%s: %s\n' "$1" "$2"; failures=$((failures + 1)); }

while IFS= read -r hit; do
  where=${hit%%:\#*} line=${hit#*:\#}
  line=${line%%'`'*}                     # the end of inline code
  line=${line%%  \#*}                    # a comment after the command
  line=${line%% | *}
  line=${line%% -->}                     # the end of a comment of documented_outputs.sh
  read -ra words <<<"${line//[\'\"]/}"    # quotes do not matter here: only words are compared
  command=${words[0]:-}
  [[ $command =~ ^[a-z]+$ ]] || continue # './run.sh' alone, or options only
  [[ $command != benchmark ]] || continue # of run.sh itself
  [[ $command != traj || ! ${words[1]:-} =~ ^[a-z]+$ ]] || command="traj ${words[1]}"
  checked=$((checked + 1))
  read -ra verbs <<<"$command"
  [[ -v help_of[$command] ]] || help_of[$command]=$("$loopbench" "${verbs[@]}" --help 2>&1) ||
    { fail "$where" "no command is named '$command'"; help_of[$command]=''; continue; }
  [[ ${help_of[$command]} != *--help-all* ]] || help_of[$command]=$("$loopbench" "${verbs[@]}" --help-all)
  for word in "${words[@]:1}"; do
    case $word in
      --*) option=${word%%=*}
        grep -qE -- "(^|[ ,])$option([ ,:]|\$)" <<<"${help_of[$command]}" ||
          fail "$where" "'$command' has no option $option" ;;
      configs/*NAME*) ;;  # a placeholder
      configs/*.yaml | results/*/configs/*.yaml)
        compgen -G "$word" >/dev/null || fail "$where" "no file matches $word" ;;
    esac
  done
done < <(grep -rnoE --include='*.md' --include='*.yaml' --exclude-dir=build --exclude=CHANGELOG.md \
  '(\./run\.sh|^ *loopbench|`loopbench) [a-z].*' . | sed -E 's/^([^:]*:[0-9]+):(.*(run\.sh|loopbench)) /\1:#/')

printf '%d commands checked, %d wrong\n' "$checked" "$failures"
((failures == 0 && checked > 50))
