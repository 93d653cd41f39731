#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Assimp 5.2.5 (Debian 12): glTF clips lose their interpolation. STEP keys and CUBICSPLINE keys are
# read as linear ones, tangents are dropped, and nothing says so: half way between a key at 0 and one at
# 1 a stepped joint stands at 0.5 in place of 0, and one whose tangents are 9 and -9 at 0.5 in place of
# 2.75. One expects keys that are resampled, or a warning.
. "$(dirname "$0")/common.sh"
debian_package assimp-utils 5.2.5~ds0-1+b1
npm_packages @gltf-transform/core@4.5.1
cat >make.mjs <<'END'
import { writeFileSync } from 'fs';
import { makeBar, wholly, addClip, glbOf } from './bar.mjs';
for (const [mode, values] of [
  ['STEP', [0, 1, 0, 0, 1, 1]],
  ['CUBICSPLINE', [0, 0, 0, 0, 1, 0, 0, 0, 9, 0, 0, -9, 0, 1, 1, 0, 0, 0]]]) {
  const bar = makeBar(2, wholly(1));
  addClip(bar, 'clip', bar.joints[1], [0, 1], values, mode);
  writeFileSync(mode + '.glb', await glbOf(bar.document));
}
END
cat >show.mjs <<'END'
import { NodeIO } from '@gltf-transform/core';
for (const file of process.argv.slice(2)) {
  const root = (await new NodeIO().read(file)).getRoot();
  for (const channel of root.listAnimations()[0].listChannels()) {
    if (channel.getTargetPath() !== 'translation') continue;
    const sampler = channel.getSampler();
    console.log(file, sampler.getInterpolation(), Array.from(sampler.getOutput().getArray()).join(' '));
  }
}
END
node make.mjs
for mode in STEP CUBICSPLINE; do assimp export $mode.glb $mode-again.glb >log; grep -i "warn" log || true; done
node show.mjs {STEP,CUBICSPLINE}{,-again}.glb 2>/dev/null >seen
expect <<'END'
STEP.glb STEP 0 1 0 0 1 1
STEP-again.glb LINEAR 0 1 0 0 1 1
CUBICSPLINE.glb CUBICSPLINE 0 0 0 0 1 0 0 0 9 0 0 -9 0 1 1 0 0 0
CUBICSPLINE-again.glb LINEAR 0 1 0 0 1 1
END
