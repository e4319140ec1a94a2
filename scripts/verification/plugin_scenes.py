"""Scenes of Mitsuba as Python values, and the places of the test scenes where a plugin stands."""

import xml.sax.saxutils as sax
from dataclasses import dataclass, field
from typing import NamedTuple, Optional


class Point(NamedTuple):
    x: float
    y: float
    z: float


class Vector(NamedTuple):
    x: float
    y: float
    z: float


class Spectrum(NamedTuple):
    """<spectrum> of a constant, of wavelength:value pairs, or of a file."""

    value: str = ""
    filename: str = ""


class Transform:
    """Operations in their order, such as "rotate y 30", "scale 2 1 1", "translate 0 1 0", "lookat 0 1 5 0 0 0 0 1 0"."""

    def __init__(self, *operations):
        self.operations = operations

    def __repr__(self):
        return "[" + ", ".join(self.operations) + "]"

    def xml(self, name):
        return f'<transform name="{name}">' + "".join(map(self._operation, self.operations)) + "</transform>"

    @staticmethod
    def _operation(text):
        kind, *values = text.split()
        if kind == "lookat":
            groups = zip(("origin", "target", "up"), (values[0:3], values[3:6], values[6:9]))
            return "<lookat " + " ".join(f'{key}="{", ".join(v)}"' for key, v in groups) + "/>"
        if kind == "matrix":
            return f'<matrix value="{" ".join(values)}"/>'
        if kind == "rotate":
            *axis, angle = values
            axis = dict(zip("xyz", axis)) if len(axis) == 3 else {axis[0]: "1"}
            return "<rotate " + " ".join(f'{k}="{v}"' for k, v in axis.items()) + f' angle="{angle}"/>'
        if len(values) == 1:
            return f'<{kind} value="{values[0]}"/>'
        return f"<{kind} " + " ".join(f'{k}="{v}"' for k, v in zip("xyz", values)) + "/>"


class Node:
    """An object: its kind (tag), its plugin, nested objects without a name, and properties, some of them nested objects."""

    def __init__(self, kind, plugin, *children, **properties):
        self.kind, self.plugin, self.children, self.properties = kind, plugin, children, properties

    def __repr__(self):
        inner = [repr(child) for child in self.children] + [f"{k}={_text(v)}" for k, v in self.properties.items()]
        return self.plugin + (f"({', '.join(inner)})" if inner else "")

    def xml(self, name=None):
        properties = dict(self.properties)
        head = f'<{self.kind} type="{self.plugin}"' + (f' name="{name}"' if name else "")
        if "id" in properties:
            head += f' id="{properties.pop("id")}"'
        inner = "".join(_property(key, value) for key, value in properties.items())
        return f"{head}>{inner}{''.join(child.xml() for child in self.children)}</{self.kind}>"


class Ref(NamedTuple):
    id: str

    def xml(self, name=None):
        return f'<ref id="{self.id}"' + (f' name="{name}"' if name else "") + "/>"


class Xml(NamedTuple):
    """Text of a scene file as it is."""

    text: str

    def xml(self, _name=None):
        return self.text


def _text(value):
    if isinstance(value, (Point, Vector)) or (isinstance(value, tuple) and not isinstance(value, (Spectrum, Ref))):
        return "(" + " ".join(f"{x:g}" for x in value) + ")"
    if isinstance(value, Spectrum):
        return value.filename or value.value
    return value if isinstance(value, str) else f"{value:g}" if isinstance(value, float) else repr(value)


def _property(name, value):
    if isinstance(value, (Node, Transform, Ref)):
        return value.xml(name)
    if isinstance(value, (Point, Vector)):
        return f'<{type(value).__name__.lower()} name="{name}" x="{value.x}" y="{value.y}" z="{value.z}"/>'
    if isinstance(value, Spectrum):
        key, text = ("filename", value.filename) if value.filename else ("value", value.value)
        return f'<spectrum name="{name}" {key}="{text}"/>'
    if isinstance(value, tuple):
        return f'<rgb name="{name}" value="{", ".join(map(str, value))}"/>'
    tag = {bool: "boolean", int: "integer", float: "float", str: "string"}[type(value)]
    text = str(value).lower() if isinstance(value, bool) else sax.escape(str(value), {'"': "&quot;"})
    return f'<{tag} name="{name}" value="{text}"/>'


