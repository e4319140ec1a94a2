"""Our scenes against Mitsuba 3: every pixel by a test of means, and the mean of the picture.

Both render each scene several times with independent seeds, at the same size with a box filter. Per pixel and channel the
two means are compared by Welch's test, with the variances that the rounds show; the threshold is Sidak's for all pixels of a
picture at once. Scenes that Mitsuba cannot load are named.
"""

import json
import os
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))
from common import ROOT, WORK, comparable_scene, run_wavelobe  # noqa: E402

SIZE = 64
SPP = 64
ROUNDS = int(os.environ.get("WAVELOBE_VERIFY_ROUNDS", "40"))
SIGNIFICANCE = 0.01


def student_p_values(t, degrees):
    """Two-sided, by integrating the density of Student's distribution; `degrees` is one number."""
    from math import exp, lgamma, pi, sqrt

    # Substitute x = tan(a) sqrt(degrees): the tail is the integral of cos^(degrees - 1) from a to pi / 2.
    grid = np.linspace(0.0, pi / 2, 200001)
    density = np.cos(grid) ** (degrees - 1) * exp(lgamma((degrees + 1) / 2) - lgamma(degrees / 2)) / sqrt(pi)
    steps = 0.5 * (density[1:] + density[:-1]) * (grid[1] - grid[0])
    tail = np.append(np.cumsum(steps[::-1])[::-1], 0.0)
    return 2.0 * np.interp(np.arctan(np.abs(t) / sqrt(degrees)), grid, tail)


def load(mi, path):
    bitmap = mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    return np.array(bitmap, dtype=np.float64)


def compare(mi, source):
    start = time.time()
    scene = comparable_scene(source, SIZE, SPP)
    try:
        theirs_scene = mi.load_file(str(scene))
    except RuntimeError as error:
        return [], str(error).strip().splitlines()[-1]
    ours, theirs = [], []
    picture = WORK / f"{source.stem}.verify.exr"
    for seed in range(ROUNDS):
        run_wavelobe(scene, picture, 2, "--seed", seed)
        ours.append(load(mi, picture))
        theirs.append(np.array(mi.render(theirs_scene, spp=SPP, seed=seed), dtype=np.float64)[..., :3])
    ours, theirs = np.array(ours), np.array(theirs)
    difference = ours.mean(axis=0) - theirs.mean(axis=0)
    # Pixels without variance agree to a few roundings, or do not.
    rounding = 1e-5 * np.abs(theirs.mean(axis=0))
    variance = (ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1)) / ROUNDS
    t = np.maximum(np.abs(difference) - rounding, 0.0) / np.sqrt(np.maximum(variance, 1e-300))
    p = student_p_values(t, 2 * ROUNDS - 2)
    threshold = -np.expm1(np.log1p(-SIGNIFICANCE) / p.size)
    worst = np.unravel_index(np.argmin(p), p.shape)
    by_channel = difference.mean(axis=(0, 1)) / theirs.mean(axis=(0, 1, 2))
    samples = SIZE * SIZE * SPP * ROUNDS
    common = {"section": "Light transport", "samples": samples, "seconds": time.time() - start, "test": "peers.py"}
    name = f"{source.name} against Mitsuba {mi.__version__}"
    rejected = int((p < threshold).sum())
    off = float(np.abs(by_channel).max())
    error = float(np.max(np.sqrt(variance.sum(axis=(0, 1))) / (SIZE * SIZE) / theirs.mean(axis=(0, 1, 2))))
    return [
        {**common, "claim": f"{name}: pixels that differ (Welch's test, Sidak)", "unit": "pixel channels", "measured": rejected, "bound": 0,
         "worst": f"row {worst[0]}, column {worst[1]}, channel {worst[2]}: p {p[worst]:.2g}, threshold {threshold:.2g}", "holds": rejected == 0},
        {**common, "claim": f"{name}: mean of the picture", "unit": "relative", "measured": off, "bound": 1e-3,
         "worst": "by channel " + " ".join(f"{x:+.1e}" for x in by_channel) + f"; standard error {error:.1e}", "holds": off <= 1e-3},
    ], None


def main():
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    rows = []
    WORK.mkdir(parents=True, exist_ok=True)
    sources = [Path(s).resolve() for s in sys.argv[1:]] or sorted((ROOT / "scenes").glob("*.xml"))
    for source in sources:
        found, reason = compare(mi, source)
        if reason:
            print(f"{source.name}: not for Mitsuba: {reason}", flush=True)
        for row in found:
            print(f"{row['claim']}: {row['measured']:.3g}, bound {row['bound']:g} ({row['worst']})", flush=True)
        rows += found
    if "WAVELOBE_VERIFY_ROWS" in os.environ:
        with open(os.environ["WAVELOBE_VERIFY_ROWS"], "a", encoding="utf-8") as out:
            out.writelines(json.dumps(row) + "\n" for row in rows)
    return 0 if all(row["holds"] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
