"""Writes the accuracy report from the rows that the tests measured; fails where a claim does not hold.

usage: report.py ROWS.jsonl [REPORT.md]
"""

import json
import os
import platform
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SECTIONS = ["Appearance", "Light transport", "Numerical stability", "Determinism", "Broken on purpose"]
INTRODUCTION = {
    "Appearance": "Kernels against references in double or extended precision. A *mixed* error counts how many roundings of the"
    " result and of each input component together explain the difference: float directions decide how well a narrow or grazing"
    " lobe can be known at all.",
    "Light transport": "Pictures whose value is known in closed form (derived beside each scene in `tests/render`).",
    "Numerical stability": "What must not change a picture, and scenes that try to break it.",
    "Determinism": "The same scene, seed and samples, the work divided in other ways.",
    "Broken on purpose": "One formula of the kernels broken at a time; the suite must notice.",
}


def number(value):
    if isinstance(value, str):
        return value
    if value == 0 or 0.01 <= abs(value) < 1e5:
        return f"{value:.4g}"
    return f"{value:.2e}"


def cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ")


def table(columns, rows):
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    return lines + ["| " + " | ".join(cell(c) for c in row) + " |" for row in rows]


def claims_of(rows):
    columns = ["claim", "measured", "bound", "unit", "samples", "s", "worst case"]
    return table(columns, [[r["claim"] + ("" if r["holds"] else " **fails**"), number(r["measured"]), number(r["bound"]), r["unit"],
                            f"{r['samples']:,}", f"{r['seconds']:.1f}", r["worst"]] for r in rows])


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def write(rows, path):
    mode = os.environ.get("WAVELOBE_VERIFY", "quick")
    revision = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    claims = [r for r in rows if "claim" in r]
    lines = ["# Accuracy", "",
             f"Written by `scripts/verify --{mode} --report docs/accuracy.md` at {revision} on {processor()}: {len(claims)} claims,"
             f" {sum(not r['holds'] for r in claims)} of which fail. The command measures all of it again.", ""]
    known = [line for line in (ROOT / "docs/accuracy_notes.md").read_text().splitlines()]
    lines += known + [""]
    for section in SECTIONS:
        mine = [r for r in rows if r["section"] == section]
        if not mine:
            continue
        lines += [f"## {section}", "", INTRODUCTION[section], ""]
        lines += claims_of([r for r in mine if "claim" in r]) + [""]
        for t in (r for r in mine if "table" in r):
            lines += [f"**{t['table']}**", ""]
            lines += table(t["columns"], [[number(c) for c in row] for row in t["rows"]]) + [""]
        for p in (r for r in mine if "picture" in r):
            lines += [f"![{p['picture']}](images/{p['file']})", "", f"*{p['picture']}*", ""]
    path.write_text("\n".join(lines).rstrip() + "\n")


def main():
    rows = [json.loads(line) for line in Path(sys.argv[1]).read_text().splitlines()]
    unknown = {r["section"] for r in rows} - set(SECTIONS)
    if unknown:
        sys.exit(f"no such section of the report: {', '.join(sorted(unknown))}; known are {', '.join(SECTIONS)}")
    failing = [r for r in rows if not r.get("holds", True)]
    for r in failing:
        print(f"fails: {r['claim']}: {number(r['measured'])} {r['unit']}, bound {number(r['bound'])} ({r['worst']})", file=sys.stderr)
    claims = sum("claim" in r for r in rows)
    print(f"{claims - len(failing)} of {claims} claims hold")
    if len(sys.argv) > 2:
        write(rows, Path(sys.argv[2]))
    return 1 if failing else 0


if __name__ == "__main__":
    sys.exit(main())
