#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Times the systems of the thesis beside the product, in turn, and prints a table in Markdown.

usage: systems.py SCENE [--overcast build/bin/overcast] [--runs 3] [--size 1024] [--only NAME[,NAME]]

Each run is a whole `overcast render SCENE --backend B --stats`, primary and shadow rays; a first round, which fills the
driver's cache of compiled kernels, is not counted. Mrays/s: rays divided by `time.kernel`, the seconds from a batch's
upload until its answers are read back; median, least and most of the runs. A backend that refuses the scene is named with
its sentence.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile

SYSTEMS = {
    "two-level": ["--backend", "two-level"],
    "two-level, one leaf": ["--backend", "two-level", "--leaves", "1"],
    "two-level, fragment": ["--backend", "two-level", "--kernel", "fragment"],
    "single-texture": ["--backend", "single-texture"],
    "multi-texture, 2 textures": ["--backend", "multi-texture", "--leaves", "2"],
    "multi-texture, 4 to 7": ["--backend", "multi-texture", "--leaves", "4"],
    "gpu-grid": ["--backend", "gpu-grid"],
    "gpu-kdtree": ["--backend", "gpu-kdtree"],
    "skip-bvh": ["--backend", "skip-bvh"],
}


def run(overcast, scene, size, options, folder):
    """The statistics of one rendering, or the sentence it was refused with."""
    stats = os.path.join(folder, "stats.json")
    command = [overcast, "render", scene, "--size", f"{size}x{size}", "--quiet", "--stats", stats,
               "-o", os.path.join(folder, "x.png"), *options]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        return done.stderr.strip()
    with open(stats) as text:
        return json.load(text)


def rate(stats):
    return sum(stats["rays"].values()) / stats["time"]["kernel"] / 1e6


def row(name, runs):
    last = runs[-1]
    rates = [rate(r) for r in runs]
    build = statistics.median(r["time"]["level1"] + r["time"]["level2"] for r in runs)
    return (f"| {name} | {statistics.median(rates):.2f} ({min(rates):.2f} to {max(rates):.2f}) | {build:.2f} "
            f"| {last['level2_bytes'] / last['triangles']:.1f} | {last['passes']:,} | {last['flagged']:,} "
            f"| {last['retraced']:,} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--overcast", default="build/bin/overcast")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--only", default="", help="rows whose names begin so")
    given = parser.parse_args()
    prefixes = tuple(given.only.split(","))
    results = {name: [] for name in SYSTEMS if name.startswith(prefixes)}
    refused = {}
    with tempfile.TemporaryDirectory() as folder:
        for turn in range(given.runs + 1):
            for name in results:
                if name in refused:
                    continue
                stats = run(given.overcast, given.scene, given.size, SYSTEMS[name], folder)
                if isinstance(stats, str):
                    refused[name] = stats
                elif turn > 0:
                    results[name].append(stats)
    print("| system | kernel Mrays/s | build s | bytes a triangle | passes | flagged | retraced |\n|---|---|---|---|---|---|---|")
    for name, runs in results.items():
        print(row(name, runs) if name not in refused else f"| {name} | {refused[name]} | | | | | |")
    return 1 if len(refused) == len(results) else 0


if __name__ == "__main__":
    sys.exit(main())
