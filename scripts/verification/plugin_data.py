"""Textures, meshes and spectra for the test scenes of plugins.py, made here of formulas."""

import struct
import zlib

import numpy as np

GRID = 10  # vertices a side of the meshes


def waves(width, height, channels, seed, low=0.05, high=0.95):
    """Smooth patterns of period one, none of them symmetric."""
    random = np.random.default_rng(seed)
    y, x = np.meshgrid(np.arange(height) / height, np.arange(width) / width, indexing="ij")
    out = np.zeros((height, width, channels))
    for channel in range(channels):
        for _ in range(4):
            kx, ky = random.integers(-2, 3, 2)
            out[..., channel] += random.normal() * np.cos(2 * np.pi * (kx * x + ky * y + random.random()))
    out -= out.min(axis=(0, 1))
    return low + (high - low) * out / np.maximum(out.max(axis=(0, 1)), 1e-9)


def normals_of(heights, scale):
    dy, dx = np.gradient(heights)
    n = np.dstack((-dx * scale, -dy * scale, np.ones_like(heights)))
    return 0.5 + 0.5 * n / np.linalg.norm(n, axis=2, keepdims=True)


def mesh():
    """A bent and twisted cloth: positions, normals, texture coordinates, quadrilaterals as triangles."""
    u, v = np.meshgrid(np.linspace(0, 1, GRID), np.linspace(0, 1, GRID))

    def surface(u, v):
        return np.dstack((2.6 * u - 1.3, 1.8 * v + 0.1, 0.35 * np.sin(5 * u + 2 * v) + 0.3 * v * v))

    step = 1e-4
    normals = np.cross(surface(u + step, v) - surface(u - step, v), surface(u, v + step) - surface(u, v - step))
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    corner = (np.arange(GRID - 1)[:, None] * GRID + np.arange(GRID - 1)).ravel()
    triangles = np.concatenate([np.stack((corner, corner + 1, corner + GRID + 1), 1), np.stack((corner, corner + GRID + 1, corner + GRID), 1)])
    flat = lambda a: a.reshape(GRID * GRID, -1)  # noqa: E731
    return flat(surface(u, v)), flat(normals), np.stack((u.ravel(), v.ravel()), 1), triangles


def write_obj(path, positions, normals, uvs, triangles, with_normals=True):
    lines = ["v " + " ".join(map(str, p)) for p in positions] + ["vt " + " ".join(map(str, t)) for t in uvs]
    lines += ["vn " + " ".join(map(str, n)) for n in normals] if with_normals else []
    corner = (lambda i: f"{i}/{i}/{i}") if with_normals else (lambda i: f"{i}/{i}")
    lines += ["f " + " ".join(corner(i + 1) for i in t) for t in triangles]
    path.write_text("\n".join(lines) + "\n")


def write_ply(path, positions, normals, uvs, triangles, binary=False):
    """With a colour and a number at each vertex and each face."""
    columns = ["x", "y", "z"] + (["nx", "ny", "nz"] if normals is not None else []) + ["u", "v", "r", "g", "b", "shine_x"]
    random = np.random.default_rng(5)
    attributes = [random.uniform(0.1, 0.9, (len(positions), 3)), random.uniform(0.1, 0.6, (len(positions), 1))]
    vertices = np.hstack([positions] + ([normals] if normals is not None else []) + [uvs] + attributes).astype("<f4")
    faces = random.uniform(0.1, 0.9, (len(triangles), 4)).astype("<f4")
    head = ["ply", f"format {'binary_little_endian' if binary else 'ascii'} 1.0", f"element vertex {len(vertices)}"]
    head += [f"property float {c}" for c in columns]
    head += [f"element face {len(triangles)}", "property list uchar int vertex_indices"]
    head += [f"property float {c}" for c in ("r", "g", "b", "shine_x")] + ["end_header"]
    if binary:
        body = vertices.tobytes() + b"".join(struct.pack("<B3i", 3, *t) + f.tobytes() for t, f in zip(triangles, faces))
    else:
        rows = [" ".join(map(repr, map(float, v))) for v in vertices]
        rows += [f"3 {t[0]} {t[1]} {t[2]} " + " ".join(map(repr, map(float, f))) for t, f in zip(triangles, faces)]
        body = ("\n".join(rows) + "\n").encode()
    path.write_bytes(("\n".join(head) + "\n").encode() + body)


