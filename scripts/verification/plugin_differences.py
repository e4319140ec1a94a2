"""Cases of plugins.py in closed form: named materials side by side, and where Mitsuba is known to differ, with the ratio derived."""

from math import cos, hypot, pi, radians, sin, sqrt

from plugin_scenes import Case, Point, Transform, Vector, bsdf, emitter, integrator, sensor, shape, texture

CONDUCTORS = """Ag Al AlAs AlAs_palik AlSb AlSb_palik Au Be Be_palik Cr CsI CsI_palik Cu Cu2O Cu2O_palik CuO CuO_palik Cu_palik Hg HgTe HgTe_palik
    Hg_palik Ir Ir_palik K K_palik Li Li_palik MgO MgO_palik Mo Mo_palik Na_palik Nb Nb_palik Ni_palik Rh Rh_palik Se Se-e Se-e_palik Se_palik SiC
    SiC_palik SnTe SnTe_palik Ta Ta_palik Te Te-e Te-e_palik Te_palik ThF4 ThF4_palik TiC TiC_palik TiN TiN_palik TiO2 TiO2-e TiO2-e_palik
    TiO2_palik VC VC_palik VN VN_palik V_palik W a-C d-C d-C_palik none""".split()
DIELECTRICS = """vacuum, helium, hydrogen, air, carbon dioxide, water, acetone, ethanol, carbon tetrachloride, glycerol, benzene, silicone oil, bromine,
    water ice, fused quartz, pyrex, acrylic glass, polypropylene, bk7, sodium chloride, amber, pet, diamond""".replace("\n   ", "").split(", ")

FACING = sensor.orthographic(to_world=Transform("lookat 0 0 3 0 0 0 0 1 0"))  # sees [-1, 1] of x at z = 0
EVEN = emitter.constant(radiance=1.0)
MATT = bsdf.diffuse(reflectance=0.8)
LAMP_ONLY = integrator.direct(emitter_samples=1, bsdf_samples=0)
LIMITLESS = integrator.path(max_depth=-1)


def side_by_side(materials):
    """Cards of all materials, seen 50 degrees from the side under an even sky, which shows what each sends back."""
    cards = [shape.rectangle(m, to_world=Transform("scale 0.12 0.06 1", "rotate y 50", f"translate {-0.9 + 0.2 * (i % 10)} {-0.58 + 0.165 * (i // 10)} 0"))
             for i, m in enumerate(materials)]
    return (*cards, EVEN)


def facing(*objects, at=0.0):
    """A card of a material that fills the picture, and other objects, none of which the camera sees."""
    material, *others = objects
    return (shape.rectangle(material, to_world=Transform("scale 4", f"translate 0 0 {at}")), *others)


def behind_camera(z, size, radiance, x=0.0):
    return shape.rectangle(emitter.area(radiance=radiance), to_world=Transform(f"scale {size}", "rotate y 180", f"translate {x} 0 {z}"))


def blended_mirror(weight, reflectance):
    """Mitsuba samples the mirror with probability 1 - weight and then divides by a sum of its probability and of the other's density,
    cos / pi at cosine 1; ours adds the two."""
    density = weight / pi
    mirror = (1 - weight) * (density * reflectance + (1 - weight)) / (density + (1 - weight))
    return (weight * reflectance + mirror) / (weight * reflectance + 1 - weight)


