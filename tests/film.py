# SPDX-License-Identifier: Apache-2.0
"""Renders pictures with the options of the film, and compares them with what oiiotool makes of a
picture without them, and with what they say of themselves.

usage: film.py OVERCAST DENOISER
DENOISER: a library that stands in for Open Image Denoise.
"""
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest

OVERCAST, DENOISER = map(pathlib.Path, sys.argv[1:3])
OIIOTOOL = shutil.which("oiiotool")
SIZE = ["--size", "24x18"]
SCENE = ["box", "--backend", "cpu-kdtree", "--integrator", "path"]


def filmic(x):
    """Hable 2010: his six constants, an exposure of 2 and white at 11.2."""
    def curve(v):
        return (v * (0.15 * v + 0.05) + 0.004) / (v * (0.15 * v + 0.5) + 0.06) - 0.02 / 0.3
    return min(curve(2 * x) / curve(11.2), 1)


def aces(x):
    """Narkowicz 2016."""
    return min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1)


def srgb(x):
    return 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055


class Film(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def run_render(self, *words, wanted=0, libraries=""):
        """Returns what was said on standard error. libraries: a folder of some."""
        done = subprocess.run([OVERCAST, "render", *SCENE, *SIZE, *words], capture_output=True,
                              text=True, cwd=self.folder, timeout=300,
                              env={**os.environ, "LD_LIBRARY_PATH": str(libraries)})
        self.assertEqual(done.returncode, wanted, done.stderr)
        return done.stderr

    def values(self, file, channels=range(3), size=24 * 18):
        """Returns these channels of a file's pixels, as oiiotool reads them."""
        text = subprocess.run([OIIOTOOL, "--dumpdata", self.folder / file], capture_output=True,
                              text=True, check=True).stdout
        # "Pixel (0, 0): 226 227 231 (0.886 0.890 0.906)": codes, and what they are of 1.
        rows = [(line.split("(")[2:] or [line.split(":")[1]])[0].rstrip(")").split()
                for line in text.splitlines() if "Pixel (" in line]
        self.assertEqual(len(rows), size)
        return [[float(row[channel]) for channel in channels] for row in rows]

    def test_exposure_scales_light_and_tone_maps_only_pictures_for_displays(self):
        self.run_render("--samples", "4", "-o", "plain.exr")
        plain = self.values("plain.exr")
        for name, curve in [("filmic", filmic), ("aces", aces)]:
            self.run_render("--samples", "4", "--exposure", "1.5", "--tone-map", name, "--png-bits",
                            "16", "-o", "a.exr", "-o", "a.png")
            light, codes = self.values("a.exr"), self.values("a.png")
            for before, exposed, code in zip(plain, light, codes):
                for a, b, c in zip(before, exposed, code):
                    self.assertAlmostEqual(b, a * 2 ** 1.5, delta=1e-5 * (1 + b))
                    self.assertAlmostEqual(c, srgb(curve(b)), delta=2e-4)

    def test_automatic_exposure_is_said_and_makes_a_middle_grey(self):
        said = self.run_render("--samples", "2", "--exposure", "auto", "-o", "a.exr")
        self.assertRegex(said, r"--exposure auto: [+-]\d+\.\d\d stops")
        logs = [sum(w * v for w, v in zip((0.2126, 0.7152, 0.0722), p)) for p in
                self.values("a.exr")]
        product = 1.0
        lit = [v for v in logs if v > 0]
        for v in lit:
            product *= (v / 0.18) ** (1 / len(lit))
        self.assertAlmostEqual(product, 1, delta=0.01)

    def test_noise_ends_the_passes(self):
        said = self.run_render("--noise", "0.05", "-o", "a.png")
        found = re.search(r"([\d.]+) samples a pixel, (\d+) to (\d+); noise of the noisiest block: "
                          r"([\d.]+)", said)
        self.assertTrue(found, said)
        self.assertLessEqual(float(found[4]), 0.05)
        self.assertLessEqual(int(found[2]), float(found[1]))
        self.assertTrue((self.folder / "a.png").exists())
        self.assertFalse((self.folder / "a.unfinished.png").exists(), "removed at the end")
        # The same command makes the same picture: no clock decides.
        before = (self.folder / "a.png").read_bytes()
        self.run_render("--noise", "0.05", "-o", "a.png")
        self.assertEqual((self.folder / "a.png").read_bytes(), before)

    def test_a_denoiser_gets_the_picture_its_albedo_and_its_normals(self):
        plain = ["--samples", "4", "--aov", "albedo,normal"]
        self.run_render(*plain, "-o", "a.exr")
        self.run_render(*plain, "--denoise", "--exposure", "1", "-o", "b.exr",
                        libraries=DENOISER.parent)
        # Channels: R, G, B, A, albedo.R, .G, .B, normal.X, .Y, .Z
        before = self.values("a.exr", (0, 1, 2, 4, 5, 6, 7, 8, 9))
        for row, found in zip(before, self.values("b.exr")):
            for light, albedo, normal, value in zip(row[:3], row[3:6], row[6:], found):
                mixed = 0.5 * light + 0.25 * albedo + 0.125 * normal # the stand-in's shares
                self.assertAlmostEqual(value, 2 * mixed, delta=1e-5)

    @unittest.skipIf(shutil.which("Xvfb") is None, "Xvfb is not installed")
    def test_a_window_shows_the_picture(self):
        server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", "640x480x24",
                                   "-fbdir", str(self.folder)], stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        display = ":" + server.stdout.readline().strip()
        self.addCleanup(server.stdout.close)
        render = subprocess.Popen([OVERCAST, "render", *SCENE, "--size", "240x180", "--time", "1s",
                                   "--view", "-o", "a.png"], cwd=self.folder,
                                  env={**os.environ, "DISPLAY": display},
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(render.communicate)
        self.addCleanup(render.terminate)
        end = time.monotonic() + 60
        while not (self.folder / "a.png").exists() and time.monotonic() < end:
            self.assertIsNone(render.poll(), "it has ended")
            time.sleep(0.1)
        wanted = self.values("a.png", size=240 * 180)
        while time.monotonic() < end:
            time.sleep(0.3)
            if self.screen_has(wanted, 240, 180):
                return
        self.fail("the screen does not show the picture")

    def screen_has(self, wanted, width, height):
        """Whether the screen, in XWD's format, shows the picture somewhere."""
        data = (self.folder / "Xvfb_screen0").read_bytes()
        header = struct.unpack(">25I", data[:100])
        start, row_bytes = header[0] + 12 * header[19], header[12]
        row = b"".join(bytes(round(255 * v) for v in reversed(pixel)) + b"\0"
                       for pixel in wanted[90 * width:91 * width]) # blue, green, red
        plain = bytes(b for i, b in enumerate(row) if i % 4 != 3)
        for y in range(header[5]):
            line = data[start + y * row_bytes:start + (y + 1) * row_bytes]
            if plain in bytes(b for i, b in enumerate(line) if i % 4 != 3):
                return True
        return False

    def test_progress_is_told_in_lines_of_json(self):
        done = subprocess.run([OVERCAST, "render", *SCENE, *SIZE, "--time", "1.2s", "-o", "a.png",
                               "--progress", "-"], capture_output=True, text=True,
                              cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        events = [json.loads(line) for line in done.stdout.splitlines()]
        pictures = [e for e in events if e["event"] == "picture"]
        self.assertEqual(pictures[0], {"event": "picture", "frame": 0,
                                       "file": "a.unfinished.png", "finished": False})
        self.assertEqual(pictures[-1], {"event": "picture", "frame": 0, "file": "a.png",
                                        "finished": True})
        self.assertEqual(events[-1], {"event": "end", "complete": True})
        shares = [e["done"] for e in events if e["event"] == "progress"]
        self.assertGreaterEqual(len(shares), 3)
        self.assertEqual(shares, sorted(shares))
        self.assertLess(shares[0], 0.5)
        self.assertLessEqual(shares[-1], 1)

    def test_what_cannot_be_is_refused_in_a_sentence(self):
        for words, sentence in [
                (["--time", "1s", "--continue"],
                 "--continue cannot go on with a picture of --time"),
                (["--noise", "0.1", "--antialias", "0.3"],
                 "--noise and --antialias cannot be given together"),
                (["--time", "soon"], "--time needs a time, such as 30s, 1.5m or 2h, not 'soon'"),
                (["--filter", "gaussian"], "--filter needs --samples of at least 2"),
                (["--lens-radius", "1"], "--lens-radius needs --samples of at least 2"),
                (["--focus", "1"], "--focus needs --lens-radius"),
                (["--exposure", "bright"],
                 "--exposure needs a number from -100 to 100, not 'bright', or auto"),
                (["--clamp", "2", "--integrator", "whitted"],
                 "--clamp is for --integrator path alone")]:
            if "--integrator" in words:
                words = words + ["-o", "a.png"]
                done = subprocess.run([OVERCAST, "render", "box", *words], capture_output=True,
                                      text=True, cwd=self.folder, timeout=60)
                self.assertEqual(done.returncode, 1)
                said = done.stderr
            else:
                said = self.run_render(*words, "-o", "a.png", wanted=1)
            self.assertIn(sentence, said)
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    if not OIIOTOOL:
        print("oiiotool is not installed")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0]])
