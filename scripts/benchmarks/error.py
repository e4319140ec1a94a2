"""Error against time of Wavelobe and of other renderers on the same scene files.

Each renderer makes every picture of a ladder of samples (1, 4, 16, ...), with another seed each round, the renderers taking
turns; seconds are medians, errors means, over the rounds. Set-up and kernel compilation are apart. The error is

    relMSE = mean of (x - r)^2 / (r^2 + 0.01)

over pixels and channels, also without the worst 0.1 % of pixels, and FLIP of the HDR pictures. The reference r is the mean of
many independent seeds; its own relMSE (`floor`) is estimated from their spread, shown, and taken off. Errors below twice
the floor are not used. Seconds to a given error are interpolated between the logarithms of seconds and error; `~` marks those
beyond the ladder, continued with a slope of -1.
"""

import argparse
import hashlib
import json
import os
import statistics
import sys
from pathlib import Path

import numpy as np

import report
from common import DATA, ROOT, WORK, comparable_scene, processor, scene_name
from generated_scenes import GENERATED, generated_scene
from renderers import Missing, Wavelobe, Worker, peer_settings

TARGETS = (1e-2, 1e-3)
SCENES = [DATA / "scenes/cornell-box/scene_v3.xml", DATA / "scenes/veach-bidir/scene.xml",
          ROOT / "scenes/glossy_plates.xml", "room_500", "room_50000", "caustics", "sun_and_sky"]
FIRST_REFERENCE_SEED = 1 << 24


def relative_squares(picture, reference):
    """(x - r)^2 / (r^2 + 0.01), averaged over the channels of each pixel."""
    return np.mean((picture - reference) ** 2 / (reference ** 2 + 0.01), axis=2)


class Reference:
    """The mean of many seeds and the variance of that mean, a pixel and channel; kept on disk."""

    def __init__(self, source, size, options):
        # The scene as it is rendered and the files beside it, by name and size.
        digest = hashlib.sha256(comparable_scene(source, size, 1).read_bytes())
        for sibling in sorted(source.parent.iterdir()):
            digest.update(f"{sibling.name} {sibling.stat().st_size}".encode())
        self.path = WORK / "references" / f"{scene_name(source)}-{size}-{options.reference}-{digest.hexdigest()[:12]}.npz"
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.count, self.total, self.squares, self.seconds = 0, 0.0, 0.0, 0.0
        if self.path.exists():
            kept = np.load(self.path)
            self.count, self.total, self.squares = int(kept["count"]), kept["total"], kept["squares"]
            self.seconds = float(kept["seconds"])

    def refine(self, renderer, spp, floor, seconds):
        """Adds seeds until its own relMSE is below `floor` or it has cost that many seconds."""
        while self.count < 8 or (self.floor > floor and self.seconds < seconds):
            taken, picture = renderer.render(spp, FIRST_REFERENCE_SEED + self.count)
            self.total, self.squares = self.total + picture, self.squares + picture ** 2
            self.count, self.seconds = self.count + 1, self.seconds + taken
            np.savez(self.path, count=self.count, total=self.total, squares=self.squares, seconds=self.seconds)

    @property
    def picture(self):
        return self.total / self.count

    @property
    def variance(self):
        spread = np.maximum(self.squares / self.count - self.picture ** 2, 0)
        return spread / (self.count - 1)

    @property
    def floor(self):
        return float(np.mean(self.variance / (self.picture ** 2 + 0.01)))

    def relative_error(self):
        """Standard error of the picture's mean, as a share of it."""
        return float(np.sqrt(self.variance.sum()) / self.picture.sum())


def compare(picture, reference):
    import flip_evaluator

    error = relative_squares(picture, reference.picture)
    kept = np.sort(error, axis=None)[: int(np.ceil(error.size * 0.999))]
    flip = flip_evaluator.evaluate(reference.picture.astype(np.float32), picture.astype(np.float32), "HDR",
                                   applyMagma=False)[1]
    difference = picture - reference.picture
    return {"rel_mse": float(error.mean()) - reference.floor, "trimmed": float(kept.mean()), "flip": float(flip),
            "bias": float(difference.sum() / reference.picture.sum()),
            "bias_error": float(np.hypot(np.sqrt((difference ** 2).sum()) / reference.picture.sum(),
                                         reference.relative_error()))}


def climb(renderers, reference, options):
    """Rows of all renderers: one a rung of the ladder. A renderer stops once it is below the last target or out of time."""
    rows = {r.name: [] for r in renderers}
    active = list(renderers)
    spp = 1
    while active and spp <= options.max_spp:
        rounds = {r.name: [] for r in active}
        for turn in range(options.rounds + 1):
            for renderer in active:
                seconds, picture = renderer.render(spp, 1 + turn + 16 * spp)
                if turn > 0:  # the first is for whatever is compiled or allocated for this number of samples
                    rounds[renderer.name].append({"seconds": seconds, **compare(picture, reference)})
        for renderer in list(active):
            found = rounds[renderer.name]
            row = {key: statistics.fmean(f[key] for f in found) for key in found[0]}
            row["seconds"] = statistics.median(f["seconds"] for f in found)
            row["bias_error"] /= np.sqrt(len(found))
            row["spp"] = spp
            row["used"] = row["rel_mse"] > 2 * reference.floor
            rows[renderer.name].append(row)
            done = row["rel_mse"] < 0.7 * min(options.targets) or row["seconds"] * 4 > options.seconds or not row["used"]
            if done:
                active.remove(renderer)
        spp *= 4
    return rows


