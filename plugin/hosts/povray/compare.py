#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""Draws scenes with povray and povray-overcast, and compares the pictures, time and memory.

usage: compare.py [--build DIR] [--data DIR] [-o DIR] [--size WxH] [--threads 1,2,4]
                  [--at-most RMSE] [--scene FILE ...] [NAME ...]

Draws the scenes NAME of scenes/ and the scenes FILE, or all of scenes/ except plants if none is
named. The folder of -o keeps the pictures. Without --data, the folder with the real data
unpacked, test scenes of Overcast stand in for the real meshes.

A line for each scene has
- for each number of threads, the root mean square difference of the two programs' code values,
  which have 8 bits,
- the number of pixels with a color that differs by more than 2,
- the difference among povray's own pictures at these numbers of threads,
- the number of rays that Overcast answered,
- for the first number of threads, both programs' seconds of CPU time for parsing (with
  building) and for tracing, seconds in all, and peak memory.

The exit code is 1 if Overcast answered no ray, or if a picture differs by more than --at-most
(0.5). After the first number of threads, the difference among povray's own pictures is added to
that limit, because radiosity on several threads differs from run to run. The exit code is 77 if
povray or povray-overcast is missing.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

from mesh_files import SOURCES, write_include

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
SKIPPED = 77  # what CTest is told
LOUD = 2      # code values
TIMES = re.compile(r"^\s*(Parse|Photon|Radiosity|Trace) Time:.*\n.*?([\d.]+) CPU-seconds", re.M)
ANSWERED = re.compile(r"^povray-overcast: meshes: .*rays: (\d+)", re.M)

# Linux counts the memory that the parent had at the fork as memory of the child. So the programs
# are started by a process that has little.
SMALL_PARENT = """import os, sys
_, status, used = os.wait4(os.posix_spawnp(sys.argv[2], sys.argv[2:], os.environ), 0)
with open(sys.argv[1], "w") as file:
    print(os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime,
          used.ru_maxrss / 1024, file=file)
"""


class Run:
    """A picture that a program drew, with its time and memory."""

    def __init__(self, program, scene, picture, threads, options):
        self.picture = picture
        command = [program, f"+I{scene}", f"+O{picture}", "+FP8", "File_Gamma=sRGB",
                   "-D", "-A", "+HR", f"+WT{threads}",
                   f"+L{options.output}", f"+L{HERE / 'scenes'}", f"+L{scene.parent}",
                   f"+W{options.width}", f"+H{options.height}"]
        triangles = os.environ.get("OVC_POVRAY_TRIANGLES", "1")
        environment = dict(os.environ, OVC_POVRAY_TRIANGLES=triangles)
        log, took = picture.with_suffix(".log"), picture.with_suffix(".took")
        start = time.monotonic()
        with open(log, "wb") as said:
            subprocess.run([sys.executable, "-SE", "-c", SMALL_PARENT, took, *command],
                           stdout=said, stderr=said, stdin=subprocess.DEVNULL,
                           cwd=scene.parent, env=environment, check=True)
        self.wall = time.monotonic() - start
        text = log.read_text(errors="replace")
        code, self.cpu, self.megabytes = map(float, took.read_text().split())
        if code != 0:
            sys.exit(f"compare.py: {' '.join(map(str, command))} ended with {code:.0f}; "
                     f"what it said is in {log}")
        self.trace = sum(float(seconds) for phase, seconds in TIMES.findall(text)
                         if phase != "Parse")
        rays = ANSWERED.findall(text)
        self.rays = int(rays[-1]) if rays else 0

    def pixels(self):
        """Returns three code values for each pixel."""
        data = self.picture.read_bytes()
        header = re.match(rb"P6\s+(?:#.*\n\s*)*(\d+)\s+(\d+)\s+255\s", data)
        if not header:
            sys.exit(f"compare.py: {self.picture} is no PPM file of 8 bits")
        return data[header.end():][:3 * int(header[1]) * int(header[2])]


def off(ours, theirs):
    """Returns the root mean square difference, and the number of pixels with a color more than LOUD
    off."""
    differences = [abs(a - b) for a, b in zip(ours, theirs)]
    loud = sum(max(differences[at:at + 3]) > LOUD for at in range(0, len(differences), 3))
    return (sum(d * d for d in differences) / len(differences)) ** 0.5, loud


