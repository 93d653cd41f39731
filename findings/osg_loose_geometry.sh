#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# OpenSceneGraph 3.6.5: since 3.4 a geometry is a node, and need not be in an osg::Geode. The writers of .stl,
# .3ds, .dxf and .ive drop geometries that are directly below a group; osgconv says "Data written", and no
# warning. The first number counts geometries that come back from a geode, the second those from a group.
. "$(dirname "$0")/common.sh"
debian_package openscenegraph 3.6.5+dfsg1-8+b2
geometry() {
  printf '%s\n' 'osg::Geometry {' 'UniqueID 3' 'PrimitiveSetList 1 {' 'osg::DrawArrays {' 'UniqueID 4' \
    'Mode TRIANGLES' 'First 0' 'Count 3' '}' '}' 'VertexArray TRUE {' 'osg::Vec3Array {' 'UniqueID 5' \
    'Binding BIND_PER_VERTEX' 'vector 3 {' '0 0 0' '1 0 0' '0 0 1' '}' '}' '}' '}'
}
scene() { # its lines above and below the geometry
  printf '%s\n' '#Ascii Scene' '#Version 161' '#Generator OpenSceneGraph 3.6.5' '' 'osg::Group {' 'UniqueID 1' \
    'Children 1 {' "$1"
  geometry
  printf '%s\n' "$2" '}' '}'
}
scene $'osg::Geode {\nUniqueID 2\nDrawables 1 {' $'}\n}' >geode.osgt
scene '' '' >group.osgt
for format in osgb obj stl 3ds dxf ive; do
  found=
  for from in geode group; do
    osgconv $from.osgt $from.$format >log 2>&1
    cat log >>logs
    osgconv $from.$format $from.$format.osgt >/dev/null 2>&1 || true
    found+=" $(cat $from.$format.osgt 2>/dev/null | grep -c VertexArray || true)"
  done
  echo "$format:$found"
done >seen
echo "warnings: $(grep -ci warn logs || true)" >>seen
expect <<'END'
osgb: 1 1
obj: 1 1
stl: 1 0
3ds: 1 0
dxf: 1 0
ive: 1 0
warnings: 0
END
