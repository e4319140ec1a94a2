"""The cases of plugins.py that are no BSDFs: one line each."""

from plugin_scenes import (LAMP, SKY, Case, Point, Ref, Spectrum, Transform, Vector, Xml, balls_and_card, bsdf, emitter, film,
                           integrator, lit, medium, painted, rfilter, sensor, shape, shaped, spectrum, texture)

PATTERN = bsdf.diffuse(reflectance=texture.bitmap(filename="paint.png"))
BOTH = bsdf.twosided(PATTERN)
TURNED = Transform("rotate 0 1 0 25", "translate 0 0.1 -0.3")
MIRRORED = Transform("scale -1 1 1", "rotate y 15")
SQUEEZED = Transform("scale 1 0.7 1.6", "rotate 0.6 0.8 0 30", "translate 0 0.3 0")
UP = Transform("translate 0 1 0")
SHINY = bsdf.roughconductor(alpha_u=0.1, alpha_v=0.4)

SHAPES = [
    *(shape.sphere(PATTERN, center=Point(0.2, 1.0, 0.3), radius=0.9, flip_normals=f) for f in (False, True)),
    shape.sphere(BOTH, to_world=Transform("scale 0.8", "rotate 1 0 0 50", "translate 0 1 0")),
    shape.sphere(BOTH, to_world=Transform("scale -0.8 0.8 0.8", "translate 0 1 0")),
    shape.sphere(PATTERN, to_world=Transform("scale -0.8 0.8 0.8", "translate 0 1 0")),
    shape.sphere(SHINY, to_world=Transform("scale 0.8", "rotate x -60", "translate 0 1 0")),
    shape.rectangle(PATTERN, to_world=Transform("rotate y 30", "translate 0 1.2 0")),
    shape.rectangle(PATTERN, to_world=Transform("rotate y 30", "translate 0 1.2 0"), flip_normals=True),
    shape.rectangle(PATTERN, to_world=Transform("rotate y 170", "translate 0 1.2 0"), flip_normals=True),
    shape.rectangle(BOTH, to_world=Transform("matrix 1 0.5 0 0 0 1 0 1.2 0 0.3 1 0 0 0 0 1")),
    shape.rectangle(PATTERN, to_world=Transform("scale -1 1 1", "translate 0 1.2 0")),
    shape.rectangle(SHINY, to_world=Transform("scale 1.2 0.6 1", "rotate z 30", "translate 0 1.2 0")),
    shape.cube(PATTERN, to_world=Transform("scale 0.7", "rotate 0.6 0.8 0 40", "translate 0 1.2 0")),
    shape.cube(PATTERN, to_world=Transform("scale 0.7", "translate 0 1.2 0"), flip_normals=True),
    shape.cube(PATTERN, to_world=Transform("scale -0.7 0.7 0.7", "rotate 0.6 0.8 0 40", "translate 0 1.2 0")),
    shape.cube(SHINY, to_world=Transform("scale 0.7 1 0.5", "rotate 0.6 0.8 0 40", "translate 0 1.2 0")),
    shape.disk(PATTERN, to_world=Transform("rotate y 20", "translate 0 1.2 0")),
    shape.disk(PATTERN, to_world=Transform("rotate y 20", "translate 0 1.2 0"), flip_normals=True),
    shape.disk(BOTH, to_world=Transform("scale 1.3 0.7 1", "rotate z 20", "translate 0 1.2 0")),
    shape.disk(PATTERN, to_world=Transform("scale -1 1 1", "translate 0 1.2 0")),
    shape.disk(SHINY, to_world=Transform("rotate y 20", "translate 0 1.2 0")),
    shape.cylinder(PATTERN, p0=Point(-0.8, 0.4, 0), p1=Point(0.9, 1.5, 0.3), radius=0.5),
    shape.cylinder(PATTERN, p0=Point(-0.8, 0.4, 0), p1=Point(0.9, 1.5, 0.3), radius=0.5, flip_normals=True),
    shape.cylinder(BOTH, to_world=Transform("scale 0.6 0.6 1.5", "rotate y 60", "translate -0.7 1 0")),
    shape.cylinder(PATTERN, to_world=Transform("scale -0.6 0.6 1.5", "rotate y 60", "translate -0.7 1 0")),
    shape.cylinder(SHINY, p0=Point(-0.8, 0.4, 0), p1=Point(0.9, 1.5, 0.3), radius=0.5),
    *(plugin(material, filename=f"{name}.{end}", **extra)
      for plugin, end in ((shape.obj, "obj"), (shape.ply, "ply")) for name in ("cloth", "bare")
      for material, extra in ((PATTERN, {}), (BOTH, {"to_world": SQUEEZED}), (PATTERN, {"flip_normals": True}),
                              (BOTH, {"face_normals": True}), (PATTERN, {"to_world": MIRRORED}))),
    shape.obj(PATTERN, filename="cloth.obj", flip_tex_coords=False),
    shape.ply(PATTERN, filename="cloth.ply", flip_tex_coords=True),
    shape.ply(SHINY, filename="cloth.ply", to_world=SQUEEZED),
    shape.ply(SHINY, filename="bare.ply", face_normals=True),
    shape.ply(PATTERN, filename="cloth.ply", face_normals=True, flip_normals=True),
    shape.serialized(PATTERN, filename="cloth.serialized"),
    shape.serialized(BOTH, filename="cloth.serialized", shape_index=1),
    shape.serialized(BOTH, filename="cloth.serialized", face_normals=True, to_world=TURNED),
    shape.serialized(PATTERN, filename="cloth.serialized", shape_index=1, flip_normals=True),
]

