#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares what `overcast info --json` says of PBRT scenes with an independent reading of them.

usage: compare.py OVERCAST SCENES EXPECTED.jsonl [--all]

OVERCAST: the command. SCENES: the folder that the scenes' names are relative to. EXPECTED: one JSON object a line with
scene, unique_tris, flat_tris, bbox_min, bbox_max, shapes, not_flattened and missing; what stands in not_flattened
(quadrics, loopsubdiv, ...) that reading does not
count, so such scenes can only have more. Prints a table of the scenes
that differ (with --all: of all) and a summary; exit 1 where a scene differs that the other reading has in full.
"""
import json
import subprocess
import sys

TOLERANCE = 1e-5  # of the extent: the other reading has rounded its bounds


def read_scene(command, path):
    done = subprocess.run([command, "info", "--json", path], capture_output=True, text=True, timeout=600)
    warnings = [line for line in done.stderr.splitlines() if "warning" in line]
    return (json.loads(done.stdout) if done.returncode == 0 else None), warnings, done.stderr.strip()


def bounds_difference(found, expected):
    """The largest difference of a bound, in extents; 0 where both have none."""
    if not found["bounds"] or expected["bbox_min"] is None:
        return 0.0 if not found["bounds"] and expected["bbox_min"] is None else float("inf")
    pairs = list(zip(found["bounds"]["min"], expected["bbox_min"])) + list(zip(found["bounds"]["max"], expected["bbox_max"]))
    extent = max(b - a for a, b in zip(expected["bbox_min"], expected["bbox_max"])) or 1.0
    return max(abs(a - b) for a, b in pairs) / extent


def verdict(found, expected):
    if found is None:
        return "error"
    unique = found["unique_triangles"] - expected["unique_tris"]
    flat = found["triangles"] - expected["flat_tris"]
    same_counts = unique == 0 and flat == 0
    if same_counts and bounds_difference(found, expected) <= TOLERANCE:
        return "same"
    if expected["not_flattened"]:
        return "more" if unique >= 0 and flat >= 0 else "differs"
    return "bounds differ" if same_counts else "differs"


def main():
    command, folder, index = sys.argv[1:4]
    everything = "--all" in sys.argv
    counts = {}
    for line in open(index):
        expected = json.loads(line)
        found, warnings, message = read_scene(command, f"{folder}/{expected['scene']}")
        result = verdict(found, expected)
        complete = not expected["not_flattened"]
        counts[result, complete] = counts.get((result, complete), 0) + 1
        if result == "same" and not everything:
            continue
        ours = f"{found['unique_triangles']} / {found['triangles']}" if found else message
        bounds = bounds_difference(found, expected) if found else 0
        print(f"{result:13} {expected['scene']:60} {ours:22} {expected['unique_tris']} / {expected['flat_tris']:<12}"
              f" bounds {bounds:.1e}  {expected['not_flattened'] or ''} {len(warnings)} warnings")
    print()
    for (result, complete), count in sorted(counts.items()):
        print(f"{count:4} {result:14} {'read in full by both' if complete else 'with shapes that the other reading leaves out'}")
    return 1 if any(complete and result != "same" for result, complete in counts) else 0


if __name__ == "__main__":
    sys.exit(main())
