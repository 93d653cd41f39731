#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# lint.sh BUILD [FILE...]: runs clang-tidy over the kits, plug-ins and examples, or over FILEs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. cmake/setup.sh

osgskin_install clang-tidy python3
build=$1
shift
[ $# -gt 0 ] || set -- '/(nodekits|osgPlugin|examples)/'
run-clang-tidy -quiet -p "$build" -j "$(nproc)" \
  -extra-arg=-Wno-unknown-warning-option -extra-arg=-Wno-unused-parameter \
  -extra-arg=-Wdocumentation -extra-arg=-Wreserved-identifier "$@" 2>&1 |
  { grep -v -E '^(clang-tidy|[0-9]+ warnings|Suppressed|Use -header-filter)|^$' || true; }