GROUP = shape.shapegroup(shape.sphere(BOTH, center=Point(0, 0.5, 0), radius=0.4), shape.ply(BOTH, filename="bare.ply", to_world=Transform("scale 0.5")),
                         shape.cylinder(SHINY, p0=Point(0.5, 0, 0), p1=Point(0.6, 1, 0), radius=0.15), id="group")
INSTANCES = [
    (shape.instance(Ref("group")),),
    (shape.instance(Ref("group"), to_world=Transform("scale 1.4 0.8 1", "rotate 0 1 0 40", "translate -0.8 0.4 0")),
     shape.instance(Ref("group"), to_world=Transform("scale -1 1.2 1", "rotate z 20", "translate 0.9 0.3 0"))),
    (shape.merge(shape.ply(BOTH, filename="cloth.ply"), shape.merge(shape.cube(BOTH, to_world=UP), shape.sphere(PATTERN))),),
    (shape.instance(Ref("group"), to_world=Transform("matrix 1 0.4 0 0 0 1 0.2 0.2 0.3 0 1 0 0 0 0 1")),),
]

TEXTURES = [
    texture.bitmap(filename="paint.png"),
    texture.bitmap(filename="paint.exr"),
    texture.bitmap(filename="paint.png", raw=True),
    texture.bitmap(filename="grey.png"),
    texture.bitmap(filename="paint.png", filter_type="nearest"),
    *(texture.bitmap(filename="paint.png", wrap_mode=w, filter_type=f, to_uv=Transform("scale 2.3 1.7 1", "rotate z 20", "translate 0.2 -0.4 0"))
      for w in ("repeat", "mirror", "clamp") for f in ("bilinear", "nearest")),
    texture.bitmap(filename="paint.png", format="fp16"),
    texture.bitmap(filename="paint.png", accel=False),
    *(texture.bitmap(filename=name) for name in ("form.png", "form.jpg", "form.ppm", "form.bmp", "form.tga", "form.hdr", "form.pfm", "alpha.png", "deep.png",
                                                 "half.exr", "luminance.exr")),
    texture.bitmap(filename="form.jpg", raw=True), texture.bitmap(filename="deep.png", raw=True), texture.bitmap(filename="half.exr", raw=True),
    texture.bitmap(filename="paint.png", to_uv=Transform("matrix 2 1 0 0.3 0.5 3 0 0.1 0 0 1 0 0 0 0 1")),
    texture.checkerboard(),
    texture.checkerboard(color0=(0.8, 0.2, 0.1), color1=(0.1, 0.3, 0.7), to_uv=Transform("scale 3 5 1", "rotate z 30")),
    texture.checkerboard(color0=0.9, color1=0.1, to_uv=Transform("translate 0.3 0.1 0", "scale 4")),
]
ATTRIBUTES = [bsdf.twosided(bsdf.diffuse(reflectance=texture.mesh_attribute(name="vertex_color"))),
              bsdf.twosided(bsdf.diffuse(reflectance=texture.mesh_attribute(name="face_color", scale=0.6))),
              bsdf.twosided(bsdf.roughconductor(alpha=texture.mesh_attribute(name="vertex_shine"))),
              bsdf.twosided(bsdf.roughconductor(alpha=texture.mesh_attribute(name="face_shine"), distribution="ggx"))]

