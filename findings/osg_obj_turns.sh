#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# OpenSceneGraph 3.6.5, osgconv from OBJ to OBJ: the reader turns files by 90 degrees about X (Y up to
# Z up), the writer does not turn them back. Each conversion turns the model once more; four make it
# whole. One expects a file with the same coordinates. The reader's option "noRotation" prevents it.
. "$(dirname "$0")/common.sh"
debian_package openscenegraph 3.6.5+dfsg1-8+b2
printf '%s\n' 'newmtl plain' 'Kd 1 1 1' >plain.mtl
printf '%s\n' 'mtllib plain.mtl' 'usemtl plain' 'v 0 1 2' 'v 1 0 0' 'v 0 0 3' 'f 1 2 3' >a.obj
osgconv a.obj once.obj >/dev/null 2>&1
osgconv once.obj twice.obj >/dev/null 2>&1
osgconv -O noRotation a.obj kept.obj >/dev/null 2>&1
for name in a once twice kept; do echo "$name: $(grep -m 1 '^v ' $name.obj)"; done >seen
expect <<'END'
a: v 0 1 2
once: v 0 -2 1
twice: v 0 -1 -2
kept: v 0 1 2
END