def turned_about_a_long_axis(degrees):
    """Cosine of the light from the front on a cube's face towards x that is turned about (1, 1, 0) and then to the front: Mitsuba's over ours.
    Such a matrix M shears. Normals of faces are M y x M z; Mitsuba takes M for the transpose of its own inverse, and M x for the normal."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    theirs, ours = (1.0, 1 - c, -s), (c + 1 - c * c, 1 - c, -(2 - c) * s)
    return theirs[0] / hypot(*theirs) * hypot(*ours) / ours[0]


VEIL = shape.rectangle(bsdf.mask(bsdf.diffuse(reflectance=0.0), opacity=0.5), to_world=Transform("scale 4", "rotate y 90", "translate 2 0 0"))
COVER = shape.rectangle(bsdf.twosided(bsdf.diffuse(reflectance=0.0)), to_world=Transform("scale 0.2", "translate -1.5 0 3.9968"))
SHADOWS = "masks cast whole shadows under lights that no path finds"
EXPECTED = [
    # derived ratio of Mitsuba's mean to ours, reason, integrator, objects
    (blended_mirror(0.5, 0.8), "blends divide a probability by a density", LIMITLESS, facing(bsdf.blendbsdf(bsdf.conductor(), MATT, weight=0.5), EVEN)),
    (blended_mirror(0.2, 0.8), "blends divide a probability by a density", LIMITLESS, facing(bsdf.blendbsdf(bsdf.conductor(), MATT, weight=0.2), EVEN)),
    (0.0, SHADOWS, LIMITLESS, facing(MATT, VEIL, emitter.point(position=Point(4, 0, 3), intensity=50.0))),
    (0.0, SHADOWS, LIMITLESS, facing(MATT, VEIL, emitter.directional(direction=Vector(-1, 0, -0.8), irradiance=5.0))),
    (0.0, SHADOWS, LIMITLESS, facing(MATT, VEIL, emitter.spot(to_world=Transform("lookat 4 0 3 0 0 0 0 1 0"), intensity=50.0, cutoff_angle=60.0))),
    (4.0, "`direct` divides what lights without extent bring by no number of samples", integrator.direct(emitter_samples=4, bsdf_samples=0),
     facing(MATT, emitter.point(position=Point(0, 0, 3), intensity=5.0))),
    (0.0, "a passage through a mask counts as a vertex", integrator.path(max_depth=2),
     facing(MATT, shape.rectangle(bsdf.mask(bsdf.diffuse(reflectance=0.0), opacity=0.5), to_world=Transform("scale 4", "translate 0 0 1")), behind_camera(4, 1, 5.0))),
    (0.5, "paths through nothing but masks count as background, with what the mask sent back", LIMITLESS,
     facing(bsdf.mask(MATT, opacity=0.5), behind_camera(6, 1, 5.0))),
    (None, "", integrator.volpath(), facing(bsdf.mask(MATT, opacity=0.5), behind_camera(6, 1, 5.0))),
    (turned_about_a_long_axis(80), "a rotation about an axis that is not of length one is taken for its own inverse's transpose", LAMP_ONLY,
     (shape.cube(MATT, to_world=Transform("rotate 1 1 0 80", "rotate y -90", "scale 4", "translate -3.94 -3.3 -12")),
      emitter.directional(direction=Vector(0, 0, -1), irradiance=3.0))),
    # The vertex normals are turned by 60 degrees, and their cosine takes the place of the face's.
    (0.5, "light samples of meshes take the cosine of the vertex normal", LAMP_ONLY,
     facing(MATT, shape.obj(emitter.area(radiance=1e5), filename="tilted.obj", to_world=Transform("scale 0.2", "rotate y 180", "translate 0 0 60")))),
    # Two equal quadrilaterals, which share their texture coordinates: Mitsuba's light samples find one of them.
    (0.5, "light samples of a texture that shows in several places find one of them", LAMP_ONLY,
     facing(MATT, shape.obj(emitter.area(radiance=texture.bitmap(filename="slide.png")), filename="twice.obj",
                            to_world=Transform("scale 2", "rotate y 180", "translate 0 0 60")))),
    # Mitsuba's light samples of textured cylinders that do not lie along z are not where their texture says; what finds them by chance is right.
    (None, "", integrator.direct(emitter_samples=0, bsdf_samples=4),
     facing(MATT, shape.cylinder(emitter.area(radiance=texture.bitmap(filename="slide.png")), p0=Point(-2, -1, 5), p1=Point(2, 1, 6), radius=1.5))),
    # Of two equal lamps the covered one shines there. Shadow rays stop 0.0009 of their length before it: 0.0036 / cos, behind the cover at 0.0032 / cos.
    (2.0, "shadow rays stop short of a light and miss what covers it", LAMP_ONLY,
     facing(MATT, behind_camera(4, 0.1, 500.0, -1.5), behind_camera(4, 0.1, 500.0, 1.5), COVER)),
]


def cases():
    yield Case("names", "conductors", side_by_side([bsdf.conductor(material=m) for m in CONDUCTORS]), parts={"sensor": FACING})
    yield Case("names", "rough conductors", side_by_side([bsdf.roughconductor(material=m, alpha=0.3) for m in CONDUCTORS]), parts={"sensor": FACING})
    yield Case("names", "int_ior", side_by_side([bsdf.dielectric(int_ior=m, specular_transmittance=0.0) for m in DIELECTRICS]), parts={"sensor": FACING})
    yield Case("names", "ext_ior", side_by_side([bsdf.plastic(ext_ior=m, diffuse_reflectance=(0.2, 0.5, 0.8)) for m in DIELECTRICS]), parts={"sensor": FACING})
    # Turned by a rotation, z has the cosine cos(40); by Mitsuba's matrix it is (s, -s, c), whose length is not one.
    front = emitter.directional(direction=Vector(0, 0, -1), irradiance=3.0)
    turned = shape.rectangle(MATT, to_world=Transform("rotate 1 1 0 40", "scale 6"))
    yield Case("closed form", "0.x, rotation about a long axis", (turned, front), ratio=1 / sqrt(1 + sin(radians(40)) ** 2),
               reason="0.x made axes one long", parts={"sensor": FACING, "version": "0.6.0"})
    for ratio, reason, tracer, objects in EXPECTED:
        yield Case("closed form", f"{objects[0].children[0]} under {objects[-1].plugin}, {tracer}", objects, ratio=ratio, reason=reason, parts={"sensor": FACING, "integrator": tracer})
