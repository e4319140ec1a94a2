"""What the benchmarks share: places, comparable copies of scenes, pinning, and Wavelobe as a process."""

import json
import os
import platform
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WAVELOBE = ROOT / "build/release/bin/wavelobe"
WORK = ROOT / "build/benchmark"
DATA = Path(os.environ.get("WAVELOBE_DATA", ROOT.parent / "shared/data"))


def scene_name(path):
    """A scene's own name; those whose file is called `scene` go by their folder."""
    return path.parent.name if path.stem.startswith("scene") else path.stem


def comparable_scene(source, size, spp, sampler="independent"):
    """A copy of the scene at another size, with a box filter, beside links to the files it names."""
    folder = WORK / f"{scene_name(source)}-{size}-{spp}-{sampler}"
    folder.mkdir(parents=True, exist_ok=True)
    for sibling in source.parent.resolve().iterdir():
        link = folder / sibling.name
        if sibling.name != source.name and not link.exists():
            link.symlink_to(sibling)
    tree = xml.parse(source)
    for film in tree.iter("film"):
        for name in ("width", "height"):
            for value in film.findall(f"integer[@name='{name}']"):
                value.set("value", str(size))
        for old in film.findall("rfilter"):
            film.remove(old)
        xml.SubElement(film, "rfilter", type="box")
    for element in tree.iter("sampler"):
        element.set("type", sampler)
        for value in element.findall("integer[@name='sample_count']"):
            value.set("value", str(spp))
    path = folder / source.name
    tree.write(path)
    return path


def pin(threads):
    """Restricts this process, before it starts any thread, to that many of the cores it may use."""
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:threads])


def run_wavelobe(scene, picture, threads, *arguments):
    """Renders a scene and returns the figures of --stats."""
    stats = picture.with_suffix(".json")
    command = [WAVELOBE, "render", scene, "-o", picture, "--stats", stats, "--quiet", "--threads", str(threads)]
    subprocess.run(command + [str(a) for a in arguments], check=True, preexec_fn=lambda: pin(threads))
    figures = json.loads(stats.read_text())
    if figures["nan_samples"]:
        print(f"warning: {figures['nan_samples']} NaN samples", file=sys.stderr)
    return figures


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()
