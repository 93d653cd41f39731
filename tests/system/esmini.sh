#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# esmini.sh SOURCES BUILD FOLDER: does what examples/simulators/esmini.md says with the checkout that
# OSGSKIN_ESMINI names, and once more beside a load, which must give the same pictures. Needs a display.
set -euo pipefail
[ -n "${OSGSKIN_ESMINI:-}" ] ||
  { echo "skipped: OSGSKIN_ESMINI does not name a checkout of esmini"; exit 77; }
# The FBX file of the test of the page before.
OSG_LIBRARY_PATH=$2/lib "$2/bin/system_test" --gtest_filter='WalkerFromFbx.*'
fbx=$(find "$2/tests/system/output" -path '*WalkerFromFbx*' -name walker.fbx)
python3 "$1/tests/system/tutorial.py" "$1/examples/simulators/esmini.md" "$1" "$2" "$3" "$fbx"
run=$3/home/esmini-run walker=$3/clone/walkman.osgb
cp "$run/three_pedestrians.sha256" "$3/first.sha256"
[ "$(cut -d ' ' -f 1 "$3/first.sha256" | sort -u | wc -l)" -gt 50 ] ||
  { echo "the pictures do not change: nobody walks"; exit 1; }
(while :; do :; done) & load=$!
trap 'kill $load' EXIT
OSG_LIBRARY_PATH=$2/lib "$1/examples/simulators/run_esmini.sh" "$OSGSKIN_ESMINI" "$walker" "$run"
cmp "$run/three_pedestrians.sha256" "$3/first.sha256"