DOWN = Transform("lookat 1.5 4 2 0 0.5 0 0 1 0.2")
SLIDE = texture.bitmap(filename="slide.png")
LIGHTS = [
    *((shape.rectangle(emitter.area(radiance=r), to_world=Transform("rotate x 90", "rotate y 30", "translate 0.4 3 0.5")),)
      for r in (4.0, (4.0, 3.0, 2.0), SLIDE, texture.checkerboard(color0=0.9, color1=0.2, to_uv=Transform("scale 3")))),
    (shape.sphere(emitter.area(radiance=(9.0, 5.0, 3.0)), center=Point(1, 2.4, 1), radius=0.4),),
    (shape.sphere(emitter.area(radiance=SLIDE), center=Point(1, 2.4, 1), radius=0.6),),
    (shape.disk(emitter.area(radiance=SLIDE), to_world=Transform("scale 1.4 0.7 1", "rotate x 100", "translate 0 3 0")),),
    (shape.cylinder(emitter.area(radiance=SLIDE), p0=Point(0.3, 2.5, -1), p1=Point(0.3, 2.5, 1), radius=0.3),),
    (shape.cylinder(emitter.area(radiance=3.0), p0=Point(-1, 2.5, 1), p1=Point(1, 2.7, 1), radius=0.8, flip_normals=True),),
    (shape.cube(emitter.area(radiance=(4.0, 3.0, 2.0)), to_world=Transform("scale 0.4", "rotate 0.6 0.8 0 40", "translate 0 2.6 1")),),
    (shape.obj(emitter.area(radiance=SLIDE), filename="cloth.obj", face_normals=True, to_world=Transform("rotate x 100", "translate 0 2.6 -1")),),
    (shape.rectangle(emitter.area(radiance=3.0), bsdf.diffuse(reflectance=0.6), to_world=Transform("rotate x 70", "translate 0.4 3 -1")),),
    (emitter.constant(radiance=1.0),), (emitter.constant(radiance=(0.3, 0.5, 0.9)),), (emitter.constant(),),
    (emitter.envmap(filename="sky.exr"),), (emitter.envmap(filename="sky.exr", scale=2.5),),
    (emitter.envmap(filename="sky.exr", to_world=Transform("rotate y 70")),),
    (emitter.envmap(filename="sky.exr", to_world=Transform("rotate 0.6 0.8 0 130")),),
    (emitter.envmap(filename="sky.exr", to_world=Transform("scale -1 1 1", "rotate x 30")),),
    (emitter.envmap(filename="sky.exr", mis_compensation=True),), (emitter.envmap(filename="paint.png"),),
    (emitter.point(position=Point(1, 3, 2), intensity=(9.0, 8.0, 5.0)),),
    (emitter.point(to_world=Transform("translate -1 3 1"), intensity=9.0),),
    (emitter.spot(to_world=DOWN, intensity=(20.0, 15.0, 10.0)),),
    *((emitter.spot(to_world=DOWN, intensity=20.0, cutoff_angle=c, beam_width=b),) for c, b in ((30.0, 10.0), (50.0, 49.0), (80.0, 0.5))),
    (emitter.spot(to_world=DOWN, intensity=20.0, cutoff_angle=40.0),),
    (emitter.spot(to_world=DOWN, intensity=20.0, cutoff_angle=35.0, texture=SLIDE),),
    (emitter.spot(to_world=DOWN, intensity=20.0, cutoff_angle=35.0, texture=texture.checkerboard(to_uv=Transform("scale 5"))),),
    (emitter.directional(direction=Vector(-0.4, -1, -0.3), irradiance=(2.0, 1.5, 1.0)),),
    (emitter.directional(to_world=DOWN, irradiance=2.0),),
    (emitter.projector(to_world=DOWN, irradiance=SLIDE),),
    (emitter.projector(to_world=DOWN, irradiance=SLIDE, scale=3.0, fov=35.0),),
    *((emitter.projector(to_world=DOWN, irradiance=SLIDE, fov=35.0, fov_axis=a),) for a in ("y", "diagonal", "smaller", "larger")),
    (emitter.projector(to_world=DOWN, irradiance=SLIDE, focal_length="70mm"),),
    (emitter.projector(to_world=DOWN, irradiance=(3.0, 2.0, 1.0), fov=30.0),),
    (emitter.projector(to_world=DOWN, irradiance=texture.bitmap(filename="slide.png", raw=True, filter_type="nearest", to_uv=Transform("scale 2 1 1")), fov=40.0),),
    *((emitter.point(position=Point(1, 3, 2), intensity=5.0, sampling_weight=w), emitter.spot(to_world=DOWN, sampling_weight=w),
       emitter.constant(radiance=0.2)) for w in (0.0, 3.0)),
    (emitter.point(position=Point(1, 3, 2), intensity=5.0), emitter.constant(radiance=0.2, sampling_weight=0.0)),
    (shape.disk(emitter.area(radiance=3.0, sampling_weight=0.0), to_world=Transform("scale 1.5", "rotate x 90", "translate 0 3 0")), emitter.constant(radiance=0.2)),
    (emitter.point(position=Point(1, 3, 2), intensity=5.0), emitter.directional(direction=Vector(0.5, -1, -0.2)), emitter.constant(radiance=0.2)),
]

