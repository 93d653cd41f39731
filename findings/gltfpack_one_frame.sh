#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# gltfpack 1.3.0: clips are sampled 30 times a second unless -af says otherwise. A clip of 60 frames a
# second whose only motion is in one odd frame, such as a blink or a muzzle flash, is left out whole; a
# line on its output says that it has no motion. One expects keys of a file to stay, or to be
# thinned where that changes nothing.
. "$(dirname "$0")/common.sh"
npm_packages gltfpack@1.3.0 @gltf-transform/core@4.5.1 @gltf-transform/extensions@4.5.1
cat >make.mjs <<'END'
import { writeFileSync } from 'fs';
import { makeBar, wholly, addClip, glbOf } from './bar.mjs';
const bar = makeBar(2, wholly(1)), times = [], values = [];
for (let i = 0; i <= 60; ++i) times.push(i / 60), values.push(0, 1, i === 31 ? 1 : 0);
addClip(bar, 'blink', bar.joints[1], times, values);
writeFileSync('clip.glb', await glbOf(bar.document));
END
cat >show.mjs <<'END'
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
for (const file of process.argv.slice(2)) {
  const document = await new NodeIO().registerExtensions(ALL_EXTENSIONS).read(file);
  const moves = document.getRoot().listAnimations().map((clip) => clip.listSamplers().map((sampler) =>
    Math.max(...Array.from(sampler.getOutput().getArray()).filter((_, i) => i % 3 === 2))));
  console.log(file, 'clips', moves.length, 'largest move', moves.flat().join(' ') || 'none');
}
END
node make.mjs
node node_modules/gltfpack/cli.js -i clip.glb -o packed.glb >seen 2>&1
node node_modules/gltfpack/cli.js -af 60 -i clip.glb -o packed60.glb
node show.mjs clip.glb packed.glb packed60.glb >>seen
expect <<'END'
Warning: ignoring animation 0 (blink) because it has no tracks with motion; use -ac to override
clip.glb clips 1 largest move 1
packed.glb clips 0 largest move none
packed60.glb clips 1 largest move 1
END
