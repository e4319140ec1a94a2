"""Every plugin and parameter of docs/formats.md against Mitsuba 3: a small scene each, rendered by both.

usage: plugins.py [--list] [TEXT...]      default: all cases; otherwise those whose name, as --list prints it, holds one of the texts

Pixels, squares of pixels and the whole picture are compared by Welch's test over rounds of other seeds; the threshold is Sidak's
for all tests of all cases chosen. The means must agree within half a percent besides, and are measured until their standard error
is a third of that. Where Mitsuba is known to differ, the ratio of the means is compared with the one derived for that. Prints a
line a case; those that Mitsuba cannot load are named. Fails if any case differs. No case is begun after WAVELOBE_PLUGINS_SECONDS (3600).
"""

import contextlib
import os
import subprocess
import sys
import time
import zlib
from pathlib import Path

import numpy as np

from means import blocks, count_variance, p_values
from peers import SIGNIFICANCE
from plugin_data import write_all
import plugin_cases
import plugin_differences
import plugin_materials
from rows import append_rows

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))
from common import ROOT, WAVELOBE  # noqa: E402

WORK = ROOT / "build/plugins"
# Of ours, which is called anew each time and varies less, and of Mitsuba: degrees of freedom are those of the noisier.
ROUNDS = (8, 20)
MOST_ROUNDS = 4  # times as many
BOUND = 5e-3  # of the mean
BLOCK = 8


class NotLoaded(Exception):
    """Why Mitsuba refuses a scene."""


def channels_of(bitmap):
    """Pictures by name."""
    values = np.array(bitmap, dtype=np.float64).reshape(bitmap.height(), bitmap.width(), -1)
    return dict(zip((field.name for field in bitmap.struct_()), np.moveaxis(values, 2, 0)))


class Wavelobe:
    def __init__(self, mi, scene):
        self.mi, self.scene, self.picture = mi, scene, WORK / "picture.exr"

    def render(self, seed):
        command = [WAVELOBE, "render", self.scene, "-o", self.picture, "--quiet", "--threads", "2", "--seed", str(seed)]
        subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True)
        return channels_of(self.mi.Bitmap(str(self.picture)))


class Mitsuba:
    def __init__(self, mi, scene, spp):
        self.mi, self.spp = mi, spp
        with self.refusals():
            self.scene = mi.load_file(str(scene))

    @staticmethod
    @contextlib.contextmanager
    def refusals():
        try:
            yield
        except (RuntimeError, TypeError) as error:
            first = error
            while first.__cause__ is not None:
                first = first.__cause__
            raise NotLoaded(str(first).strip().splitlines()[-1]) from error

    def render(self, seed):
        with self.refusals():
            self.mi.render(self.scene, spp=self.spp, seed=seed)
            return channels_of(self.scene.sensors()[0].film().bitmap())


def comparable(channel):
    """Second moments of light are those of each renderer's own estimates."""
    return not (channel.startswith("m2_") and channel[-1] in "XYZRGB")


def p_of_means(ours, theirs, samples, rounding):
    """The least p of Welch's tests of every mean, where it is, and how many tests that are. `samples` of ours are in each mean of a round:
    what the picture's mean as one sample more of all rounds would make of it is no difference, as rare samples need not have come yet."""
    if not (np.isfinite(ours).all() and np.isfinite(theirs).all()):
        return 0.0, "not finite", 1
    reference = theirs.mean(axis=0)
    slack = rounding * np.abs(reference) + np.abs(theirs).mean(axis=tuple(range(theirs.ndim - 1))) / (samples * len(ours))
    p = p_values(ours, theirs, slack, count_variance(theirs, samples))
    place = np.unravel_index(np.argmin(p), p.shape)
    return float(p[place]), tuple(map(int, place)), p.size


