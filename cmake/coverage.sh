#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# coverage.sh [TEST PROGRAM...]: measures which lines of the kits and plug-ins the tests reach, with
# gcovr. Prints a table and writes build/coverage/report/index.html. Runs all tests, or only the
# given programs (bindTests importTests ...).
set -euo pipefail
osgskin_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$osgskin_root"
. cmake/setup.sh

osgskin_install $osgskin_build_packages $osgskin_test_packages gcovr
build=build/coverage
failed=false
cmake --preset coverage >build-coverage.log
rm build-coverage.log
# Counts of an earlier run would be added.
find "$build" -name '*.gcda' -delete
if [ $# -gt 0 ]; then
  cmake --build --preset coverage --target "$@"
  for program in "$@"; do
    OSG_LIBRARY_PATH="$build/lib" "$build/bin/$program" --gtest_brief=1
  done
else
  osgskin_install $osgskin_show_packages
  osgskin_build coverage all tests/all
  ctest --test-dir "$build" --output-on-failure -j "$(nproc)" || failed=true # the table is still useful
fi

mkdir -p "$build/report"
gcovr --root . --filter nodekits/ --filter osgPlugin/ --object-directory "$build" --sort-uncovered \
  --exclude-unreachable-branches --print-summary --html-details "$build/report/index.html"
echo "Line by line: $build/report/index.html"
! $failed
