"""Rays a second of our traversal kernels beside Embree: runs build/release/bin/traversal_benchmark and prints its figures.

Each number of threads is a process of its own. See scripts/benchmarks/traversal/ for what is measured.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys

from report import draw_traversal

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODERN_HALL = ROOT.parent / "shared/data/scenes/modern-hall/scene.xml"


def parse_arguments():
    parser = argparse.ArgumentParser(prog="scripts/benchmark traversal", description=__doc__)
    parser.add_argument("--meshes", nargs="+", default=["box", "room-1k", "room-9k", "room-99k", "room-990k", "scene", "room-10M"])
    parser.add_argument("--scene", default=str(MODERN_HALL), help="Mitsuba scene of the mesh `scene` (left out if absent)")
    parser.add_argument("--threads", nargs="+", type=int, default=sorted({1, os.cpu_count() or 1}))
    parser.add_argument("--side", type=int, default=512, help="rays a set: side x side")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--quality", choices=["fast", "best"], default="best")
    parser.add_argument("--json", help="write the rows here")
    return parser.parse_args()


def measure(options, meshes, threads):
    command = [str(ROOT / "build/release/bin/traversal_benchmark"), "--threads", str(threads), "--side", str(options.side),
               "--rounds", str(options.rounds), "--quality", options.quality, "--scene", options.scene, "--meshes", *meshes]
    if threads == 1:
        command = ["taskset", "-c", "0", *command]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)


def print_tables(result):
    print(f"{'mesh':10} {'rays':8} {'threads':>7} {'ours':>8} {'portable':>8} {'Embree':>8} {'robust':>8} {'ratio':>6} {'robust':>6}")
    for row in result["rows"]:
        print(f"{row['mesh']:10} {row['rays']:8} {row['threads']:7} {row['ours']:8.2f} {row['portable']:8.2f} "
              f"{row['embree_best']:8.2f} {row['embree_best_robust']:8.2f} {row['ratio']:6.2f} {row['ratio_robust']:6.2f}")
    print("M rays/s. Hierarchies:")
    for row in result["build"]:
        print(f"{row['mesh']:10} {row['triangles']:9} triangles, {row['threads']} threads: {row['seconds']:.2f} s, "
              f"{row['bytes_per_triangle']:.0f} bytes a triangle")


def print_growth(result):
    """What a bounce ray costs more for twice the triangles: the same from room to room where the cost grows as their logarithm."""
    for threads in sorted({row["threads"] for row in result["rows"]}):
        rows = [r for r in result["rows"] if r["rays"] == "bounce1" and r["threads"] == threads and r["mesh"].startswith("room-")]
        for a, b in zip(rows, rows[1:]):
            more = (1e3 / b["ours"] - 1e3 / a["ours"]) / math.log2(b["triangles"] / a["triangles"])
            print(f"bounce1, {threads} threads, {a['mesh']} to {b['mesh']}: {1e3 / a['ours']:.0f} to {1e3 / b['ours']:.0f} ns a ray, "
                  f"{more:.0f} ns for twice the triangles")


def main():
    options = parse_arguments()
    meshes = [m for m in options.meshes if m != "scene" or os.path.exists(options.scene)]
    if len(meshes) < len(options.meshes):
        print(f"{options.scene} is absent: left out", file=sys.stderr)
    result = {"rows": [], "build": []}
    for threads in options.threads:
        part = measure(options, meshes, threads)
        result["rows"] += part["rows"]
        result["build"] += part["build"]
    print_tables(result)
    print_growth(result)
    for path in draw_traversal(result, ROOT / "build/benchmark/plots"):
        print(f"wrote {path}")
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
