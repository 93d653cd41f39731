// SPDX-License-Identifier: MIT
// A skinned bar for the findings: a triangle at the end of a chain of joints, a unit apart along Y.
import { Document, NodeIO } from '@gltf-transform/core';

/// weights(vertex) gives the [joint, weight] pairs of a vertex: four, or eight.
export function makeBar(jointCount, weights) {
  const document = new Document(), buffer = document.createBuffer();
  const accessor = (type, array) =>
    document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  const joints = [];
  const inverse = new Float32Array(16 * jointCount);
  for (let i = 0; i < jointCount; ++i) {
    const joint = document.createNode('joint' + i);
    if (i > 0) joints[i - 1].addChild(joint.setTranslation([0, 1, 0]));
    joints.push(joint);
    inverse.set([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -i, 0, 1], 16 * i);
  }
  const skin = document.createSkin().setInverseBindMatrices(accessor('MAT4', inverse));
  for (const joint of joints) skin.addJoint(joint);
  const end = jointCount - 1;
  const triangle = document.createPrimitive()
    .setAttribute('POSITION', accessor('VEC3',
      new Float32Array([0, end, 0, 1, end, 0, 0, end + 1, 0])))
    .setIndices(accessor('SCALAR', new Uint16Array([0, 1, 2])));
  for (let set = 0; set < weights(0).length / 4; ++set) {
    const index = new Uint8Array(12), share = new Float32Array(12);
    for (let v = 0; v < 3; ++v)
      for (let k = 0; k < 4; ++k)
        [index[4 * v + k], share[4 * v + k]] = weights(v)[4 * set + k];
    triangle.setAttribute('JOINTS_' + set, accessor('VEC4', index));
    triangle.setAttribute('WEIGHTS_' + set, accessor('VEC4', share));
  }
  const body = document.createNode('body').setSkin(skin)
    .setMesh(document.createMesh('bar').addPrimitive(triangle));
  document.createScene().addChild(body).addChild(joints[0]);
  return { document, joints, accessor };
}

/// All of a vertex to one joint.
export const wholly = (joint) => () => [[joint, 1], [0, 0], [0, 0], [0, 0]];

/// Adds a clip that moves a joint.
export function addClip({ document, accessor }, name, joint, times, values, interpolation = 'LINEAR') {
  const sampler = document.createAnimationSampler().setInterpolation(interpolation)
    .setInput(accessor('SCALAR', new Float32Array(times)))
    .setOutput(accessor('VEC3', new Float32Array(values)));
  document.createAnimation(name).addSampler(sampler).addChannel(document.createAnimationChannel()
    .setTargetNode(joint).setTargetPath('translation').setSampler(sampler));
}

export const glbOf = (document) => new NodeIO().writeBinary(document);
