# SPDX-License-Identifier: Apache-2.0
"""Kills conversions at moments of all their length: the old file stays, or the new one is whole.
What --continue has kept is gone on with, killed again and again, to the same bytes.

usage: killed_conversion.py OVERCAST [RUNS]
"""
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time


def continue_killed(convert, target, whole, seconds, runs):
    """Kills conversions with --continue until each is done. Returns how many were killed."""
    folder, killed = target.parent, 0
    continued = convert + ["--continue"]
    old = b"the old file"
    while killed < runs:
        target.write_bytes(old)
        begun = 0
        while target.read_bytes() == old:
            process = subprocess.Popen(continued, stderr=subprocess.DEVNULL)
            deadly = signal.SIGINT if killed % 5 == 4 else signal.SIGKILL
            # Later runs live longer, so that each conversion comes to its end.
            try:
                process.wait(seconds * random.uniform(0, 1 + begun / 4))
            except subprocess.TimeoutExpired:
                process.send_signal(deadly)
                killed += 1
            process.wait()
            begun += 1
            now = target.read_bytes()
            if now not in (old, whole):
                sys.exit(f"run {killed}: the file is neither the old one nor the new one")
        left = sorted(f.name for f in folder.iterdir() if f.name not in ("a.ply", "a.ovc"))
        # A run that is killed behind its last step, once the file is in its place, cannot tidy up.
        if any("unfinished" not in name for name in left):
            sys.exit(f"run {killed}: --continue has left {left}")
        for name in left:
            (folder / name).unlink()
    return killed


def damage_kept(convert, target, whole):
    """Spoils each kept file of a run that was killed: a sentence, or the same bytes."""
    kept = [target.with_name(f"a.unfinished.{end}") for end in ("ovc", "scratch", "steps")]
    continued = convert + ["--continue"]
    for spoilt in kept:
        target.unlink(missing_ok=True)
        process = subprocess.Popen(continued, stderr=subprocess.DEVNULL)
        while process.poll() is None and not (kept[2].exists() and
                                              kept[2].stat().st_size > 3000):
            time.sleep(0.002)
        process.kill()
        process.wait()
        if spoilt.exists():
            damaged = bytearray(spoilt.read_bytes())
            for at in range(0, len(damaged), 50):
                damaged[at] ^= 1
            spoilt.write_bytes(damaged)
        said = subprocess.run(continued, stderr=subprocess.PIPE, text=True)
        if said.returncode == 0 and target.read_bytes() != whole:
            sys.exit(f"{spoilt.name} was damaged, and nobody noticed")
        print(f"{spoilt.name} damaged: exit code {said.returncode}; "
              f"{said.stderr.strip().splitlines()[-1] if said.stderr.strip() else ''}")
        if said.returncode != 0:
            subprocess.run(continued, stderr=subprocess.DEVNULL, check=True)
            if target.read_bytes() != whole:
                sys.exit(f"{spoilt.name} was damaged, and the run after that made another file")
        left = [file.name for file in kept if file.exists()]
        if left:
            sys.exit(f"a conversion that ended well has left {left}")


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
        killed = continue_killed(convert, target, whole, seconds, runs)
        print(f"{killed} conversions with --continue killed: all ended with the same bytes")
        damage_kept(convert, target, whole)
        return 0 if outcomes["old"] else 1


if __name__ == "__main__":
    sys.exit(main())
