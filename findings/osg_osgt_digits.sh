#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# OpenSceneGraph 3.6.5, .osgt: vertices are written with six significant digits, where a float needs up
# to nine. A vertex at 12345.678 comes back 2 cm away, one at 1000001 a metre away; .osgb keeps all
# bits. One expects that a scene format of the library gives back what it was given.
. "$(dirname "$0")/common.sh"
debian_package openscenegraph 3.6.5+dfsg1-8+b2
printf '%s\n' 'newmtl plain' 'Kd 1 1 1' >plain.mtl
printf '%s\n' 'mtllib plain.mtl' 'usemtl plain' 'v 12345.678 0.123456789 1000001' 'v 1 0 0' 'v 0 0 3' \
  'f 1 2 3' >a.obj
for format in osgb osgt; do
  osgconv -O noRotation a.obj a.$format >/dev/null 2>&1
  osgconv a.$format $format.obj >/dev/null 2>&1
  echo "$format: $(grep -m 1 '^v ' $format.obj)"
done >seen
expect <<'END'
osgb: v 12345.677734375 0.12345679104328156 1000001
osgt: v 12345.7001953125 0.12345699965953827 1000000
END
