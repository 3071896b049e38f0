#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares which pixels of POV-Ray scenes are hit, by povray and by us, scene by scene.
docs/design/readers_compared.md says how we learn it from povray.

usage: compare.py [--data DIR] [--index FILE] [--tiers AB] [--only TEXT] [--again TABLE]
                  [--cache DIR] [--build DIR] [--jobs N] [--limit SECONDS] [--reference-only]

DIR holds, unpacked, pov/ (data/scenes); FILE is pov_tiers.txt. --cache keeps povray's answers, so
that povray runs once for each scene. TABLE is the output of an earlier run, of which only the
scenes that were not imported, or differed, run again.
"""
import argparse
import collections
import concurrent.futures
import hashlib
import math
import os
import pathlib
import re
import resource
import subprocess
import sys
import time

WIDTH, HEIGHT = 160, 120
KEY = (0.71, 0.03, 0.37)  # the color of "no hit", which no object is likely to have
AGREE = 0.99
BLACK = 2
ROOT = pathlib.Path(__file__).resolve().parents[2]


def sky(key):
    """Returns the text that gives a scene a sky of the color `key`."""
    return ('\n#version 3.7;\nsky_sphere { pigment { color rgb <%g, %g, %g> } }\n' % key)


def read_ppm(path):
    """Returns the picture's width x height x 3 numbers of 16 bits, as one bytes object."""
    data = path.read_bytes()
    fields, at = [], 0
    while len(fields) < 4:
        end = data.index(b"\n", at)
        line = data[at:end].split(b"#")[0]
        fields += line.split()
        at = end + 1
    assert fields[0] == b"P6" and fields[3] == b"65535", fields
    return data[at:]


def is_key(pixel):
    """Returns whether the pixel is the key raised to the power that assumed_gamma causes."""
    if min(pixel) == 0 or pixel[0] == 65535:
        return False
    power = math.log(pixel[0] / 65535) / math.log(KEY[0])
    return 0.2 < power < 5 and all(abs(p - 65535 * k ** power) <= 4 + 0.001 * p
                                   for p, k in zip(pixel, KEY))


def run_povray(arguments, folder, limit):
    """Runs povray in `folder`. Returns why it failed, or ""."""
    command = ["povray", *arguments, "-D", "-GA", "+WT1", f"+L{folder}"]
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, timeout=limit,
                              preexec_fn=lambda: os.nice(10))
    except subprocess.TimeoutExpired:
        return f"more than {limit:g} s"
    text = done.stderr.decode("utf-8", "replace")
    if done.returncode == 0:
        return ""
    return next((line for line in text.splitlines() if "error" in line.lower()),
                f"exit {done.returncode}")


def add_choice(parser):
    """Adds the arguments that choose the scenes."""
    parser.add_argument("--data", type=pathlib.Path, default=ROOT / "data" / "scenes")
    parser.add_argument("--index", type=pathlib.Path,
                        default=ROOT.parent / "shared" / "data" / "pov_tiers.txt")
    parser.add_argument("--tiers", default="AB")
    parser.add_argument("--only", default="")


def chosen_scenes(options):
    """Returns the paths of the index's scenes that the options choose."""
    data = options.data.resolve()
    return [data / line.split()[2] for line in options.index.read_text().splitlines()
            if line and line[0] in options.tiers and options.only in line.split()[2]]


def povray_mask(scene, cache, limit):
    """Returns (povray's mask or None, why there is none).

    The mask has a byte for each pixel: 0 for no hit, 1 for a hit, BLACK where the pixel is black.
    """
    name = hashlib.sha1(str(scene).encode()).hexdigest()[:16]
    kept, failed = cache / (name + ".mask"), cache / (name + ".failed")
    if kept.exists():
        return kept.read_bytes(), ""
    if failed.exists():
        return None, failed.read_text()
    wrapped, picture = cache / (name + ".pov"), cache / (name + ".ppm")
    wrapped.write_bytes(scene.read_bytes() + sky(KEY).encode())
    error = run_povray([f"+I{wrapped}", f"+O{picture}", f"+W{WIDTH}", f"+H{HEIGHT}", "+FP16",
                        "File_Gamma=1.0", "-A", "+Q0"], scene.parent, limit)
    wrapped.unlink()
    if error:
        failed.write_text(error)
        return None, error
    pixels = read_ppm(picture)
    picture.unlink()
    values = [256 * pixels[i] + pixels[i + 1] for i in range(0, len(pixels), 2)]
    mask = bytes(0 if is_key(pixel) else 1 if any(pixel) else BLACK
                 for pixel in (values[3 * i:3 * i + 3] for i in range(WIDTH * HEIGHT)))
    kept.write_bytes(mask)
    return mask, ""


