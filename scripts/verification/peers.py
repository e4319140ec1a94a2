"""Scenes against Mitsuba 3: every pixel and every block of pixels by a test of means, the mean of the picture, its relMSE.

usage: peers.py [SCENE...]        default: our scenes, and the two of WAVELOBE_DATA that nobody here wrote

Both render each scene several times with independent seeds, at the same size with a box filter. Means of the two are compared
by Welch's test, with the variances that the rounds show; the threshold is Sidak's for all tests of a picture at once. relMSE is
that of one renderer's mean picture against the other's, over what the two variances say it should be. Scenes that Mitsuba cannot
load are named.
"""

import os
import sys
import time
from pathlib import Path

import numpy as np

from means import blocks, count_variance, p_values
from rows import append_rows

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))
from common import DATA, ROOT, WORK, comparable_scene, run_wavelobe, scene_name  # noqa: E402

# Pixels a side, samples a pixel and round, rounds, and how far the mean may be off: scenes of ours are small and many.
OURS = (64, 64, int(os.environ.get("WAVELOBE_VERIFY_ROUNDS", "40")), 1e-3)
FOREIGN = (256, 64, int(os.environ.get("WAVELOBE_VERIFY_ROUNDS", "16")), 5e-3)
FOREIGN_SCENES = [DATA / "scenes" / name for name in ("cornell-box/scene_v3.xml", "veach-bidir/scene.xml")]
BLOCK = 8
SIGNIFICANCE = 0.01
MOST_ROUNDS = 5  # times as many, where the means are not known well enough


def load(mi, path):
    bitmap = mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    return np.array(bitmap, dtype=np.float64)


def deviations(ours, theirs):
    """Difference of the means in standard errors. Where nothing varies both agree to a few roundings, or do not."""
    reference = theirs.mean(axis=0)
    difference = ours.mean(axis=0) - reference
    variance = (ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1)) / len(ours)
    beyond_rounding = np.maximum(np.abs(difference) - 1e-5 * np.abs(reference), 0.0)
    return np.sign(difference) * beyond_rounding / np.sqrt(np.maximum(variance, 1e-300))


def welch(ours, theirs, samples):
    """How many means of `samples` differ, of which channel and place the least likely is, its p-value, and the threshold. Where nothing
    varies both agree to a few roundings, or do not."""
    p = p_values(ours, theirs, 1e-5 * np.abs(theirs.mean(axis=0)), count_variance(theirs, samples))
    threshold = -np.expm1(np.log1p(-SIGNIFICANCE) / p.size)
    worst = np.unravel_index(np.argmin(p), p.shape)
    return int((p < threshold).sum()), f"row {worst[0]}, column {worst[1]}, channel {worst[2]}: p {p[worst]:.2g}, threshold {threshold:.2g}"


def relative_mse(ours, theirs):
    """relMSE between the mean pictures, its ratio to what their variances predict, and that ratio's standard error from blocks of
    pixels. Relative to the mean of both, which knows nothing of their difference."""
    reference = 0.5 * (ours.mean(axis=0) + theirs.mean(axis=0))
    weight = 1.0 / (reference**2 + 0.01)
    found = ((ours.mean(axis=0) - theirs.mean(axis=0)) ** 2 * weight).mean(axis=-1)
    expected = ((ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1)) / len(ours) * weight).mean(axis=-1)
    ratio = found.mean() / expected.mean()
    rest = blocks((found - ratio * expected)[None, :, :, None], BLOCK)
    return found.mean(), ratio, rest.std(ddof=1) / np.sqrt(rest.size) / expected.mean()


def relative_means(ours, theirs):
    """By how much the means of all pictures differ, by channel, and the standard errors of that."""
    ours_mean, theirs_mean = np.mean(ours, axis=(1, 2)), np.mean(theirs, axis=(1, 2))
    errors = np.sqrt((ours_mean.var(axis=0, ddof=1) + theirs_mean.var(axis=0, ddof=1)) / len(ours)) / theirs_mean.mean(axis=0)
    return ours_mean.mean(axis=0) / theirs_mean.mean(axis=0) - 1.0, errors


