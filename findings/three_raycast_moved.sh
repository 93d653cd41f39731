#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# three.js 0.187.0, Raycaster: a skinned mesh is picked where it was when it was first picked. Its
# bounding sphere is computed once; a figure that has walked out of it is missed, also at its new
# place, until computeBoundingSphere() is called. One expects a hit where the figure is drawn.
. "$(dirname "$0")/common.sh"
npm_packages three@0.187.0 @gltf-transform/core@4.5.1
cat >run.mjs <<'END'
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { makeBar, wholly, glbOf } from './bar.mjs';
globalThis.self = globalThis;
const glb = await glbOf(makeBar(2, wholly(1)).document);
const { scene } = await new GLTFLoader().parseAsync(glb.slice().buffer, '');
let mesh;
scene.traverse((node) => { if (node.isSkinnedMesh) mesh = node; });
const hitsAt = (x) => {
  scene.updateMatrixWorld(true);
  const from = new THREE.Vector3(x + 0.2, 1.2, 5);
  return new THREE.Raycaster(from, new THREE.Vector3(0, 0, -1)).intersectObject(mesh).length;
};
console.log('at rest', hitsAt(0));
mesh.skeleton.bones[1].position.x = 5;
console.log('moved by 5, aimed at its new place', hitsAt(5));
mesh.computeBoundingSphere();
console.log('after computeBoundingSphere()', hitsAt(5));
END
node run.mjs >seen
expect <<'END'
at rest 1
moved by 5, aimed at its new place 0
after computeBoundingSphere() 1
END