def our_mask(tool, scene, limit):
    """Returns (the mask of pov_mask or None, its messages or why it failed, seconds)."""
    start = time.time()
    try:
        done = subprocess.run([tool, scene, str(WIDTH), str(HEIGHT)], capture_output=True,
                              timeout=limit, preexec_fn=lambda: (os.nice(10), resource.setrlimit(
                                  resource.RLIMIT_AS, (8 << 30,) * 2)))
    except subprocess.TimeoutExpired:
        return None, f"more than {limit} s", limit
    said = done.stderr.decode("utf-8", "replace").strip()
    seconds = time.time() - start
    if done.returncode != 0:
        # Indented lines quote the scene.
        lines = [line for line in said.splitlines() if not line.startswith("    ")]
        if lines and done.returncode == 1:
            return None, lines[-1], seconds
        return None, f"exit {done.returncode}: {said[-200:]}", seconds
    return done.stdout, said, seconds


def compare(scene, options, tool):
    """Returns a row of the table: the scene's path and state, why, and numbers where both drew."""
    theirs, error = povray_mask(scene, options.cache, options.limit)
    if theirs is None:
        return {"scene": scene, "state": "povray fails", "why": error}
    if options.reference_only:
        return {"scene": scene, "state": "povray renders", "why": ""}
    ours, said, seconds = our_mask(tool, scene, options.limit)
    if ours is None:
        return {"scene": scene, "state": "not imported", "why": said, "seconds": seconds}
    # povray draws the pixels outside a fisheye's circle black, like a black object. There both a
    # hit of ours and a pixel for which we have no ray are right.
    same = sum(a == b or (a > 0 and b == BLACK) for a, b in zip(ours, theirs)) / len(theirs)
    hit = sum(b > 0 for b in theirs) / len(theirs)
    state = "agrees" if same >= AGREE else "differs"
    return {"scene": scene, "state": state, "why": "", "same": same, "hit": hit, "seconds": seconds,
            "said": said}


def show(results, data):
    """Prints the table, the counts of the states and the reasons for failed imports."""
    print("| scene | state | hit by povray | same | s | |\n|---|---|---:|---:|---:|---|")
    for r in results:
        numbers = f"{r['hit']:.1%} | {r['same']:.2%}" if "same" in r else " | "
        print(f"| {r['scene'].relative_to(data)} | {r['state']} | {numbers} "
              f"| {r.get('seconds', 0):.2f} | {r['why']} |")
    counts = collections.Counter(r["state"] for r in results)
    judged = [r for r in results if r["state"] != "povray fails"]
    imported = [r for r in judged if r["state"] in ("agrees", "differs")]
    print("\n" + ", ".join(f"{n} {state}" for state, n in counts.most_common()))
    if judged:
        print(f"of {len(judged)} that povray renders: "
              f"{len(imported)} imported ({len(imported) / len(judged):.1%}), "
              f"{counts['agrees']} agree on {AGREE:.0%} of the pixels "
              f"({counts['agrees'] / len(judged):.1%})")
    reasons = collections.Counter(re.sub(r"^.*?:\d+:\d+: ", "", r["why"]) for r in results
                                  if r["state"] == "not imported")
    for reason, n in reasons.most_common():
        print(f"  {n} x {reason}")


def main():
    parser = argparse.ArgumentParser()
    add_choice(parser)
    parser.add_argument("--again", type=pathlib.Path,
                        help="the table of a former run: only what failed in it")
    parser.add_argument("--cache", type=pathlib.Path,
                        default=pathlib.Path("/tmp/overcast-pov-masks"))
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--limit", type=float, default=60, help="seconds for one scene")
    parser.add_argument("--reference-only", action="store_true")
    options = parser.parse_args()
    options.cache.mkdir(parents=True, exist_ok=True)
    data = options.data.resolve()
    scenes = chosen_scenes(options)
    if options.again:
        rows = [[cell.strip() for cell in line.split("|")[1:3]]
                for line in options.again.read_text().splitlines() if line.startswith("| pov")]
        failed = {data / scene for scene, state in rows if state in ("not imported", "differs")}
        scenes = [scene for scene in scenes if scene in failed]
    tool = options.build / "bin" / "pov_mask"
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(lambda s: compare(s, options, tool), scenes))
    show(results, data)
    return 0


if __name__ == "__main__":
    sys.exit(main())
