# SPDX-License-Identifier: Apache-2.0
"""Makes a folder, and a .tgz of it, that tests Overcast on a machine with a GPU: the command, the
library, tests, the libraries that all these need besides glibc and the driver, scenes and run.sh.

usage: make_kit.py BUILD SOURCE VERSION
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile

PROGRAMS = ("overcast", "gpu_test", "plugin_test", "gpu_probe")
LIBRARIES = ("libovercast.so.1", "libovercast-thesis.so")
SCENES = ("box", "sphere-5")
MAX_BYTES = 60 << 20
# Those of glibc, which a system has, and those that the driver brings.
NOT_OURS = re.compile(r"^(linux-vdso|ld-linux|lib(c|m|dl|rt|pthread|resolv|GL|EGL|OpenGL|GLX|"
                      r"GLdispatch|X11|xcb)\b)")


def needed(file):
    """Yields the name and the path of each library that the file is linked with."""
    for line in subprocess.check_output(["ldd", file], text=True).splitlines():
        name, _, path = line.strip().partition(" => ")
        if path == "not found":
            sys.exit(f"{file} needs {name}, which is not here")
        if path and not NOT_OURS.match(name):
            yield name, path.split()[0]


def strip(file):
    subprocess.run(["strip", "--strip-unneeded", file], check=True)


def main():
    build, source, version = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    kit = build / f"overcast-kit-{version}"
    shutil.rmtree(kit, ignore_errors=True)
    for folder in ("bin", "lib", "scenes"):
        (kit / folder).mkdir(parents=True)
    for name in PROGRAMS + LIBRARIES:
        shutil.copy(build / "bin" / name, kit / "bin" / name)
        for library, path in needed(build / "bin" / name):
            if not (kit / "bin" / library).exists() and library not in LIBRARIES:
                shutil.copy(path, kit / "lib" / library)
    for file in [*(kit / "bin").iterdir(), *(kit / "lib").iterdir()]:
        file.chmod(0o755)
        strip(file)
    for scene in SCENES:
        subprocess.run([build / "bin/overcast", "convert", scene, kit / f"scenes/{scene}.ovc"],
                       check=True, stdout=subprocess.DEVNULL)
    for name in ("run.sh", "in_shares.sh", "README.md"):
        shutil.copy(source / "tests/kit" / name, kit / name)
    shutil.copy(source / "LICENSE", kit / "LICENSE")
    (kit / "VERSION").write_text(version + "\n")
    archive = kit.with_suffix(kit.suffix + ".tgz")
    with tarfile.open(archive, "w:gz") as tar:
        tar.add(kit, kit.name)
    size = archive.stat().st_size
    if size > MAX_BYTES:
        archive.unlink()
        sys.exit(f"the kit has {size} bytes, {MAX_BYTES} at most")
    print(f"{archive}: {size / 2**20:.1f} MiB")


if __name__ == "__main__":
    main()
