# SPDX-License-Identifier: Apache-2.0
"""Holds the choice of kernel variants to its promises, on a machine that is busy.

usage: ten_starts.py BUILD [--starts N]

`overcast devices --tune` measures all variants. Then so many renderings, each as if it were the
first on this device, choose for themselves while two other processes take all the time they get.
Fails where one chooses a variant that takes 3 % longer than the one that was measured to be best,
spends more than 0.3 s, or where a later rendering measures anything.
"""
import argparse
import contextlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SCENES = {"knot": ["--size", "1024x1024", "--samples", "4"],
          "far-terrain": ["--size", "1024x1024", "--samples", "2"]}
TRIED = re.compile(r"kernel variant tried for (.*): (\S+): ([\d.]+) times")
CHOSEN = re.compile(r"kernel variant for (.*?): ([^,]\S*?)(, the default)?$", re.MULTILINE)


@contextlib.contextmanager
def busy(count):
    spinners = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for spinner in spinners:
            spinner.kill()
            spinner.wait()


def run(overcast, cache, *arguments):
    environment = dict(os.environ, OVC_KERNEL_CACHE=str(cache))
    done = subprocess.run([overcast, *arguments], env=environment, text=True, check=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.stdout


def microseconds(cache):
    return sum(int(re.search(r"microseconds (\d+)", path.read_text())[1])
               for path in cache.glob("*.variants"))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--starts", type=int, default=10)
    asked = parser.parse_args()
    overcast = asked.build / "bin/overcast"
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        told = run(overcast, folder / "table", "devices", "--tune")
        table, best = {}, {}
        for kind, variant, ratio in TRIED.findall(told):
            table.setdefault(kind, {})[variant] = float(ratio)
        for kind, variant, _ in CHOSEN.findall(told):
            best[kind] = table[kind].get(variant, 1.0)
        with busy(2):
            for start in range(asked.starts):
                for scene, options in SCENES.items():
                    cache = folder / f"{scene}-{start}"
                    render = ["render", scene, *options, "-o", folder / "picture.png",
                              "--log-level", "info"]
                    told = run(overcast, cache, *render)
                    spent = microseconds(cache) / 1e6
                    for kind, variant, _ in CHOSEN.findall(told):
                        ratio = table.get(kind, {}).get(variant, 1.0) / best.get(kind, 1.0)
                        failed += ratio > 1.03
                        print(f"start {start}, {kind}: {variant}, {ratio:.3f} of the best's time")
                    failed += spent > 0.3
                    print(f"start {start}, {scene}: {spent:.3f} s of measuring")
                    if start == 0 and TRIED.search(run(overcast, cache, *render)):
                        failed += spent <= 0.3 and "kind" not in told
                        print(f"{scene}: a later start measures other kinds of rays")
    print(f"{failed} failures")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
