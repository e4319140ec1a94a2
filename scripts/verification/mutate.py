"""Breaks formulas of the kernels one at a time and lists which test notices; a break that none does is a failure.

The kernels travel inside the executables: each break is made in a copy of the sources and built there.
"""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

from rows import append_rows

ROOT = Path(__file__).resolve().parents[2]
# Where a release build lies relative to its sources, so that a compiler cache knows the files.
COPY = ROOT / "build/mutants"
BUILD = COPY / "build/release"

# What is broken, the file, the text, what takes its place, and the tests that may notice, the likeliest first.
LOBES = ["verify_test_lobe_precision", "kernels_test_lobes"]
SCENES = ["render_test_closed_forms"]
MUTANTS = [
    ("cosine dropped from Lambert's value", "bsdf/lambert.h", "scale(l.diffuse, pdf)", "scale(l.diffuse, (Float)INV_PI)", LOBES),
    ("densities swapped in the MIS weight", "sampling/mis.h", "pdf_b / pdf_a", "pdf_a / pdf_b", SCENES),
    ("squared index forgotten in refraction", "bsdf/dielectric.h", "f.eta_ti * f.eta_ti", "ONE", LOBES),
    ("half vector's Jacobian 1/2 for 1/4", "bsdf/microfacet.h", "0.25f * microfacet_density", "0.5f * microfacet_density", LOBES),
    ("Phong normalised with n + 1", "bsdf/phong.h", "(l.exponent + 2.0f)", "(l.exponent + 1.0f)", LOBES),
    ("masking of the outgoing direction left out", "bsdf/microfacet.h", "g.both = 2.0f * inverse * wo.z", "g.both = g.visible", LOBES),
    ("Fresnel: polarizations not averaged", "bsdf/fresnel.h", "0.5f * madd(r_s, r_s, r_p * r_p)", "r_s * r_s", ["verify_test_fresnel_points"]),
    ("hash of the sampler loses its last bits", "sampling/sampler.h", "return x ^ (x >> 15);", "return x & (UInt)0xfffff000u;", ["kernels_test_sampler"] + SCENES),
    ("cone of a sphere light too wide by 1 %", "lights/sphere.h", "r2 / d2, ONE", "1.01f * r2 / d2, ONE", SCENES + ["kernels_test_lights"]),
    ("rounding bound of hit points dropped", "core/rounding.h", "Float d = dot3(absolute(normal), error) * (1.0f + GAMMA(8));",
     "Float d = ZERO;", ["kernels_test_leaving_rays"]),
    ("Beckmann masking off by 1 % in a coefficient", "bsdf/microfacet.h", "(Float)3.535f", "(Float)3.5f", LOBES),
    ("what is not finite is not looked for", "core/block.h", "Int broken = live & !(finiteness == 0.0f);", "Int broken = live & !TRUE_MASK;",
     ["stages_test_broken_samples"]),
    ("light samples' weight left out beside BSDF samples", "sampling/mis.h", "SELECT(delta, ONE, inverse_power_heuristic(pdf_light, pdf_bsdf))",
     "ONE", ["verify_test_estimators"] + SCENES),
    ("last child left out where a light's probability is found again", "lights/light_tree.h", "mine / running_sums(importances).s7",
     "mine / running_sums(importances).s6", ["kernels_test_light_tree"]),
    ("facets sure of what is too close to call", "shapes/few_facets.h", "#define FACET_ERROR GAMMA(128)", "#define FACET_ERROR GAMMA(1)",
     ["kernels_test_few_facets"]),
    ("cosine of the light forgotten", "lights/area.h", "SELECT(by_area, fabs(cosine), solid_angle)", "SELECT(by_area, ONE, solid_angle)",
     ["kernels_test_lights"] + SCENES),
]


def run(command, **options):
    return subprocess.run([str(c) for c in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **options).returncode


def outdated():
    """Those of the texts to break that are no longer in the kernels, a line each."""
    return [f"kernels/{path} no longer holds `{old}`: bring the list of scripts/verification/mutate.py up to date"
            for _, path, old, _, _ in MUTANTS if old not in (ROOT / "kernels" / path).read_text()]


def prepare():
    for part in ("host", "kernels", "scripts", "tests", "scenes"):
        shutil.rmtree(COPY / part, ignore_errors=True)
    COPY.parent.mkdir(parents=True, exist_ok=True)
    for part in ("CMakeLists.txt", "CMakePresets.json", "host", "kernels", "scripts", "tests", "scenes"):
        source = ROOT / part
        (shutil.copytree if source.is_dir() else lambda a, b: (b.parent.mkdir(parents=True, exist_ok=True), shutil.copy2(a, b)))(source, COPY / part)
    # What was built last may hold a broken formula, from a run that was cut off.
    for file in (COPY / "kernels").rglob("*.h"):
        file.touch()
    options = ["-DCMAKE_BUILD_TYPE=Release"] + ([f"-DCMAKE_CXX_COMPILER_LAUNCHER={shutil.which('ccache')}"] if shutil.which("ccache") else [])
    subprocess.run(["cmake", "-G", "Ninja", "-S", COPY, "-B", BUILD, *options], check=True, stdout=subprocess.DEVNULL)


def failing_test(tests):
    """The first of the tests that fails, by its program and the first case that does; None if all pass."""
    if run(["cmake", "--build", BUILD, "--target", *tests, "-j2"]) != 0:
        raise RuntimeError("the broken sources do not build")
    for test in tests:
        output = subprocess.run([BUILD / "bin" / test], capture_output=True, text=True, env={**os.environ, "WAVELOBE_VERIFY": "quick", "WAVELOBE_VERIFY_ROWS": "/dev/null"}).stdout
        failed = [line.split("]", 1)[1].strip() for line in output.splitlines() if line.startswith("[  FAILED  ]")]
        if failed:
            return f"{test}: {failed[0].split(',')[0].split(' (')[0]}"
    return None


def main():
    missing = outdated()
    if missing or "--check" in sys.argv:
        sys.stderr.writelines(line + "\n" for line in missing)
        return 1 if missing else 0
    prepare()
    tests = sorted({t for m in MUTANTS for t in m[4]})
    broken = failing_test(tests)
    if broken:
        print(f"fails before anything is broken: {broken}", file=sys.stderr)
        return 1
    missed = left = 0
    rows = []
    limit = time.time() + float(os.environ.get("WAVELOBE_MUTATE_SECONDS", "1800"))
    for title, path, old, new, tests in MUTANTS:
        start = time.time()
        if start > limit:
            left += 1
            rows.append([title, path, "not tried: no time left", 0.0])
            continue
        file = COPY / "kernels" / path
        text = file.read_text()
        file.write_text(text.replace(old, new, 1))
        try:
            caught = failing_test(tests)
        finally:
            file.write_text(text)
        missed += caught is None
        rows.append([title, path, caught or "**nothing**", round(time.time() - start, 1)])
        print(f"{title}: {caught or 'NOT NOTICED'}", flush=True)
    lines = [{"section": "Broken on purpose", "claim": "Broken formulas that no test notices", "unit": "formulas", "measured": missed,
              "bound": 0, "samples": len(rows) - left, "seconds": sum(r[3] for r in rows), "worst": f"{left} not tried" if left else "", "holds": missed == 0, "test": "mutate.py"},
             {"section": "Broken on purpose", "table": "What noticed", "columns": ["broken", "file", "noticed first by", "s"], "rows": rows}]
    append_rows(lines)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
