#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# OpenSceneGraph 3.6.5, .ply: texture coordinates called "s" and "t", as Blender writes them, are
# dropped without a word, normals are kept. One expects an array of texture coordinates, as for the OBJ
# file of the second column.
. "$(dirname "$0")/common.sh"
debian_package openscenegraph 3.6.5+dfsg1-8+b2
{
  printf '%s\n' ply 'format ascii 1.0' 'element vertex 4'
  printf 'property float %s\n' x y z nx ny nz s t
  printf '%s\n' 'element face 1' 'property list uchar int vertex_indices' end_header
  printf '%s\n' '0 0 0 0 0 1 0 0' '1 0 0 0 0 1 1 0' '1 1 0 0 0 1 1 1' '0 1 0 0 0 1 0 1' '4 0 1 2 3'
} >a.ply
printf '%s\n' 'newmtl plain' 'Kd 1 1 1' >plain.mtl
printf '%s\n' 'mtllib plain.mtl' 'usemtl plain' 'v 0 0 0' 'v 1 0 0' 'v 1 1 0' 'vn 0 0 1' 'vt 0 0' 'vt 1 0' \
  'vt 1 1' 'f 1/1/1 2/2/1 3/3/1' >b.obj # for comparison
osgconv a.ply a.osgt >log 2>&1
osgconv b.obj b.osgt >/dev/null 2>&1
{
  for array in VertexArray NormalArray TexCoordArrayList; do
    echo "$array: $(grep -c "$array" a.osgt || true) $(grep -c "$array" b.osgt || true)"
  done
  echo "warnings: $(grep -ci warn log || true)"
} >seen
expect <<'END'
VertexArray: 1 1
NormalArray: 1 1
TexCoordArrayList: 0 1
warnings: 0
END
