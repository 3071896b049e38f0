# SPDX-License-Identifier: Apache-2.0
"""How long a host waits for its first answer. usage: first_answer.py BUILD [RUNS]

Prints the seconds from opening a device to the first hit of a small scene, in processes of their
own: with the kernels that earlier runs have kept, and with none. The median of RUNS, 5 by default.
"""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

PROGRAM = """
import time
import numpy
import overcast
overcast.prepare_process()
corners = numpy.random.default_rng(1).random((3000, 3))
begun = time.perf_counter()
scene = overcast.Scene(overcast.Device())
scene.add(corners, numpy.arange(3000).reshape(-1, 3))
scene.commit()
scene.intersect([0.5, 0.5, 5], [0, 0, -1])
print(time.perf_counter() - begun)
"""


def seconds(build, cache):
    environment = {**os.environ, "PYTHONPATH": str(build / "python"), "XDG_CACHE_HOME": cache}
    return float(subprocess.run([sys.executable, "-c", PROGRAM], env=environment, check=True,
                                capture_output=True, text=True).stdout)


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    runs = range(int(sys.argv[2]) if len(sys.argv) > 2 else 5)
    with tempfile.TemporaryDirectory() as kept:
        seconds(build, kept)
        warm = [seconds(build, kept) for _ in runs]
    cold = []
    for _ in runs:
        with tempfile.TemporaryDirectory() as empty:
            cold.append(seconds(build, empty))
    for name, times in (("kernels kept", warm), ("no kernels kept", cold)):
        print(f"{name}: {statistics.median(times):.3f} s ({min(times):.3f} to {max(times):.3f})")


if __name__ == "__main__":
    main()
