# SPDX-License-Identifier: Apache-2.0
"""Kills conversions at moments of all their length: the old file stays, or the new one is whole.

usage: killed_conversion.py OVERCAST [RUNS]
"""
import pathlib
import signal
import subprocess
import sys
import tempfile
import time


def main():
    overcast, runs = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 8
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        source, target = folder / "a.ply", folder / "a.ovc"
        convert = [overcast, "convert", source, target, "--host-memory", "48M"]
        subprocess.run([overcast, "convert", "sphere-7", source, "--quiet"], check=True)
        begun = time.monotonic()
        if subprocess.run(convert, stderr=subprocess.DEVNULL).returncode != 0:
            print("skipped: no device for the plugin")
            return 77
        seconds, whole = time.monotonic() - begun, target.read_bytes()
        old = b"the old file"
        outcomes = {"old": 0, "new": 0}
        for run in range(runs):
            target.write_bytes(old)
            deadly = signal.SIGINT if run % 2 else signal.SIGKILL
            process = subprocess.Popen(convert, stderr=subprocess.DEVNULL)
            time.sleep(seconds * run / runs)
            process.send_signal(deadly)
            process.wait()
            now = target.read_bytes()
            if now not in (old, whole):
                print(f"run {run}: the file is neither the old one nor the new one")
                return 1
            outcomes["old" if now == old else "new"] += 1
            left = sorted(f.name for f in folder.iterdir() if f not in (source, target))
            # Only the unfinished output has a name, which a process that is killed cannot remove.
            if len(left) > (deadly == signal.SIGKILL):
                print(f"run {run}: {deadly.name} has left {left}")
                return 1
            for file in left:
                (folder / file).unlink()
        print(f"{runs} conversions of {seconds:.2f} s killed: {outcomes}")
        return 0 if outcomes["old"] else 1


if __name__ == "__main__":
    sys.exit(main())
