"""Cycles, as Blender's Python module `bpy` brings it: a scene's facts as a Blender scene, rendered on the CPU.

As it comes but for what would change the picture: no clamping, no blurred caustics, no adaptive sampling, no denoising, a box filter.
"""

import tempfile
import time
from pathlib import Path

import numpy as np

from scene_facts import Missing, read

ONE = (1.0, 1.0, 1.0, 1.0)


class Nodes:
    """The nodes of one material or world, made and linked by name."""

    def __init__(self, owner, output):
        owner.use_nodes = True
        self.tree = owner.node_tree
        self.tree.nodes.clear()
        self.output = self.tree.nodes.new(output)

    def add(self, kind, inputs=(), **properties):
        node = self.tree.nodes.new(kind)
        for name, value in properties.items():
            setattr(node, name, value)
        for name, value in dict(inputs).items():
            if hasattr(value, "is_output"):
                self.tree.links.new(value, node.inputs[name])
            else:
                node.inputs[name].default_value = value
        return node

    def finish(self, socket):
        self.tree.links.new(socket, self.output.inputs["Surface"])


def scattering(nodes, material):
    if material.kind == "diffuse":
        return nodes.add("ShaderNodeBsdfDiffuse", {"Color": (*material.color, 1.0), "Roughness": 0.0})
    roughness = np.sqrt(material.alpha)  # Cycles squares it
    if material.kind == "conductor":
        if min(material.color) < 1.0:
            raise Missing("no counterpart of a conductor with a reflectance of its own")
        distribution = {"ggx": "GGX", "beckmann": "BECKMANN"}[material.distribution]
        return nodes.add("ShaderNodeBsdfMetallic", {"IOR": material.eta, "Extinction": material.k, "Roughness": roughness},
                         fresnel_type="PHYSICAL_CONDUCTOR", distribution=distribution)
    return nodes.add("ShaderNodeBsdfGlass", {"Color": ONE, "IOR": material.eta[0], "Roughness": roughness})


def blender_material(bpy, mesh):
    owner = bpy.data.materials.new("material")
    nodes = Nodes(owner, "ShaderNodeOutputMaterial")
    surface = scattering(nodes, mesh.material).outputs[0]
    if mesh.radiance:
        # Only the front shines.
        front = nodes.add("ShaderNodeEmission", {"Color": (*mesh.radiance, 1.0), "Strength": 1.0}).outputs[0]
        back = nodes.add("ShaderNodeNewGeometry").outputs["Backfacing"]
        mix = nodes.add("ShaderNodeMixShader", {0: back, 1: front, 2: surface})
        surface = mix.outputs[0]
    nodes.finish(surface)
    return owner


def add_mesh(bpy, mesh):
    data = bpy.data.meshes.new("mesh")
    data.from_pydata(mesh.vertices.tolist(), [], mesh.faces.tolist())
    if mesh.normals is not None:
        data.shade_smooth()
        data.normals_split_custom_set_from_vertices(mesh.normals.tolist())
    else:
        data.shade_flat()
    data.materials.append(blender_material(bpy, mesh))
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("shape", data))


def set_world(bpy, environment):
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world = world
    nodes = Nodes(world, "ShaderNodeOutputWorld")
    color = (0.0, 0.0, 0.0, 1.0)
    scale = 1.0
    if environment:
        file, scale = environment
        # Across a panorama Blender turns about z from -x over +y, Mitsuba about y from -z over +x.
        place = nodes.add("ShaderNodeTexCoord").outputs["Generated"]
        split = nodes.add("ShaderNodeSeparateXYZ", {0: place}).outputs
        turned = nodes.add("ShaderNodeCombineXYZ", {"X": split["Z"], "Y": split["X"], "Z": split["Y"]})
        image = bpy.data.images.load(str(Path(file).resolve()))
        image.colorspace_settings.name = "Linear Rec.709"
        color = nodes.add("ShaderNodeTexEnvironment", {"Vector": turned.outputs[0]}, image=image).outputs["Color"]
    nodes.finish(nodes.add("ShaderNodeBackground", {"Color": color, "Strength": scale}).outputs[0])


def set_camera(bpy, facts):
    import mathutils

    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle = "HORIZONTAL", np.radians(facts.fov)
    data.clip_start, data.clip_end = 1e-3, 1e5
    camera = bpy.data.objects.new("camera", data)
    # Blender's cameras look along -z with x to the right.
    camera.matrix_world = mathutils.Matrix((facts.to_world @ np.diag([-1.0, 1.0, -1.0, 1.0])).tolist())
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def set_renderer(bpy, facts, threads):
    scene = bpy.context.scene
    render, cycles, image = scene.render, scene.cycles, scene.render.image_settings
    render.engine = "CYCLES"
    cycles.device = "CPU"
    render.threads_mode, render.threads = "FIXED", threads
    render.use_persistent_data = True
    render.resolution_x, render.resolution_y, render.resolution_percentage = *facts.size, 100
    cycles.pixel_filter_type = "BOX"
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.light_sampling_threshold = 0.0
    bounces = facts.max_depth - 1 if facts.max_depth > 0 else 1024
    for name in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"):
        setattr(cycles, name, bounces)
    image.file_format, image.color_mode, image.color_depth, image.exr_codec = "OPEN_EXR", "RGB", "32", "NONE"


class CyclesPeer:
    def __init__(self, scene_file, threads):
        import bpy

        facts = read(scene_file)
        self.bpy, self.version = bpy, bpy.app.version_string
        bpy.ops.wm.read_factory_settings(use_empty=True)
        set_renderer(bpy, facts, threads)
        set_camera(bpy, facts)
        set_world(bpy, facts.environment)
        for mesh in facts.meshes:
            add_mesh(bpy, mesh)
        self.folder = tempfile.TemporaryDirectory()
        bpy.context.scene.render.filepath = str(Path(self.folder.name) / "picture.exr")
        self.render(1, 0)  # builds the hierarchy, which is kept

    def render(self, spp, seed):
        from renderers import load_picture

        scene = self.bpy.context.scene
        scene.cycles.samples, scene.cycles.seed = spp, seed
        scene.update_tag()
        self.bpy.context.view_layer.update()
        start = time.perf_counter()
        self.bpy.ops.render.render(write_still=True)
        seconds = time.perf_counter() - start
        return seconds, load_picture(scene.render.filepath)
