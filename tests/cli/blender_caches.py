"""Inside Blender: plays a PC2 on its base mesh, and exports what it shows as PC2 and MDD.

usage: blender -b --factory-startup -noaudio -P blender_caches.py -- BASE.obj CACHE.pc2 FRAMES OUT
"""
import sys

import addon_utils
import bpy

base, cache, frames, out = sys.argv[sys.argv.index("--") + 1 :]
for addon in ("io_shape_mdd", "io_export_pc2"):
    addon_utils.enable(addon)

bpy.ops.wm.obj_import(filepath=base, forward_axis="Y", up_axis="Z")
mesh = bpy.context.selected_objects[0]
bpy.context.view_layer.objects.active = mesh
player = mesh.modifiers.new("cache", "MESH_CACHE")
player.cache_format = "PC2"
player.filepath = cache
player.interpolation = "NONE"
player.forward_axis = "POS_Y"
player.up_axis = "POS_Z"
player.frame_start = 0

last = int(frames) - 1
bpy.ops.export_shape.mdd(filepath=out + ".mdd", fps=25, frame_start=0, frame_end=last)
bpy.ops.export_shape.pc2(filepath=out + ".pc2", rot_x90=False, range_start=0, range_end=last, sampling="1")
