"""What each feature costs the scene that has it, and the scene that declares it and has no use for it.

A room of diffuse walls is the base. For each feature the table shows, of a room that has it: seconds of rendering against the
base (they take turns; medians of the rounds), seconds to build its kernels with an empty cache, bytes of its buffers, and its
stages; and of a room that only declares it, whether the kernels, the buffers and each bit of the picture are those of the base, as
they must be, and its seconds against the base. Lights and layers cannot be declared without effect.
"""

import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from common import ROOT, WAVELOBE, WORK, processor, run_wavelobe

BLOCK = '<ref id="ochre"/>'
EXTRA = '<ref id="extra"/>'


def bsdf(text):
    """A BSDF that the block has, or that nothing has."""
    return {"declared": text.replace("<bsdf", '<bsdf id="extra"', 1), "block": EXTRA}


DIFFUSE = '<bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.5, 0.2"/></bsdf>'
LAMPS = "".join(
    f'<shape type="rectangle"><transform name="to_world"><scale value="0.02"/><rotate x="1" angle="90"/>'
    f'<translate x="{-0.9 + 0.2 * (i % 10):.2f}" y="1.97" z="{-0.9 + 0.2 * (i // 10):.2f}"/></transform>'
    f'<emitter type="area"><rgb name="radiance" value="60"/></emitter></shape>' for i in range(40))
FEATURES = {
    "microfacets": bsdf('<bsdf type="roughconductor"><string name="material" value="Al"/><float name="alpha" value="0.2"/></bsdf>'),
    "dielectric": bsdf('<bsdf type="dielectric"/>'),
    "rough plastic": bsdf('<bsdf type="roughplastic"><float name="alpha" value="0.2"/></bsdf>'),
    "principled": bsdf('<bsdf type="principled"><float name="roughness" value="0.4"/><float name="metallic" value="0.5"/></bsdf>'),
    "texture": bsdf('<bsdf type="diffuse"><texture type="checkerboard" name="reflectance"/></bsdf>'),
    "normal map": bsdf(f'<bsdf type="normalmap"><texture type="checkerboard" name="normalmap"><rgb name="color0" value="0.6, 0.5, 0.9"/>'
                       f'<rgb name="color1" value="0.4, 0.5, 0.9"/></texture>{DIFFUSE}</bsdf>'),
    "blend": bsdf(f'<bsdf type="blendbsdf"><float name="weight" value="0.3"/>{DIFFUSE}<bsdf type="roughconductor"/></bsdf>'),
    "mask": bsdf(f'<bsdf type="mask"><float name="opacity" value="0.5"/>{DIFFUSE}</bsdf>'),
    "instances": {"declared": '<shape type="shapegroup" id="group"><shape type="cube"/></shape>',
                  "added": '<shape type="instance"><ref id="group"/><transform name="to_world"><scale value="0.1"/>'
                           '<translate y="1.4"/></transform></shape>'},
    "spheres": {"added": '<shape type="sphere"><point name="center" x="0" y="1.3" z="0"/><float name="radius" value="0.2"/></shape>'},
    "environment": {"added": '<emitter type="constant"/>'},
    "40 lights": {"added": LAMPS},
    "layers": {"integrator": '<integrator type="aov"><string name="aovs" value="dd:depth,nn:sh_normal,al:albedo"/>'
                             '<integrator type="path"><integer name="max_depth" value="12"/></integrator></integrator>'},
}


class Room:
    """One scene file and what was found of it."""

    def __init__(self, folder, name, text, options):
        self.path = folder / f"{re.sub('[^a-z0-9]+', '_', name)}.xml"
        self.path.write_text(text)
        self.picture = self.path.with_suffix(".exr")
        self.options, self.seconds = options, []
        self.program = subprocess.run([WAVELOBE, "info", "--program", self.path], check=True, capture_output=True, text=True).stdout
        # The cost of its kernels, once, with a cache of its own.
        cache = tempfile.mkdtemp(prefix="wavelobe-kernels-")
        kept = os.environ.get("POCL_CACHE_DIR")
        os.environ["POCL_CACHE_DIR"] = cache
        try:
            setup = self.run()["setup"]
        finally:
            shutil.rmtree(cache)
            os.environ.pop("POCL_CACHE_DIR")
            if kept is not None:
                os.environ["POCL_CACHE_DIR"] = kept
        self.kernel_seconds = setup["program_build"] + setup["first_launches"]
        self.stats = self.run()

    def run(self):
        return run_wavelobe(self.path, self.picture, self.options.threads, "--spp", self.options.spp)

    def measure(self):
        self.seconds.append(self.run()["render_seconds"])

    def same_bits(self, other):
        found = subprocess.run([WAVELOBE, "compare", self.picture, other.picture], check=True, capture_output=True, text=True).stdout
        return float(re.search(r"max difference\s+(\S+)", found).group(1)) == 0.0

    def row(self):
        return {"seconds": statistics.median(self.seconds), "kernel_seconds": self.kernel_seconds,
                "device_bytes": self.stats["device_bytes"], "program_bytes": len(self.program),
                "stages": [s["name"] for s in self.stats["stages"]]}


