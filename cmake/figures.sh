#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# figures.sh [SECONDS]: renews the figures of the READMEs and of speed.md. Each command of a README that measures is
# run for at most SECONDS (60); its figures there are printed as "old", its output as "new". Commands
# that need more time, a file of yours or a display are listed, and so are sections with a table of
# figures but no command. Times are to be compared as ratios. Needs build/release with all targets.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
limit=${1:-60}
export OSG_LIBRARY_PATH=$PWD/build/release/lib
# What commands write lands in a folder of its own.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ln -s "$PWD"/{build,cmake,data,examples,nodekits,tests} "$work"
programs='osgskin_[a-z_]*|[a-z]*Tests|osgskintwist --report|osgskincrowd --time'

# Prints the sections of a README as lines "SECTION<tab>LINE".
sections() { awk '/^#/ { title = $0 } { print title "\t" $0 }' "$1"; }

while read -r readme; do
  sections "$readme" | grep -E $'\t    (build/release/bin/)?('"$programs"')' |
    while IFS=$'\t' read -r section command; do
      command=$(sed 's/^ *//; s/ *#.*//; s|^build/release/bin/||' <<<"$command")
      echo "== $readme, $section: $command"
      if grep -qE '[A-Z]{4}|\[|\.obj' <<<"$command"; then
        echo "left out: needs arguments of yours"
        continue
      fi
      echo "old:"
      sections "$readme" | grep -F "$section"$'\t' | cut -f2- | grep -E '[0-9]' | grep -vE '^    |^#' || true
      echo "new:"
      output=$(mktemp)
      # shellcheck disable=SC2086 # a command and its words
      (cd "$work" && eval "timeout $limit build/release/bin/$command") >"$output" 2>&1 </dev/null
      case $? in
        124) echo "left out: takes more than $limit s" ;;
        127) echo "left out: not built" ;;
        *) grep -E '[0-9]' "$output" | grep -vE '^\[ *(RUN|OK)|^(Running|Note:|Load|CPU| *L[123])' ;;
      esac
      rm "$output"
    done
done < <(git ls-files '*README.md' nodekits/speed.md)

echo "== sections with a table of figures and no command"
while read -r readme; do
  sections "$readme" | awk -F '\t' -v file="$readme" '
    $2 ~ /^\|.*[0-9]\.[0-9].*[|].*[0-9]\.[0-9]/ || $2 ~ /^\|.*[0-9] (us|ms|%).*\|.*[0-9] (us|ms|%)/ { table[$1] = 1 }
    $2 ~ /^    [^ ]/ || $2 ~ /`[^`]*(osgskin[a-z_]*|Tests|--benchmark|ctest)[^`]*`/ { command[$1] = 1 }
    END { for (s in table) if (!(s in command)) print file ", " s }'
done < <(git ls-files '*README.md' nodekits/speed.md)
