#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# docs.sh FOLDER: writes the site to FOLDER/html: the pages, and in FOLDER/html/reference the reference by
# Doxygen. Fails on a warning of Doxygen, and on a link that leads nowhere. The build target `docs` calls it.
set -euo pipefail
osgskin_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=${1:?expected a folder}
rm -rf "$folder/html"
mkdir -p "$folder/html"
folder=$(cd "$folder" && pwd)
cd "$osgskin_root"
. cmake/setup.sh
osgskin_install doxygen python3-markdown-it

headers='' includes='' exports=''
for kit in nodekits/*/include/*; do
  headers+=" $kit"
  includes+=" $(dirname "$kit")"
  exports+=" $(basename "$kit" | tr '[:lower:]' '[:upper:]')_EXPORT="
done
sed -e "s|@output@|$folder|" -e "s|@headers@|$headers|" -e "s|@includes@|$includes|" \
  -e "s|@exports@|$exports|" cmake/Doxyfile.in >"$folder/Doxyfile"
doxygen "$folder/Doxyfile"
/usr/bin/python3 cmake/site.py . "$folder/html" # Debian's Python has the package
echo "The site: $folder/html/index.html"