def draw(panels, path):
    """A row a scene: ours, Mitsuba's, and by how many standard errors they differ, from blue (-4) over white to red (4)."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(len(panels), 3, figsize=(6.6, 2.3 * len(panels)), squeeze=False, layout="constrained")
    for row, (name, ours, theirs) in zip(axes, panels):
        for axis, title, pictures in ((row[0], name, ours), (row[1], "Mitsuba 3", theirs)):
            axis.imshow(np.clip(np.mean(pictures, axis=0), 0, 1) ** (1 / 2.2))
            axis.set_title(title, fontsize=8)
        row[2].imshow(deviations(ours.mean(axis=-1), theirs.mean(axis=-1)), cmap="bwr", vmin=-4, vmax=4)
        row[2].set_title("difference, standard errors", fontsize=8)
        for axis in row:
            axis.set_axis_off()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=100)
    pyplot.close(figure)


def compare(mi, source, panels):
    start = time.time()
    size, spp, rounds, bound = OURS if source.parent == ROOT / "scenes" else FOREIGN
    scene = comparable_scene(source, size, spp)
    try:
        theirs_scene = mi.load_file(str(scene))
    except RuntimeError as error:
        return [], str(error).strip().splitlines()[-1]
    ours, theirs = [], []
    picture = WORK / f"{scene_name(source)}.verify.exr"
    while len(ours) < rounds or (len(ours) < MOST_ROUNDS * rounds and relative_means(ours, theirs)[1].max() > 0.5 * bound):
        seed = len(ours)
        run_wavelobe(scene, picture, 2, "--seed", seed)
        ours.append(load(mi, picture))
        theirs.append(np.array(mi.render(theirs_scene, spp=spp, seed=seed), dtype=np.float64)[..., :3])
    ours, theirs, rounds = np.array(ours), np.array(theirs), len(ours)
    panels.append((scene_name(source), ours, theirs))
    pixels, worst_pixel = welch(ours, theirs, spp)
    squares, worst_square = welch(blocks(ours, BLOCK), blocks(theirs, BLOCK), spp * BLOCK**2)
    by_channel, errors = relative_means(ours, theirs)
    mse, ratio, ratio_error = relative_mse(ours, theirs)
    name = f"{scene_name(source)} against Mitsuba {mi.__version__}"
    common = {"section": "Light transport", "samples": size * size * spp * rounds, "seconds": time.time() - start, "test": "peers.py"}

    def row(claim, unit, measured, limit, worst):
        return {**common, "claim": f"{name}: {claim}", "unit": unit, "measured": measured, "bound": limit, "worst": worst, "holds": bool(measured <= limit)}

    def mean_row():
        worst = "by channel " + ", ".join(f"{x:+.1e} (standard error {e:.1e})" for x, e in zip(by_channel, errors))
        if errors.max() <= 0.5 * bound:
            return row("mean of the picture", "relative", float(np.abs(by_channel).max()), bound, worst)
        # Noise hides such a difference: what can be said is that there is nothing but noise.
        return row(f"mean of the picture, too noisy to tell {bound:g} of it", "standard errors",
                   float(np.abs(by_channel / errors).max()), 4, worst)

    return [
        row("pixels that differ (Welch's test, Sidak)", "pixel channels", pixels, 0, worst_pixel),
        row(f"squares of {BLOCK} x {BLOCK} pixels that differ", "square channels", squares, 0, worst_square),
        mean_row(),
        row("relMSE against what the noise of both predicts", "standard errors", float(abs(ratio - 1.0) / ratio_error), 4,
            f"relMSE {mse:.3g}, ratio {ratio:.4f}, standard error {ratio_error:.2g}"),
    ], None


def main():
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    rows, panels = [], []
    WORK.mkdir(parents=True, exist_ok=True)
    sources = [Path(s).resolve() for s in sys.argv[1:]] or sorted((ROOT / "scenes").glob("*.xml")) + [
        s for s in FOREIGN_SCENES if s.exists()]
    limit = time.time() + float(os.environ.get("WAVELOBE_PEERS_SECONDS", "1800"))
    for source in sources:
        if time.time() > limit:
            print(f"{source.name}: not compared, no time left", flush=True)
            continue
        found, reason = compare(mi, source, panels)
        if reason:
            print(f"{source.name}: not for Mitsuba: {reason}", flush=True)
        for row in found:
            print(f"{row['claim']}: {row['measured']:.3g}, bound {row['bound']:g} ({row['worst']})", flush=True)
        rows += found
    folder = os.environ.get("WAVELOBE_VERIFY_PICTURES")
    if folder and panels:
        draw(panels, Path(folder) / "accuracy_peers.png")
        append_rows([{"section": "Light transport", "picture": "Ours, Mitsuba's, and their difference in standard errors, -4 (blue) to 4 (red)",
                      "file": "accuracy_peers.png"}])
    append_rows(rows)
    return 0 if all(row["holds"] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
