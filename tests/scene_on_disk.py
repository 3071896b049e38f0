# SPDX-License-Identifier: Apache-2.0
"""Plans, converts and renders scenes of which host memory holds a part: the picture is the same
bits, the process stays within its budgets as the kernel measures it, the plan told what all takes,
and what is damaged is said.

usage: scene_on_disk.py OVERCAST [SCENE [WIDTHxHEIGHT]]     default: three small scenes
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

MIB = 1 << 20
SIZE = "160x120"


def run(command, environment=None):
    """Returns the exit code, what the command said, and the most memory that it had resident."""
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen([str(word) for word in command], stdout=said, stderr=said,
                                   env=environment)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        return process.returncode, said.read().decode(), usage.ru_maxrss * 1024


class Pictures:
    def __init__(self, overcast, folder, size):
        self.overcast, self.size = overcast, size
        self.picture = folder / "picture.png"
        self.kernels = folder / "kernels"
        # Mesa keeps a kernel's machine code, of which a program may have several.
        self.environment = dict(os.environ, OVC_KERNEL_CACHE=str(self.kernels),
                                MESA_SHADER_CACHE_DIR=str(self.kernels))

    def render(self, scene, *options):
        self.picture.unlink(missing_ok=True)
        return run([self.overcast, "render", scene, "--size", self.size, "-o", self.picture,
                    *options], self.environment)

    def kernels_kept(self):
        """Their files and bytes. Mesa since version 24 keeps all kernels in the same files."""
        sizes = [path.stat().st_size for path in self.kernels.rglob("*") if path.is_file()]
        return len(sizes), sum(sizes)

    def bytes_of(self, scene, *options):
        code, said, peak = self.render(scene, *options)
        if code != 0:
            sys.exit(f"{scene} {options}: {said}")
        return self.picture.read_bytes(), peak, said

    def bytes_without_compiling(self, scene, *options):
        """The same of a run that finds all its kernels compiled, which takes some 30 MiB each.

        Which kernels a run needs depends on when pages come, so the first may not be the last.
        """
        kept = None
        while kept != self.kernels_kept():
            kept = self.kernels_kept()
            found = self.bytes_of(scene, *options)
        return found


def compare(pictures, file, shares=(1, 0.25, 0.05)):
    """Renders under several budgets of both kinds. Returns the level 2 in bytes."""
    expected, _, said = pictures.bytes_of(file)
    units = {"B": 1, "KiB": 1 << 10, "MiB": MIB, "GiB": 1 << 30}
    number, unit = re.search(r"leaves .*?, ([\d.]+) (\w+) of level 2", said).groups()
    level2 = int(float(number) * units[unit])
    whole = file.stat().st_size
    for gpu in (2 * level2, max(level2 // 10, 4 * MIB)):
        _, empty, _ = pictures.bytes_without_compiling("box", "--gpu-memory", gpu)
        for share in shares:
            host = int(whole * share)
            allowed = (host + gpu + empty) * 1.05
            found, peak, said = pictures.bytes_without_compiling(file, "--gpu-memory", gpu,
                                                                 "--host-memory", host)
            disk = re.search(r"disk .*", said)[0]
            print(f"GPU {gpu / MIB:.0f} MiB, host {host / MIB:.1f} MiB ({share:.0%}): peak "
                  f"{peak / MIB:.0f} MiB, empty {empty / MIB:.0f} MiB; {disk}")
            if found != expected:
                sys.exit("another picture")
            if peak > allowed:
                sys.exit(f"{peak / MIB:.0f} MiB, {allowed / MIB:.0f} MiB are allowed")
    return level2


def check_plan(overcast, file, scene, options):
    """Compares what a plan told before anything was built with what was."""
    told = json.loads(run([overcast, "info", scene, "--json", "--log-level", "error", *options])[1])
    takes = told["plan"]["takes"]
    stats = file.with_name("stats.json")
    code, said, _ = run([overcast, "render", scene, "--size", "16x12", "--quiet", "--stats", stats,
                         "-o", file.with_name("small.png"), *options])
    if code != 0:
        sys.exit(said)
    made = json.loads(stats.read_text())
    unique = made["unique_triangles"] * 36
    for what, planned, found in (("file", takes["file"], file.stat().st_size),
                                 ("host", takes["host"], made["host_bytes"] + unique),
                                 ("GPU", takes["gpu"], made["gpu_peak_bytes"])):
        print(f"plan of {scene}, {what}: {planned / MIB:.1f} MiB, made {found / MIB:.1f} MiB")
        if abs(planned - found) > 0.1 * found:
            sys.exit(f"{what}: planned {planned}, made {found}")


def check_streamed_plan(overcast, file, scene, options, memory):
    """Compares what a plan told of a scene that streams with that of the file it became."""
    def takes(*words):
        code, said, _ = run([overcast, "info", *words, "--json", "--log-level", "error", *memory])
        if code != 0:
            sys.exit(said)
        return json.loads(said)["plan"]["takes"]

    told, made = takes(scene, *options), takes(file)
    for what, planned in told.items():
        print(f"plan of {scene}, {what}: {planned / MIB:.1f} MiB, made {made[what] / MIB:.1f} MiB")
        if abs(planned - made[what]) > 0.1 * made[what]:
            sys.exit(f"{what}: planned {planned}, made {made[what]}")


def expect_error(pictures, file, sentence, *options):
    code, said, _ = pictures.render(file, *options)
    print(said.strip())
    if code != 1 or not re.search(sentence, said):
        sys.exit(f"exit code {code}, expected 1 and: {sentence}")


def damage(pictures, file, level2):
    """Spoils what rays read, and cuts the file off."""
    # One thread, for several race for what is the first damage of all.
    options = ("--host-memory", 64 * MIB, "--gpu-memory", 2 * level2, "--threads", 1)
    whole = bytearray(file.read_bytes())
    spoilt = file.with_name("spoilt.ovc")
    # Corners come before levels, which begin with all pages.
    for place, sentence in ((whole.find(b"ovc levels") + 64 + level2 // 2,
                             r"the page of leaf \d+ is damaged: its checksum is wrong"),
                            (None, r"the corners of triangles \d+ to \d+ of mesh 0 are damaged")):
        again = whole.copy()
        if place is None:  # all that a picture could show
            for at in range(MIB, whole.find(b"ovc levels") - MIB, 4096):
                again[at] ^= 1
        else:
            again[place] ^= 1
        spoilt.write_bytes(again)
        expect_error(pictures, spoilt, sentence, *options)
    spoilt.write_bytes(whole[:-100])
    expect_error(pictures, spoilt, "the file is cut off", *options)
    expect_error(pictures, file, r"the smallest number that works is (\d+)", "--host-memory", 1000)
    smallest = int(re.search(r"that works is (\d+)",
                             pictures.render(file, "--host-memory", 1000)[1])[1])
    pictures.bytes_of(file, "--host-memory", smallest)
    expect_error(pictures, file, r"the smallest number that works is", "--host-memory",
                 smallest - 1)
    expect_error(pictures, "box", r"--host-memory goes with one \.ovc file", *options)


def main():
    overcast = sys.argv[1]
    size = sys.argv[3] if len(sys.argv) > 3 else SIZE
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        model = folder / "model.ply"  # that dragons show, unless a scene is asked for
        run([overcast, "convert", "sphere-5", model, "--quiet"])
        small = [("plants-1", ()), ("dragons-2", ("--model", model)), ("landscape-1", ())]
        file = folder / "scene.ovc"
        pictures = Pictures(overcast, folder, size)
        for scene, options in [(sys.argv[2], ())] if len(sys.argv) > 2 else small:
            options += ("--leaf-triangles", 2000 if len(sys.argv) <= 2 else 8000)
            streams = ("--host-memory", 128 * MIB) if scene.startswith("landscape") else ()
            code, said, _ = run([overcast, "convert", scene, file, *options, *streams])
            if code != 0:
                print(f"skipped: {said}")
                return 77
            level2 = compare(pictures, file, (0.05,)) if streams else compare(pictures, file)
            if streams:
                check_streamed_plan(overcast, file, scene, options, streams)
            else:
                check_plan(overcast, file, scene, options)
        if len(sys.argv) <= 2:
            damage(pictures, file, level2)
    return 0


if __name__ == "__main__":
    sys.exit(main())
