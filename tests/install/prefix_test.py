# SPDX-License-Identifier: Apache-2.0
"""Tests cmake --install into a clean prefix, which is then moved: everything in it must still find
everything else."""

import os
import pathlib
import tempfile
import unittest

from installed import BUILD, Tree, run


class MovedPrefix(Tree, unittest.TestCase):
    zsh = "zsh/site-functions/_overcast"

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="overcast prefix ")  # with a blank in it
        cls.addClassCleanup(holder.cleanup)
        cls.folder = pathlib.Path(holder.name).resolve()
        run("cmake", "--install", BUILD, "--prefix", cls.folder / "first")
        cls.prefix = (cls.folder / "first").rename(cls.folder / "moved")
        cls.libraries = cls.prefix / os.environ["OVC_LIBDIR"]
        cls.modules = cls.prefix / os.environ["OVC_PYTHON_DIR"]


if __name__ == "__main__":
    unittest.main(verbosity=2)
