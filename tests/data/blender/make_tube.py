# SPDX-License-Identifier: MIT
"""make_tube.py: a tube of three bones that bend and twist, exported by Blender 5.2.2 as glTF, FBX and BVH, with its
own vertices in the middle of the clip: blender -b --factory-startup -P make_tube.py -- FOLDER"""
import math
import sys

import bpy
import mathutils

folder = sys.argv[-1]
BONES, SIDES, RINGS, HEIGHT = ["base", "middle", "top"], 6, 13, 1.5
BEND = {"base": (10, 20, 0), "middle": (60, 30, 0), "top": (0, 0, 50)}  # degrees at frame 12

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
armature = bpy.data.armatures.new("Rig")
rig = bpy.data.objects.new("Rig", armature)
scene.collection.objects.link(rig)
bpy.context.view_layer.objects.active = rig
bpy.ops.object.mode_set(mode="EDIT")
above = None
for i, name in enumerate(BONES):
    bone = armature.edit_bones.new(name)
    bone.head, bone.tail = (0, 0, 0.5 * i), (0, 0, 0.5 * i + 0.5)
    bone.parent, bone.use_connect = above, i > 0
    above = bone
bpy.ops.object.mode_set(mode="OBJECT")

around = [2 * math.pi * k / SIDES for k in range(SIDES)]
rings = [HEIGHT * r / (RINGS - 1) for r in range(RINGS)]
vertices = [(0.15 * math.cos(a), 0.1 * math.sin(a), z) for z in rings for a in around]
faces = [
    (r * SIDES + k, r * SIDES + (k + 1) % SIDES, (r + 1) * SIDES + (k + 1) % SIDES, (r + 1) * SIDES + k)
    for r in range(RINGS - 1)
    for k in range(SIDES)
]
mesh = bpy.data.meshes.new("Tube")
mesh.from_pydata(vertices, [], faces)
tube = bpy.data.objects.new("Tube", mesh)
scene.collection.objects.link(tube)
tube.parent = rig
for i, name in enumerate(BONES):
    group = tube.vertex_groups.new(name=name)
    for v, (_, _, z) in enumerate(vertices):
        if 2 * z < i or 2 * z > i + 1 + 1e-6 * (name == "top"):
            weight = 0.0
        else:
            weight = 0.5 if 2 * z in (1, 2) else 1.0
        if weight > 0:
            group.add([v], weight, "REPLACE")
modifier = tube.modifiers.new("Armature", "ARMATURE")
modifier.object = rig

rig.animation_data_create()
rig.animation_data.action = bpy.data.actions.new("bend")
for name, degrees in BEND.items():
    pose = rig.pose.bones[name]
    for frame, share in (0, 0), (12, 1):
        turn = mathutils.Euler([math.radians(share * d) for d in degrees])
        pose.rotation_quaternion = turn.to_quaternion()
        pose.keyframe_insert("rotation_quaternion", frame=frame)
scene.render.fps, scene.frame_start, scene.frame_end = 24, 0, 12

scene.frame_set(6)
posed = tube.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
with open(folder + "/tube_at_6.txt", "w") as out:
    for v in posed.vertices:
        x, y, z = tube.matrix_world @ v.co
        out.write(f"{x:.5f} {y:.5f} {z:.5f}\n")
bpy.ops.export_scene.gltf(filepath=folder + "/tube.glb")
bpy.ops.export_scene.fbx(filepath=folder + "/tube.fbx", add_leaf_bones=False)
bpy.ops.export_anim.bvh(filepath=folder + "/tube.bvh")
