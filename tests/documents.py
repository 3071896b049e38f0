# SPDX-License-Identifier: Apache-2.0
"""Fails where a document points to what is not there: files, decisions by another number, programs that demo.sh does not build.

usage: documents.py ROOT
"""
import pathlib
import re
import subprocess
import sys


def documents(root):
    listed = subprocess.run(["git", "-C", root, "ls-files", "*.md"], capture_output=True, text=True).stdout.split()
    return [root / name for name in listed] or [*root.glob("*.md"), *root.glob("docs/**/*.md"), *root.glob("plugin/**/*.md")]


def wrong_links(document):
    for words, target in re.findall(r"\[([^\]]*)\]\(([^)#\s]+)[^)]*\)", document.read_text()):
        if re.match(r"\w+:", target):
            continue
        if not (document.parent / target).exists():
            yield f"{document}: there is no {target}"
        decision, number = re.search(r"(\d{4})-[\w-]*\.md$", target), re.fullmatch(r"decision (\d+)", words, re.IGNORECASE)
        if decision and number and int(decision.group(1)) != int(number.group(1)):
            yield f"{document}: {words} leads to {target}"


def wrong_programs(root):
    built = re.search(r"^cmake --build build(?: --target (.*))?$", (root / "demo.sh").read_text(), re.MULTILINE)
    targets = built.group(1)
    shown = set(re.findall(r"^build/bin/([\w-]+)", (root / "README.md").read_text(), re.MULTILINE))
    for program in sorted(shown - {"povray-overcast"}):  # which README builds by a line of its own
        if targets is not None and program not in targets.split():
            yield f"README.md shows {program}, which demo.sh does not build"


def main():
    root = pathlib.Path(sys.argv[1])
    wrong = [line for document in documents(root) for line in wrong_links(document)] + list(wrong_programs(root))
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
