# SPDX-License-Identifier: Apache-2.0
"""Lists the repository's files for the scripts beside this one, which check how they look."""
import subprocess

# Names of built, rendered and downloaded files begin with these; git ignores them too.
MADE = ("build", "out/", "data/")


def files(root, endings):
    """Yields (name relative to root, path) of each file that git tracks and whose name ends so.

    Without git (the sources unpacked from an archive) these are all files but those of hidden
    folders and of MADE. Files that git tracks and that were deleted since are left out.
    """
    listed = subprocess.run(["git", "-C", root, "ls-files", "-z"], capture_output=True, text=True)
    names = listed.stdout.split("\0") if listed.returncode == 0 else []
    for name in names or sorted(path.relative_to(root).as_posix() for path in root.rglob("*")):
        is_ours = bool(names) or not name.startswith((".", *MADE))
        if is_ours and name.endswith(endings) and (root / name).is_file():
            yield name, root / name
