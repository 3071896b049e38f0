#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the kernels on every driver that Mesa has without a GPU, and compares the answers' hashes.

usage: drivers.py BUILD [--driver NAME] [--rays N]

Prints the table of docs/guide/gpu.md: for each driver whether all variants of the kernel compile,
and the hash of the hits of both kernels in two test scenes, one of one frame and one of instances,
which must be that of the CPU KD-tree. A driver that the table of workarounds refuses must say so,
and versions of it that are not refused must answer as the others do.
With --driver one row is made; the script exits with 77 where its package is not installed.
"""
import argparse
import dataclasses
import hashlib
import os
import pathlib
import random
import struct
import subprocess
import sys
import tempfile

SCENES = ("soup-10", "fractal-3")
ICDS = [pathlib.Path("/usr/share/vulkan/icd.d") / name
        for name in ("lvp_icd.x86_64.json", "lvp_icd.json")]  # Debian 12's, Debian 13's
LAVAPIPE = ICDS[ICDS[1].exists()]


@dataclasses.dataclass
class Driver:
    name: str
    environment: dict
    kernels: tuple = ("compute", "fragment")
    refused: str = ""  # what a refusal must say, where this version of the driver is refused
    unreadable: str = ""  # the variant of a kernel that this driver would let answer wrongly
    needs: pathlib.Path = None
    package: str = ""


# softpipe has OpenGL 3.3 by its own account, and all that kernels use where it is told to say 4.5.
DRIVERS = [
    Driver("llvmpipe-128", {"LP_NATIVE_VECTOR_WIDTH": "128"}),
    Driver("llvmpipe-256", {"LP_NATIVE_VECTOR_WIDTH": "256"}),
    Driver("llvmpipe-512", {"LP_NATIVE_VECTOR_WIDTH": "512"}, kernels=("compute",)),
    Driver("softpipe", {"GALLIUM_DRIVER": "softpipe", "MESA_GL_VERSION_OVERRIDE": "4.5",
                        "MESA_GLSL_VERSION_OVERRIDE": "450"},
           unreadable="compute,group=64,branches,array,textures"),
    Driver("zink-lavapipe", {"LIBGL_ALWAYS_SOFTWARE": "1", "MESA_LOADER_DRIVER_OVERRIDE": "zink",
                             "VK_ICD_FILENAMES": str(LAVAPIPE)},
           refused="crashes when kernels are compiled", needs=LAVAPIPE,
           package="mesa-vulkan-drivers"),
]


def rays(count):
    """Returns rays of doubles: from a sphere around the scenes, to points within them."""
    choose = random.Random(5)
    out = bytearray()
    for _ in range(count):
        org = [choose.gauss(0, 1) for _ in range(3)]
        length = sum(x * x for x in org) ** 0.5
        org = [3 * x / length for x in org]
        aim = [choose.uniform(-1, 1) for _ in range(3)]
        out += struct.pack("<8d", *org, 0, *(a - o for a, o in zip(aim, org)), float("inf"))
    return bytes(out)


def hash_of(hits):
    return hits and hashlib.sha256(hits).hexdigest()[:16]


class Runs:
    def __init__(self, build, count, folder):
        self.bin = pathlib.Path(build) / "bin"
        self.rays = rays(count)
        self.folder = folder

    def run(self, command, driver, **options):
        environment = os.environ | driver.environment | {
            "MESA_SHADER_CACHE_DISABLE": "true", "XDG_RUNTIME_DIR": self.folder,
            "OVC_KERNEL_CACHE": f"{self.folder}/{driver.name}"}
        return subprocess.run(command, env=environment, capture_output=True, timeout=1500,
                              **options)

    def trace(self, driver, *options):
        """Returns the hits in all scenes, and what the command said where it failed."""
        hits = bytes()
        for scene in SCENES:
            done = self.run([self.bin / "overcast", "trace", "--binary", *options, scene], driver,
                            input=self.rays)
            if done.returncode:
                return None, done.stderr.decode().strip()
            hits += done.stdout
        return hits, ""

    def expected(self):
        """Returns the hash of the CPU's hits, and what is wrong where there is none."""
        found, said = self.trace(Driver("cpu", {}), "--backend", "cpu-kdtree")
        if not found:
            return None, said
        hits = [t < float("inf") for t, *_ in struct.iter_unpack("<3d2I", found)]
        for scene, first in zip(SCENES, range(0, len(hits), len(hits) // len(SCENES))):
            count = sum(hits[first:first + len(hits) // len(SCENES)])
            if not len(self.rays) / 64 / 20 < count:
                return None, f"too few rays hit anything of {scene}: {count}"
        return hash_of(found), ""

    def compiles(self, driver):
        done = self.run([self.bin / "gpu_test", "--gtest_filter=KernelVariantsGl.*"], driver)
        text = done.stdout.decode()
        return done.returncode == 0 and "[  PASSED  ] 1 test" in text, text[-2000:]


def row(runs, driver, expected):
    """Returns the row of a driver, and whether it is as it must be."""
    if driver.refused:
        said = runs.trace(driver, "--backend", "two-level")[1]
        if driver.refused in said:
            return f"| `{driver.name}` | refused | the device is passed over |", True
    compiled, text = runs.compiles(driver)
    if not compiled:
        print(text, file=sys.stderr)
    hashes = []
    for kernel in driver.kernels:
        hits, said = runs.trace(driver, "--backend", "two-level", "--kernel", kernel)
        found = hash_of(hits)
        hashes.append(found)
        if found != expected:
            print(f"{driver.name}, {kernel}: {found}, not {expected}; {said}", file=sys.stderr)
    refuses = True
    if driver.unreadable:
        said = runs.trace(driver, "--backend", "two-level", "--kernel-variant",
                          driver.unreadable)[1]
        refuses = f"cannot read this scene's pages as the kernel variant '{driver.unreadable}'" \
            in said
        if not refuses:
            print(f"{driver.name}, {driver.unreadable}: is not refused; {said}", file=sys.stderr)
    what = "NOT all" if not compiled else "all" if len(hashes) > 1 else "all of compute"
    cells = ", ".join(f"{kernel} `{found}`" for kernel, found in zip(driver.kernels, hashes))
    return (f"| `{driver.name}` | {what} | {cells} |",
            compiled and refuses and all(found == expected for found in hashes))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build")
    parser.add_argument("--driver", choices=[driver.name for driver in DRIVERS])
    parser.add_argument("--rays", type=int, default=20000)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(arguments.build, arguments.rays, folder)
        expected, said = runs.expected()
        if not expected:
            print(said)
            return 1
        print(f"{arguments.rays} rays; the CPU KD-tree's hash is `{expected}`\n")
        print("| driver | variants that compile | hits |\n|---|---|---|")
        fine = True
        for driver in DRIVERS:
            if arguments.driver not in (None, driver.name):
                continue
            if driver.needs and not driver.needs.exists():
                print(f"| `{driver.name}` | skipped | {driver.package} is not installed |")
                if arguments.driver:
                    return 77
                continue
            line, as_it_must_be = row(runs, driver, expected)
            print(line, flush=True)
            fine &= as_it_must_be
        return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