SENSORS = [
    sensor.perspective(), sensor.perspective(fov=60.0), sensor.perspective(focal_length="35mm"), sensor.perspective(focal_length="80"),
    *(sensor.perspective(fov=40.0, fov_axis=a) for a in ("x", "y", "diagonal", "smaller", "larger")),
    sensor.perspective(fov=40.0, principal_point_offset_x=0.2, principal_point_offset_y=-0.15),
    sensor.perspective(fov=40.0, near_clip=5.5, far_clip=7.0),
    sensor.perspective(fov=40.0, to_world=Transform("scale -1 1 1", "lookat 0.3 1.6 6 0 0.9 0 0 1 0")),
    sensor.perspective(fov=40.0, to_world=Transform("lookat 3 1.6 5 0 0.9 0 0.3 1 0")),
    sensor.thinlens(fov=40.0, aperture_radius=0.3, focus_distance=5.0),
    sensor.thinlens(fov=40.0, aperture_radius=0.2, focus_distance=7.0, fov_axis="y"),
    sensor.thinlens(focal_length="70mm", aperture_radius=0.1, focus_distance=6.0),
    sensor.thinlens(fov=40.0, aperture_radius=0.0, focus_distance=5.0),
    sensor.thinlens(fov=40.0, aperture_radius=0.3, focus_distance=5.0, near_clip=5.5, far_clip=7.0),
    sensor.orthographic(to_world=Transform("scale 3 3 1", "lookat 0.3 1.6 6 0 0.9 0 0 1 0")),
    sensor.orthographic(to_world=Transform("scale 3 2 1", "lookat 0.3 1.6 6 0 0.9 0 0 1 0"), near_clip=5.5, far_clip=7.0),
]

FLAT = sensor.orthographic(to_world=Transform("scale 30 30 1", "lookat 0 0 60 0 0 0 0 1 0"))

FILTERS = [rfilter.box(), rfilter.tent(), rfilter.tent(radius=2.0), rfilter.gaussian(), rfilter.gaussian(stddev=1.0), rfilter.gaussian(stddev=0.25),
           rfilter.mitchell(), rfilter.mitchell(B=0.0, C=0.75), rfilter.mitchell(B=1.0, C=0.0), rfilter.catmullrom(), rfilter.lanczos(), rfilter.lanczos(lobes=2)]
