# SPDX-License-Identifier: Apache-2.0
"""Renders pictures with the options of the film, and compares them with what oiiotool makes of a
picture without them, and with what they say of themselves.

usage: film.py OVERCAST
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

OVERCAST = pathlib.Path(sys.argv[1])
OIIOTOOL = shutil.which("oiiotool")
SCENE = ["box", "--size", "24x18", "--backend", "cpu-kdtree", "--integrator", "path"]


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

    def run_render(self, *words, wanted=0):
        """Returns what was said on standard error."""
        done = subprocess.run([OVERCAST, "render", *SCENE, *words], capture_output=True, text=True,
                              cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, wanted, done.stderr)
        return done.stderr

    def values(self, file):
        """Returns the red, green and blue of a file's pixels, as oiiotool reads them."""
        text = subprocess.run([OIIOTOOL, "--dumpdata", self.folder / file], capture_output=True,
                              text=True, check=True).stdout
        # "Pixel (0, 0): 226 227 231 (0.886 0.890 0.906)": codes, and what they are of 1.
        pixels = [[float(v) for v in (line.split("(")[2:] or [line.split(":")[1]])[0].rstrip(")")
                   .split()[:3]] for line in text.splitlines() if "Pixel (" in line]
        self.assertEqual(len(pixels), 24 * 18)
        return pixels

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

    def test_progress_is_told_in_lines_of_json(self):
        done = subprocess.run([OVERCAST, "render", *SCENE, "--time", "1.2s", "-o", "a.png",
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
                (["--time", "1s", "--continue"], "--continue cannot go on with a picture of --time"),
                (["--noise", "0.1", "--antialias", "0.3"],
                 "--noise and --antialias cannot be given together"),
                (["--time", "soon"], "--time needs a time, such as 30s, 1.5m or 2h, not 'soon'"),
                (["--filter", "gaussian"], "--filter needs --samples of at least 2"),
                (["--lens-radius", "1"], "--lens-radius needs --samples of at least 2"),
                (["--focus", "1"], "--focus needs --lens-radius"),
                (["--exposure", "bright"], "--exposure needs a number from -100 to 100, not 'bright'"
                                           ", or auto"),
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
