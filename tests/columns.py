# SPDX-License-Identifier: Apache-2.0
"""Fails where a line has more than 100 columns. usage: columns.py ROOT

It checks all lines of CMake, Python, shell and YAML, lines of C, C++ and GLSL that have a comment,
because clang-format wraps the code, and the prose of Markdown. Tables, code blocks, HTML, headings
and links alone on their line are not prose.
"""
import pathlib
import re
import sys

import tree

MAX_COLUMNS = 100
WHOLE = ("CMakeLists.txt", ".cmake", ".py", ".py.in", ".sh", ".ci/run", ".yml")
COMMENTED = (".cpp", ".h", ".hpp", ".c", ".glsl")
EXCEPTIONS = {
    "plugin/overcast.h": "laid out by hand: the comments stand beside the fields, in columns",
    "shaders/layout.h": "laid out by hand: the comments stand beside the fields, in columns",
}
# A string or character is matched first, because it may hold what looks like a comment.
TOKEN = re.compile(r'R"(?P<end>[^()\\\s]*)\(.*?\)(?P=end)"|"(?:\\.|[^"\\\n])*"'
                   r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'|(?P<comment>//[^\n]*|/\*.*?\*/)",
                   re.DOTALL)
FENCE = re.compile(r"\s*(```+|~~~+)")
# Matches a table's row, HTML, a heading, a link that is a line by itself and a link's address.
NOT_PROSE = re.compile(r"\s*(\||<|#+ |[*-]?\s*!?\[[^\]]*\]\([^)]*\)[.,;:]?$|\[[^\]]*\]:)")


def commented_lines(text):
    """Returns the numbers, from 0, of the lines that a comment is on."""
    numbers = set()
    for token in TOKEN.finditer(text):
        if token["comment"]:
            first = text.count("\n", 0, token.start())
            numbers.update(range(first, first + token["comment"].count("\n") + 1))
    return numbers


def prose_lines(text):
    """Returns the numbers, from 0, of the lines of a Markdown page that hold prose."""
    numbers, fence = set(), None
    for number, line in enumerate(text.splitlines()):
        mark = FENCE.match(line)
        if mark and fence is None:
            fence = mark[1]
        elif mark and mark[1].startswith(fence):
            fence = None
        elif fence is None and not NOT_PROSE.match(line):
            numbers.add(number)
    return numbers


def long_lines(name, path):
    lines = path.read_text(errors="replace").split("\n")
    long = [number for number, line in enumerate(lines) if len(line) > MAX_COLUMNS]
    if long and not name.endswith(WHOLE):
        counted = prose_lines if name.endswith(".md") else commented_lines
        long = sorted(counted("\n".join(lines)).intersection(long))
    return [f"{name}:{number + 1}: {len(lines[number])} columns, {MAX_COLUMNS} at most"
            for number in long]


def main():
    root = pathlib.Path(sys.argv[1])
    files = list(tree.files(root, (*WHOLE, *COMMENTED, ".md")))
    wrong = [line for name, path in files if name not in EXCEPTIONS
             for line in long_lines(name, path)]
    print(f"{len(files)} files, {len(wrong)} lines that are too long")
    print("\n".join(wrong))
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main())
