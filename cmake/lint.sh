#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# cmake/lint.sh BUILD_FOLDER: formatting and lint of our own code; fails on the first complaint.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${1:?expected a build folder with compile_commands.json}

echo "clang-format"
git ls-files '*.cpp' '*.h' | xargs clang-format --dry-run -Werror
# Public headers have no extension, so clang-format must be told what they are.
git ls-files 'nodekits/*/include/*' | while read -r header; do
  clang-format --assume-filename=header.h <"$header" | cmp -s - "$header" ||
    { echo "$header is not formatted" >&2; exit 1; }
done

echo "clang-tidy"
# tests/downstream is no part of the build. GCC's own warning options mean nothing to clang, and
# OSG's wrapper macros leave parameters unused.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! git ls-files '*.cpp' ':!tests/downstream' |
  xargs -P "$(nproc)" -n 4 clang-tidy -p "$build" --quiet \
    --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-unused-parameter >"$log" 2>&1; then
  grep -v -E '^[0-9]+ warnings? (generated|treated)|^Suppressed|^Use -header-filter|^$' "$log" >&2
  exit 1
fi
echo "Formatting and lint are clean"
