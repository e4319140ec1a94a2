"""Every plugin and parameter of docs/formats.md against Mitsuba 3: a small scene each, rendered by both.

usage: plugins.py [--list] [TEXT...]      default: all cases; otherwise those whose name, as --list prints it, holds one of the texts

Pixels, squares of pixels and the whole picture are compared by Welch's test over rounds of other seeds; the threshold is Sidak's
for all tests of all cases that run. The means must agree within half a percent besides, and are measured until their standard error
is a third of that. Where Mitsuba is known to differ, the ratio of the means is compared with the one derived for that. Prints a
line a case; cases that either cannot load are named. Fails if any case differs.
"""

import functools
import json
import os
import subprocess
import sys
import time
import zlib
from pathlib import Path

import numpy as np

from peers import SIGNIFICANCE, blocks
from plugin_data import write_all
import plugin_cases
import plugin_differences
import plugin_materials

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))
from common import ROOT, WAVELOBE  # noqa: E402

WORK = ROOT / "build/plugins"
# Ours are calls of a program, and vary less: what the tests lack for is degrees of freedom of the other.
ROUNDS = (8, 20)
MOST_ROUNDS = 4  # times as many
BOUND = 5e-3  # of the mean
BLOCK = 8


class NotLoaded(Exception):
    """Why a renderer refuses a scene."""


class Wavelobe:
    def __init__(self, mi, scene):
        self.mi, self.scene, self.picture = mi, scene, WORK / "picture.exr"

    def render(self, seed):
        command = [WAVELOBE, "render", self.scene, "-o", self.picture, "--quiet", "--threads", "2", "--seed", str(seed)]
        run = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
        if run.returncode == 2:
            raise NotLoaded(run.stderr.strip().splitlines()[0])
        if run.returncode:
            raise RuntimeError(run.stderr)
        bitmap = self.mi.Bitmap(str(self.picture))
        names = [field.name for field in bitmap.struct_()]
        return dict(zip(names, np.moveaxis(np.array(bitmap, dtype=np.float64).reshape(bitmap.height(), bitmap.width(), -1), 2, 0)))


class Mitsuba:
    def __init__(self, mi, scene, spp):
        self.mi, self.spp = mi, spp
        try:
            self.scene = mi.load_file(str(scene))
        except (RuntimeError, TypeError) as error:
            raise NotLoaded(str(error).strip().splitlines()[-1]) from error

    def render(self, seed):
        try:
            picture = np.array(self.mi.render(self.scene, spp=self.spp, seed=seed), dtype=np.float64)
        except RuntimeError as error:
            raise NotLoaded(str(error).strip().splitlines()[-1]) from error
        names = ["R", "G", "B"] if picture.shape[2] <= 4 else self.scene.integrator().aov_names()
        extra = picture.shape[2] - len(names)
        base = ["R", "G", "B", "A"][:extra] if extra else []
        return dict(zip(base + list(names), np.moveaxis(picture, 2, 0)))


@functools.cache
def tail(degrees):
    """Angles, and the two-sided p of the t whose tangent over the root of the degrees of freedom they are."""
    grid = np.linspace(0.0, np.pi / 2, 20001)
    steps = np.exp((degrees - 1) * np.log(np.maximum(np.cos(0.5 * (grid[1:] + grid[:-1])), 1e-300)))
    sums = np.append(np.cumsum(steps[::-1])[::-1], 0.0)
    return grid, sums / sums[0]


def p_of_means(ours, theirs):
    """The least p of Welch's tests of every mean, where it is, and how many tests that are."""
    reference = theirs.mean(axis=0)
    rounding = 1e-5 * np.abs(reference) + 1e-6 * np.abs(theirs).mean()
    parts = [np.maximum(a.var(axis=0, ddof=1) / len(a), 1e-30) for a in (ours, theirs)]
    t = np.maximum(np.abs(ours.mean(axis=0) - reference) - rounding, 0.0) / np.sqrt(parts[0] + parts[1])
    degrees = (parts[0] + parts[1]) ** 2 / (parts[0] ** 2 / (len(ours) - 1) + parts[1] ** 2 / (len(theirs) - 1))
    degrees = np.floor(degrees).astype(int)
    p = np.ones_like(t)
    for d in np.unique(degrees):
        here = degrees == d
        p[here] = np.interp(np.arctan(t[here] / np.sqrt(d)), *tail(int(d)))
    place = np.unravel_index(np.argmin(p), p.shape)
    return float(p[place]), tuple(map(int, place)), p.size


