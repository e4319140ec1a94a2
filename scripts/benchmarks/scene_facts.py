"""What a Mitsuba scene holds, as plain arrays and numbers, for renderers that do not read its file.

`read(path)` loads the scene with Mitsuba and returns `Facts`. What has no counterpart here raises `Missing` with its name. Spheres
become meshes of 80,000 triangles with smooth normals: the only liberty taken.
"""

import xml.etree.ElementTree as xml
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np


class Missing(Exception):
    """A peer that cannot run here, or cannot render this scene; the text says why."""


@dataclass
class Material:
    kind: str  # diffuse, conductor or dielectric
    color: tuple = (1.0, 1.0, 1.0)  # reflectance of diffuse, factor of a conductor
    eta: tuple = (1.0, 1.0, 1.0)  # of a dielectric three times its relative index
    k: tuple = (0.0, 0.0, 0.0)
    alpha: float = 0.0  # roughness; 0 is smooth
    distribution: str = "ggx"


@dataclass
class Mesh:
    vertices: np.ndarray  # n x 3, world space
    faces: np.ndarray  # m x 3, front sides counterclockwise
    normals: np.ndarray | None  # n x 3 where they are smooth
    material: Material
    radiance: tuple | None = None  # of the front side


@dataclass
class Facts:
    to_world: np.ndarray  # camera: looks along +z, x to the left, y up
    fov: float  # degrees across the width
    size: tuple
    max_depth: int
    rr_depth: int
    meshes: list = field(default_factory=list)
    environment: tuple | None = None  # (file, 4 x 4 to world, factor)


def color(value):
    return tuple(np.broadcast_to(np.asarray(value, dtype=float).ravel(), 3))


def material_of(mi, bsdf):
    text = str(bsdf)
    kind = text.split("[", 1)[0]
    found = {key.removeprefix("brdf_0."): value for key, value in mi.traverse(bsdf)}

    def rgb(name, default):
        return color(found.get(f"{name}.value", found.get(name, default)))

    if kind == "TwoSided":
        kind = text.split("brdf[0] = ", 1)[1].split("[", 1)[0]
    if kind == "SmoothDiffuse":
        return Material("diffuse", rgb("reflectance", 0.5))
    if kind in ("SmoothConductor", "RoughConductor"):
        alpha = float(found["alpha.value"]) if "alpha.value" in found else 0.0
        distribution = "beckmann" if "beckmann" in text else "ggx"
        return Material("conductor", rgb("specular_reflectance", 1), rgb("eta", 0), rgb("k", 1), alpha, distribution)
    if kind == "SmoothDielectric":
        return Material("dielectric", eta=color(found["eta"]))
    raise Missing(f"no counterpart of {kind}")


def unit_sphere(rings=200):
    """Vertices and faces of a sphere about the origin, counterclockwise from outside."""
    theta = np.linspace(0, np.pi, rings + 1)[:, None]
    phi = np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)[None, :]
    points = np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), axis=-1)
    i, j = np.meshgrid(np.arange(rings), np.arange(2 * rings), indexing="ij")
    next_j = (j + 1) % (2 * rings)
    a, b, c, d = i * 2 * rings + j, (i + 1) * 2 * rings + j, (i + 1) * 2 * rings + next_j, i * 2 * rings + next_j
    upper, lower = np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)
    # At the poles one triangle of each pair is a line.
    return points.reshape(-1, 3), np.concatenate([upper[:-1].reshape(-1, 3), lower[1:].reshape(-1, 3)])


def geometry_of(mi, shape):
    found = dict(iter(mi.traverse(shape)))
    kind = shape.class_name()
    if "vertex_positions" in found:
        vertices = np.array(found["vertex_positions"]).reshape(-1, 3)
        normals = np.array(found["vertex_normals"]).reshape(-1, 3) if "vertex_normals" in found else np.empty((0, 3))
        return vertices, np.array(found["faces"]).reshape(-1, 3), normals if len(normals) == len(vertices) else None
    matrix = np.array(found["to_world"].matrix) if "to_world" in found else None
    if kind == "Rectangle":
        corners = np.array([[-1, -1, 0, 1], [1, -1, 0, 1], [1, 1, 0, 1], [-1, 1, 0, 1]]) @ matrix.T
        faces = np.array([[0, 1, 2], [0, 2, 3]])
        return corners[:, :3], faces if np.linalg.det(matrix[:3, :3]) > 0 else faces[:, ::-1], None
    if kind == "Sphere":
        points, faces = unit_sphere()
        return points @ matrix[:3, :3].T + matrix[:3, 3], faces, points @ matrix[:3, :3].T / np.cbrt(np.linalg.det(matrix[:3, :3]))
    raise Missing(f"no counterpart of {kind}")


def environment_of(path):
    """The environment map as the file names it, which Mitsuba does not tell."""
    for emitter in xml.parse(path).getroot().findall("emitter"):
        if emitter.get("type") != "envmap":
            raise Missing(f"no counterpart of the emitter {emitter.get('type')}")
        if emitter.find("transform") is not None:
            raise Missing("no counterpart of an environment map that is turned")
        scale = emitter.find("float[@name='scale']")
        return Path(path).parent / emitter.find("string[@name='filename']").get("value"), float(scale.get("value")) if scale is not None else 1.0
    return None


def read(path):
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    scene = mi.load_file(str(path))
    sensor = scene.sensors()[0]
    settings = {key: value for key, value in mi.traverse(sensor)}
    depth = {line.split("=")[0].strip(): int(line.split("=")[1].strip(" ,")) for line in str(scene.integrator()).splitlines() if "depth" in line}
    facts = Facts(np.array(sensor.world_transform().matrix), float(np.ravel(settings["x_fov"])[0]), tuple(sensor.film().size()),
                  depth["max_depth"], depth["rr_depth"], environment=environment_of(path))
    for shape in scene.shapes():
        vertices, faces, normals = geometry_of(mi, shape)
        radiance = color(dict(iter(mi.traverse(shape.emitter())))["radiance.value"]) if shape.emitter() else None
        facts.meshes.append(Mesh(vertices, faces, normals, material_of(mi, shape.bsdf()), radiance))
    return facts
