#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# coverage.sh [TEST PROGRAM...]: which lines of the kits and plug-ins the tests reach, by gcovr: a table, and
# build/coverage/report/index.html. All tests, or only these programs (bindTests importTests ...).
set -euo pipefail
osgskin_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$osgskin_root"
. cmake/setup.sh

osgskin_install $osgskin_build_packages $osgskin_test_packages gcovr
build=build/coverage
failed=false
cmake --preset coverage >build-coverage.log
rm build-coverage.log
# Counts of an earlier run would add up.
find "$build" -name '*.gcda' -delete
if [ $# -gt 0 ]; then
  cmake --build --preset coverage --target "$@"
  for program in "$@"; do
    OSG_LIBRARY_PATH="$build/lib" "$build/bin/$program" --gtest_brief=1
  done
else
  osgskin_install $osgskin_show_packages
  osgskin_build coverage
  ctest --test-dir "$build" --output-on-failure -j "$(nproc)" || failed=true # the table is of use anyway
fi

mkdir -p "$build/report"
gcovr --root . --filter nodekits/ --filter osgPlugin/ --object-directory "$build" --sort-uncovered \
  --exclude-unreachable-branches --print-summary --html-details "$build/report/index.html"
echo "Line by line: $build/report/index.html"
! $failed
