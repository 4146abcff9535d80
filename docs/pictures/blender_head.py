"""Takes the picture of docs/blender.md in Blender: a head with a swollen cheek as it is scanned, coloured by
its asymmetry with its mirror, and made symmetric.

PYTHON docs/pictures/blender_head.py ZIP docs/images; PYTHON has Blender as a module, ZIP is the extension
for it.
"""

import math
import os
import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

sys.path.insert(0, str(Path(__file__).parents[2] / "tests/blender/inside"))
from heads import coordinates, head, set_coordinates

SWOLLEN = (0.85, -0.65, 0.15)  # where, on the side x > 0
APART = 3.4  # units between the heads


def material(name, colour, alpha=1.0, attribute=None):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Roughness"].default_value = 0.6
    shader.inputs["Alpha"].default_value = alpha
    if attribute:
        node = made.node_tree.nodes.new("ShaderNodeAttribute")
        node.attribute_name = attribute
        made.node_tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    return made


def swollen_head(place):
    shape, _ = head(240, 140, place=place)
    points = coordinates(shape)
    near = np.exp(-((points - SWOLLEN) ** 2).sum(axis=1) / 0.08)
    set_coordinates(shape, points * (1 + 0.12 * near[:, None]))
    shape.data.shade_smooth()
    return shape


def take(path):
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.device, scene.cycles.samples = "CYCLES", "CPU", 48
    scene.cycles.use_denoising = False
    scene.cycles.seed = 0
    scene.render.resolution_x, scene.render.resolution_y = 1100, 400
    scene.render.filepath = str(path)
    scene.render.image_settings.color_mode = "RGB"
    scene.view_settings.view_transform = "Standard"
    bpy.ops.render.render(write_still=True)


def main(extension, folder):
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    bpy.ops.extensions.package_install_files(
        filepath=os.path.abspath(extension), repo="user_default", enable_on_install=True
    )
    skin = material("Skin", (0.75, 0.6, 0.5))
    tilt = Matrix.Rotation(0.25, 4, "Y") @ Matrix.Rotation(-0.3, 4, "Z")
    for number in range(3):
        shape = swollen_head(Matrix.Translation((APART * (number - 1), 0, 0)) @ tilt)
        if number == 1:
            bpy.ops.symsurf.detect(method="plane")
            bpy.ops.symsurf.asymmetry()
            shape.data.materials.append(material("Colours", (1, 1, 1), 1, "Mirror asymmetry"))
            drawn = shape.symsurf_mirror
            drawn.hide_render = False
            drawn.data.materials[0] = material("Mirror", (0.1, 0.55, 0.6), 0.3)
            continue
        shape.data.materials.append(skin)
        if number == 2:
            bpy.ops.symsurf.align(move="OBJECT")
            bpy.ops.symsurf.symmetrize(side="negative")
            shape.location.x += APART
    light = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    light.data.energy, light.rotation_euler = 1.2, (0.7, 0.3, -0.4)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 3 * APART
    camera.location = Vector((0, -10, 1.5))
    camera.rotation_euler = (math.radians(90) - math.atan2(1.5, 10), 0, 0)
    for each in (light, camera):
        bpy.context.scene.collection.objects.link(each)
    bpy.context.scene.camera = camera
    bpy.context.scene.world = bpy.data.worlds.new("World")
    bpy.context.scene.world.use_nodes = True
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.6, 0.6, 0.6, 1)
    take(Path(folder).resolve() / "blender-head.png")


if __name__ == "__main__":
    main(*sys.argv[1:])
    sys.stdout.flush()
    os._exit(0)  # as a module Blender may wait for ever when the interpreter ends
