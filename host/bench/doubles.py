#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What triangles in the same place cost: renders scenes of 200,000 triangles without doubles, and
with.

usage: doubles.py [--overcast build/bin/overcast] [--runs 5] [--size 512] [--triangles 200000]
                  [--most 1.5]

Pairs: slivers strewn at random and a closed sphere, each written twice (as it is, and with the copy
wound the other way from another corner); two walls along an axis and two tilted ones, cut
differently, once one behind the other and once in one plane. One light with shadows; runs in turn.
Prints a row a scene: medians of seconds of the kernel, of tracing, of building and of the whole
program, shares of flagged and retraced answers; and the ratio of each doubled scene to its single
one. Exits with 1 where a whole program or its tracing takes more than --most times the single
scene's.
"""
import argparse
import array
import json
import math
import os
import random
import statistics
import subprocess
import sys
import tempfile
import time


def write_ply(path, triangles):
    corners = array.array("f", (x for t in triangles for corner in t for x in corner))
    faces = bytearray()
    for first in range(0, 3 * len(triangles), 3):
        faces += b"\x03" + array.array("i", (first, first + 1, first + 2)).tobytes()
    with open(path, "wb") as out:
        out.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {3 * len(triangles)}\nproperty float x\nproperty float y\n"
                  f"property float z\nelement face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        out.write(corners.tobytes())
        out.write(faces)


def slivers(count):
    draw = random.Random(91)
    result = []
    for _ in range(count):
        centre = [draw.random() for _ in range(3)]
        along = [draw.gauss(0, 0.03) for _ in range(3)]
        across = [draw.gauss(0, 0.002) for _ in range(3)]
        result.append(tuple(tuple(c + s * d for c, d in zip(centre, by))
                            for s, by in ((-1, along), (1, along), (1, across))))
    return result


def sphere(count):
    n = max(4, math.isqrt(count // 2))

    def at(i, j):
        theta, phi = math.pi * j / n, 2 * math.pi * (i % n) / n
        ring = math.sin(theta) if 0 < j < n else 0.0
        return (0.5 + 0.5 * ring * math.cos(phi), 0.5 + 0.5 * math.cos(theta), 0.5 + 0.5 * ring * math.sin(phi))

    return [t for i in range(n) for j in range(n)
            for t in ((at(i, j), at(i, j + 1), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i + 1, j)))]


def wall(count, tilted, cut, behind=0.0):
    """Returns a square of n x n cells. Cut 1 has other cells and other diagonals than cut 0, and
    lies a little aside."""
    n = max(4, math.isqrt(count // 2)) - 7 * cut
    shift = 0.0123 * cut

    def at(i, j):
        x, y = shift + i / n, shift / 2 + j / n
        return (x, y, (0.31 * x - 0.17 * y + 0.5 if tilted else 0.5) - behind)

    result = []
    for i in range(n):
        for j in range(n):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            result += [(a, b, c), (a, c, d)] if cut == 0 else [(a, b, d), (b, c, d)]
    return result


def turned(triangles):
    """Returns the same triangles wound the other way, from another corner."""
    return [(c, b, a) for a, b, c in triangles]


def scenes(count):
    """Yields (name, name of the single scene or None, triangles)."""
    for name, make in (("slivers", slivers), ("sphere", sphere)):
        once = make(count)
        yield name, None, once
        yield f"{name} twice", name, once + once
        yield f"{name} twice, turned", name, once + turned(once)
    for name, tilted in (("walls", False), ("tilted walls", True)):
        front = wall(count // 2, tilted, 0)
        yield name, None, front + wall(count // 2, tilted, 1, behind=0.05)
        yield f"{name} in one plane", name, front + wall(count // 2, tilted, 1)


def measure(overcast, scene, size, folder):
    stats = os.path.join(folder, "stats.json")
    command = [overcast, "render", scene, "--size", f"{size}x{size}", "--camera", "1.3,1.1,2.2,0.5,0.5,0.5,40",
               "--light", "3,4,5", "--quiet", "--stats", stats, "-o", os.path.join(folder, "image.png")]
    start = time.perf_counter()
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    seconds = time.perf_counter() - start
    if done.returncode != 0:
        sys.exit(f"doubles.py: {overcast} failed: {(done.stderr.strip().splitlines() or ['without a word'])[-1]}")
    with open(stats) as file:
        s = json.load(file)
    rays = sum(s["rays"].values())
    return {"kernel": s["time"]["kernel"], "trace": s["time"]["trace"], "build": s["time"]["level1"] + s["time"]["level2"],
            "whole": seconds, "flagged": 100 * s["flagged"] / rays, "retraced": 100 * s["retraced"] / rays}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--overcast", default="build/bin/overcast")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--triangles", type=int, default=200000)
    parser.add_argument("--most", type=float, default=1.5)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        table = []
        for name, single, triangles in scenes(options.triangles):
            path = os.path.join(folder, f"{len(table)}.ply")
            write_ply(path, triangles)
            table.append((name, single, len(triangles), path, []))
        for _ in range(options.runs):
            for name, single, count, path, runs in table:
                runs.append(measure(options.overcast, path, options.size, folder))
    median = {name: {key: statistics.median(run[key] for run in runs) for key in runs[0]}
              for name, single, count, path, runs in table}
    print(f"{options.size} x {options.size}, {options.runs} runs in turn, {os.cpu_count()} threads, medians; "
          "(times the single scene)")
    print("| scene | triangles | kernel s | trace s | build s | whole s | flagged % | retraced % |\n" + "|---" * 8 + "|")
    too_slow = []
    for name, single, count, path, runs in table:
        m = median[name]
        ratio = {key: m[key] / median[single][key] for key in ("kernel", "trace", "build", "whole")} if single else {}
        cells = [f"{m[key]:.3f}" + (f" ({ratio[key]:.2f})" if single else "") for key in ("kernel", "trace", "build", "whole")]
        print(f"| {name} | {count} | " + " | ".join(cells) + f" | {m['flagged']:.2f} | {m['retraced']:.2f} |")
        if single and max(ratio["trace"], ratio["whole"]) > options.most:
            too_slow.append(name)
    if too_slow:
        sys.exit(f"doubles.py: more than {options.most} times the single scene: {', '.join(too_slow)}")


if __name__ == "__main__":
    main()
