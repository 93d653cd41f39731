#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# lint.sh BUILD [FILE...]: checks the formatting, compiles each public header alone, and runs
# clang-tidy on the kits and plug-ins, or on FILEs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${1:?expected a build folder with compile_commands.json}
shift
cmake/format.sh
cmake --build "$build" --target public_headers >/dev/null
cmake/lint.py "$build" "$@"
