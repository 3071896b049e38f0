# SPDX-License-Identifier: Apache-2.0
"""Prints how large folders, files and functions are; fails where one is too large.
usage: shape.py ROOT

A folder has at most 30 files of code, the median file has at most 100 lines, and a function has at
most 60.
"""
import pathlib
import re
import statistics
import sys

import tree

MAX_FILES = 30
MAX_MEDIAN_LINES = 100
MAX_FUNCTION_LINES = 60
CODE = (".cpp", ".h", ".hpp", ".c", ".glsl")
# clang-format ends a function's head with a brace, and indents the line that closes the body like
# the one that opens it.
HEAD = re.compile(r"^( *)[^\s#/}].*\)( const| noexcept| override| mutable)*( -> [\w:<>&* ]+)? \{$")


def functions(lines):
    """Yields (length, first line) of everything that looks like a function's body."""
    for first, line in enumerate(lines):
        head = HEAD.match(line)
        if not head or re.match(r"\s*(if|for|while|switch|else)\b", line):
            continue
        # A head of several lines is indented further than the line that closes it.
        end = re.compile(rf" {{0,{len(head.group(1))}}}}}")
        last = next((i for i in range(first + 1, len(lines)) if end.match(lines[i])), first)
        yield last - first + 1, first + 1


def main():
    root = pathlib.Path(sys.argv[1])
    files = list(tree.files(root, CODE))
    folders, lengths, longest = {}, [], []
    for name, path in files:
        folders.setdefault(name.rpartition("/")[0], []).append(name)
        lines = path.read_text().splitlines()
        lengths.append(len(lines))
        longest += [(length, f"{name}:{first}") for length, first in functions(lines)]
    median = statistics.median(lengths) if lengths else 0
    print(f"{len(files)} files in {len(folders)} folders; the median file has {median:.0f} lines")
    large = {folder: len(names) for folder, names in folders.items() if len(names) > MAX_FILES}
    for folder, count in sorted(large.items()):
        print(f"{folder} has {count} files, {MAX_FILES} at most: part it")
    long = sorted((found for found in longest if found[0] > MAX_FUNCTION_LINES), reverse=True)
    for length, place in long:
        print(f"{place}: a function of {length} lines, {MAX_FUNCTION_LINES} at most")
    if median > MAX_MEDIAN_LINES:
        print(f"the median file has more than {MAX_MEDIAN_LINES} lines")
    return 1 if large or long or not files or median > MAX_MEDIAN_LINES else 0


if __name__ == "__main__":
    sys.exit(main())
