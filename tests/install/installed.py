# SPDX-License-Identifier: Apache-2.0
"""The tests that every installed tree must pass, and how they run programs."""

import gzip
import os
import pathlib
import re
import shlex
import shutil
import subprocess

BUILD = pathlib.Path(os.environ["OVC_BINARY_DIR"])
SOURCE = pathlib.Path(os.environ["OVC_SOURCE_DIR"])
PYTHON = os.environ.get("OVC_PYTHON")  # a Python with NumPy, or empty
CONSUMER = SOURCE / "tests/install"
CLEAN = {name: value for name, value in os.environ.items()
         if name not in ("OVC_PLUGIN", "LD_LIBRARY_PATH", "PYTHONPATH")}
RAY = "0.25 0.5 5 0 0 -1\n"


def run(*command, environment=None, **options):
    """Returns the standard output of a command, which must succeed. It runs without the variables
    that could lead to the build folder."""
    done = subprocess.run([str(word) for word in command], env={**CLEAN, **(environment or {})},
                          text=True, capture_output=True, timeout=300, **options)
    assert done.returncode == 0, (f"{command} ended with {done.returncode}:\n"
                                  f"{done.stdout}\n{done.stderr}")
    return done.stdout


def loaded_from(*command, name, environment=None):
    """Returns the files called `name…` that the command loaded, as reported by the system's
    loader."""
    done = subprocess.run([str(word) for word in command],
                          env={**CLEAN, **(environment or {}), "LD_DEBUG": "files"}, text=True,
                          capture_output=True, timeout=300, input=RAY)
    assert done.returncode == 0, done.stderr[-2000:]
    return set(re.findall(rf"calling init: (.*{name}.*)", done.stderr))


