"""Imports GLB files into Blender, without a screen, and writes what came of each as JSON.

    python import_in_blender.py REPORT SECONDS FILE…

It is run by an interpreter that has PyPI's bpy, which wants an older numpy than ours. Places are
those that Blender shows at SECONDS, turned back from its axes (z up) to glTF's, in metres.
"""

import json
import sys

import bpy

FPS = 24


def imported(path, seconds):
    """Return meshes with their shape keys, places and actions of one file."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if not hasattr(bpy.types, "IMPORT_SCENE_OT_gltf"):
        bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    scene = bpy.context.scene
    scene.render.fps = FPS
    bpy.ops.import_scene.gltf(filepath=path)
    scene.frame_set(round(seconds * FPS))
    graph = bpy.context.evaluated_depsgraph_get()
    meshes = {}
    for thing in bpy.data.objects:
        if thing.type == "MESH":
            keys = thing.data.shape_keys
            names = [] if keys is None else [block.name for block in keys.key_blocks]
            meshes[thing.name] = {"keys": names, "places": places(thing.evaluated_get(graph))}
    actions = {action.name: list(action.frame_range) for action in bpy.data.actions}
    return {"path": path, "fps": FPS, "meshes": meshes, "actions": actions}


def places(thing):
    """Return the vertices of an evaluated object in the scene, y up."""
    mesh = thing.to_mesh()
    turned = [thing.matrix_world @ vertex.co for vertex in mesh.vertices]
    found = [[x, z, -y] for x, y, z in turned]
    thing.to_mesh_clear()
    return found


report, at, *files = sys.argv[1:]
with open(report, "w", encoding="utf-8") as out:
    json.dump([imported(file, float(at)) for file in files], out)
