# SPDX-License-Identifier: Apache-2.0
"""Runs commands on a disk that fails: the right bytes, or a sentence and nothing half-written.

usage: failing_disk.py OVERCAST LIBRARY     LIBRARY: of tests/faults/failing_disk.c
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SECONDS = 120  # a command that takes longer hangs
RAYS = "".join(f"{x / 7} {y / 7} 9  0 0 -1\n" for x in range(-9, 10) for y in range(-9, 10))
# The message of a disk that cannot read or write.
REASON = r"Input/output error|No space left on device"


class Disk:
    def __init__(self, folder, library):
        self.folder, self.library = folder, library
        self.outcomes = {}

    def run(self, command, fault=None, rays=None, kernels=None):
        environment = dict(os.environ, OVC_KERNEL_CACHE=str(kernels or "off"))
        if fault:
            environment |= {"LD_PRELOAD": self.library, "OVC_FAULT": fault,
                            "OVC_FAULT_FOLDER": str(kernels or self.folder)}
        return subprocess.run([str(word) for word in command], env=environment, text=True,
                              input=rays, capture_output=True, timeout=SECONDS)

    def check_end(self, command, fault, done):
        """Checks how a command ended. Returns whether it was right."""
        said = done.stderr.strip()
        words = f"{fault}: {' '.join(map(str, command[1:]))}"
        fatal = fault.startswith(("eio", "enospc"))
        if done.returncode not in (0, 1):
            sys.exit(f"{words}: exit code {done.returncode}: {said}")
        if done.returncode == 1 and not (fatal and "overcast: " in said and
                                         re.search(REASON, said)):
            sys.exit(f"{words}: {said}")
        if done.returncode == 0 and fatal and fault.endswith(":1"):
            sys.exit(f"{words}: a disk of which nothing works was not noticed")
        self.outcomes[said.splitlines()[-1] if done.returncode else "right"] = fault
        return done.returncode == 0

    def check_written(self, command, target, whole, fault):
        """Runs a command that writes the target. Fails unless the fault is healed or said."""
        old = b"the old file"
        target.write_bytes(old)
        before = {file.name for file in self.folder.iterdir()}
        is_right = self.check_end(command, fault, self.run(command, fault))
        left = {file.name for file in self.folder.iterdir()} - before
        words = f"{fault}: {' '.join(map(str, command[1:]))}"
        if left:
            sys.exit(f"{words} has left {left}")
        if target.read_bytes() != (whole if is_right else old):
            sys.exit(f"{words}: exit code {int(not is_right)}, and the file is another one")

    def check_told(self, command, whole, fault, rays):
        """Runs a command that answers on its standard output."""
        done = self.run(command, fault, rays)
        if self.check_end(command, fault, done) != (done.stdout == whole) or \
                not whole.startswith(done.stdout):
            sys.exit(f"{fault}: {' '.join(map(str, command[1:]))} tells {done.stdout}")

    def check_kernels(self, command, picture):
        """Runs a command whose kernels are kept on the disk, which it can do without."""
        kernels = self.folder / "kernels"
        self.run(command, kernels=kernels)
        whole, kept = picture.read_bytes(), sorted(kernels.iterdir())
        if not kept:
            sys.exit("no kernel was kept")
        for call in ("mmap", "pread", "write"):
            for fault in faults_of(call) + [f"eio:{call}:2"]:
                if call == "write":
                    for file in kernels.iterdir():
                        file.unlink()
                done = self.run(command, fault, kernels=kernels)
                if done.returncode or done.stderr or picture.read_bytes() != whole:
                    sys.exit(f"{fault}: kernels that are kept: exit code {done.returncode}: "
                             f"{done.stderr}")
                if set(kernels.iterdir()) - set(kept):
                    sys.exit(f"{fault}: kernels that are kept: another file is left")


def faults_of(call):
    if call == "fsync":
        return ["eio:fsync:1"]
    full = "enospc" if "write" in call else "eio"
    return [fault.format(call) for fault in
            ("eio:{}:1", full + ":{}:4", full + ":{}:40", "short:{}:3", "eintr:{}:3")]


def main():
    overcast, library = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        disk = Disk(folder, library)
        source, packed, scene = folder / "a.ply", folder / "a.ply.gz", folder / "a.ovc"
        copy, mesh, picture = folder / "b.ovc", folder / "b.ply", folder / "a.png"
        budget = ["--host-memory", "48M"]
        render = [overcast, "render", scene, "--size", "40x30", "--quiet", "-o", picture]
        trace = [overcast, "trace", scene] + budget
        disk.run([overcast, "convert", "sphere-7", source, "--quiet"])
        subprocess.run(["gzip", "--fast", "--keep", source], check=True)
        if disk.run([overcast, "convert", source, scene] + budget).returncode != 0:
            print("skipped: no device for the plugin")
            return 77
        # A scene without a budget is mapped, and no call reads it.
        written = [([overcast, "convert", source, mesh], mesh, ("pread", "write", "fsync")),
                   ([overcast, "convert", packed, mesh], mesh, ("pread",)),
                   ([overcast, "convert", source, copy] + budget, copy,
                    ("pread", "pwrite", "write")),
                   (render + budget, picture, ("pread", "write"))]
        for command, target, calls in written:
            done = disk.run(command)
            if done.returncode != 0:
                sys.exit(done.stderr)
            whole = target.read_bytes()
            for fault in [fault for call in calls for fault in faults_of(call)]:
                disk.check_written(command, target, whole, fault)
        for command, rays in ((trace, RAYS), ([overcast, "info", scene] + budget, None)):
            whole = disk.run(command, rays=rays).stdout
            for fault in faults_of("pread") + ["none:pread:1"]:
                disk.check_told(command, whole, fault, rays)
        disk.check_kernels([overcast, "render", "sphere-3", "--size", "40x30", "--quiet", "-o",
                            picture], picture)
        for sentence, fault in disk.outcomes.items():
            print(f"{fault}: {sentence}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
