#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# cmake/format.sh [--fix]: lists our own sources that are not formatted, and fails if there are any;
# with --fix, formats them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [ "${1-}" = --fix ]; then
  git ls-files '*.cpp' '*.h' | xargs clang-format -i
else
  git ls-files '*.cpp' '*.h' | xargs clang-format --dry-run -Werror
fi
# Public headers have no extension, so clang-format needs a file name to detect the language.
wrong=0
while read -r header; do
  formatted=$(clang-format --assume-filename=header.h <"$header")
  [ "$formatted" != "$(cat "$header")" ] || continue
  if [ "${1-}" = --fix ]; then
    echo "$formatted" >"$header"
  else
    echo "$header is not formatted" >&2
    wrong=1
  fi
done < <(git ls-files 'nodekits/*/include/*')
exit "$wrong"
