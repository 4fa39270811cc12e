"""Inside Blender: a curtain, self-collision on, and a ball that is pushed through it; written as Blender computes it.

usage: blender -b --factory-startup -noaudio -P blender_cloth.py -- OUT SIDE FRAMES
Settings of the cloth are Blender's defaults, but for self-collision. Writes OUT.obj, the mesh at the start with a group
for each thing, and OUT.pc2, the vertices of frames 1 to FRAMES: Blender's own float32 numbers.
"""
import math
import struct
import sys

import bpy
import numpy as np

out, side, frames = sys.argv[sys.argv.index("--") + 1 :]
frames = int(frames)

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.frame_start, scene.frame_end = 1, frames

bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=0.3, location=(0.1, -1.2, -0.2))
ball = bpy.context.object
ball.modifiers.new("collision", "COLLISION")
for frame, y in ((1, -1.2), (5, -1.0), (9, 1.2), (14, -1.2), (19, 1.2)):
    ball.location.y = y
    ball.keyframe_insert("location", frame=frame)

# A curtain in the plane y = 0, held at its upper edge.
bpy.ops.mesh.primitive_grid_add(x_subdivisions=int(side), y_subdivisions=int(side), size=1.6, rotation=(math.pi / 2, 0, 0))
cloth = bpy.context.object
bpy.ops.object.transform_apply(rotation=True)
held = cloth.vertex_groups.new(name="held")
held.add([v.index for v in cloth.data.vertices if v.co.z > 0.799], 1.0, "REPLACE")
simulation = cloth.modifiers.new("cloth", "CLOTH")
simulation.settings.vertex_group_mass = "held"
simulation.collision_settings.use_self_collision = True
simulation.point_cache.frame_start, simulation.point_cache.frame_end = 1, frames


def triangles(mesh):
    mesh.calc_loop_triangles()
    faces = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", faces)
    return faces.reshape(-1, 3)


def positions(thing):
    """Of the evaluated object, moved to the world in float32, as Blender shows it."""
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    points = np.empty(3 * len(evaluated.data.vertices), dtype=np.float32)
    evaluated.data.vertices.foreach_get("co", points)
    world = np.array(evaluated.matrix_world, dtype=np.float32)
    return points.reshape(-1, 3) @ world[:3, :3].T + world[:3, 3]


things = {"cloth": cloth, "ball": ball}
with open(out + ".obj", "w", encoding="ascii") as file:
    first = 1
    for name, thing in things.items():
        points = positions(thing)
        file.writelines("v %r %r %r\n" % tuple(map(float, p)) for p in points)
        file.write("g %s\n" % name)
        file.writelines("f %d %d %d\n" % tuple(face + first) for face in triangles(thing.data))
        first += len(points)

with open(out + ".pc2", "wb") as file:
    file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, first - 1, 1.0, 1.0, frames))
    for frame in range(1, frames + 1):
        scene.frame_set(frame)
        for thing in things.values():
            file.write(positions(thing).astype("<f4").tobytes())
