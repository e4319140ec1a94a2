"""Scenes too large or too regular to keep as files, written by the same random numbers each time.

    room_500       a room lit by 250 small panels, two triangles each, of radiances 1 to 100
    room_50000     a hall lit by 50,000 triangles: 50 meshes of 1000, each of its own colour
    caustics       a small lamp over a glass ball and a glass block
    sun_and_sky    a displaced mesh of half a million triangles under a sky with the sun in it
"""

import numpy as np

from common import WORK

HEADER = """<scene version="3.0.0">
    <integrator type="path"><integer name="max_depth" value="{depth}"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="{fov}"/>
        <transform name="to_world"><lookat origin="{eye}" target="{target}" up="0, 1, 0"/></transform>
        <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
        <film type="hdrfilm">
            <integer name="width" value="256"/><integer name="height" value="256"/><rfilter type="box"/>
        </film>
    </sensor>
"""


def rgb(name, value):
    return f'<rgb name="{name}" value="{", ".join(f"{v:.4g}" for v in np.broadcast_to(value, 3))}"/>'


def diffuse(reflectance):
    return f'<bsdf type="twosided"><bsdf type="diffuse">{rgb("reflectance", reflectance)}</bsdf></bsdf>'


def emitter(radiance):
    return f'<emitter type="area">{rgb("radiance", radiance)}</emitter>'


def cube(centre, half, bsdf):
    scale = " ".join(f'{axis}="{v:g}"' for axis, v in zip("xyz", half))
    move = " ".join(f'{axis}="{v:g}"' for axis, v in zip("xyz", centre))
    return f'<shape type="cube"><transform name="to_world"><scale {scale}/><translate {move}/></transform>{bsdf}</shape>\n'


def mesh(folder, name, vertices, triangles, inside):
    """A binary PLY file and the shape that names it."""
    record = np.dtype([("n", "u1"), ("i", "<i4", 3)])
    faces = np.zeros(len(triangles), record)
    faces["n"], faces["i"] = 3, triangles
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    with open(folder / f"{name}.ply", "wb") as file:
        file.write(head.encode() + np.asarray(vertices, "<f4").tobytes() + faces.tobytes())
    return (f'<shape type="ply"><string name="filename" value="{name}.ply"/>'
            f'<boolean name="face_normals" value="true"/>{inside}</shape>\n')


def panels(random, count, low, high, size):
    """`count` triangles about as large as `size`, turned at random, their centres evenly in a box."""
    centre = random.uniform(low, high, (count, 1, 3))
    corners = random.normal(size=(count, 3, 3)) * size
    return (centre + corners - corners.mean(axis=1, keepdims=True)).reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def furnished_room(random, half, height, pillars):
    out = [cube((0, -0.05, 0), (half, 0.05, half), diffuse((0.5, 0.45, 0.4))),
           cube((0, height + 0.05, 0), (half, 0.05, half), diffuse(0.7))]
    for sign in (-1, 1):
        out.append(cube((sign * (half + 0.05), height / 2, 0), (0.05, height / 2, half), diffuse((0.6, 0.6, 0.5))))
        out.append(cube((0, height / 2, sign * (half + 0.05)), (half, height / 2, 0.05), diffuse((0.5, 0.6, 0.6))))
    for _ in range(pillars):
        x, z = random.uniform(-0.8 * half, 0.8 * half, 2)
        tall = random.uniform(0.2, 0.75) * height
        out.append(cube((x, tall / 2, z), (0.04 * half, tall / 2, 0.04 * half), diffuse(random.uniform(0.2, 0.7, 3))))
    return "".join(out)


def room_500(folder):
    random = np.random.default_rng(500)
    text = HEADER.format(depth=8, fov=60, eye="-4.4, 1.7, -4.4", target="0.5, 1, 0.5") + furnished_room(random, 5, 3, 24)
    for i in range(250):
        # A panel of 0.1 x 0.1 close below the ceiling or upright near the floor.
        x, z = random.uniform(-4.8, 4.8, 2)
        y = random.choice([2.9, random.uniform(0.1, 2.5)])
        turn = "" if y == 2.9 else f'<rotate y="1" angle="{random.uniform(0, 360):.3f}"/>'
        tilt = '<rotate x="1" angle="90"/>' if y == 2.9 else ""
        radiance = np.exp(random.uniform(0, np.log(100))) * random.uniform(0.4, 1, 3)
        text += (f'<shape type="rectangle"><transform name="to_world"><scale value="0.05"/>{tilt}{turn}'
                 f'<translate x="{x:.4f}" y="{y:.4f}" z="{z:.4f}"/></transform>{emitter(radiance)}</shape>\n')
    return text