def write_serialized(path, meshes):
    """Version 4: each mesh compressed behind its own header, offsets and their number at the end."""
    out, offsets = b"", []
    for positions, normals, uvs, triangles in meshes:
        offsets.append(len(out))
        flags = 0x1000 | (1 if normals is not None else 0) | 2
        data = struct.pack("<I", flags) + b"cloth\0" + struct.pack("<QQ", len(positions), len(triangles))
        for array in [positions] + ([normals] if normals is not None else []) + [uvs]:
            data += array.astype("<f4").tobytes()
        out += struct.pack("<HH", 0x041C, 4) + zlib.compress(data + triangles.astype("<u4").tobytes())
    path.write_bytes(out + b"".join(struct.pack("<Q", o) for o in offsets) + struct.pack("<I", len(offsets)))


def write_bmp_and_tga(path, pixels):
    """Rows of a multiple of four bytes, from below, blue first."""
    height, width, _ = pixels.shape
    body = pixels[::-1, :, ::-1].tobytes()
    header = struct.pack("<IiiHHIIiiII", 40, width, height, 1, 24, 0, len(body), 2835, 2835, 0, 0)
    path.with_suffix(".bmp").write_bytes(b"BM" + struct.pack("<IHHI", 54 + len(body), 0, 0, 54) + header + body)
    path.with_suffix(".tga").write_bytes(struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, width, height, 24, 0) + body + bytes(8) + b"TRUEVISION-XFILE.\0")


def write_all(mi, folder):
    folder.mkdir(parents=True, exist_ok=True)

    def picture(name, values, eight_bits=True):
        bitmap = mi.Bitmap(np.ascontiguousarray(values, dtype=np.float32))
        if eight_bits:  # the numbers as they are: encoding is what the reader makes of them
            bitmap = mi.Bitmap(np.round(np.clip(values, 0, 1) * 255).astype(np.uint8))
        bitmap.write(str(folder / name))

    picture("paint.png", waves(12, 8, 3, 1))
    picture("grey.png", waves(8, 8, 1, 2))
    picture("heights.png", waves(16, 16, 1, 3))
    picture("wide_heights.png", waves(24, 12, 1, 3))
    picture("normals.png", normals_of(waves(16, 16, 1, 3)[..., 0], 2.5))
    picture("paint.exr", waves(9, 7, 3, 4), eight_bits=False)
    paint = waves(12, 12, 3, 8)
    for name in ("form.png", "form.jpg", "form.ppm"):
        picture(name, paint)
    write_bmp_and_tga(folder / "form", np.round(paint * 255).astype(np.uint8))
    for name in ("form.hdr", "form.pfm"):
        picture(name, paint, eight_bits=False)
    picture("alpha.png", waves(12, 12, 4, 8))
    mi.Bitmap((paint * 65535).astype(np.uint16)).write(str(folder / "deep.png"))
    mi.Bitmap(paint.astype(np.float16)).write(str(folder / "half.exr"))
    mi.Bitmap(paint[..., :1].astype(np.float32)).write(str(folder / "luminance.exr"))
    picture("slide.png", waves(16, 10, 3, 6))
    y, x = np.mgrid[0:32, 0:64] / 32.0
    sky = waves(64, 32, 3, 7, 0.1, 0.5) + (2.0 * np.exp(-((x - 0.6) ** 2 + (y - 0.3) ** 2) * 12.0))[..., None] * (1.0, 0.9, 0.7)
    picture("sky.exr", sky, eight_bits=False)
    positions, normals, uvs, triangles = mesh()
    write_obj(folder / "cloth.obj", positions, normals, uvs, triangles)
    write_obj(folder / "bare.obj", positions, normals, uvs, triangles, with_normals=False)
    write_ply(folder / "cloth.ply", positions, normals, uvs, triangles)
    write_ply(folder / "bare.ply", positions, None, uvs, triangles, binary=True)
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=float)
    turned = np.tile((0.75**0.5, 0.0, 0.5), (4, 1))
    write_obj(folder / "tilted.obj", square, turned, (square[:, :2] + 1) / 2, np.array([[0, 1, 2], [0, 2, 3]]))
    sides = np.concatenate((square - (2, 0, 0), square + (2, 0, 0)))
    upright = np.tile((0.0, 0.0, 1.0), (8, 1))
    write_obj(folder / "twice.obj", sides, upright, (np.tile(square, (2, 1))[:, :2] + 1) / 2, np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]))
    lifted = positions + np.array([0.0, 0.2, -0.5])
    write_serialized(folder / "cloth.serialized", [(positions, normals, uvs, triangles), (lifted, None, uvs, triangles[:100])])
    (folder / "green.spd").write_text("# made up\n400 0.05\n450 0.1\n500 0.5\n550 0.8\n600 0.3\n650 0.15\n700 0.1\n")
