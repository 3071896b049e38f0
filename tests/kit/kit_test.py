# SPDX-License-Identifier: Apache-2.0
"""Runs the kit in a bare Debian with libegl1, libgl1 and libgl1-mesa-dri added, and nothing else.

usage: kit_test.py BUILD [--whole]     --whole: all that run.sh does, instead of --short
"""
import argparse
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tarfile
import tempfile

PACKAGES = "libegl1,libgl1,libgl1-mesa-dri"
SKIPPED = 77


def inside(root, command, seconds):
    """Runs a command in the bare system, which has no network and few variables."""
    mounted = (f"mount -t proc proc {root}/proc && mount --bind /dev {root}/dev && "
               f"exec chroot {root} env -i PATH=/usr/bin:/bin sh -c {shlex.quote(command)}")
    return subprocess.run(["unshare", "--mount", "--pid", "--net", "--fork", "sh", "-c", mounted],
                          text=True, capture_output=True, timeout=seconds)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--whole", action="store_true")
    asked = parser.parse_args()
    if not shutil.which("mmdebstrap") or os.geteuid() != 0:
        print("it takes mmdebstrap, and root")
        return SKIPPED
    archive, = asked.build.glob("overcast-kit-*.tgz")
    with tempfile.TemporaryDirectory(prefix="overcast_kit_") as holder:
        root = pathlib.Path(holder).resolve() / "root"
        mirror = next(iter(subprocess.run(["apt-get", "indextargets", "--format", "$(SITE)"],
                                          text=True, capture_output=True).stdout.split()),
                      "http://deb.debian.org/debian")
        made = subprocess.run(["mmdebstrap", "--variant=minbase", f"--include={PACKAGES}",
                               "bookworm", root, mirror], text=True, capture_output=True)
        if made.returncode != 0:
            print("no Debian to be had here: " + made.stderr.strip()[-200:])
            return SKIPPED
        with tarfile.open(archive) as tar:
            tar.extractall(root / "kit")
        kit, = (root / "kit").iterdir()
        done = inside(root, f"/kit/{kit.name}/run.sh {'' if asked.whole else '--short'}", 1800)
        print(done.stdout + done.stderr)
        told = json.loads((kit / "results/kit.json").read_text())
        wrong = [part["name"] for part in told["parts"] if part["exit"] != 0]
        for part in told["parts"]:
            if part["exit"] != 0:
                print(part["name"], part["text"][-3000:])
        if asked.whole:
            for name in ("kit.json", "page.md"):
                shutil.copy(kit / "results" / name, asked.build / f"bare-{name}")
        kept = sum(file.stat().st_size for file in kit.rglob("*") if file.is_file())
        print(f"{archive.stat().st_size / 2**20:.1f} MiB packed, {kept / 2**20:.1f} MiB with "
              f"results; {len(told['parts'])} parts, wrong: {wrong}")
        has_page = (kit / "results/page.md").stat().st_size > 1000
        return 0 if done.returncode == 0 and not wrong and has_page else 1


if __name__ == "__main__":
    sys.exit(main())
