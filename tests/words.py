# SPDX-License-Identifier: Apache-2.0
"""Fails where a word that was replaced comes back. usage: words.py ROOT

Each idea has one word, which docs/reference/glossary.md defines. CHANGELOG.md and docs/decisions
are history and keep the words of their day.
"""
import pathlib
import re
import sys

import tree

OLD = {
    r"\bk([A-Z]\w*)?(Most|Least|Fewest)([A-Z]\w*|\b)": "kMax, kMin",
    r"\barbiter\w*": "exact fallback",
    r"\b(settling|Settling|settled in double)\b": "resolve",
    r"\b[Rr]ivals?(_\w+|\b)": "candidate",
    r"\b[Tt]ravellers?\b": "ray state",
    r"\bFlights?\b": "ray state",
    r"\b(link tree|linked pages|link key)\b": "top-level tree, resume key",
    r"\b[Tt]wins?\b": "duplicate triangles",
    r"\bOVC_TURNS\b": "ray refill",
    r"\bPlacement\b(?! of)": "transform",
}
# The field of ovc_statistics and its key in JSON are part of the ABI, so they keep the old word.
PROMISED = re.compile(r'\.twins\b|"twins"|`twins`|uint64_t twins;|statistics\.twins')
TEXT = (".cpp", ".h", ".hpp", ".c", ".glsl", ".md", ".py", ".txt", ".cmake", ".sh")
SKIPPED = ("CHANGELOG.md", "docs/decisions/", "docs/reference/glossary.md", "tests/words.py")


def main():
    root = pathlib.Path(sys.argv[1])
    read = found = 0
    for name, path in tree.files(root, TEXT):
        if name.startswith(SKIPPED):
            continue
        read += 1
        for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
            for pattern, instead in OLD.items():
                match = re.search(pattern, line)
                if match and not PROMISED.search(line):
                    print(f"{name}:{number}: '{match.group()}'; we say: {instead}")
                    found += 1
    print(f"{read} files, {found} old words")
    return 1 if found or not read else 0


if __name__ == "__main__":
    sys.exit(main())
