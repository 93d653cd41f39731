#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# three.js 0.187.0, GLTFLoader: a vertex with eight influences (JOINTS_1, WEIGHTS_1) follows its first
# four, whose weights are scaled up to a sum of 1, without a warning. glTF lets a client support four
# only; one expects to be told. Half of the weight lies on joints that move by 8: the vertex should
# move by 4.
. "$(dirname "$0")/common.sh"
npm_packages three@0.187.0 @gltf-transform/core@4.5.1
cat >run.mjs <<'END'
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { makeBar, glbOf } from './bar.mjs';
globalThis.self = globalThis;
const warnings = [];
console.warn = (...words) => warnings.push(words.join(' '));
const bar = makeBar(9, () => [0, 1, 2, 3, 4, 5, 6, 7].map((joint) => [joint, 1 / 8]));
bar.joints[4].setTranslation([0, 1, 8]);
const glb = await glbOf(bar.document);
const loaded = await new GLTFLoader().parseAsync(glb.slice().buffer, '');
loaded.scene.updateMatrixWorld(true);
loaded.scene.traverse((node) => {
  if (!node.isSkinnedMesh) return;
  console.log('attributes', Object.keys(node.geometry.attributes).join(' '));
  console.log('first weight', node.geometry.attributes.skinWeight.getX(0));
  console.log('moved by', node.getVertexPosition(0, new THREE.Vector3()).z);
});
console.log('warnings', warnings.length);
END
node run.mjs >seen
expect <<'END'
attributes position skinIndex skinWeight joints_1 weights_1
first weight 0.25
moved by 0
warnings 0
END