class Comparison:
    """Rounds of both renderers for one case, and what they say."""

    def __init__(self, mi, case, index):
        self.case = case
        scene = WORK / f"case{index}.xml"
        scene.write_text(case.xml())
        theirs = Mitsuba(mi, scene, case.spp)
        self.renderers = (Wavelobe(mi, scene), theirs)
        self.pictures = ([], [])
        seed = zlib.crc32(case.name.encode()) % 1000000  # another for each case: their noise shall not be one
        while not self.pictures[0] or (len(self.pictures[0]) < MOST_ROUNDS * ROUNDS[0] and self.standard_error() > BOUND / 3):
            for renderer, pictures, rounds in zip(self.renderers, self.pictures, ROUNDS):
                for _ in range(rounds):
                    pictures.append(renderer.render(seed + len(pictures)))
        self.channels = [c for c in self.pictures[1][0] if c in self.pictures[0][0] and comparable(c)]
        self.missing = [c for c in self.pictures[1][0] if c not in self.pictures[0][0] and c != "A"]
        ours, theirs = self.stack(0), self.stack(1)
        height, width = (n // BLOCK * BLOCK for n in ours.shape[1:3])
        samples = case.spp
        self.tests = [
            ("pixel", *p_of_means(ours, theirs, samples, case.rounding)),
            ("square", *p_of_means(*(blocks(a[:, :height, :width], BLOCK) for a in (ours, theirs)), samples * BLOCK**2, case.rounding)),
            ("mean", *p_of_means(ours.mean(axis=(1, 2)), theirs.mean(axis=(1, 2)), samples * ours[0, ..., 0].size, case.rounding))]
        self.ratio, self.error = self.ratio_of_means()

    def stack(self, which):
        return np.stack([np.stack([p[c] for c in self.channels], axis=-1) for p in self.pictures[which]])

    def ratio_of_means(self):
        """Mitsuba's mean over ours, of the colours, and its standard error; one where there are none."""
        colours = [c for c in "RGB" if c in self.pictures[0][0] and c in self.pictures[1][0]]
        if not colours:
            return 1.0, 0.0
        ours, theirs = (np.array([np.mean([p[c].mean() for c in colours]) for p in pictures]) for pictures in self.pictures)
        if not ours.mean():
            return (1.0 if not theirs.mean() else np.inf), 0.0
        ratio = theirs.mean() / ours.mean()
        error = np.hypot(theirs.std(ddof=1) / np.sqrt(len(theirs)), ratio * ours.std(ddof=1) / np.sqrt(len(ours)))
        return ratio, error / ours.mean()

    def standard_error(self):
        return self.ratio_of_means()[1]

    def verdict(self, cases):
        """What differs, in words; empty if nothing does. Each of the cases has an equal share of the significance."""
        tests = cases * sum(count for *_, count in self.tests)
        threshold = -np.expm1(np.log1p(-SIGNIFICANCE) / tests)
        found = []
        expected = self.case.ratio
        due = 1.0 if expected is None else expected
        if abs(self.ratio - due) > BOUND * due + 3.0 * self.error:
            found.append("the mean")
        if expected is None:
            found += [f"{kind} {place} (p {p:.1g}, threshold {threshold:.1g})" for kind, p, place, _ in self.tests if p < threshold]
            found += [f"no channel {c}" for c in self.missing]
        return ", ".join(found)


def row(group, cases, differing, seconds):
    return {"section": "Light transport", "claim": f"{group} plugins against Mitsuba: cases that differ", "unit": "cases",
            "measured": len(differing), "bound": 0, "worst": differing[0] if differing else "", "holds": not differing,
            "samples": cases, "seconds": seconds, "test": "plugins.py"}


def main():
    import mitsuba as mi

    cases = [*plugin_materials.cases(), *plugin_cases.cases(), *plugin_differences.cases()]
    names = [a for a in sys.argv[1:] if a != "--list"]
    chosen = [c for c in cases if not names or any(n in f"{c.group} {c.name}" for n in names)]
    if "--list" in sys.argv:
        print("\n".join(f"{c.group} {c.name}" for c in chosen))
        return 0
    mi.set_variant("llvm_ad_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    write_all(mi, WORK)
    limit = time.time() + float(os.environ.get("WAVELOBE_PLUGINS_SECONDS", "3600"))
    start, groups, refused, late = {}, {}, 0, 0
    for index, case in enumerate(chosen):
        start.setdefault(case.group, time.time())
        title = f"{case.group} {case.name}"
        if time.time() > limit:
            late += 1
            continue
        try:
            result = Comparison(mi, case, index)
        except NotLoaded as reason:
            print(f"{title}: not loaded: {reason}", flush=True)
            refused += 1
            continue
        except subprocess.CalledProcessError as error:
            print(f"{title}: differs: refused: {error.stderr.strip()}", flush=True)
            groups.setdefault(case.group, []).append((title, True, time.time()))
            continue
        verdict = result.verdict(len(chosen))
        agreement = "agrees" if case.ratio is None else f"expected difference ({case.reason}; derived {case.ratio:.4f})"
        said = f"differs: {verdict}" if verdict else agreement
        print(f"{title}: {said}; ratio {result.ratio:.4f}, standard error {result.error:.4f}", flush=True)
        groups.setdefault(case.group, []).append((title, bool(verdict), time.time()))
    rows = [row(group, len(found), [t for t, bad, _ in found if bad], found[-1][2] - start[group]) for group, found in groups.items()]
    differing = sum(r["measured"] for r in rows)
    print(f"{sum(map(len, groups.values()))} cases compared, {differing} differ; {refused} not loaded, {late} without time left")
    append_rows(rows)
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
