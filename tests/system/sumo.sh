#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# sumo.sh SOURCES BUILD FOLDER: does what examples/simulators/sumo.md says, and looks for figures
# before the sky of the pictures, and for complaints about them.
set -euo pipefail
for program in sumo-gui import convert; do
  command -v $program >/dev/null ||
    { echo "skipped: no $program, expected Debian's packages sumo and imagemagick"; exit 77; }
done
python3 "$1/tests/system/tutorial.py" "$1/examples/simulators/sumo.md" "$1" "$2" "$3"
cd "$3/home/sumo-run"
if grep -E 'osgSkin|\.osgb' sumo.log; then exit 1; fi
for i in 4 7 9; do # above the street there is sky, and who stands there
  share=$(convert $i.png -crop 1100x300+120+280 -fill white -opaque '#333366' -fill black \
    +opaque white -format '%[fx:1-mean]' info:)
  awk -v share="$share" 'BEGIN { exit !(share > 0.01 && share < 0.3) }' ||
    { echo "$i.png: $share of the sky is hidden, expected figures before it"; exit 1; }
done
