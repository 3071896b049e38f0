# SPDX-License-Identifier: Apache-2.0
"""Tests the Debian package in a bare Debian: with its Depends alone it names the missing packages,
with its Recommends it works."""

import os
import pathlib
import shlex
import shutil
import subprocess
import tempfile
import unittest

from installed import BUILD, run

TRACE = ("import overcast; scene = overcast.Scene(); "
         "scene.add([[0, 0, 0], [1, 0, 0], [0, 1, 0]]); scene.commit(); "
         "print(scene.intersect([0.25, 0.5, 5], [0, 0, -1]).t)")


@unittest.skipUnless(shutil.which("mmdebstrap") and os.geteuid() == 0,
                     "it takes mmdebstrap, and root")
class BareDebian(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="overcast_chroot_")
        cls.addClassCleanup(holder.cleanup)
        cls.root = pathlib.Path(holder.name).resolve() / "root"
        mirror = next(iter(run("apt-get", "indextargets", "--format", "$(SITE)").split()),
                      "http://deb.debian.org/debian")
        # apt's lists stay, so that they need not be fetched again inside.
        made = subprocess.run(["mmdebstrap", "--variant=minbase", "--skip=cleanup/apt",
                               "bookworm", cls.root, mirror], text=True, capture_output=True)
        if made.returncode != 0:
            raise unittest.SkipTest("no Debian to be had here: " + made.stderr.strip()[-200:])
        run("cpack", "--config", BUILD / "CPackConfig.cmake", "-G", "DEB", "-B",
            cls.root / "package")
        cls.package, = (cls.root / "package").glob("overcast_*.deb")

    def inside(self, command):
        """Runs a command of the bare system as root there, in process and mount namespaces of its
        own, and returns the subprocess that has ended."""
        mounted = (f"mount -t proc proc {self.root}/proc && exec chroot {self.root} env -i "
                   f"PATH=/usr/bin:/bin:/usr/sbin:/sbin sh -c {shlex.quote(command)}")
        return subprocess.run(["unshare", "--mount", "--pid", "--fork", "sh", "-c", mounted],
                              text=True, capture_output=True, timeout=900)

    def succeeds(self, command):
        done = self.inside(command)
        self.assertEqual(done.returncode, 0,
                         f"{command}:\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
        return done.stdout

    def field(self, name):
        return " ".join(entry.split()[0]
                        for entry in run("dpkg-deb", "--field", self.package, name).split(","))

    def hills(self):
        """Builds the C example outside, because a bare system has no compiler."""
        files = self.root / "unpacked"
        run("dpkg-deb", "--extract", self.package, files)
        example, = files.glob("usr/share/doc/overcast/examples/hills.c")
        run("cc", "-std=c99", f"-I{files}/usr/include", example, "-o", self.root / "hills", "-ldl",
            "-lm")

    def test_it_says_what_is_missing_and_then_works(self):
        self.hills()
        self.succeeds(f"apt-get install -qy --no-install-recommends /package/{self.package.name}")
        # Without a driver the command renders on the CPU, and says so.
        for command, code in {"overcast devices": 1, "/hills": 1,
                              "overcast render knot --size 64x64 -o /cpu.png": 0}.items():
            with self.subTest("without Recommends", command=command):
                done = self.inside(command)
                self.assertEqual(done.returncode, code, f"{command}: {done.stdout}{done.stderr}")
                self.assertRegex(done.stdout + done.stderr, "lib[a-z0-9-]*(mesa|gl)[a-z0-9-]*",
                                 "the package that is missing")

        self.succeeds(f"apt-get install -qy {self.field('Recommends')}")
        self.assertIn("llvmpipe", self.succeeds("overcast devices"))
        self.assertGreater(len(self.succeeds("/hills")), 500, "a picture in letters")
        self.assertEqual(self.succeeds(f"python3 -c '{TRACE}'"), "5.0\n")
        self.succeeds("overcast render knot --size 64x64 -o /knot.png")
        self.assertEqual((self.root / "knot.png").read_bytes()[:4], b"\x89PNG")


if __name__ == "__main__":
    unittest.main(verbosity=2)