FILMS = [film.hdrfilm(width=40, height=40), film.hdrfilm(crop_width=16, crop_height=16, crop_offset_x=16, crop_offset_y=8),
         film.hdrfilm(rfilter.gaussian(), sample_border=True, crop_width=16, crop_height=16, crop_offset_x=24, crop_offset_y=8),
         film.hdrfilm(pixel_format="rgba", component_format="float32")]

LAYERS = "a:albedo,d:depth,p:position,u:uv,g:geo_normal,n:sh_normal,s:dp_du,t:dp_dv"
INTEGRATORS = [
    *(integrator.path(max_depth=n) for n in (0, 1, 2, 3, -1)), integrator.path(), integrator.path(max_depth=8, rr_depth=2),
    integrator.path(max_depth=4, hide_emitters=True), integrator.direct(), integrator.direct(hide_emitters=True), integrator.direct(shading_samples=4),
    integrator.direct(emitter_samples=4, bsdf_samples=0), integrator.direct(emitter_samples=0, bsdf_samples=4), integrator.direct(emitter_samples=2, bsdf_samples=1),
    integrator.volpath(max_depth=4), integrator.volpathmis(max_depth=4), integrator.volpath(max_depth=4, rr_depth=2, hide_emitters=True),
    integrator.prb(max_depth=4), integrator.prb_basic(), integrator.prbvolpath(max_depth=4),
    integrator.aov(aovs=LAYERS), integrator.aov(integrator.path(max_depth=4), aovs=LAYERS), integrator.aov(integrator.direct(), aovs="x:uv"),
    integrator.moment(integrator.path(max_depth=4)), integrator.moment(integrator.aov(integrator.direct(), aovs="d:depth")),
]

COLOURS = ["400:0.1, 500:0.2, 600:0.9, 700:0.4", "360:0.2, 830:0.8", "0.6", "500:1, 501:0", "450:0.9, 600:0.1"]
INDICES = ["1.5", "400:1.6, 700:1.2"]
SPECTRA = [
    *(bsdf.diffuse(reflectance=Spectrum(c)) for c in COLOURS), bsdf.diffuse(reflectance=Spectrum(filename="green.spd")),
    bsdf.diffuse(reflectance=spectrum.uniform(value=0.4)), bsdf.diffuse(reflectance=spectrum.srgb(color=(0.2, 0.4, 0.7))),
    bsdf.diffuse(reflectance=spectrum.rawconstant(value=0.4)), bsdf.diffuse(reflectance=spectrum.rawconstant(value=Vector(0.4, 0.2, 0.6))),
    bsdf.diffuse(reflectance=spectrum.irregular(wavelengths="400, 500, 700", values="0.1, 0.9, 0.3")),
    bsdf.diffuse(reflectance=spectrum.regular(wavelength_min=400.0, wavelength_max=700.0, values="0.1, 0.9, 0.3")),
    *(bsdf.conductor(eta=Spectrum(c), k=Spectrum(c)) for c in INDICES),
]
EMISSION = [Spectrum("2"), Spectrum("400:1, 500:3, 600:2, 700:4"), Spectrum(filename="green.spd"), (0.5, 2.0, 3.0), spectrum.d65(), spectrum.d65(scale=3.0),
            spectrum.d65(color=(0.4, 0.2, 0.9), scale=2.0), spectrum.d65(SLIDE), spectrum.uniform(value=2.0), spectrum.blackbody(temperature=4000.0),
            spectrum.rawconstant(value=2.0), spectrum.srgb(color=(0.3, 0.9, 0.2))]

CLEAR_BALL = {"center": Point(0, 1, 0.3), "radius": 0.9}
MEDIA = [
    shape.sphere(bsdf.null(), interior=medium.homogeneous(albedo=0.0, sigma_t=(0.2, 0.5, 1.0), scale=1.5), **CLEAR_BALL),
    shape.sphere(bsdf.dielectric(), interior=medium.homogeneous(albedo=0.0, sigma_t=(0.2, 0.5, 1.0), scale=0.7), **CLEAR_BALL),
    shape.sphere(bsdf.roughdielectric(alpha=0.2), interior=medium.homogeneous(albedo=0.0, sigma_t=0.8), **CLEAR_BALL),
    shape.cube(bsdf.dielectric(), interior=medium.homogeneous(albedo=0.0, sigma_t=0.8), to_world=Transform("scale 0.7", "rotate 0.6 0.8 0 40", "translate 0 1.2 0")),
]


