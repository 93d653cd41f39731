#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# docs.sh FOLDER: writes the reference as HTML to FOLDER/html, with Doxygen. Fails on a warning. The
# build target `docs` calls it.
set -euo pipefail
osgskin_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=${1:?expected a folder}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
cd "$osgskin_root"
. cmake/setup.sh
osgskin_install doxygen

headers='' includes='' exports=''
for kit in nodekits/*/include/*; do
  headers+=" $kit"
  includes+=" $(dirname "$kit")"
  exports+=" $(basename "$kit" | tr '[:lower:]' '[:upper:]')_EXPORT="
done
sed -e "s|@output@|$folder|" -e "s|@headers@|$headers|" -e "s|@includes@|$includes|" \
  -e "s|@exports@|$exports|" cmake/Doxyfile.in >"$folder/Doxyfile"
doxygen "$folder/Doxyfile"
echo "The reference: $folder/html/index.html"
