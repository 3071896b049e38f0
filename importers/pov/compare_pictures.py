#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares how POV-Ray scenes look: povray's picture beside ours, scene by scene.
docs/design/readers_compared.md says what we compare.

usage: compare_pictures.py -o DIR [--data DIR] [--index FILE] [--tiers AB] [--only TEXT]
                           [--cache DIR] [--build DIR] [--backend NAME] [--jobs N]
                           [--limit SECONDS] [--plain] [--at-most N] [SCENE ...]

Prints a table and writes DIR/index.html with the pairs, the worst first. Errors are root mean
squares over pixels and colors, in code values of 8 bits as both programs write them. The scenes are
those of the index (compare.py), or SCENE ... . Where the importer warns that it approximates
something or leaves it out, the scene is listed with the warning. The last lines count the scenes
without warnings, and all that both programs draw. With --at-most
the program fails where a scene is off by more, is not plain, or is drawn by only one of the two.
Without povray it exits with 77.
"""
import argparse
import collections
import concurrent.futures
import hashlib
import html
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys

from compare import ROOT, add_choice, chosen_scenes, run_povray
from png import read_png, write_png

WIDTH, HEIGHT = 320, 240
LOUDER = 8  # how much the difference is magnified on the page
SKIPPED = 77  # the exit code that CTest counts as skipped
EDGE = 4    # code values between neighbours
WARNING = re.compile(r"^overcast: warning: .*?:\d+:\d+: (.*)$", re.M)
# Warnings of things that do not change the picture.
HARMLESS = re.compile(r"the scene warns: |a scale by 0 is taken")


def povray_picture(scene, cache, limit):
    """Returns (the picture's file or None, why there is none)."""
    key = hashlib.sha1(str(scene).encode() + scene.read_bytes()).hexdigest()[:16]
    kept, failed = cache / f"{key}.png", cache / f"{key}.failed"
    if not kept.exists() and not failed.exists():
        drawn = cache / f"{key}.new.png"
        error = run_povray([f"+I{scene}", f"+O{drawn}", f"+W{WIDTH}", f"+H{HEIGHT}", "+FN8",
                            "File_Gamma=sRGB", "-A"], scene.parent, limit)
        if error:
            failed.write_text(error)
            drawn.unlink(missing_ok=True)
        else:
            drawn.rename(kept)
    return (kept, "") if kept.exists() else (None, failed.read_text())


def run_overcast(arguments, options):
    """Returns (the importer's warnings, why the command failed or "")."""
    command = [options.build / "bin" / "overcast", *arguments]
    try:
        done = subprocess.run(command, capture_output=True, timeout=options.limit,
                              preexec_fn=lambda: os.nice(15))
    except subprocess.TimeoutExpired:
        return [], f"more than {options.limit:g} s"
    said = done.stderr.decode("utf-8", "replace")
    # Indented lines quote the scene.
    lines = [line for line in said.splitlines() if not line.startswith("    ")]
    warnings = [w for w in WARNING.findall(said) if not HARMLESS.match(w)]
    if done.returncode == 0:
        return warnings, ""
    return warnings, lines[-1] if lines else f"exit {done.returncode}"


def off(ours, theirs):
    """Returns the root mean square of the differences of two lists of code values."""
    squares = [(a - b) ** 2 for a, b in zip(ours, theirs)]
    return (sum(squares) / max(1, len(squares))) ** 0.5


def away_from_edges(picture):
    """Returns the numbers of the pixels whose eight neighbours look about the same."""
    def spread(rows, at):
        values = [v for row in rows for v in row[max(0, at - 3):at + 4:3]]
        return max(values) - min(values)
    lines = [picture[3 * WIDTH * y:3 * WIDTH * (y + 1)] for y in range(HEIGHT)]
    return [y * WIDTH + x for y in range(HEIGHT) for x in range(WIDTH)
            if all(spread(lines[max(0, y - 1):y + 2], 3 * x + c) <= EDGE for c in range(3))]


def colors_at(picture, pixels):
    """Returns the code values of the pixels with these numbers."""
    return [picture[3 * i + c] for i in pixels for c in range(3)]


def compare(scene, options):
    """Returns a row of the table: the scene's path and state, why, and errors where both drew."""
    warnings, refused = run_overcast(["info", scene], options) if options.plain else ([], "")
    if warnings:
        return {"scene": scene, "state": "approximated", "why": "; ".join(warnings)}
    kept, error = povray_picture(scene, options.cache, options.limit)
    if not kept:
        return {"scene": scene, "state": "povray fails", "why": error}
    name = hashlib.sha1(str(scene).encode()).hexdigest()[:12]
    picture = options.output / f"{name}-ours.png"
    warnings, refused = run_overcast(["render", scene, "--size", f"{WIDTH}x{HEIGHT}", "-o", picture,
                                      "--quiet", "--backend", options.backend], options)
    if refused:
        return {"scene": scene, "state": "not imported", "why": refused}
    _, _, theirs = read_png(kept)
    _, _, ours = read_png(picture)
    (options.output / f"{name}-povray.png").write_bytes(kept.read_bytes())
    write_png(options.output / f"{name}-off.png", WIDTH, HEIGHT,
              bytes(min(255, LOUDER * abs(a - b)) for a, b in zip(ours, theirs)))
    inner = away_from_edges(theirs)
    return {"scene": scene, "state": "approximated" if warnings else "plain",
            "why": "; ".join(warnings), "name": name, "rmse": off(ours, theirs),
            "inner": off(colors_at(ours, inner), colors_at(theirs, inner)),
            "inner_share": len(inner) / WIDTH / HEIGHT}


def of_meshes(options):
    """Returns the scenes of the index that have triangles and no round shapes."""
    flat = set()
    for line in options.index.read_text().splitlines() if options.index.exists() else ():
        words = line.split()
        counts = {a: int(b) for a, b in zip(words[3:], words[4:]) if b.isdigit()}
        triangles = sum(counts.get(k, 0) for k in ("tri", "mesh2tri"))
        if triangles and not any(counts.get(k, 0) for k in ("sph", "cyl", "cone", "disc")):
            flat.add(words[2])
    return flat


def percentile(values, share):
    """Returns the value below which about the share, from 0 to 1, of the values lies."""
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def summary(results, meshes):
    """Yields the lines below the table."""
    plain = [r for r in results if r["state"] == "plain"]
    yield ", ".join(f"{n} {state}"
                    for state, n in collections.Counter(r["state"] for r in results).most_common())
    if plain:
        errors = [r["rmse"] for r in plain]
        yield (f"of {len(plain)} plain scenes: median {statistics.median(errors):.2f}, "
               f"90 % at most {percentile(errors, 0.9):.2f}, "
               f"worst {max(errors):.2f} of 255; {sum(e > 4 for e in errors)} above 4")
    drawn = [r["rmse"] for r in results if "rmse" in r]
    if drawn:
        yield (f"of {len(drawn)} scenes that both draw: median {statistics.median(drawn):.2f}, "
               f"90 % at most {percentile(drawn, 0.9):.2f}, worst {max(drawn):.2f} of 255")
    inner = [r["inner"] for r in plain if r["label"] in meshes]
    if inner:
        yield (f"of {len(inner)} of meshes only, away from edges: "
               f"median {statistics.median(inner):.2f}, worst {max(inner):.2f}; "
               f"{sum(e > 1 for e in inner)} above 1")


def show(results, meshes):
    """Prints the table and its summary."""
    print("| scene | off | away from edges | |\n|---|---:|---:|---|")
    for r in results:
        numbers = f"{r['rmse']:.2f} | {r['inner']:.2f}" if "rmse" in r else " | "
        why = r["state"] + (": " + r["why"] if r["why"] else "")
        print(f"| {r['label']} | {numbers} | {why}{' (meshes)' if r['label'] in meshes else ''} |")
    print("", *summary(results, meshes), sep="\n")


def write_page(results, meshes, file):
    """Writes the page with the pairs of pictures and their differences."""
    rows = []
    for r in results:
        said = html.escape(r["state"] + (": " + r["why"] if r["why"] else ""))
        rows.append(f"<h2>{html.escape(r['label'])}</h2><p>" +
                    (f"{r['rmse']:.2f} off; " if "rmse" in r else "") + f"{said}</p>")
        if "rmse" in r:
            rows.append("".join(f'<img src="{r["name"]}-{kind}.png" alt="{kind}" title="{kind}" '
                                f'width={WIDTH} height={HEIGHT}> '
                                for kind in ("povray", "ours", "off")))
    head = "".join(f"<p>{html.escape(line)}</p>" for line in summary(results, meshes))
    file.write_text('<!doctype html><meta charset="utf-8"><title>Beside POV-Ray</title>'
                    "<style>body{font:14px sans-serif;margin:2em}h2{font-size:14px}</style>"
                    f"<h1>Beside POV-Ray</h1>{head}"
                    f"<p>povray, ours, and {LOUDER} x the difference.</p>{''.join(rows)}\n")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scenes", nargs="*", type=pathlib.Path, metavar="SCENE")
    add_choice(parser)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--cache", type=pathlib.Path,
                        default=pathlib.Path("/tmp/overcast-pov-pictures"),
                        help="keeps povray's pictures")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--backend", default="auto")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--limit", type=float, default=120, help="seconds for one picture")
    parser.add_argument("--plain", action="store_true", help="ask povray only about plain scenes")
    parser.add_argument("--at-most", type=float,
                        help="code values: fail where a scene is off by more")
    options = parser.parse_args()
    if not shutil.which("povray"):
        print("povray is not installed")
        return SKIPPED
    options.cache.mkdir(parents=True, exist_ok=True)
    options.output.mkdir(parents=True, exist_ok=True)
    scenes = [s.resolve() for s in options.scenes] or chosen_scenes(options)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(lambda s: compare(s, options), scenes))
    order = {"plain": 0, "approximated": 1, "not imported": 2, "povray fails": 3}
    results.sort(key=lambda r: (order[r["state"]], -r.get("rmse", 0)))
    data = options.data.resolve()
    for r in results:
        r["label"] = str(r["scene"].relative_to(data) if r["scene"].is_relative_to(data)
                         else r["scene"].name)
    meshes = of_meshes(options)
    show(results, meshes)
    write_page(results, meshes, options.output / "index.html")
    bad = [r for r in results if r["state"] != "plain" or r["rmse"] > (options.at_most or 0)]
    return 1 if options.at_most is not None and bad else 0


if __name__ == "__main__":
    sys.exit(main())
