# SPDX-License-Identifier: Apache-2.0
"""Fails where the documents and the table of their claims disagree. usage: claims.py ROOT

tests/claims.json has a row for each figure and each promise of README.md,
docs/guide/performance.md and docs/benchmarks.md: words of a line there, words that follow in the
same line, and what holds or measures it: a test or a command. Neither changes without the other.
"""
import json
import pathlib
import re
import sys

import tree

DOCUMENTS = ("README.md", "docs/guide/performance.md", "docs/benchmarks.md")


def sections_of(document):
    """Rows of tables and paragraphs, each as one line, by the heading of their section."""
    sections, heading, in_paragraph = {"": []}, "", False
    for line in document.read_text().splitlines():
        begins = not line or line.startswith(("|", "#", "* ", "- "))
        if line.startswith("## "):
            heading = line[3:]
            sections.setdefault(heading, [])
        elif in_paragraph and not begins:
            sections[heading][-1] += " " + line.strip()
        else:
            sections[heading].append(line)
        in_paragraph = bool(line) and not line.startswith(("|", "#"))
    return sections


def plain(line):
    return re.sub(r"[*`]", "", line.replace("|", " "))


def says(line, claim):
    """Whether both are there as whole words, so that 0.5 is not found in 0.55."""
    def words(text):
        return rf"(?<![\w.]){re.escape(text)}(?!\w|\.\d)"
    return re.search(words(claim["what"]) + ".*?" + words(claim["says"]), plain(line))


def first_cells(lines):
    cells, in_body = [], False
    for line in lines:
        if line.startswith("|--"):
            in_body = True
        elif not line.startswith("|"):
            in_body = False
        elif in_body:
            cells.append(plain(line.split("|")[1]).strip())
    return cells


def problems(root):
    claims = json.loads((root / "tests/claims.json").read_text())
    documents = {name: sections_of(root / name) for name in DOCUMENTS}
    for claim in claims:
        lines = documents[claim["document"]].get(claim["heading"])
        if lines is None or not any(says(line, claim) for line in lines):
            yield (f"{claim['document']}, '{claim['heading']}', does not say: {claim['what']} … "
                   f"{claim['says']}")
    claimed = {claim["what"] for claim in claims}
    for cell in first_cells(documents["docs/benchmarks.md"]["The bars"]):
        if cell not in claimed:
            yield f"docs/benchmarks.md, The bars: '{cell}' is not in tests/claims.json"
    for heading in ("Measured", "What it promises"):
        for line in documents["docs/guide/performance.md"][heading]:
            is_row = line.startswith("| ") and not line.startswith("| what")
            if (is_row or line.startswith("- ")) and not any(says(line, c) for c in claims):
                yield f"docs/guide/performance.md, {heading}: not in tests/claims.json: {line}"
    headings = {claim["heading"] for claim in claims} | {"", "Contenders, columns, keys"}
    for heading in documents["docs/benchmarks.md"]:
        if heading not in headings:
            yield f"docs/benchmarks.md: no claim of '{heading}' is in tests/claims.json"
    tests = {f"{suite}.{name}" for _, path in tree.files(root, (".cpp",)) for suite, name in
             re.findall(r"^TEST\w*\((\w+), (\w+)\)", path.read_text(), re.MULTILINE)}
    for claim in claims:
        if claim["by"].startswith("ctest -R ") and not any(
                test.startswith(claim["by"].removeprefix("ctest -R ")) for test in tests):
            yield f"{claim['what']}: no test begins with that of '{claim['by']}'"


def main():
    found = list(problems(pathlib.Path(sys.argv[1])))
    print("\n".join(found) or "all claims stand in the documents")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
