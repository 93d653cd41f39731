#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# lint.sh BUILD [FILE...]: formatting, and clang-tidy over the kits, plug-ins and examples, or over FILEs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${1:?expected a build folder with compile_commands.json}
shift
cmake/format.sh
cmake/lint.py "$build" "$@"
