#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the numbers of `overcast info --json` for PBRT scenes with an independent reading.

usage: compare.py OVERCAST SCENES EXPECTED.jsonl [--all]

OVERCAST: the command. SCENES: the folder that the scenes' names are relative to. EXPECTED: one JSON
object a line with scene, unique_tris, flat_tris, bbox_min, bbox_max, not_flattened and missing. The
independent reading does not count the shapes in not_flattened (quadrics, loopsubdiv, ...): there we
must find more triangles, exactly those of these shapes, and bounds that reach at least as far.
Prints the scenes that are not the same (with --all: all) with the reason, and a summary; exit 1
where a difference has no reason.
"""
import json
import subprocess
import sys

TOLERANCE = 1e-5  # of the extent: the other reading has rounded its bounds
# We make this many triangles of a shape that is not partial; see docs/reference/pbrt.md.
WHOLE = {"sphere": 1520, "disk": 32, "cylinder": 64}
# In these scenes one shape is partial: it covers 225 degrees, which are 20 of 32 steps.
PARTIAL = {
    "pbrt/v1-pharr/cylinders.pbrt": ("cylinder", 40),
    "pbrt/v1-pharr/disks.pbrt": ("disk", 40),  # a ring: two triangles a step
}
LEFT_OUT = {"curve", "nurbs"}


def read_scene(command, path):
    done = subprocess.run([command, "info", "--json", path], capture_output=True, text=True,
                          timeout=600)
    return (json.loads(done.stdout) if done.returncode == 0 else None), done.stderr.strip()


def bounds_agree(found, expected, may_reach_farther):
    if expected["bbox_min"] is None:
        return found["bounds"] is None or may_reach_farther
    if found["bounds"] is None:
        return False
    low = list(zip(found["bounds"]["min"], expected["bbox_min"]))
    high = list(zip(found["bounds"]["max"], expected["bbox_max"]))
    slack = TOLERANCE * (max(b - a for a, b in zip(expected["bbox_min"], expected["bbox_max"]))
                         or 1.0)
    if may_reach_farther:
        return all(a <= b + slack for a, b in low) and all(a >= b - slack for a, b in high)
    return all(abs(a - b) <= slack for a, b in low + high)


def reason(found, expected):
    """Returns the shapes that explain the difference, "" without one, None where nothing does."""
    if found is None:
        return None
    shapes = {s: n for s, n in expected["not_flattened"].items() if s not in LEFT_OUT}
    part, part_triangles = PARTIAL.get(expected["scene"], (None, 0))
    if part:
        shapes[part] -= 1
    unique = found["unique_triangles"] - expected["unique_tris"]
    flat = found["triangles"] - expected["flat_tris"]
    if (not bounds_agree(found, expected, bool(shapes))
            or unique != flat and not expected["objects"]):
        return None
    if unique == flat == 0 and not shapes:
        return ""
    parts = [f"{part_triangles} of a partial {part}"] if part else []
    parts += [f"{count} {shape} x {WHOLE[shape]}" for shape, count in shapes.items()
              if shape in WHOLE]
    rest = unique - part_triangles - sum(count * WHOLE[shape]
                                         for shape, count in shapes.items() if shape in WHOLE)
    others = [f"{count} {shape}" for shape, count in shapes.items() if shape not in WHOLE]
    if others and rest > 0:
        parts.append(f"{rest} of {', '.join(others)}")
        rest = 0
    return " + ".join(parts) if rest == 0 and parts else None


def main():
    command, folder, index = sys.argv[1:4]
    counts = {"same": 0, "explained": 0, "differ": 0}
    for line in open(index):
        expected = json.loads(line)
        found, message = read_scene(command, f"{folder}/{expected['scene']}")
        why = reason(found, expected)
        result = "differ" if why is None else "explained" if why else "same"
        counts[result] += 1
        if result == "same" and "--all" not in sys.argv:
            continue
        ours = (f"{found['unique_triangles']} / {found['triangles']}" if found
                else message.splitlines()[-1])
        theirs = f"{expected['unique_tris']} / {expected['flat_tris']}"
        print(f"{result:10} {expected['scene']:60} {ours:20} {theirs:20} {why or ''}")
    print("\n".join(f"{count:4} {result}" for result, count in counts.items()))
    return 1 if counts["differ"] else 0


if __name__ == "__main__":
    sys.exit(main())