class Comparison:
    """Rounds of both renderers for one case, and what they say."""

    def __init__(self, mi, case, index):
        self.case = case
        scene = WORK / f"case{index}.xml"
        scene.write_text(case.xml())
        self.renderers = (Wavelobe(mi, scene), Mitsuba(mi, scene, case.spp))
        self.pictures = ([], [])
        seed = zlib.crc32(case.name.encode()) % 1000000  # another for each case: their noise shall not be one
        while not self.pictures[0] or (len(self.pictures[0]) < MOST_ROUNDS * ROUNDS[0] and self.standard_error() > BOUND / 3):
            for renderer, pictures, rounds in zip(self.renderers, self.pictures, ROUNDS):
                for _ in range(rounds):
                    pictures.append(renderer.render(seed + len(pictures)))
        self.channels = [c for c in self.pictures[1][0] if c in self.pictures[0][0]]
        self.missing = [c for c in self.pictures[1][0] if c not in self.pictures[0][0] and c != "A"]
        ours, theirs = self.stack(0), self.stack(1)
        self.tests = [("pixel", *p_of_means(ours, theirs))]
        height, width = (n // BLOCK * BLOCK for n in ours.shape[1:3])
        self.tests.append(("square", *p_of_means(*(blocks(a[:, :height, :width], BLOCK) for a in (ours, theirs)))))
        self.tests.append(("mean", *p_of_means(ours.mean(axis=(1, 2)), theirs.mean(axis=(1, 2)))))
        self.ratio, self.error = self.ratio_of_means()

    def stack(self, which):
        return np.stack([np.stack([p[c] for c in self.channels], axis=-1) for p in self.pictures[which]])

    def ratio_of_means(self):
        """Mitsuba's mean over ours, of the colours, and its standard error."""
        colours = [c for c in "RGB" if c in self.pictures[0][0] and c in self.pictures[1][0]]
        ours, theirs = (np.array([np.mean([p[c].mean() for c in colours]) for p in pictures]) for pictures in self.pictures)
        if not ours.mean():
            return (1.0 if not theirs.mean() else np.inf), 0.0
        ratio = theirs.mean() / ours.mean()
        error = np.hypot(theirs.std(ddof=1) / np.sqrt(len(theirs)), ratio * ours.std(ddof=1) / np.sqrt(len(ours)))
        return ratio, error / ours.mean()

    def standard_error(self):
        return self.ratio_of_means()[1]

    def verdict(self, threshold):
        """What differs, in words; empty if nothing does."""
        found = []
        expected = self.case.ratio
        due = 1.0 if expected is None else expected
        if abs(self.ratio - due) > BOUND * due + 3.0 * self.error:
            found.append("the mean")
        if expected is None:
            found += [f"{kind} {place} p {p:.1g}" for kind, p, place, _ in self.tests if p < threshold]
            found += [f"no channel {c}" for c in self.missing]
        return ", ".join(found)


def row(group, tests, differing, seconds):
    return {"section": "Light transport", "claim": f"{group} plugins against Mitsuba: cases that differ", "unit": "cases", "measured": len(differing), "bound": 0,
            "worst": differing[0] if differing else "", "holds": not differing, "samples": tests, "seconds": seconds, "test": "plugins.py"}


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
    # A first guess of how many tests there are: a picture of 48 x 32, its squares and its mean, in three colours.
    threshold = -np.expm1(np.log1p(-SIGNIFICANCE) / (len(chosen) * 3 * (48 * 32 + 24 + 1)))
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
        verdict = result.verdict(threshold)
        said = "differs: " + verdict if verdict else "agrees" if case.ratio is None else f"expected difference ({case.reason}; derived {case.ratio:.4f})"
        print(f"{title}: {said}; ratio {result.ratio:.4f}, standard error {result.error:.4f}", flush=True)
        groups.setdefault(case.group, []).append((title, bool(verdict), time.time()))
    rows = [row(group, len(found), [t for t, bad, _ in found if bad], found[-1][2] - start[group]) for group, found in groups.items()]
    differing = sum(r["measured"] for r in rows)
    print(f"{sum(map(len, groups.values()))} cases compared, {differing} differ; {refused} not loaded, {late} without time left")
    if "WAVELOBE_VERIFY_ROWS" in os.environ:
        with open(os.environ["WAVELOBE_VERIFY_ROWS"], "a", encoding="utf-8") as out:
            out.writelines(json.dumps(r) + "\n" for r in rows)
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