def room_texts(base, feature):
    """Of the room with the feature, and of the room that declares it (None: it cannot)."""
    declared = base.replace("</scene>", feature.get("declared", "") + "</scene>")
    having = declared.replace("</scene>", feature.get("added", "") + "</scene>")
    if "block" in feature:
        having = having.replace(BLOCK, feature["block"])
    if "integrator" in feature:
        having = re.sub(r"<integrator.*?</integrator>", feature["integrator"], having, count=1, flags=re.S)
    return having, declared if "declared" in feature else None


def take_turns(rooms, rounds):
    for _ in range(rounds):
        for room in rooms:
            room.measure()


def measure(name, base_text, base, folder, options):
    having_text, declared_text = room_texts(base_text, FEATURES[name])
    having = Room(folder, name, having_text, options)
    declared = Room(folder, f"{name} declared", declared_text, options) if declared_text else None
    base.seconds = []
    take_turns([base, having] + ([declared] if declared else []), options.rounds)
    base_row = base.row()
    row = {"feature": name, "having": having.row(), "base": base_row}
    if declared:
        row["declared"] = {**declared.row(), "same_program": declared.program == base.program,
                           "same_bytes": declared.stats["device_bytes"] == base.stats["device_bytes"],
                           "same_bits": declared.same_bits(base)}
    return row


def print_row(row):
    having, base = row["having"], row["base"]
    text = (f"{row['feature']:<15}{having['seconds'] / base['seconds']:>8.2f}{having['kernel_seconds']:>10.2f}"
            f"{having['device_bytes'] / 2**20:>10.1f}{having['program_bytes'] / 1024:>10.0f}{len(having['stages']):>8}")
    if "declared" in row:
        declared = row["declared"]
        same = [declared["same_program"], declared["same_bytes"], declared["same_bits"]]
        text += f"   {'yes' if all(same) else 'NO: kernels, buffers, bits ' + str(same):<6}{declared['seconds'] / base['seconds']:>8.3f}"
    else:
        text += "   -"
    print(text, flush=True)


def main():
    parser = argparse.ArgumentParser(prog="scripts/benchmark features", description=__doc__.splitlines()[0])
    parser.add_argument("--features", nargs="+", default=list(FEATURES), choices=list(FEATURES), metavar="NAME",
                        help=", ".join(FEATURES))
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--size", type=int, default=256, help="width and height of the pictures")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--json", type=Path, help="also write all figures there")
    options = parser.parse_args()
    folder = WORK / "features"
    folder.mkdir(parents=True, exist_ok=True)
    base_text = (ROOT / "scenes/cornell_box.xml").read_text().replace('value="512"', f'value="{options.size}"')
    base = Room(folder, "base", base_text, options)
    print(f"{processor()}; {options.size} x {options.size} pixels, {options.spp} samples each, {options.threads} threads, "
          f"medians of {options.rounds}; load average before {os.getloadavg()[0]:.2f}")
    print(f"base: kernels {base.kernel_seconds:.2f} s, buffers {base.stats['device_bytes'] / 2**20:.1f} MiB, program "
          f"{len(base.program) / 1024:.0f} KiB, stages {', '.join(s['name'] for s in base.stats['stages'])}")
    print(f"{'feature':<15}{'time':>8}{'kernels s':>10}{'MiB':>10}{'KiB':>10}{'stages':>8}   declared alone: same, time")
    rows = []
    for name in options.features:
        rows.append(measure(name, base_text, base, folder, options))
        print_row(rows[-1])
    if options.json:
        options.json.write_text(json.dumps({"processor": processor(), "rows": rows}, indent=2) + "\n")
    declared = [row["declared"] for row in rows if "declared" in row]
    return 0 if all(d["same_program"] and d["same_bytes"] and d["same_bits"] for d in declared) else 1


if __name__ == "__main__":
    sys.exit(main())
