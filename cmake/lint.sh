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

# By clang-tidy and, for comments, clang's -Wdocumentation.
cmake/lint.py "$build"
echo "Formatting and lint are clean"