class Tree:
    """Tests an installed tree below `prefix`, with libraries in `libraries` and Python modules in
    `modules`. A unittest.TestCase inherits from it."""

    prefix: pathlib.Path
    libraries: pathlib.Path
    modules: pathlib.Path

    def test_the_library_exports_one_function_and_has_its_soname(self):
        library = self.libraries / "libovercast.so"
        symbols = [line.split()[-1]
                   for line in run("nm", "--dynamic", "--defined-only", library).splitlines()]
        self.assertEqual(symbols, ["ovc_get_api"])
        self.assertIn("[libovercast.so.1]", run("readelf", "--dynamic", library))
        self.assertEqual(os.readlink(library), "libovercast.so.1")

    def test_nothing_knows_the_folders_it_was_built_in(self):
        for file in [*self.prefix.glob("bin/*"), *self.libraries.glob("libovercast.so"),
                     *self.libraries.glob("overcast/*.so")]:
            self.assertNotRegex(run("readelf", "--dynamic", file), "R(UN)?PATH")
        for file in [*self.libraries.glob("cmake/Overcast/*.cmake"),
                     self.libraries / "pkgconfig/overcast.pc",
                     self.modules / "overcast/_built.py"]:
            self.assertNotIn(str(BUILD), file.read_text(), file)

    def test_programs_are_hardened_as_debian_asks(self):
        for file in [*self.prefix.glob("bin/*"), self.libraries / "libovercast.so",
                     *self.libraries.glob("overcast/*.so")]:
            self.assertRegex(run("readelf", "--dynamic", file), "BIND_NOW|Flags:.* NOW", file)
            self.assertIn("GNU_RELRO", run("readelf", "--program-headers", file), file)
        for file in [self.prefix / "bin/overcast", self.libraries / "libovercast.so"]:
            self.assertIn("__stack_chk_fail", run("nm", "--dynamic", "--undefined-only", file),
                          file)

    def test_the_command_finds_its_libraries(self):
        triangle = self.prefix / "triangle.obj"
        triangle.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.addCleanup(triangle.unlink)
        command = self.prefix / "bin/overcast", "trace", triangle
        self.assertEqual(run(*command, input=RAY), "5 0.25 0.5 0 0\n")
        self.assertEqual(loaded_from(*command, name="libovercast"),
                         {str(self.libraries / "libovercast.so.1")})
        self.assertEqual(loaded_from(*command, "--backend", "single-texture", name="libovercast"),
                         {str(self.libraries / "overcast/libovercast-thesis.so")})

    def test_the_command_finds_what_makes_a_page(self):
        report = self.folder / "report"
        made = subprocess.run([self.prefix / "bin/overcast", "report", "--quick", "--only",
                               "pictures", "--scene", "box", "--size", "32x32", "-o", report],
                              env=CLEAN, capture_output=True, text=True, timeout=300)
        self.assertTrue((report / "pictures.json").exists(), made.stderr)
        if made.returncode:
            self.assertIn("apt install", made.stderr)
        else:
            self.assertIn("<img", (report / "index.html").read_text())

    def test_the_manual_and_the_completions_are_what_the_command_says(self):
        command = self.prefix / "bin/overcast"
        share = self.prefix / "share"
        self.assertEqual(gzip.decompress((share / "man/man1/overcast.1.gz").read_bytes()).decode(),
                         run(command, "man"))
        for shell, file in {"bash": "bash-completion/completions/overcast", "zsh": self.zsh,
                            "fish": "fish/vendor_completions.d/overcast.fish"}.items():
            self.assertEqual((share / file).read_text(), run(command, "completion", shell))

    def test_tachyon_is_given_the_libraries_of_the_tree(self):
        program = self.prefix / "bin/overcast-tachyon"
        if not program.exists() or not shutil.which("tachyon"):
            self.skipTest("tachyon, or the header that overcast-tachyon is built with, "
                          "is not installed")
        (self.folder / "triangle.dat").write_text(
            "BEGIN_SCENE RESOLUTION 8 8 CAMERA ZOOM 1 ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH 1 "
            "CENTER 0 0 -3 VIEWDIR 0 0 1 UPDIR 0 1 0 END_CAMERA "
            "TRI V0 -9 -9 0 V1 9 -9 0 V2 0 9 0 TEXTURE AMBIENT 1 DIFFUSE 0 SPECULAR 0 OPACITY 1 "
            "COLOR 1 1 1 TEXFUNC 0 END_SCENE\n")
        # tachyon takes no names of files with blanks, so it runs in the folder.
        command = ("env", "-C", self.folder, program, "triangle.dat", "-format", "PPM",
                   "-o", "triangle.ppm")
        loaded = {pathlib.Path(file).resolve()
                  for file in loaded_from(*command, name="libovercast")}
        self.assertEqual(loaded,
                         {(self.libraries / file).resolve()
                          for file in ("libovercast.so.1", "overcast/libovercast_tachyon.so")})
        self.assertEqual((self.folder / "triangle.ppm").read_bytes()[-3 * 36:-3 * 35], b"\xff" * 3,
                         "the pixel in the middle")

    def test_python_finds_the_library(self):
        if not PYTHON:
            self.skipTest("no Python with NumPy")
        program = ("import overcast; scene = overcast.Scene(); "
                   "scene.add([[0, 0, 0], [1, 0, 0], [0, 1, 0]]); scene.commit(); "
                   "hit = scene.intersect([0.25, 0.5, 5], [0, 0, -1]); "
                   "print(hit.t, hit.u, hit.v, scene.statistics()['nearest_rays'], "
                   "overcast.__file__)")
        environment = {"PYTHONPATH": str(self.modules), "PYTHONDONTWRITEBYTECODE": "1"}
        self.assertEqual(run(PYTHON, "-c", program, environment=environment),
                         f"5.0 0.25 0.5 1 {self.modules}/overcast/__init__.py\n")
        loaded, = loaded_from(PYTHON, "-c", program, environment=environment, name="libovercast")
        self.assertEqual(pathlib.Path(loaded).resolve(),
                         (self.libraries / "libovercast.so.1").resolve())

    def test_a_consumer_builds_with_find_package(self):
        build = self.folder / "by_find_package"
        run("cmake", "-S", CONSUMER, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}",
            f"-DCMAKE_C_COMPILER={os.environ['CC']}",
            f"-DCMAKE_CXX_COMPILER={os.environ['CXX']}",
            f"-DEXAMPLES={self.prefix / 'share/doc/overcast/examples'}",
            "-DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF")
        run("cmake", "--build", build)
        self.assertEqual(run(build / "consumer"), "hit 5 0.25 0.5\n")
        self.assertRegex(run(build / "sunlit"),
                         "^[1-9][0-9]* of [0-9]+ rays hit, [1-9][0-9]* of those in the sun\n$")
        self.assertEqual(loaded_from(build / "consumer", name="libovercast"),
                         {str(self.libraries / "libovercast.so.1")})

    def test_a_consumer_builds_with_pkg_config(self):
        if not shutil.which("pkg-config"):
            self.skipTest("no pkg-config")
        environment = {"PKG_CONFIG_PATH": str(self.libraries / "pkgconfig")}
        flags = run("pkg-config", "--cflags", "--libs", "overcast", environment=environment)
        program = self.folder / "by_pkg_config"
        run(os.environ["CC"], "-std=c99", "-Wall", "-Wextra", "-Wno-missing-field-initializers",
            "-Werror", "-o", program, CONSUMER / "consumer.c", *shlex.split(flags))
        self.assertEqual(run(program, environment={"LD_LIBRARY_PATH": str(self.libraries)}),
                         "hit 5 0.25 0.5\n")
        self.assertEqual("overcast " +
                         run("pkg-config", "--modversion", "overcast", environment=environment),
                         run(self.prefix / "bin/overcast", "--version").split("\n")[0] + "\n")
