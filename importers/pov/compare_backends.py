#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders POV-Ray scenes by two backends, whose pictures must have the same bytes: a backend that
loses a hit, or takes a farther one, shows in one pixel. cpu-kdtree shares no kernel with two-level.

usage: compare_backends.py [--data DIR] [--index FILE] [--tiers AB] [--only TEXT] [--build DIR]
                           [--backends A,B] [--size WxH] [--limit SECONDS] [SCENE ...]

The scenes are those of the index (compare.py), or SCENE ... . Prints the scenes that differ, and
those of which one backend alone makes a picture; what takes longer than --limit is not compared.
Exits with 1 where there are any, no picture was compared, or one of SCENE ... was not. The vectors
of a software renderer are as wide as LP_NATIVE_VECTOR_WIDTH says.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

from compare import ROOT, add_choice, chosen_scenes
from png import read_png


def picture(scene, backend, options, folder):
    """Returns (the picture's bytes, or None where there is none; why there is none)."""
    path = folder / f"{backend}.png"
    path.unlink(missing_ok=True)
    command = [options.build / "bin" / "overcast", "render", scene, "--size", options.size,
               "--backend", backend, "--quiet", "-o", path]
    try:
        done = subprocess.run(command, capture_output=True, timeout=options.limit)
    except subprocess.TimeoutExpired:
        return None, "too slow"
    lines = done.stderr.decode("utf-8", "replace").strip().splitlines()
    if done.returncode != 0 or not path.exists():
        return None, lines[-1] if lines else f"exit {done.returncode}"
    return read_png(path)[2], ""


def compare(scene, options, folder):
    """Returns what is wrong with the scene's pictures, "" or None where there is none."""
    backends = options.backends.split(",")
    pictures = [picture(scene, backend, options, folder) for backend in backends]
    values = [values for values, _ in pictures]
    whys = [why for _, why in pictures]
    if None in values:
        return None if values[0] == values[1] or "too slow" in whys else \
            "; ".join(f"{b}: {why}" for b, why in zip(backends, whys) if why)
    off = sum(a != b for a, b in zip(*values))
    return f"{off} of {len(values[0])} values differ" if off else ""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scenes", nargs="*", type=pathlib.Path, metavar="SCENE")
    add_choice(parser)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--backends", default="two-level,cpu-kdtree")
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--limit", type=float, default=60, help="seconds for one picture")
    options = parser.parse_args()
    scenes = [s.resolve() for s in options.scenes] or chosen_scenes(options)
    same = wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            found = compare(scene, options, pathlib.Path(folder))
            same += found == ""
            wrong += bool(found)
            if found:
                print(f"{scene}: {found}", flush=True)
    print(f"{same} scenes have the same picture, {wrong} do not, of {len(scenes) - same - wrong} "
          "there is none")
    return 1 if wrong or same < max(1, len(options.scenes)) else 0


if __name__ == "__main__":
    sys.exit(main())