# Ways to write the same.
BALL = '<point name="center" x="0" y="1" z="0"/>'
FORMS = {
    "matrix of 9 numbers": '<shape type="cube"><transform name="to_world"><matrix value="0.6 0.2 0  0 0.7 0.1  0.3 0 0.5"/><translate y="1.2"/></transform></shape>',
    "values of vectors": '<shape type="sphere"><point name="center" value="0.2, 1.1, 0.1"/><transform name="to_world"><scale value="0.8 0.8 0.8"/>'
                         '<translate value="0.1, 0.2, 0.3"/></transform></shape>',
    "rotation by value": '<shape type="cube"><transform name="to_world"><scale value="0.6"/><rotate value="0.6, 0.8, 0" angle="40"/><translate y="1.2"/></transform></shape>',
    "lookat of a shape": '<shape type="rectangle"><transform name="to_world"><lookat origin="0, 1, 0" target="1, 2, 6" up="0, 1, 0"/></transform></shape>',
    "lookat without up": '<shape type="cube"><transform name="to_world"><scale value="0.6"/><lookat origin="0, 1, 0" target="1, 2, 6"/></transform></shape>',
    "colour in hexadecimal": f'<shape type="sphere">{BALL}<bsdf type="diffuse"><rgb name="reflectance" value="#ff8040"/></bsdf></shape>',
    "one number as colour": f'<shape type="sphere">{BALL}<bsdf type="diffuse"><rgb name="reflectance" value="0.3"/></bsdf></shape>',
    "number as colour": f'<shape type="sphere">{BALL}<bsdf type="diffuse"><float name="reflectance" value="0.3"/></bsdf></shape>',
    "whole numbers as real": f'<shape type="sphere">{BALL}<integer name="radius" value="1"/><bsdf type="roughconductor"><integer name="alpha" value="1"/></bsdf></shape>',
    "defaults": f'<default name="r" value="0.7"/><shape type="sphere">{BALL}<float name="radius" value="$r"/></shape>',
    "an alias": f'<bsdf type="diffuse" id="a"><rgb name="reflectance" value="0.7, 0.2, 0.1"/></bsdf><alias id="a" as="b"/><shape type="sphere">{BALL}<ref id="b"/></shape>',
    "axes of another length": '<shape type="rectangle"><transform name="to_world"><rotate x="1" y="1" angle="40"/><translate y="1.2"/></transform></shape>',
}

# Files of 0.x: what stands among floor, lamp and sky, whose own names are those of both.
OLD = {
    "camelCase, lookAt": ('<shape type="sphere"><transform name="toWorld"><scale value="0.8"/><translate y="1"/></transform>'
                             '<boolean name="flipNormals" value="false"/><bsdf type="plastic"><rgb name="diffuseReflectance" value="0.6, 0.2, 0.1"/>'
                             '<float name="intIOR" value="1.7"/><string name="extIOR" value="water"/></bsdf></shape>'),
    "diffuseReflectance of diffuse": ('<shape type="sphere"><point name="center" x="0" y="1" z="0"/><bsdf type="diffuse">'
                                         '<rgb name="diffuseReflectance" value="0.6, 0.2, 0.1"/></bsdf></shape>'),
    "uscale, voffset": ('<shape type="sphere"><point name="center" x="0" y="1" z="0"/><bsdf type="diffuse"><texture name="reflectance" type="bitmap">'
                           '<string name="filename" value="paint.png"/><float name="uscale" value="3"/><float name="vscale" value="2"/>'
                           '<float name="voffset" value="0.3"/><string name="wrapMode" value="mirror"/><string name="filterType" value="nearest"/></texture></bsdf></shape>'),
    "alphaU": ('<shape type="sphere"><point name="center" x="0" y="1" z="0"/><bsdf type="roughconductor"><float name="alphaU" value="0.1"/>'
                  '<float name="alphaV" value="0.4"/><string name="material" value="Au"/></bsdf></shape>'),
    "phong": '<shape type="sphere"><point name="center" x="0" y="1" z="0"/><bsdf type="phong"/></shape>',
    "ward": '<shape type="sphere"><point name="center" x="0" y="1" z="0"/><bsdf type="ward"/></shape>',
}


