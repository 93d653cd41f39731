#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# cmake/lint.sh BUILD_FOLDER: formatting and lint of our own code; fails on the first complaint.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${1:?expected a build folder with compile_commands.json}

cmake/format.sh
# By clang-tidy and, for comments, clang's -Wdocumentation.
cmake/lint.py "$build"
echo "Formatting and lint are clean"
