# SPDX-License-Identifier: Apache-2.0
"""Converts random PBRT files under a budget of host memory and without one: rays hit the same
triangles in the same points, bit for bit.

usage: streamed_pbrt.py OVERCAST [FILES [FIRST_SEED]]
"""
import pathlib
import random
import re
import struct
import subprocess
import sys
import tempfile

BUDGET = 16 << 20  # holds 33,554 triangles; files have more


def numbers(values):
    return "[" + " ".join(f"{value:.9g}" for value in values) + "]"


def grid(rng, columns, rows):
    """Returns the points, normals, texture coordinates and triangles of a bumpy square."""
    points, normals, uv = [], [], []
    bump = rng.uniform(0, 0.3)
    for i in range(columns + 1):
        for j in range(rows + 1):
            points.append((i / columns * 4 - 2, j / rows * 4 - 2, rng.uniform(-bump, bump)))
            normals.append((rng.uniform(-1, 1), rng.uniform(-1, 1), rng.choice((1, 1, 1, -1))))
            uv.append((i / columns, j / rows))
    triangles = []
    for i in range(columns):
        for j in range(rows):
            a, b = i * (rows + 1) + j, (i + 1) * (rows + 1) + j
            triangles += [(a, b, b + 1), (a, b + 1, a + 1)]
    return points, normals, uv, triangles


class File:
    """Writes a random file, and what it includes, to a folder."""

    def __init__(self, folder, seed):
        self.folder, self.rng = folder, random.Random(seed)
        self.files = 0
        self.triangles = 0
        self.objects = []
        (folder / "holes.pgm").write_text("P2\n2 2\n255\n0 255 255 0\n")

    def new_file(self, ending):
        self.files += 1
        return self.folder / f"{self.files}.{ending}"

    def triangle_mesh(self):
        points, normals, uv, triangles = grid(self.rng, self.rng.randint(1, 60),
                                              self.rng.randint(1, 60))
        self.triangles += len(triangles)
        text = (f'Shape "trianglemesh" "integer indices" {numbers(sum(triangles, ()))} '
                f'"point3 P" {numbers(sum(points, ()))}')
        if self.rng.random() < 0.5:
            text += f' "normal N" {numbers(sum(normals, ()))}'
        if self.rng.random() < 0.3:
            text += f' "point2 uv" {numbers(sum(uv, ()))}'
        if self.rng.random() < 0.2:
            text += ' "texture alpha" "holes"'
        return text + "\n"

    def ply_mesh(self):
        points, normals, _, triangles = grid(self.rng, self.rng.randint(1, 110),
                                             self.rng.randint(1, 110))
        self.triangles += len(triangles)
        has_normals, double = self.rng.random() < 0.5, self.rng.random() < 0.3
        kind = "double" if double else "float"
        names = ["x", "y", "z"] + ["nx", "ny", "nz"] * has_normals
        header = ("ply\nformat binary_little_endian 1.0\n" f"element vertex {len(points)}\n" +
                  "".join(f"property {kind} {name}\n" for name in names) +
                  f"element face {len(triangles)}\n"
                  "property list uchar int vertex_indices\nend_header\n")
        body = b""
        far = self.rng.choice((0, 0, 1e6)) if double else 0
        for point, normal in zip(points, normals):
            row = (point[0] + far, *point[1:]) + (normal if has_normals else ())
            body += struct.pack(f"<{len(row)}{kind[0]}", *row)
        body += b"".join(struct.pack("<B3i", 3, *triangle) for triangle in triangles)
        path = self.new_file("ply")
        path.write_bytes(header.encode() + body)
        back = f"Translate {-far} 0 0 " if far else ""
        return f'{back}Shape "plymesh" "string filename" "{path.name}"\n'

    def round_shape(self):
        self.triangles += 1000
        return self.rng.choice((
            'Shape "sphere" "float radius" 1.5\n', 'Shape "cylinder" "float phimax" 200\n',
            'Shape "disk" "float height" 0.5\n', 'Shape "cone"\n', 'Shape "paraboloid"\n',
            'Shape "loopsubdiv" "integer nlevels" 3 "integer indices" [0 1 2 0 3 1 1 3 2 2 3 0] '
            '"point3 P" [0 0 0 2 0 0 0 2 0 0 0 2]\n',
            'Shape "heightfield" "integer nu" 3 "integer nv" 3 '
            '"float Pz" [0 .1 .2 .3 .1 .5 0 .2 .4]\n'))

    def transform(self):
        rng = self.rng
        return rng.choice((
            f"Translate {rng.uniform(-9, 9):.4f} {rng.uniform(-9, 9):.4f} 0\n",
            f"Rotate {rng.uniform(0, 360):.4f} {rng.uniform(-1, 1):.3f} 1 0.3\n",
            f"Scale {rng.uniform(0.3, 2):.4f} {rng.choice((1, -1))} {rng.uniform(0.3, 2):.4f}\n",
            f"ConcatTransform [1 {rng.uniform(0, 1):.3f} 0 0  0 1 0 0  0 0.2 1 0  "
            f"{rng.uniform(-5, 5):.3f} 0 0 1]\n", "ReverseOrientation\n",
            f'Material "matte" "rgb Kd" [{rng.random():.2f} 0.5 0.5]\n'))

    def item(self, depth, in_object=False):
        rng = self.rng
        chance = rng.random()
        if chance < 0.3:
            return self.triangle_mesh()
        if chance < 0.45:
            return self.ply_mesh()
        if chance < 0.6:
            return self.round_shape()
        if chance < 0.75:
            return self.transform()
        if chance < 0.85 and depth < 3:
            path = self.new_file("pbrt")
            path.write_text(self.items(rng.randint(1, 3), depth + 1, in_object))
            return f'Include "{path.name}"\n'
        if chance < 0.92 and not in_object and depth == 0:
            self.objects.append(f"o{len(self.objects)}")
            shape = self.triangle_mesh() if rng.random() < 0.3 else self.round_shape()
            if rng.random() < 0.5:  # a small one, which is copied wherever it is placed
                shape = ('Shape "trianglemesh" "integer indices" [0 1 2] '
                         '"point3 P" [0 0 0 1 0 0 0 1 0]\n')
            return f'ObjectBegin "{self.objects[-1]}"\n{shape}ObjectEnd\n' + self.instance()
        return self.instance() if self.objects and not in_object else self.triangle_mesh()

    def instance(self):
        name = self.rng.choice(self.objects)
        return f'AttributeBegin\n{self.transform()}ObjectInstance "{name}"\nAttributeEnd\n'

    def items(self, count, depth=0, in_object=False):
        return "".join(f"AttributeBegin\n{self.transform()}{self.item(depth, in_object)}"
                       "AttributeEnd\n" if self.rng.random() < 0.7 else
                       self.item(depth, in_object) for _ in range(count))

    def write(self):
        text = ('LookAt 0 0 -50  0 0 0  0 1 0\nCamera "perspective"\nWorldBegin\n'
                'Texture "holes" "float" "imagemap" "string filename" "holes.pgm"\n')
        while self.triangles < 45000:
            text += self.items(5)
        path = self.folder / "a.pbrt"
        path.write_text(text)
        return path


