# SPDX-License-Identifier: Apache-2.0
"""Prints how large folders, files and functions are; fails where a folder or the median file is
too large. usage: shape.py ROOT

A folder has at most 30 files of code, and the median file has at most 100 lines. Long functions
are only printed: they are candidates for splitting, not errors.
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
        end = head.group(1) + "}"
        last = next((i for i in range(first + 1, len(lines)) if lines[i].startswith(end)), first)
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
    for length, place in sorted(longest, reverse=True):
        if length > MAX_FUNCTION_LINES:
            print(f"{place}: a function of {length} lines")
    if median > MAX_MEDIAN_LINES:
        print(f"the median file has more than {MAX_MEDIAN_LINES} lines")
    return 1 if large or not files or median > MAX_MEDIAN_LINES else 0


if __name__ == "__main__":
    sys.exit(main())