def room_50000(folder):
    random = np.random.default_rng(50000)
    text = HEADER.format(depth=8, fov=60, eye="-18, 4, -18", target="2, 2.4, 2") + furnished_room(random, 20, 8, 60)
    for i in range(50):
        # A chandelier: a cloud of a thousand small triangles.
        centre = np.array([random.uniform(-18, 18), random.uniform(1.5, 7), random.uniform(-18, 18)])
        radiance = np.exp(random.uniform(0, np.log(30))) * random.uniform(0.3, 1, 3) * 12
        vertices, triangles = panels(random, 1000, centre - 0.5, centre + 0.5, 0.01)
        text += mesh(folder, f"lamp_{i}", vertices, triangles, emitter(radiance))
    return text


def caustics(folder):
    text = HEADER.format(depth=12, fov=42, eye="0, 2.2, 5.2", target="0, 0.7, 0")
    text += cube((0, -0.05, 0), (3, 0.05, 3), diffuse((0.6, 0.6, 0.58)))
    text += cube((0, 2, -3.05), (3, 2, 0.05), diffuse((0.6, 0.5, 0.4)))
    text += cube((-3.05, 2, 0), (0.05, 2, 3), diffuse((0.5, 0.2, 0.15))) + cube((3.05, 2, 0), (0.05, 2, 3), diffuse((0.15, 0.3, 0.5)))
    text += ('<shape type="sphere"><point name="center" x="-0.8" y="0.75" z="0"/><float name="radius" value="0.7"/>'
             '<bsdf type="dielectric"><float name="int_ior" value="1.5"/></bsdf></shape>\n')
    text += cube((0.95, 0.5, 0.2), (0.4, 0.45, 0.4), '<bsdf type="dielectric"><float name="int_ior" value="1.5"/></bsdf>')
    return text + ('<shape type="rectangle"><transform name="to_world"><scale value="0.15"/><rotate x="1" angle="90"/>'
                   f'<translate x="0.2" y="3.6" z="0.3"/></transform>{emitter((150, 140, 120))}</shape>\n')


def write_radiance(path, pixels):
    """Radiance's RGBE, not compressed."""
    exponent = np.ceil(np.log2(np.maximum(pixels.max(axis=-1), 1e-30)))
    mantissa = np.clip(pixels / np.exp2(exponent)[..., None] * 256, 0, 255)
    data = np.concatenate([mantissa, exponent[..., None] + 128], axis=-1).astype(np.uint8)
    with open(path, "wb") as file:
        file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {pixels.shape[0]} +X {pixels.shape[1]}\n".encode())
        file.write(data.tobytes())


def sun_and_sky(folder):
    rows, columns = 256, 512
    theta = np.pi * (np.arange(rows) + 0.5)[:, None] / rows
    phi = 2 * np.pi * (np.arange(columns) + 0.5)[None, :] / columns
    up, across, along = np.cos(theta), np.sin(theta) * np.sin(phi), np.sin(theta) * np.cos(phi)
    sky = np.clip(up, 0, 1)[..., None] ** 0.5 * np.array([0.15, 0.3, 0.7]) + 0.1
    sky = np.where((up > 0)[..., None], sky + np.zeros((rows, columns, 3)), 0.05)
    sun = np.array([0.5, 0.6, 0.62])
    toward = up * sun[1] + across * sun[0] + along * sun[2]
    sky[toward / np.linalg.norm(sun) > np.cos(np.radians(1.2))] = [2600, 2300, 1800]
    write_radiance(folder / "sky.hdr", sky)

    steps = 501
    random = np.random.default_rng(7)
    x, z = np.meshgrid(np.linspace(-6, 6, steps), np.linspace(-6, 6, steps))
    y = np.zeros_like(x)
    for octave in range(7):
        for _ in range(6):
            wave, phase = random.normal(size=2) * 0.5 * 2 ** octave, random.uniform(0, 2 * np.pi)
            y += 0.28 * 0.5 ** octave * np.sin(wave[0] * x + wave[1] * z + phase)
    i = (np.arange(steps - 1)[:, None] * steps + np.arange(steps - 1)).ravel()
    triangles = np.concatenate([np.stack([i, i + steps, i + 1], -1), np.stack([i + 1, i + steps, i + steps + 1], -1)])
    text = HEADER.format(depth=8, fov=40, eye="0, 4.5, 9", target="0, 0, 0")
    text += mesh(folder, "ground", np.stack([x, y, z], -1).reshape(-1, 3), triangles, diffuse((0.5, 0.42, 0.32)))
    return text + '<emitter type="envmap"><string name="filename" value="sky.hdr"/></emitter>\n'


GENERATED = {"room_500": room_500, "room_50000": room_50000, "caustics": caustics, "sun_and_sky": sun_and_sky}


def generated_scene(name):
    """Path of the scene's file, written the first time."""
    folder = WORK / "scenes" / name
    path = folder / f"{name}.xml"
    if not path.exists():
        folder.mkdir(parents=True, exist_ok=True)
        text = GENERATED[name](folder)
        path.write_text(text + "</scene>\n")
    return path
