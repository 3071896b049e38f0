# SPDX-License-Identifier: Apache-2.0
"""Fails unless every diff that docs/design shows applies to the sources as they are, and touches
three files at most.

usage: document_diffs.py ROOT
"""
import pathlib
import re
import subprocess
import sys


def wrong_diffs(root, page):
    for diff in re.findall(r"^```diff\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL):
        files = re.findall(r"^\+\+\+ b/(.*)$", diff, re.MULTILINE)
        if not 1 <= len(files) <= 3:
            yield f"{page}: a diff of {len(files)} files"
        run = subprocess.run(["git", "apply", "--check", "-"], cwd=root, input=diff,
                             capture_output=True, text=True)
        if run.returncode != 0:
            yield f"{page}: the diff of {', '.join(files)} does not apply:\n{run.stderr}"


def main():
    root = pathlib.Path(sys.argv[1])
    wrong = [line for page in sorted((root / "docs/design").glob("*.md"))
             for line in wrong_diffs(root, page)]
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
