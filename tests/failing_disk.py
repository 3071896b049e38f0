# SPDX-License-Identifier: Apache-2.0
"""Runs commands on a disk that fails: the right bytes, or a sentence and nothing half-written.

usage: failing_disk.py OVERCAST LIBRARY     LIBRARY: of tests/faults/failing_disk.c
"""
import os
import pathlib
import subprocess
import sys
import tempfile

SECONDS = 120  # a command that takes longer hangs


class Disk:
    def __init__(self, folder, library):
        self.folder, self.library = folder, library
        self.whole = {}  # what a target is to hold
        self.outcomes = {}

    def run(self, command, fault=None):
        environment = dict(os.environ, OVC_KERNEL_CACHE="off")
        if fault:
            environment |= {"LD_PRELOAD": self.library, "OVC_FAULT": fault,
                            "OVC_FAULT_FOLDER": str(self.folder)}
        return subprocess.run([str(word) for word in command], env=environment, text=True,
                              capture_output=True, timeout=SECONDS)

    def check(self, command, target, fault):
        """Runs a command that writes the target. Fails unless the fault is healed or said."""
        old = b"the old file"
        target.write_bytes(old)
        before = {file.name for file in self.folder.iterdir()}
        done = self.run(command, fault)
        found, said = target.read_bytes(), done.stderr.strip()
        left = {file.name for file in self.folder.iterdir()} - before
        words = f"{fault}: {' '.join(map(str, command[1:]))}"
        if left:
            sys.exit(f"{words} has left {left}")
        if done.returncode == 0 and found != self.whole[target]:
            sys.exit(f"{words}: other bytes, and nobody noticed")
        if done.returncode != 0 and found != old:
            sys.exit(f"{words}: exit code {done.returncode}, but the old file is gone")
        if done.returncode not in (0, 1) or (done.returncode == 1 and "overcast: " not in said):
            sys.exit(f"{words}: exit code {done.returncode}: {said}")
        if done.returncode == 0 and fault.startswith(("eio", "enospc")) and fault.endswith(":1"):
            sys.exit(f"{words}: a disk of which nothing works was not noticed")
        if done.returncode == 1 and fault.startswith(("short", "eintr", "none")):
            sys.exit(f"{words}: {said}")
        self.outcomes[said.splitlines()[-1] if done.returncode else "right"] = fault


def main():
    overcast, library = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        disk = Disk(folder, library)
        source, scene, picture = folder / "a.ply", folder / "a.ovc", folder / "a.png"
        copy = folder / "b.ovc"
        budget = ["--host-memory", "48M"]
        convert = [overcast, "convert", source, copy]
        render = [overcast, "render", scene, "--size", "40x30", "--quiet", "-o", picture]
        disk.run([overcast, "convert", "sphere-7", source, "--quiet"])
        if disk.run([overcast, "convert", source, scene] + budget).returncode != 0:
            print("skipped: no device for the plugin")
            return 77
        # The C library writes outputs by calls of its own, which nothing can be put before; tests
        # with a limit of a file's size fill those disks. A scene without a budget is mapped.
        jobs = [(convert, copy, ("read",)), (convert + budget, copy, ("read", "pread", "pwrite")),
                (render + budget, picture, ("pread",))]
        for command, target, calls in jobs:
            done = disk.run(command)
            if done.returncode != 0:
                sys.exit(done.stderr)
            disk.whole = {target: target.read_bytes()}
            for call in calls:
                full = "enospc" if "write" in call else "eio"
                faults = ["eio:{}:1", full + ":{}:4", full + ":{}:40", "short:{}:3"]
                if call != "read":  # zlib, which reads inputs, takes a signal for an error
                    faults.append("eintr:{}:3")
                for fault in faults:
                    disk.check(command, target, fault.format(call))
            disk.check(command, target, "none:read:1")  # a later try works
        for sentence, fault in disk.outcomes.items():
            print(f"{fault}: {sentence}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