def seconds_to(rows, target):
    """Seconds at which the error is `target`, and whether that lies beyond the ladder. None without a usable row."""
    points = [(np.log(r["seconds"]), np.log(r["rel_mse"])) for r in rows if r["used"] and r["rel_mse"] > 0]
    if not points:
        return None, True
    goal = np.log(target)
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e0 >= goal >= e1:
            return float(np.exp(t0 + (t1 - t0) * (e0 - goal) / (e0 - e1))), False
    t, e = points[0] if points[0][1] < goal else points[-1]
    return float(np.exp(t + e - goal)), True


def summarize(rows, targets):
    result = {}
    for name, ladder in rows.items():
        used = [r for r in ladder if r["used"] and r["rel_mse"] > 0]
        slope = None
        if len(used) > 1:
            slope = float(np.polyfit([np.log(r["spp"]) for r in used], [np.log(r["rel_mse"]) for r in used], 1)[0])
        last = used[-1] if used else ladder[-1]
        # Independent samples divide the error of one by their number.
        gain = ladder[0]["rel_mse"] / (last["rel_mse"] * last["spp"]) if last["rel_mse"] > 0 else None
        result[name] = {"slope": slope, "gain": gain, "seconds_to": {str(t): seconds_to(ladder, t) for t in targets}}
    return result


def measure(source, options):
    renderers, skipped = [Wavelobe(source, options.size, options.threads)], {}
    for kind, setting in options.peers:
        name = f"{kind}-{setting}" if setting else kind
        try:
            renderers.append(Worker(kind, setting, source, options.size, options.threads))
        except Missing as missing:
            skipped[name] = str(missing)
    for name, reason in skipped.items():
        print(f"skipped {name}: {reason}", file=sys.stderr)
    try:
        reference = Reference(source, options.size, options)
        by = [r for r in renderers if r.name.startswith(options.reference)]
        if not by:
            raise SystemExit(f"--reference {options.reference}: it is not among the renderers")
        reference.refine(by[0], options.reference_spp, options.floor, options.reference_seconds)
        rows = climb(renderers, reference, options)
        return {"scene": scene_name(source), "size": options.size, "threads": options.threads,
                "reference": {"seeds": reference.count, "spp": options.reference_spp, "floor": reference.floor,
                              "mean": reference.picture.mean(axis=(0, 1)).tolist(),
                              "relative_error_of_mean": reference.relative_error(), "by": options.reference},
                "setup_seconds": {r.name: r.setup_seconds for r in renderers},
                "versions": {r.name: r.version for r in renderers if hasattr(r, "version")},
                "skipped": skipped, "rows": rows, "summary": summarize(rows, options.targets)}
    finally:
        for renderer in renderers:
            renderer.close()


def scene_source(text):
    return generated_scene(text) if str(text) in GENERATED else Path(text)


def arguments():
    cores = len(os.sched_getaffinity(0))
    parser = argparse.ArgumentParser(prog="scripts/benchmark error", description=__doc__.splitlines()[0])
    parser.add_argument("--peers", default="mitsuba", help="comma-separated: mitsuba, mitsuba-VARIANT:SAMPLER, cycles, luxcore; '' for none")
    parser.add_argument("--scenes", nargs="+", default=SCENES, help=f"Mitsuba 3 XML files, or of {', '.join(GENERATED)}")
    parser.add_argument("--threads", type=int, default=cores)
    parser.add_argument("--size", type=int, default=256, help="width and height of the pictures")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--max-spp", type=int, default=1 << 16, help="where the ladder ends at the latest")
    parser.add_argument("--seconds", type=float, default=60, help="no picture of the ladder may take longer")
    parser.add_argument("--targets", nargs="+", type=float, default=list(TARGETS), help="relMSE to reach")
    parser.add_argument("--reference", default="wavelobe", help="the renderer that makes the reference")
    parser.add_argument("--reference-spp", type=int, default=256, help="samples of each of its seeds")
    parser.add_argument("--floor", type=float, default=1e-4, help="relMSE of the reference itself to aim for")
    parser.add_argument("--reference-seconds", type=float, default=600, help="and what it may cost at the most")
    parser.add_argument("--json", type=Path, help="also write all figures there")
    parser.add_argument("--plots", type=Path, default=WORK / "plots", help="folder of the PNG and SVG curves")
    options = parser.parse_args()
    options.scenes = [scene_source(s) for s in options.scenes]
    missing = [str(s) for s in options.scenes if not s.exists()]
    if missing:
        parser.error(f"no such scene: {', '.join(missing)}; name others with --scenes, or set WAVELOBE_DATA")
    if not 1 <= options.threads <= cores:
        parser.error(f"--threads: this process may use 1 to {cores} cores")
    try:
        options.peers = peer_settings([p for p in options.peers.split(",") if p])
    except Missing as missing:
        parser.error(str(missing))
    return options


def main():
    options = arguments()
    print(f"{processor()}; {options.size} x {options.size} pixels, {options.threads} threads, {options.rounds} rounds; "
          f"load average before {os.getloadavg()[0]:.2f}")
    results = []
    for source in options.scenes:
        results.append(measure(source, options))
        report.print_scene(results[-1], options.targets)
        for path in report.draw(results[-1], options.targets, options.plots):
            print(f"  {path}")
        if options.json:
            options.json.write_text(json.dumps({"processor": processor(), "scenes": results}, indent=2) + "\n")
    report.print_summary(results, options.targets)


if __name__ == "__main__":
    main()
