// SPDX-License-Identifier: MIT
// load_vrm.mjs FILE SECONDS: loads a VRM file with three-vrm and prints what it has as JSON: human
// bones, expressions, springs, and the vertices at a time of its first clip, if it has one.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

globalThis.self = globalThis; // three's loader asks for it, and for this
globalThis.ProgressEvent = class extends Event {};
const modules = createRequire(process.env.NODE_PATH + "/");
const load = (name) => import(pathToFileURL(modules.resolve(name)).href.replace(/\.cjs$/, ".module.js"));
const THREE = await load("three");
const { GLTFLoader } = await load("three/addons/loaders/GLTFLoader.js");
const { VRMLoaderPlugin } = await load("@pixiv/three-vrm");

const [file, seconds] = process.argv.slice(2);
const loader = new GLTFLoader();
loader.register((parser) => new VRMLoaderPlugin(parser));
const bytes = readFileSync(file);
const gltf = await loader.parseAsync(
  bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "");
const vrm = gltf.userData.vrm;
vrm.scene.updateMatrixWorld(true);
const place = (node) => node.getWorldPosition(new THREE.Vector3()).toArray();

const bones = {};
for (const [name, bone] of Object.entries(vrm.humanoid.rawHumanBones))
  bones[name] = { node: bone.node.name, at: place(bone.node) };

const expressions = {};
for (const e of vrm.expressionManager?.expressions ?? [])
  expressions[e.expressionName] =
    [e.isBinary, e.overrideBlink, e.overrideLookAt, e.overrideMouth, e.binds.length];

const springs = {};
for (const joint of vrm.springBoneManager?.joints ?? []) {
  const s = joint.settings;
  springs[joint.bone.name] = {
    settings: [s.stiffness, s.dragForce, s.gravityPower, s.hitRadius, ...s.gravityDir.toArray()],
    tip: place(joint.child),
    center: joint.center?.name,
    colliders: joint.colliderGroups.flatMap((group) => group.colliders.map((c) => {
      c.updateWorldMatrix(true, false);
      const shape = c.shape, at = (v) => v.clone().applyMatrix4(c.matrixWorld).toArray();
      return { node: c.parent.name, type: shape.type, radius: shape.radius ?? 0,
               inside: Boolean(shape.inside), from: at(shape.offset),
               to: at(shape.tail ?? shape.offset) };
    })).sort((a, b) => (JSON.stringify(a) < JSON.stringify(b) ? -1 : 1)),
  };
}

const vertices = [];
if (gltf.animations.length > 0 && seconds !== undefined) {
  const mixer = new THREE.AnimationMixer(vrm.scene);
  mixer.clipAction(gltf.animations[0]).play();
  mixer.setTime(Number(seconds));
  vrm.scene.updateMatrixWorld(true);
  vrm.scene.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const v = new THREE.Vector3();
    for (let i = 0; i < mesh.geometry.attributes.position.count; ++i)
      vertices.push(mesh.getVertexPosition(i, v).clone().applyMatrix4(mesh.matrixWorld).toArray());
  });
}
const { lookAt } = vrm;
const looks = lookAt && lookAt.offsetFromHeadBone.toArray();
console.log(JSON.stringify({ meta: vrm.meta, bones, expressions, springs, looks, vertices }));
