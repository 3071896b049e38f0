# SPDX-License-Identifier: Apache-2.0
"""Holds the choice of kernel variants to its promises, on a machine that is busy.

usage: ten_starts.py BUILD [--starts N]

`overcast devices --tune` measures all variants so many times, each as if it were the first but for
compiled kernels, while two other processes take all the time they get. What a variant takes is the
median of all tables; those that fewer than half of the starts have measured are not in it. Fails
where a start has chosen a variant that takes 3 % longer than the best of its kind, or where a
rendering that nobody asked to measure spends more than 0.3 s on it.
"""
import argparse
import contextlib
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

TRIED = re.compile(r"kernel variant tried for (.*): (\S+): ([\d.]+) times")
CHOSEN = re.compile(r"kernel variant for (.*?): (\S+?)(, the default)?$", re.MULTILINE)


# It ends with the process that began it, however that ends.
SPIN = "import os\nparent = os.getppid()\nwhile os.getppid() == parent: pass"


@contextlib.contextmanager
def busy(count):
    spinners = [subprocess.Popen([sys.executable, "-c", SPIN]) for _ in range(count)]
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


def seconds_spent(cache):
    return sum(int(re.search(r"microseconds (\d+)", path.read_text())[1])
               for path in cache.glob("*.variants")) / 1e6


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--starts", type=int, default=10)
    asked = parser.parse_args()
    overcast = asked.build / "bin/overcast"
    tables, choices, failed = {}, [], 0
    with tempfile.TemporaryDirectory() as name, busy(2):
        folder = pathlib.Path(name)
        kernels = folder / "tune"
        for start in range(asked.starts):
            for record in kernels.glob("*.variants"):
                record.unlink()
            told = run(overcast, kernels, "devices", "--tune")
            print(f"start {start} has measured", flush=True)
            for kind, variant, ratio in TRIED.findall(told):
                tables.setdefault(kind, {}).setdefault(variant, []).append(float(ratio))
            choices += [(start, kind, variant, bool(default))
                        for kind, variant, default in CHOSEN.findall(told)]
        run(overcast, folder / "render", "render", "knot", "--size", "1024x1024", "-o",
            folder / "picture.png")
        spent = seconds_spent(folder / "render")
        failed += spent > 0.3
        print(f"a rendering spends {spent:.3f} s")
    medians = {kind: {variant: statistics.median(ratios) for variant, ratios in table.items()
                      if len(ratios) >= asked.starts / 2}
               for kind, table in tables.items()}
    for kind, table in medians.items():
        for variant, ratio in sorted(table.items(), key=lambda item: item[1]):
            print(f"{kind}: {variant}, {ratio:.3f} of the default's time")
    for start, kind, variant, default in choices:
        best = min(1.0, *medians[kind].values())
        ratio = (1.0 if default else statistics.median(tables[kind][variant])) / best
        failed += ratio > 1.03
        print(f"start {start}, {kind}: {variant}, {ratio:.3f} of the best's time")
    print(f"{failed} failures")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
