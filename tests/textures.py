# SPDX-License-Identifier: Apache-2.0
"""Renders textured squares of each format, and compares their pixels with the picture on them. A
plain square in the same light tells how much of a color arrives.

usage: textures.py OVERCAST
"""
import json
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "importers/pov"))
from png import MAGIC, read_png, write_png  # noqa: E402  (the importers' own)
import zlib  # noqa: E402

OVERCAST = pathlib.Path(sys.argv[1])
LIBRARY = OVERCAST.parent / "libovercast-textures.so"
# The colors of the four quarters of the picture, from the top down.
TEXELS = [(255, 0, 0), (0, 255, 0), (0, 0, 255), (200, 100, 50)]
VIEW = ["--size", "32x32", "--light", "0.5,0.5,40"]
CAMERA = ["--camera", "0.5,0.5,3,0.5,0.5,0,18"]  # sees a little less than the square
AWAY = ["--camera", "0.5,0.5,3,0.5,0.5,9,18"]


def linear(code):
    code /= 255
    return code / 12.92 if code <= 0.04045 else ((code + 0.055) / 1.055) ** 2.4


def quarters(colors):
    """Returns the pixels of a picture of 16 x 16 with these four colors."""
    return b"".join(bytes(colors[x // 8 + 2 * (y // 8)]) for y in range(16) for x in range(16))


def write_rgba(path, width, height, pixels):
    """Writes a PNG with opacity. pixels: width x height x 4 bytes."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))
    rows = b"".join(b"\0" + pixels[at:at + 4 * width] for at in range(0, len(pixels), 4 * width))
    path.write_bytes(MAGIC + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def obj(material, folder, name):
    (folder / f"{name}.mtl").write_text(f"newmtl m\n{material}\n")
    (folder / f"{name}.obj").write_text(
        f"mtllib {name}.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n")
    return folder / f"{name}.obj"


def pbrt(material, folder, name):
    (folder / f"{name}.pbrt").write_text(
        f'WorldBegin\n{material}\nShape "trianglemesh" "integer indices" [0 1 2 0 2 3] '
        '"point P" [0 0 0 1 0 0 1 1 0 0 1 0] "float uv" [0 0 1 0 1 1 0 1]\nWorldEnd\n')
    return folder / f"{name}.pbrt"


def gltf(material, folder, name):
    """A square with v downwards; its numbers lie in a file beside it."""
    corners = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]
    data = (struct.pack("<12f", *corners) + struct.pack("<8f", 0, 1, 1, 1, 1, 0, 0, 0) +
            struct.pack("<6H", 0, 1, 2, 0, 2, 3))
    (folder / f"{name}.bin").write_bytes(data)
    views = [(0, 48), (48, 32), (80, 12)]
    kinds = [(5126, 4, "VEC3"), (5126, 4, "VEC2"), (5123, 6, "SCALAR")]
    (folder / f"{name}.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "materials": [material],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2,
                                    "material": 0}]}],
        "buffers": [{"byteLength": len(data), "uri": f"{name}.bin"}],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size in views],
        "accessors": [{"bufferView": i, "componentType": kind, "count": count, "type": shape,
                       **({"min": [0, 0, 0], "max": [1, 1, 0]} if i == 0 else {})}
                      for i, (kind, count, shape) in enumerate(kinds)],
        "textures": [{"source": 0, "sampler": 0}], "images": [{"uri": "four.png"}],
        "samplers": [{"magFilter": 9728}]}))
    return folder / f"{name}.gltf"


HALF = [0.5, 0.5, 0.5, 1]
WHITE = {obj: "Kd 0.5 0.5 0.5", pbrt: 'Material "matte" "rgb Kd" [0.5 0.5 0.5]',
         gltf: {"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": HALF}}}
FOUR = {obj: "Kd 0.5 0.5 0.5\nmap_Kd four.png",
        pbrt: 'Texture "t" "color" "imagemap" "string filename" "four.png" "float scale" 0.5\n'
              'Material "matte" "texture Kd" "t"',
        gltf: {"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": HALF,
                                        "baseColorTexture": {"index": 0}}}}


class Textures(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        write_png(self.folder / "four.png", 16, 16, quarters(TEXELS))

    def render(self, scene, *more, wanted=0, overcast=OVERCAST, camera=CAMERA,
               backend="cpu-kdtree"):
        """Returns the picture's pixels in linear light, and what was said."""
        out = self.folder / "out.png"
        done = subprocess.run([overcast, "render", scene, "-o", out, "--backend", backend, *VIEW,
                               *camera, *more], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, wanted, done.stderr)
        if wanted:
            return None, done.stderr
        width, height, codes = read_png(out)
        self.assertEqual((width, height), (32, 32))
        return [[tuple(linear(codes[3 * (y * 32 + x) + c]) for c in range(3)) for x in range(32)]
                for y in range(32)], done.stderr

    def expect_texels(self, pixels, white, texels):
        """The middles of the four quarters of the square, from the top down."""
        for number, texel in enumerate(texels):
            x, y = 8 + 16 * (number % 2), 8 + 16 * (number // 2)
            for c in range(3):
                self.assertAlmostEqual(pixels[y][x][c], white[y][x][c] * linear(texel[c]),
                                       delta=0.02, msg=f"texel {number}, channel {c}")

    def test_each_format_shows_its_picture_the_right_way_up(self):
        for make in (obj, pbrt, gltf):
            with self.subTest(make.__name__):
                white, _ = self.render(make(WHITE[make], self.folder, "white"))
                pixels, said = self.render(make(FOUR[make], self.folder, "four"))
                self.assertNotIn("not shown", said)
                self.expect_texels(pixels, white, TEXELS)

    def test_path_tracing_sees_the_same_picture(self):
        more = ["--integrator", "path", "--samples", "1", "--max-depth", "1"]
        for make in (obj, pbrt):
            with self.subTest(make.__name__):
                white, _ = self.render(make(WHITE[make], self.folder, "white"), *more)
                pixels, _ = self.render(make(FOUR[make], self.folder, "four"), *more)
                self.expect_texels(pixels, white, TEXELS)

    def test_a_scene_file_keeps_the_name_and_not_the_pixels(self):
        scene = obj(FOUR[obj], self.folder, "four")
        white, _ = self.render(obj(WHITE[obj], self.folder, "white"))
        kept = self.folder / "four.ovc"
        subprocess.run([OVERCAST, "convert", scene, kept, "-q"], check=True, timeout=300)
        write_png(self.folder / "four.png", 16, 16, bytes([255] * 3 * 256))
        pixels, _ = self.render(kept)
        self.expect_texels(pixels, white, [(255, 255, 255)] * 4)
        again, _ = self.render(kept, "--texture-memory", "10M")
        self.assertEqual(again, pixels)
        on_disk, _ = self.render(kept, "--host-memory", "64M", backend="two-level")
        self.assertEqual(on_disk, pixels)

    def test_a_missing_picture_is_one_sentence_and_strict_an_error(self):
        scene = obj("Kd 0.5 0.25 1\nmap_Kd gone.png", self.folder, "gone")
        plain, _ = self.render(obj("Kd 0.5 0.25 1", self.folder, "plain"))
        pixels, said = self.render(scene)
        self.assertEqual(pixels, plain)
        sentence = f"gone.mtl, line 3: the picture '{self.folder}/gone.png' is not shown: " \
                   "there is no such file\n"
        self.assertEqual(said.count(sentence), 1, said)
        self.assertIn("not drawn as its author meant: pictures that are missing or cannot be read "
                      "(1)", said)
        _, said = self.render(scene, "--strict", wanted=1)
        self.assertIn(sentence, said)

    def test_a_picture_that_breaks_off_is_said_after_the_picture(self):
        noise = random.Random(1).randbytes(3 * 64 * 64)
        picture = self.folder / "four.png"
        write_png(picture, 64, 64, noise)
        picture.write_bytes(picture.read_bytes()[:3000])
        _, said = self.render(obj(FOUR[obj], self.folder, "four"))
        self.assertIn("is not shown: ", said)
        self.assertIn("not drawn as its author meant", said)
        self.render(obj(FOUR[obj], self.folder, "four"), "--strict", wanted=1)

    def test_without_the_library_the_scene_renders_as_before(self):
        alone = self.folder / "bin"
        alone.mkdir()
        for file in (OVERCAST, *OVERCAST.parent.glob("libovercast.so*")):
            shutil.copy2(file, alone)
        plain, _ = self.render(obj("Kd 0.5 0.25 1", self.folder, "plain"))
        scene = obj("Kd 0.5 0.25 1\nmap_Kd four.png", self.folder, "four")
        pixels, said = self.render(scene, overcast=alone / "overcast")
        self.assertEqual(pixels, plain)
        self.assertEqual(said.count("libopenimageio-dev"), 1, said)

    def test_masks_cut_holes(self):
        masked = quarters([(255, 255, 255, opacity) for opacity in (255, 0, 100, 200)])
        write_rgba(self.folder / "four.png", 16, 16, masked)
        mask = dict(FOUR[gltf], alphaMode="MASK", alphaCutoff=0.5)
        cases = {"gltf": (gltf(mask, self.folder, "mask"), [True, False, False, True]),
                 "obj": (obj("Kd 0.5 0.5 0.5\nmap_d four.png", self.folder, "holes"),
                         [True, False])}
        for name, (scene, there) in cases.items():
            with self.subTest(name):
                pixels, _ = self.render(scene)
                nothing, _ = self.render(scene, camera=AWAY)
                for number, is_there in enumerate(there):
                    x, y = 8 + 16 * (number % 2), 8 + 16 * (number // 2)
                    self.assertEqual(pixels[y][x] != nothing[y][x], is_there, f"texel {number}")

    def test_a_far_board_is_gray_and_not_aliased(self):
        board = bytes(255 * ((x + y) % 2) for y in range(64) for x in range(64) for _ in range(3))
        write_png(self.folder / "four.png", 64, 64, board)
        white, _ = self.render(obj(WHITE[obj], self.folder, "white"))
        scene = obj("Kd 0.5 0.5 0.5\nmap_Kd -s 16 16 four.png", self.folder, "far")
        pixels, _ = self.render(scene)
        for y in range(2, 30):
            for x in range(2, 30):
                self.assertAlmostEqual(pixels[y][x][1], 0.5 * white[y][x][1], delta=0.03)


if __name__ == "__main__":
    if not LIBRARY.exists():
        print(f"no {LIBRARY}")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
