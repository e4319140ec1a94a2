"""Samples a second of Wavelobe and of Mitsuba 3 (llvm_ad_rgb) on the same scene files.

Both render the same file at the same size, samples a pixel and path depth, with a box filter; Mitsuba with independent
samples. The two take turns; the table shows the median of the rounds. Set-up, kernel compilation and a first picture are
left out on both sides. On fewer threads than the machine has, both are pinned to that many cores: Mitsuba's
thread pool hangs with a single thread, so it keeps at least two.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

from common import DATA, comparable_scene, pin, processor, run_wavelobe

SCENES = [DATA / "scenes/cornell-box/scene_v3.xml", DATA / "scenes/veach-bidir/scene.xml"]


class Wavelobe:
    def __init__(self, scene, threads):
        self.scene = scene
        self.threads = threads
        self.picture = scene.with_suffix(f".{threads}.exr")

    def render(self, seed):
        stats = run_wavelobe(self.scene, self.picture, self.threads, "--seed", seed)
        return stats["samples"] / stats["render_seconds"]


class Mitsuba:
    """A process of its own, so that its thread pool can be sized and pinned; it answers one line a line."""

    def __init__(self, scene, threads, spp):
        command = [sys.executable, __file__, "--worker", scene, str(max(threads, 2)), str(spp)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                        preexec_fn=lambda: pin(threads))
        self.version = json.loads(self.process.stdout.readline())

    def ask(self, **question):
        self.process.stdin.write(json.dumps(question) + "\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def render(self, seed):
        return self.ask(seed=seed)

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def worker(scene_path, pool, spp):
    import drjit as dr
    import mitsuba as mi
    import numpy as np

    dr.set_thread_count(int(pool))
    mi.set_variant("llvm_ad_rgb")
    scene = mi.load_file(scene_path)
    spp = int(spp)
    total = None

    def render(seed):
        start = time.perf_counter()
        image = mi.render(scene, spp=spp, seed=seed)
        dr.eval(image)
        dr.sync_thread()
        return time.perf_counter() - start, np.array(image)[..., :3]

    render(1000)  # compiles
    print(json.dumps(mi.__version__), flush=True)
    for line in sys.stdin:
        question = json.loads(line)
        if "seed" in question:
            seconds, image = render(question["seed"])
            total = image.astype(np.float64) if total is None else total + image
            answer = image.shape[0] * image.shape[1] * spp / seconds
        else:  # ratio of the mean of these pictures to the mean of all pictures rendered here, by channel
            mean = np.mean([np.array(mi.Bitmap(p).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
                            .mean(axis=(0, 1)) for p in question["pictures"]], axis=0)
            answer = (mean / (total.mean(axis=(0, 1)) / question["rounds"])).tolist()
        print(json.dumps(answer), flush=True)


def measure(source, threads, options):
    scene = comparable_scene(source, options.size, options.spp)
    ours = Wavelobe(scene, threads)
    theirs = Mitsuba(scene, threads, options.spp)
    ours.render(1000)  # fills the kernel cache
    rates = {"wavelobe": [], "mitsuba": []}
    pictures = []
    for seed in range(options.rounds):
        rates["wavelobe"].append(ours.render(seed))
        kept = ours.picture.with_suffix(f".{seed}.exr")
        ours.picture.rename(kept)
        pictures.append(str(kept))
        rates["mitsuba"].append(theirs.render(seed))
    mean_ratio = theirs.ask(pictures=pictures, rounds=options.rounds)
    theirs.close()
    median = {name: statistics.median(values) for name, values in rates.items()}
    return {"scene": source.parent.name, "threads": threads, "size": options.size, "spp": options.spp,
            "samples_per_second": median, "ratio": median["wavelobe"] / median["mitsuba"],
            "mean_radiance_ratio": mean_ratio, "rounds": rates, "mitsuba_version": theirs.version}


def main():
    cores = len(os.sched_getaffinity(0))
    parser = argparse.ArgumentParser(prog="scripts/benchmark peers", description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", nargs="+", type=Path, default=SCENES, help="Mitsuba 3 XML files")
    parser.add_argument("--threads", nargs="+", type=int, default=sorted({1, cores}), help="default: one, and all")
    parser.add_argument("--size", type=int, default=512, help="width and height of the pictures")
    parser.add_argument("--spp", type=int, default=32)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--json", type=Path, help="also write all figures there")
    options = parser.parse_args()
    missing = [str(scene) for scene in options.scenes if not scene.exists()]
    if missing:
        parser.error(f"no such scene: {', '.join(missing)}; name others with --scenes, or set WAVELOBE_DATA")
    if any(not 1 <= threads <= cores for threads in options.threads):
        parser.error(f"--threads: this process may use 1 to {cores} cores")

    print(f"{processor()}; {options.size} x {options.size} pixels, {options.spp} samples each, "
          f"medians of {options.rounds}; load average before {os.getloadavg()[0]:.2f}")
    print(f"{'scene':<16}{'threads':>8}{'wavelobe':>12}{'mitsuba':>12}{'ratio':>8}   mean radiance, wavelobe / mitsuba")
    rows = []
    for scene in options.scenes:
        for threads in options.threads:
            row = measure(scene, threads, options)
            rows.append(row)
            rate = row["samples_per_second"]
            means = "  ".join(f"{ratio:.4f}" for ratio in row["mean_radiance_ratio"])
            print(f"{row['scene']:<16}{threads:>8}{rate['wavelobe'] / 1e6:>10.2f} M{rate['mitsuba'] / 1e6:>10.2f} M"
                  f"{row['ratio']:>8.2f}   {means}", flush=True)
    if options.json:
        options.json.write_text(json.dumps({"processor": processor(), "rows": rows}, indent=2) + "\n")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--worker"]:
        worker(*sys.argv[2:])
    else:
        main()
