# SPDX-License-Identifier: Apache-2.0
"""Fails where a document and the repository disagree. usage: documents.py ROOT

A document may link to files and headings, name files in `code`, and show programs: all of them
must exist, a link that says "decision 7" must lead to decision 7, and demo.sh must build the
programs. Every page must be on a list of pages, and docs/reference/abi.md must name every call of
the ABI.
"""
import pathlib
import re
import sys

import tree


def prose(document):
    """Returns the document without its code, where brackets and number signs mean other things."""
    text = re.sub(r"^( *)```.*?^\1```$", "", document.read_text(), flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"`[^`\n]*`", lambda code: "" if "](" in code.group() else code.group(), text)


def anchors(document):
    """Yields the anchors of the headings that GitHub and mkdocs name alike; links may use only
    these."""
    for heading in re.findall(r"^#+ +(.*)$", prose(document), re.MULTILINE):
        words = re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
        name = re.sub(r"[^\w -]", "", words).replace(" ", "-")
        if name.isascii() and "--" not in name:
            yield name


def wrong_links(document):
    for words, target, anchor in re.findall(r"\[([^\]]*)\]\(([^)#\s]*)(?:#([^)\s]*))?\)",
                                            prose(document)):
        if re.match(r"\w+:", target):
            continue
        leads_to = document.parent / target if target else document
        if not leads_to.exists():
            yield f"{document}: there is no {target}"
        elif anchor and anchor not in anchors(leads_to):
            yield f"{document}: {target} has no heading #{anchor}"
        decision, number = re.search(r"(\d{4})-[\w-]*\.md$",
                                     target), re.fullmatch(r"decision\s+(\d+)", words,
                                                           re.IGNORECASE)
        if decision and number and int(decision.group(1)) != int(number.group(1)):
            yield f"{document}: {' '.join(words.split())} leads to {target}"


def wrong_paths(root, document):
    """Yields a line for each file or folder that the text names and that does not exist.

    Decisions and the changelog are left out: they may name files of their day.
    """
    if document.parent.name == "decisions" or document.name == "CHANGELOG.md":
        return
    for folder, rest in re.findall(r"`([\w-]+)/([\w./-]+)`", prose(document)):
        is_source = folder in ("cmake", "docs") or (root / folder / "CMakeLists.txt").exists()
        if is_source and not (root / folder / rest).exists():
            yield f"{document}: there is no {folder}/{rest}"


def wrong_programs(root):
    built = re.search(r"^cmake --build build(?: --target (.*))?$", (root / "demo.sh").read_text(),
                      re.MULTILINE)
    targets = built.group(1)
    shown = set(re.findall(r"^build/bin/([\w-]+)", (root / "README.md").read_text(), re.MULTILINE))
    for program in sorted(shown):
        if targets is not None and program not in targets.split():
            yield f"README.md shows {program}, which demo.sh does not build"


def left_out_calls(root):
    """Yields a line for each function of the ABI's table that its reference does not name."""
    table = re.search(r"typedef struct ovc_api \{.*?^\} ovc_api;",
                      (root / "plugin/overcast.h").read_text(), re.MULTILINE | re.DOTALL).group()
    reference = (root / "docs/reference/abi.md").read_text()
    for call in re.findall(r"\(\*(\w+)\)\(", table):
        if f"`{call}`" not in reference:
            yield f"docs/reference/abi.md lacks {call}"


def left_out_pages(root):
    """Yields a line for each decision that the list of decisions lacks, and each other page that
    mkdocs.yml lacks."""
    site = (root / "mkdocs.yml").read_text()
    decisions = (root / "docs/decisions/README.md").read_text()
    for page in sorted((root / "docs").glob("**/*.md")):
        if re.match(r"\d{4}-", page.name):
            if f"({page.name})" not in decisions:
                yield f"docs/decisions/README.md lacks {page.name}"
        elif not re.search(rf": {re.escape(str(page.relative_to(root / 'docs')))}$", site,
                           re.MULTILINE):
            yield f"mkdocs.yml lacks {page.relative_to(root)}"


def main():
    root = pathlib.Path(sys.argv[1])
    documents = [path for _, path in tree.files(root, ".md")]
    wrong = [line for document in documents for line in wrong_links(document)]
    wrong += [line for document in documents for line in wrong_paths(root, document)]
    wrong += [*wrong_programs(root), *left_out_calls(root), *left_out_pages(root)]
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