def run(command, given=None):
    done = subprocess.run([str(word) for word in command], input=given, capture_output=True,
                          text=True, timeout=300)
    return done.returncode, done.stdout, done.stderr.strip()


def main():
    overcast = sys.argv[1]
    files = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    streamed = 0
    for seed in range(first, first + files):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            source = File(folder, seed).write()
            held, other = folder / "held.ovc", folder / "streamed.ovc"
            code, _, said = run([overcast, "convert", source, held, "--quiet"])
            if code != 0 and seed == first:
                print(f"skipped: {said}")
                return 77
            if code != 0:
                sys.exit(f"seed {seed}: {said}")
            convert = [overcast, "convert", source, other, "--host-memory"]
            code, _, said = run(convert + [BUDGET])
            # Objects that share triangles are built in memory, which may need a larger budget.
            larger = re.search(r"the smallest number that works is (\d+)", said)
            if code == 1 and larger:
                code, _, said = run(convert + [larger[1]])
            if code != 0:
                sys.exit(f"seed {seed}: {said}")
            streamed += not larger
            rng = random.Random(seed)
            rays = "".join(
                f"{rng.uniform(-9, 9)} {rng.uniform(-9, 9)} -40 {rng.uniform(-0.2, 0.2)} "
                f"{rng.uniform(-0.2, 0.2)} 1\n" for _ in range(2000))
            expected = run([overcast, "trace", held], rays)
            found = run([overcast, "trace", other, "--host-memory", BUDGET], rays)
            hits = sum(line != "miss" for line in expected[1].splitlines())
            print(f"seed {seed}: {hits} hits, {'held' if larger else 'streamed'}")
            if expected[0] != 0 or found[0] != 0 or hits < 100:
                sys.exit(f"seed {seed}: {hits} hits; {expected[2]}; {found[2]}")
            if expected[1] != found[1]:
                sys.exit(f"seed {seed}: other hits")
    if streamed < files / 3:
        sys.exit(f"{streamed} of {files} files were streamed, expected more")
    return 0


if __name__ == "__main__":
    sys.exit(main())
