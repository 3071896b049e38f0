# SPDX-License-Identifier: Apache-2.0
"""Tests that the examples of README and of help(overcast) run, and print what they promise."""

import contextlib
import io
import os
import pathlib
import pydoc
import re
import tempfile
import textwrap
import unittest

import numpy as np

import overcast
from scenes_for_tests import brute_force, skip_without_device, soup

setUpModule = skip_without_device


class Examples(unittest.TestCase):
    def test_readme(self):
        readme = pathlib.Path(os.environ["OVC_SOURCE_DIR"], "README.md").read_text()
        example = re.search(r"```python\n(.*?)```", readme, re.DOTALL).group(1)
        self.assertLessEqual(len(example.splitlines()), 12)
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(example, {})
        self.assertEqual(f"# {printed.getvalue()}", example.splitlines()[-1] + "\n")

    def test_picture(self):
        """The picture shows lit and shadowed floor, a lit and dark knot, and sky around it."""
        text = pathlib.Path(os.environ["OVC_SOURCE_DIR"], "docs/guide/python.md").read_text()
        names = {}
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            exec(re.search(r"```python\n(.*?)```", text, re.DOTALL).group(1), names)
            header, pixels = pathlib.Path("knot.pgm").read_bytes().split(b"\n", 1)
        self.assertEqual((header, len(pixels)), (b"P5 450 360 255", 450 * 360))
        mesh, lit = names["hits"].mesh, names["lit"]
        for part in (mesh == overcast.NONE, (mesh == 0) & lit, (mesh == 0) & ~lit,
                     (mesh == 1) & lit, (mesh == 1) & ~lit):
            self.assertGreater(part.mean(), 0.01)

    def test_docstring(self):
        example = re.search(r"\n\n(    import numpy.*?)\n\n[A-Z]", overcast.__doc__,
                            re.DOTALL).group(1)
        corners = soup(1, 100)
        directions = np.random.default_rng(2).random((48, 64, 3)) - [0.5, 0.5, 5]
        names = {"vertices": corners.reshape(-1, 3), "triangles": np.arange(300).reshape(-1, 3),
                 "origins": np.array([0.5, 0.5, 5]), "directions": directions,
                 "light": np.array([0, 0, 9.0])}
        exec(textwrap.dedent(example), names)
        expected = brute_force(corners, np.broadcast_to([0.5, 0.5, 5], (48 * 64, 3)),
                               directions.reshape(-1, 3))
        np.testing.assert_array_equal(names["hits"].prim.ravel(), expected[3])
        self.assertEqual(names["shadow"].shape, (48, 64))
        self.assertTrue(names["hits"].hit.any() and names["shadow"].any())

    def test_help_teaches_every_public_name(self):
        text = pydoc.plain(pydoc.render_doc(overcast))
        for name in overcast.__all__:
            self.assertIn(name, text)
        for name in ("Scene", "Hits", "Device"):
            public = getattr(overcast, name)
            silent = [member for member, value in vars(public).items()
                      if not member.startswith("_") and member not in ("records", "shape")
                      and not getattr(value, "__doc__", None)]
            self.assertEqual(silent, [], f"of {name} without a docstring")