def compare(scene, options):
    """Prints the line of the scene. Returns whether its pictures are within the limits."""
    for name in re.findall(r'#include "(\w+)\.inc"', scene.read_text(errors="replace")):
        if name in SOURCES and scene.parent == HERE / "scenes":
            write_include(name, options.overcast, options.data, options.output)
    theirs, ours = {}, {}
    for threads in options.threads:
        for program, runs, tag in ((options.povray, theirs, "povray"),
                                   (options.ours, ours, "overcast")):
            picture = options.output / f"{scene.stem}-{tag}-{threads}.ppm"
            runs[threads] = Run(program, scene, picture, threads, options)
    first = options.threads[0]
    pictures = {threads: run.pixels() for threads, run in theirs.items()}
    apart = [off(run.pixels(), pictures[threads]) for threads, run in ours.items()]
    among = max([off(pictures[threads], pictures[first])[0] for threads in options.threads[1:]],
                default=0)
    a, b = theirs[first], ours[first]
    print(f"{scene.stem:12} {' '.join(f'{rmse:6.3f}' for rmse, _ in apart)} "
          f"{max(loud for _, loud in apart):6d} {among:8.3f} {b.rays:11,d}  "
          f"{a.cpu - a.trace:6.1f} {b.cpu - b.trace:6.1f}  {a.trace:7.1f} {b.trace:7.1f}  "
          f"{a.wall:7.1f} {b.wall:7.1f}  {a.megabytes:6.0f} {b.megabytes:6.0f}", flush=True)
    limits = [options.at_most] + [options.at_most + among] * (len(apart) - 1)
    return (all(rmse <= limit for (rmse, _), limit in zip(apart, limits))
            and all(run.rays > 0 for run in ours.values()))


def options_of(arguments):
    description, _, epilog = __doc__.split("\n\n", 2)
    parser = argparse.ArgumentParser(description=description, epilog=epilog,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build",
                        help="where bin/ has overcast and povray-overcast")
    parser.add_argument("--data", type=pathlib.Path, help="the real data, unpacked")
    parser.add_argument("-o", "--output", type=pathlib.Path,
                        default=pathlib.Path("povray-pictures"))
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--threads", default="1,2,4")
    parser.add_argument("--at-most", type=float, default=0.5)
    parser.add_argument("--scene", type=pathlib.Path, nargs="*", default=[], metavar="FILE")
    parser.add_argument("names", nargs="*", metavar="NAME")
    options = parser.parse_args(arguments)
    size = re.fullmatch(r"\d+x\d+", options.size)
    if not size or not re.fullmatch(r"\d+(,\d+)*", options.threads):
        parser.error(f"--size is {options.size}, --threads {options.threads}; "
                     "expected such as 320x240 and 1,2,4")
    options.width, options.height = map(int, options.size.split("x"))
    options.threads = [int(t) for t in options.threads.split(",")]
    options.build = options.build.resolve()
    options.output = options.output.resolve()
    return options


def main():
    options = options_of(sys.argv[1:])
    options.overcast = options.build / "bin/overcast"
    options.ours = options.build / "bin/povray-overcast"
    options.povray = shutil.which("povray")
    if not options.povray or not options.ours.exists():
        missing = options.ours if options.povray else "povray"
        print(f"skipped: there is no {missing}; "
              "plugin/hosts/povray/README.md says how to come by it")
        return SKIPPED
    options.output.mkdir(parents=True, exist_ok=True)
    every = sorted(path.stem for path in (HERE / "scenes").glob("*.pov") if path.stem != "plants")
    names = options.names or ([] if options.scene else every)
    scenes = [HERE / "scenes" / f"{name}.pov" for name in names]
    scenes += [path.resolve() for path in options.scene]
    for scene in scenes:
        if not scene.exists():
            sys.exit(f"compare.py: there is no scene {scene}")
    print(f"{options.size}; RMSE at {', '.join(map(str, options.threads))} threads; "
          f"of times and memory, povray's first, at {options.threads[0]}")
    print(f"{'scene':12} {'RMSE':>{7 * len(options.threads) - 1}} pixels povray's        rays"
          "  parse,  build s        trace s           wall s          MB")
    good = [compare(scene, options) for scene in scenes]
    print(f"{good.count(True)} of {len(good)} scenes are the same picture, "
          f"within {options.at_most} of 255")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
