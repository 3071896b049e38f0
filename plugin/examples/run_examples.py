# SPDX-License-Identifier: Apache-2.0
"""Fails unless docs/guide/tutorial.md shows the examples as they are and what they print, and
hills.c has at most 80 lines.

usage: run_examples.py ROOT HILLS SUNLIT LIBRARY
"""
import pathlib
import subprocess
import sys


def main():
    root, hills, sunlit, library = sys.argv[1:]
    manual = (pathlib.Path(root) / "docs/guide/tutorial.md").read_text()
    examples = pathlib.Path(root) / "plugin/examples"
    wrong = []
    for name in ["hills.c", "sunlit.cpp"]:
        if (examples / name).read_text() not in manual:
            wrong.append(f"docs/guide/tutorial.md does not show {name} as it is")
    if len((examples / "hills.c").read_text().splitlines()) > 80:
        wrong.append("hills.c has more than 80 lines")
    for command in ([hills, library], [sunlit]):
        run = subprocess.run(command, capture_output=True, text=True, timeout=300)
        if "no device" in run.stderr or "EGL" in run.stderr:
            print(run.stderr)
            return 77
        print(run.stdout, run.stderr, sep="")
        shown = "\n".join(line.rstrip() for line in run.stdout.splitlines() if line.strip())
        if run.returncode != 0 or not shown or shown not in manual:
            name = pathlib.Path(command[0]).name
            wrong.append(f"{name}: exit {run.returncode}, "
                         "and docs/guide/tutorial.md does not show what it printed")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