def cases():
    def of(group, scene, entries, **options):
        for entry in entries:
            yield Case(group, ", ".join(map(repr, entry)) if isinstance(entry, tuple) else repr(entry), scene(entry), **options)

    yield from of("shape", shaped, SHAPES)
    yield from of("shape", lambda instances: shaped(GROUP, *instances), INSTANCES)
    yield from of("texture", painted, TEXTURES)
    yield from of("texture", lambda b: shaped(shape.ply(b, filename="cloth.ply")), ATTRIBUTES)
    yield from of("emitter", lambda lights: lit(*lights), LIGHTS)
    for part, entries in (("sensor", SENSORS), ("integrator", INTEGRATORS)):
        for entry in entries:
            yield Case(part, repr(entry), balls_and_card(bsdf.twosided(bsdf.roughplastic(diffuse_reflectance=texture.bitmap(filename="paint.png"), alpha=0.2))), parts={part: entry})
    # Mitsuba's partial derivatives are NaN where nothing is hit: a wall fills the picture. Parallel rays, as it shortens its steps
    # along unit directions rather than along the film; differences of places a seventh of a pixel apart have fewer digits.
    wall = shape.rectangle(bsdf.diffuse(), to_world=Transform("scale 30 40 1", "rotate y 20", "translate 0 0 -4"))
    screen = shape.rectangle(bsdf.diffuse(), to_world=Transform("scale 100", "rotate z 30", "rotate y 20"))
    partials = integrator.aov(integrator.direct(), aovs="y:duv_dx,z:duv_dy")
    yield Case("integrator", repr(partials), (screen, LAMP), parts={"integrator": partials, "sensor": FLAT}, rounding=1e-4)
    # Light that finds the camera finds few of the pixels behind glossy things, where no test of means holds.
    yield Case("integrator", "ptracer(max_depth=5)", lit(LAMP), parts={"integrator": integrator.ptracer(max_depth=5)})
    for axis in ("x", "y", "diagonal", "smaller", "larger"):
        yield Case("sensor", f"fov_axis {axis} of a tall film", lit(LAMP), parts={"sensor": sensor.perspective(fov=40.0, fov_axis=axis), "film": film.hdrfilm(width=32, height=48)})
    yield Case("sensor", "focal_length, tall, principal point, crop", lit(LAMP), parts={
        "sensor": sensor.perspective(focal_length="60mm", principal_point_offset_x=0.1, principal_point_offset_y=0.2),
        "film": film.hdrfilm(width=32, height=48, crop_width=16, crop_height=32, crop_offset_x=8, crop_offset_y=16)})
    # Samples beyond the edges are what decides whether both weigh the same places there. With the wall no pixel is black but for rare
    # samples at a filter's end.
    for entry in FILTERS:
        yield Case("filter", repr(entry), lit(LAMP, wall), parts={"film": film.hdrfilm(entry, sample_border=True)})
    for entry in FILMS:
        yield Case("film", repr(entry), lit(LAMP, SKY), parts={"film": entry})
    yield from of("spectrum", balls_and_card, SPECTRA)
    yield from of("spectrum", lambda r: lit(shape.rectangle(emitter.area(radiance=r), to_world=Transform("rotate x 90", "translate 0.4 3 0.5"))), EMISSION)
    yield from of("medium", shaped, MEDIA, parts={"integrator": integrator.volpath(max_depth=8)})
    yield from of("medium", shaped, MEDIA[:2], parts={"integrator": integrator.volpathmis(max_depth=8)})
    for name, text in FORMS.items():
        yield Case("form", name, shaped(Xml(text)))
    for name, text in OLD.items():
        yield Case("0.x", name, shaped(Xml(text)), parts={"version": "0.6.0"})
