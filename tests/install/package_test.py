# SPDX-License-Identifier: Apache-2.0
"""Tests the Debian package: unpacked, it works where it lies; its Depends name the libraries that
it loads; lintian finds no fault."""

import os
import pathlib
import re
import shutil
import tempfile
import unittest

from installed import BUILD, SOURCE, Tree, run


@unittest.skipUnless(shutil.which("dpkg-shlibdeps") and shutil.which("dpkg-deb"), "no dpkg-dev")
class DebianPackage(Tree, unittest.TestCase):
    zsh = "zsh/vendor-completions/_overcast"

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="overcast_package_")
        cls.addClassCleanup(holder.cleanup)
        cls.folder = pathlib.Path(holder.name).resolve()
        run("cpack", "--config", BUILD / "CPackConfig.cmake", "-G", "DEB", "-B", cls.folder)
        cls.package, = cls.folder.glob("overcast_*.deb")
        run("dpkg-deb", "--extract", cls.package, cls.folder / "root")
        cls.prefix = cls.folder / "root/usr"
        cls.libraries = cls.prefix / os.environ["OVC_LIBDIR"]
        cls.modules = cls.prefix / "lib/python3/dist-packages"

    def field(self, name):
        return [entry.split()[0]
                for entry in run("dpkg-deb", "--field", self.package, name).split(",")]

    def test_depends_are_what_it_loads(self):
        depends = self.field("Depends")
        for package in ("libc6", "libstdc++6", "libtbb12", "libepoxy0", "libegl1",
                        "libopenexr-3-1-30", "libassimp5"):
            self.assertIn(package, depends)
        self.assertIn("libopengl0 | libgl1", run("dpkg-deb", "--field", self.package, "Depends"),
                      "what libepoxy loads by itself")
        self.assertEqual([package for package in depends if package.endswith("-dev")], [])
        self.assertLessEqual({"python3", "python3-numpy", "libgl1-mesa-dri"},
                             set(self.field("Recommends")))

    def test_programs_that_link_it_will_depend_on_it(self):
        control = self.folder / "control"
        run("dpkg-deb", "--control", self.package, control)
        version = run("dpkg-deb", "--field", self.package, "Version").strip()
        upstream = version.split("-")[0]
        self.assertEqual((control / "shlibs").read_text(),
                         f"libovercast 1 overcast (>= {upstream})\n")
        self.assertEqual((control / "symbols").read_text(),
                         f"libovercast.so.1 overcast\n ovc_get_api@Base {upstream}\n")
        for script in ("postinst", "prerm"):
            run("sh", "-n", control / script)

    def test_the_tutorials_commands_build_its_examples(self):
        tutorial = (SOURCE / "docs/guide/tutorial.md").read_text()
        folder = self.folder / "examples"
        shutil.copytree(self.prefix / "share/doc/overcast/examples", folder)
        for program, arguments in (("hills.c", [self.libraries / "libovercast.so.1"]),
                                   ("sunlit.cpp", [])):
            command = re.search(f"^(c.* {re.escape(program)} .*)$", tutorial, re.MULTILINE).group(1)
            built = folder / program.split(".")[0]
            run("sh", "-c", command, cwd=folder,
                environment={"PKG_CONFIG_PATH": str(self.libraries / "pkgconfig")})
            printed = run(built, *arguments, environment={"LD_LIBRARY_PATH": str(self.libraries)})
            self.assertIn("\n".join(line.rstrip() for line in printed.splitlines() if line.strip()),
                          tutorial)

    def test_lintian_finds_nothing(self):
        if not shutil.which("lintian"):
            self.skipTest("no lintian")
        run("lintian", "--allow-root", "--fail-on", "error,warning", self.package)


if __name__ == "__main__":
    unittest.main(verbosity=2)
