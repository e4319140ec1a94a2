"""LuxCoreRender, as `pyluxcore` brings it: a scene's facts as a LuxCore scene, rendered on the CPU (PATHCPU).

As it comes but for what would change the picture: no clamping, no adaptive sampling, a box filter.
"""

import importlib.util
import os
import pickle
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from scene_facts import Missing


def read_facts(scene_file):
    """In a process of its own: LuxCore's allocator takes the place of the system's, which Mitsuba does not survive."""
    command = "import pickle, sys; from scene_facts import read; pickle.dump(read(sys.argv[1]), sys.stdout.buffer)"
    plain = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
    found = subprocess.run([sys.executable, "-c", command, str(scene_file)], cwd=Path(__file__).parent, capture_output=True, env=plain)
    if found.returncode != 0:
        raise Missing(found.stderr.decode().strip().splitlines()[-1])
    return pickle.loads(found.stdout)


def environment():
    """Of a process that uses it: its allocator has to be there from the start, or blocks are freed that it never made."""
    found = importlib.util.find_spec("pyluxcore")
    libraries = sorted(Path(found.origin).parent.parent.glob("pyluxcore.libs/libtbbmalloc_proxy*")) if found and found.origin else []
    return {"LD_PRELOAD": str(libraries[0])} if libraries else {}


def properties(pyluxcore, **values):
    """`a__b=1` becomes the property a.b."""
    result = pyluxcore.Properties()
    for name, value in values.items():
        plain = np.asarray(value).tolist()  # of Python's own types
        result.Set(pyluxcore.Property(name.replace("__", "."), plain))
    return result


def material_properties(name, mesh):
    """What describes the material `name`, without the prefix."""
    material = mesh.material
    if material.kind == "diffuse":
        values = {"type": "matte", "kd": material.color}
    elif material.kind == "dielectric":
        values = {"type": "glass", "kr": (1.0, 1.0, 1.0), "kt": (1.0, 1.0, 1.0), "interiorior": material.eta[0], "exteriorior": 1.0}
    else:
        raise Missing(f"no counterpart of a {material.distribution} conductor")
    if mesh.radiance:
        values.update({"emission": mesh.radiance, "emission.gain": (1.0, 1.0, 1.0)})
    return {f"scene.materials.{name}.{key}": value for key, value in values.items()}


def add_mesh(pyluxcore, scene, index, mesh):
    name = f"m{index}"
    scene.Parse(properties(pyluxcore, **material_properties(name, mesh)))
    normals = None if mesh.normals is None else [tuple(n) for n in mesh.normals.tolist()]
    scene.DefineMesh(f"shape_{name}", [tuple(v) for v in mesh.vertices.tolist()], [tuple(f) for f in mesh.faces.tolist()],
                     normals, None, None, None)
    scene.Parse(properties(pyluxcore, **{f"scene.objects.{name}.shape": f"shape_{name}", f"scene.objects.{name}.material": name}))


def screen_window(size):
    """Of a picture with a row more below: LuxCore's film lacks its first row, and shows all others one further down."""
    if size[0] != size[1]:
        raise Missing("no counterpart of a picture that is not square")
    return (-1.0, 1.0, -1.0 - 2.0 / size[1], 1.0)


def set_camera(pyluxcore, scene, facts):
    origin, forward, up = facts.to_world[:3, 3], facts.to_world[:3, 2], facts.to_world[:3, 1]
    scene.Parse(properties(pyluxcore, scene__camera__type="perspective", scene__camera__lookat__orig=origin,
                           scene__camera__lookat__target=origin + forward, scene__camera__up=up, scene__camera__fieldofview=facts.fov,
                           scene__camera__screenwindow=screen_window(facts.size), scene__camera__autovolume__enable=0))


def set_environment(pyluxcore, scene, environment):
    if not environment:
        return
    file, scale = environment
    # Across a panorama LuxCore turns about z, Mitsuba about y from -z over +x.
    turn = (0, 0, -1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1)
    scene.Parse(properties(pyluxcore, scene__lights__sky__type="infinite", scene__lights__sky__file=str(file), scene__lights__sky__gamma=1.0,
                           scene__lights__sky__gain=(scale, scale, scale), scene__lights__sky__transformation=turn))


class LuxCorePeer:
    def __init__(self, scene_file, threads):
        import pyluxcore

        pyluxcore.Init(lambda message: None)
        facts = read_facts(scene_file)
        self.luxcore, self.version, self.size = pyluxcore, pyluxcore.Version(), facts.size
        self.scene = pyluxcore.Scene()
        set_camera(pyluxcore, self.scene, facts)
        set_environment(pyluxcore, self.scene, facts.environment)
        for index, mesh in enumerate(facts.meshes):
            add_mesh(pyluxcore, self.scene, index, mesh)
        depth = facts.max_depth - 1 if facts.max_depth > 0 else 1024
        self.settings = dict(
            renderengine__type="PATHCPU", sampler__type="SOBOL", sampler__sobol__adaptive__strength=0.0, native__threads__count=threads,
            film__width=facts.size[0], film__height=facts.size[1] + 1, film__filter__type="BOX", film__filter__width=0.5,
            film__imagepipelines__0__0__type="NOP", film__noiseestimation__warmup=0,
            path__pathdepth__total=depth, path__pathdepth__diffuse=depth, path__pathdepth__glossy=depth, path__pathdepth__specular=depth,
            path__clamping__variance__maxvalue=0.0)
        self.render(1, 0)

    def render(self, spp, seed):
        config = self.luxcore.RenderConfig(
            properties(self.luxcore, **self.settings, renderengine__seed=seed + 1, batch__haltspp=spp), self.scene)
        session = self.luxcore.RenderSession(config)
        session.Start()
        while not session.HasDone():
            time.sleep(0.005)
            session.UpdateStats()
        seconds = session.GetStats().Get("stats.renderengine.time").GetFloat()
        session.Stop()
        width, height = self.size
        picture = np.zeros((height + 1, width, 3), np.float32)
        session.GetFilm().GetOutputFloat(self.luxcore.FilmOutputType.RGB, picture.reshape(-1), 0)
        return seconds, picture[height - 1::-1].astype(np.float64)
