#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Times `overcast render` against Debian's `povray` on the same mesh, whole programs from file to PNG, in turn.

usage: side_by_side.py MESH.ply [--overcast build/bin/overcast] [--runs 5] [--size 512]

The mesh is written once as POV-Ray mesh2 text (not timed); both programs then read, build, trace one light with shadows
without antialiasing, and write a PNG. Prints a row a program: minimum, median and maximum seconds; and the ratio of the
medians. Two threads each, or as many as there are cores.
"""
import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time


def read_triangles(overcast, mesh, folder):
    """Vertices and faces, through the command's own OBJ writer: one number format for both programs."""
    obj = os.path.join(folder, "mesh.obj")
    subprocess.run([overcast, "convert", mesh, obj], check=True, stderr=subprocess.DEVNULL)
    vertices, faces = [], []
    with open(obj) as lines:
        for line in lines:
            words = line.split()
            if words and words[0] == "v":
                vertices.append(words[1:4])
            elif words and words[0] == "f":
                faces.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
    return vertices, faces


def write_pov(path, vertices, faces):
    points = [[float(x) for x in v] for v in vertices]
    low = [min(p[k] for p in points) for k in range(3)]
    high = [max(p[k] for p in points) for k in range(3)]
    center = [(a + b) / 2 for a, b in zip(low, high)]
    size = max(b - a for a, b in zip(low, high))
    eye = [center[0] + 0.3 * size, center[1] + 0.4 * size, center[2] + 1.6 * size]
    light = [center[0] - size, center[1] + 2 * size, center[2] + 2 * size]
    vector = lambda v: "<" + ",".join(repr(x) if isinstance(x, float) else x for x in v) + ">"
    with open(path, "w") as out:
        out.write("global_settings { assumed_gamma 1 }\n")
        out.write(f"camera {{ location {vector(eye)} right -x*image_width/image_height look_at {vector(center)} angle 40 }}\n")
        out.write(f"light_source {{ {vector(light)} rgb 1 }}\nbackground {{ rgb 0.5 }}\n")
        out.write("mesh2 {\nvertex_vectors {\n" + str(len(vertices)) + ",\n")
        out.write(",\n".join(vector(v) for v in vertices))
        out.write("\n}\nface_indices {\n" + str(len(faces)) + ",\n")
        out.write(",\n".join("<%d,%d,%d>" % tuple(f) for f in faces))
        out.write("\n}\npigment { rgb 0.8 }\n}\n")
    camera = ",".join(repr(x) for x in eye + center + [40.0])
    return camera, ",".join(repr(x) for x in light)


def timed(command):
    start = time.perf_counter()
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    seconds = time.perf_counter() - start
    if done.returncode != 0:
        sys.exit(f"side_by_side.py: {command[0]} failed: {done.stderr.strip().splitlines()[-1]}")
    return seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("--overcast", default="build/bin/overcast")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--size", type=int, default=512)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        vertices, faces = read_triangles(options.overcast, options.mesh, folder)
        pov = os.path.join(folder, "mesh.pov")
        camera, light = write_pov(pov, vertices, faces)
        size = options.size
        programs = {
            "overcast": [options.overcast, "render", options.mesh, "--size", f"{size}x{size}", "--camera", camera,
                         f"--light={light}", "--quiet", "-o", os.path.join(folder, "overcast.png")],
            "povray": ["povray", f"+I{pov}", f"+O{folder}/povray.png", f"+W{size}", f"+H{size}", "-A", "-D", "-GA",
                       f"+WT{os.cpu_count()}"],
        }
        seconds = {name: [] for name in programs}
        for _ in range(options.runs):
            for name, command in programs.items():
                seconds[name].append(timed(command))
    print(f"{options.mesh}: {len(faces)} triangles, {size} x {size}, {options.runs} runs in turn, {os.cpu_count()} threads")
    print("| program | min s | median s | max s |\n|---|---|---|---|")
    for name, values in seconds.items():
        print(f"| {name} | {min(values):.2f} | {statistics.median(values):.2f} | {max(values):.2f} |")
    ratio = statistics.median(seconds["povray"]) / statistics.median(seconds["overcast"])
    print(f"overcast is {ratio:.1f} times as fast, from file to PNG")


if __name__ == "__main__":
    main()
