# SPDX-License-Identifier: Apache-2.0
"""Tests that cmake -DOVC_LIBRARY_ONLY=ON builds the library with libepoxy, GLM and oneTBB alone,
installs it, and that a program finds it."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from installed import CONSUMER, SOURCE, run

# The library may include headers of these packages, of the compiler and of the C library.
ALLOWED = {"libepoxy-dev", "libglm-dev", "libtbb-dev", "libegl-dev", "libgl-dev", "libglx-dev",
           "libopengl-dev", "libx11-dev"}
SYSTEM = r"libc6-dev|linux-libc-dev|libstdc\+\+|libgcc|libcrypt"
# The library must do without these, as if they were not installed.
HIDDEN = ("fmt", "assimp", "PNG", "ZLIB", "GTest", "CLI11", "OpenEXR")


class LibraryOnly(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="overcast_library_")
        cls.addClassCleanup(holder.cleanup)
        cls.folder = pathlib.Path(holder.name).resolve()
        cls.build = cls.folder / "build"
        run("cmake", "-S", SOURCE, "-B", cls.build, "-G", "Ninja",
            "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O0", "-DOVC_LIBRARY_ONLY=ON",
            "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=64",
            *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in HIDDEN))
        run("cmake", "--build", cls.build)
        run("cmake", "--install", cls.build, "--prefix", cls.folder / "prefix")

    def test_it_includes_headers_of_three_packages(self):
        dependencies = run("ninja", "-C", self.build, "-t", "deps")
        headers = set(re.findall(r"/usr/include/\S+", dependencies))
        self.assertIn("/usr/include/epoxy/gl.h", headers)
        if not pathlib.Path("/usr/bin/dpkg").exists():
            self.skipTest("no dpkg to tell whose headers they are")
        owners = subprocess.run(["dpkg", "-S", *sorted(headers)], text=True,
                                capture_output=True).stdout
        packages = {package for line in owners.splitlines()
                    for package in re.findall(r"([\w.+-]+)(?::\w+)?(?:, |: )", line)}
        foreign = {package for package in packages - ALLOWED if not re.match(SYSTEM, package)}
        self.assertEqual(foreign, set())

    def test_a_program_finds_it(self):
        run("cmake", "-S", CONSUMER, "-B", self.folder / "consumer",
            f"-DCMAKE_PREFIX_PATH={self.folder / 'prefix'}",
            f"-DEXAMPLES={SOURCE / 'plugin/examples'}")
        run("cmake", "--build", self.folder / "consumer")
        self.assertIn(os.environ["OVC_LIBDIR"], run("ldd", self.folder / "consumer/consumer"))
        run(self.folder / "consumer/consumer")


if __name__ == "__main__":
    unittest.main(verbosity=2)
