# SPDX-License-Identifier: Apache-2.0
"""Tests that the Python module goes where the system's own Python looks, even where another python3
comes first in the PATH."""

import os
import pathlib
import subprocess
import tempfile
import unittest

SOURCE = os.environ["OVC_SOURCE_DIR"]
SYSTEM = pathlib.Path("/usr/bin/python3")


@unittest.skipUnless(SYSTEM.exists(), "the system has no Python of its own")
class PythonFolder(unittest.TestCase):
    def test_another_python_does_not_choose_it(self):
        with tempfile.TemporaryDirectory(prefix="overcast_python_") as folder:
            other = pathlib.Path(folder, "bin/python3")
            other.parent.mkdir()
            # This Python does not have Debian's scheme.
            pathlib.Path(folder, "sitecustomize.py").write_text(
                "import sysconfig; names = sysconfig.get_scheme_names; "
                "sysconfig.get_scheme_names = "
                "lambda: tuple(name for name in names() if name != 'deb_system')\n")
            other.write_text(f"#!/bin/sh\nPYTHONPATH={folder} exec {SYSTEM} \"$@\"\n")
            other.chmod(0o755)
            path = f"{other.parent}:{os.environ['PATH']}"
            subprocess.run(["cmake", "-S", SOURCE, "-B", f"{folder}/build", "-DOVC_TESTS=OFF",
                            f"-DPython3_EXECUTABLE={other}"],
                           env={**os.environ, "PATH": path}, check=True, stdout=subprocess.DEVNULL,
                           timeout=300)
            cache = pathlib.Path(folder, "build/CMakeCache.txt").read_text()
        expected = subprocess.run(
            [SYSTEM, "-c", "import site, sys; "
             "is_debian = any('dist-packages' in f for f in site.getsitepackages()); "
             "print('dist' if is_debian else 'site', '%d.%d' % sys.version_info[:2])"],
            check=True, capture_output=True, text=True).stdout.split()
        self.assertIn(f"OVC_PYTHON_DIR:STRING=lib/python{expected[1]}/{expected[0]}-packages\n",
                      cache)


if __name__ == "__main__":
    unittest.main(verbosity=2)
