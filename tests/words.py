# SPDX-License-Identifier: Apache-2.0
"""Fails where a word that was replaced comes back. usage: words.py ROOT

One word an idea: docs/reference/glossary.md has those that we use. CHANGELOG.md and docs/decisions tell what was, in its words.
"""
import pathlib
import re
import subprocess
import sys

OLD = {
    r"\bk(Most|Least|Fewest)[A-Z]\w*": "kMax, kMin",
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
# The field of ovc_statistics and its key in JSON are promised.
PROMISED = re.compile(r'\.twins\b|"twins"|`twins`|uint64_t twins;|statistics\.twins')
TEXT = (".cpp", ".h", ".hpp", ".c", ".glsl", ".md", ".py", ".txt", ".cmake", ".sh")
SKIPPED = ("CHANGELOG.md", "docs/decisions/", "docs/reference/glossary.md", "tests/words.py")


def main():
    root = pathlib.Path(sys.argv[1])
    listed = subprocess.run(["git", "-C", root, "ls-files"], capture_output=True, text=True).stdout.split()
    names = listed or [p.relative_to(root).as_posix() for p in root.rglob("*") if p.is_file()]
    read = found = 0
    for name in names:
        path = root / name
        if not name.endswith(TEXT) or name.startswith(SKIPPED) or not path.is_file():
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
