#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Asks povray for its noise and prints the numbers of core/texture/noise/noise_values.h.
usage: ask_noise.py [--check HEADER]

Between two points of a lattice of unit cells, noise is S(1 - t) (a + g t) + S(t) (b + h (t - 1))
along an axis, with S(t) = 3 t^2 - 2 t^3, a value a or b and a slope g or h at each of the two
points. So the values at both points and at two places in between give both slopes. Each point has
one of 256 classes. The class of a point is the shuffled number of a shuffled number of a shuffled
number of its coordinates: see lattice_number() in core/texture/noise/noise.cpp. All of this was
found by asking; vturbulence() of one octave prints three such noises.

With --check the program fails where a number of the header differs. Without povray it exits with
77.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77  # the exit code that CTest counts as skipped
PERIOD, SHIFT = 4096, 10000
SCENE = """#version 3.7; global_settings { assumed_gamma 1 }
#macro Ask(P) #local V = vturbulence(2, 0.5, 1, P); str(V.z, 0, 12) #end
#macro Put(P) #write (F, Ask(P), " ") #end
#fopen F "values.txt" write
#for (I, 0, 4095)
  Put(<0, 0, I>)
  Put(<1/3, 0, I>) Put(<2/3, 0, I>) Put(<1, 0, I>)
  Put(<0, 1/3, I>) Put(<0, 2/3, I>) Put(<0, 1, I>)
  Put(<0, 0, I + 1/3>) Put(<0, 0, I + 2/3>) Put(<0, 0, I + 1>)
  #write (F, "\\n")
#end
#fclose F
"""


def shuffled():
    """Returns the numbers below PERIOD, shuffled by the random numbers of rand()."""
    numbers, state = list(range(PERIOD)), 0
    for i in reversed(range(PERIOD)):
        state = (state * 1812433253 + 12345) % 2**32
        j = (state >> 16) % PERIOD
        numbers[i], numbers[j] = numbers[j], numbers[i]
    return numbers


def asked():
    """Returns a line of ten values for each of the points (0, 0, i)."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "ask.pov").write_text(SCENE)
        subprocess.run(["povray", "+Iask.pov", "-D", "-F", "+W1", "+H1"], cwd=folder, check=True,
                       capture_output=True)
        text = pathlib.Path(folder, "values.txt").read_text()
    return [[float(x) for x in line.split()] for line in text.splitlines()]


def slope(a, third, two_thirds, b):
    """Returns the slope at the first of two points, from four values along an axis."""
    def step(t):
        return t * t * (3 - 2 * t)
    rows = []
    for t, value in ((1 / 3, third), (2 / 3, two_thirds)):
        rows.append((step(1 - t) * t, step(t) * (t - 1), value - step(1 - t) * a - step(t) * b))
    (p, q, u), (r, s, v) = rows
    return (u * s - v * q) / (p * s - q * r)


def noise_values():
    """Returns the numbers from the ninth on: the third noise of vturbulence() begins there."""
    numbers, found = shuffled(), {}
    for i, line in enumerate(asked()):
        first = numbers[numbers[numbers[SHIFT % PERIOD] ^ SHIFT % PERIOD]
                        ^ (i + SHIFT) % PERIOD] % 256 + 8
        found[first] = 2 * line[0]
        for axis in range(3):
            found[first + 1 + axis] = slope(line[0], *line[1 + 3 * axis:4 + 3 * axis])
    return {i: float(f"{value:.6g}") for i, value in sorted(found.items())}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--check", type=pathlib.Path, metavar="HEADER")
    options = parser.parse_args()
    if not shutil.which("povray"):
        print("povray is not installed")
        return SKIPPED
    found = noise_values()
    if not options.check:
        print(", ".join(f"{value:g}" for value in found.values()))
        return 0
    body = options.check.read_text().split("{", 1)[1].split("{")[-1].split("}")[0]
    kept = [float(x) for x in re.findall(r"-?\d[\d.e-]*", body)]
    wrong = [i for i, value in found.items() if abs(kept[i] - value) > 1e-9]
    print(f"{len(found)} numbers asked, {len(wrong)} differ")
    return 1 if wrong or len(kept) != max(found) + 1 else 0


if __name__ == "__main__":
    sys.exit(main())