class Kind:
    """`bsdf.diffuse(...)` is the node of that plugin."""

    def __init__(self, tag):
        self.tag = tag

    def __getattr__(self, plugin):
        return lambda *children, **properties: Node(self.tag, plugin, *children, **properties)


bsdf, shape, texture, emitter, sensor, film, rfilter, integrator, medium, spectrum, sampler = map(
    Kind, "bsdf shape texture emitter sensor film rfilter integrator medium spectrum sampler".split())


@dataclass
class Case:
    """A scene to compare. `ratio`: of Mitsuba's mean to ours where the two are known to differ, as derived for `reason`."""

    group: str
    name: str
    objects: tuple
    ratio: Optional[float] = None
    reason: str = ""
    spp: int = 48
    rounding: float = 1e-5  # by how much, relatively, values may differ that have no noise
    parts: dict = field(default_factory=dict)  # parts of the scene in place of the usual ones

    def xml(self):
        parts = {**PARTS, **self.parts}
        camera = parts["sensor"]
        properties = dict(camera.properties)
        properties.setdefault("to_world", VIEW)
        film_node = parts["film"]
        if not any(isinstance(child, Node) and child.kind == "rfilter" for child in film_node.children):
            film_node = Node("film", film_node.plugin, *film_node.children, rfilter.box(), **film_node.properties)
        size = {"width": WIDTH, "height": HEIGHT, "component_format": "float32", **film_node.properties}
        film_node = Node("film", film_node.plugin, *film_node.children, **size)
        camera = Node("sensor", camera.plugin, *camera.children, film_node, sampler.independent(sample_count=self.spp), **properties)
        objects = (parts["integrator"], camera, *self.objects)
        return f'<scene version="{parts["version"]}">\n' + "\n".join(o.xml() for o in objects) + "\n</scene>\n"


WIDTH, HEIGHT = 48, 32
VIEW = Transform("lookat 0.3 1.6 6 0 0.9 0 0 1 0")
PARTS = {"version": "3.0.0", "integrator": integrator.path(max_depth=5), "sensor": sensor.perspective(fov=40.0), "film": film.hdrfilm()}

# What stands in the test scenes: a floor, a lamp, an environment that is brighter on one side, none of it symmetric.
FLOOR = shape.rectangle(bsdf.diffuse(reflectance=texture.checkerboard(color0=(0.7, 0.6, 0.5), color1=(0.2, 0.25, 0.3), to_uv=Transform("scale 5"))),
                        to_world=Transform("rotate x -90", "scale 6"))
LAMP = shape.rectangle(emitter.area(radiance=(5.0, 4.0, 3.0)), to_world=Transform("rotate x 90", "rotate z 20", "scale 0.8", "translate 1 4 1"))
SKY = emitter.envmap(filename="sky.exr")


def balls_and_card(material):
    """A sphere, a card seen from its front and a disk seen from behind, all of one material."""
    shared = Node(material.kind, material.plugin, *material.children, id="tested", **material.properties)
    return (shared,
            shape.sphere(Ref("tested"), center=Point(-1.3, 0.9, 0.3), radius=0.85),
            shape.rectangle(Ref("tested"), to_world=Transform("scale 0.7 0.9 1", "rotate x -20", "rotate y -25", "translate 0.5 0.95 0")),
            shape.disk(Ref("tested"), to_world=Transform("scale 0.7", "rotate y 150", "translate 2 0.9 0.2")),
            FLOOR, LAMP, SKY)


def painted(paint):
    """A texture on a sphere, a card and a cylinder."""
    paint = Node(paint.kind, paint.plugin, *paint.children, id="paint", **paint.properties)
    return balls_and_card(bsdf.twosided(bsdf.diffuse(reflectance=paint)))


def shaped(*shapes):
    """Shapes over the floor, beneath lamp and sky."""
    return (*shapes, FLOOR, LAMP, SKY)


def lit(*lights):
    """Matt and glossy things beneath lights."""
    return (*lights, FLOOR,
            shape.sphere(bsdf.diffuse(reflectance=(0.6, 0.5, 0.3)), center=Point(-1.2, 0.8, 0.0), radius=0.8),
            shape.cube(bsdf.roughplastic(alpha=0.3), to_world=Transform("scale 0.6", "rotate y 35", "translate 1 0.6 0.2")))
