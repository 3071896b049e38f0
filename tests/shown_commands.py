# SPDX-License-Identifier: Apache-2.0
"""Runs every command that README.md and docs/guide/start.md show, as it stands there, and looks in
the command's --help for every option that docs/reference/command.md names.

The gate has installed the packages and compiled already, so here apt-get does nothing, and
`cmake --build` only links to the finished build.

usage: shown_commands.py ROOT BUILD
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

CMAKE = """#!/bin/sh
case "$*" in
"--preset "*)
    '{cmake}' --list-presets | grep -qF "\\"$2\\"" || {{ echo "there is no preset $2"; exit 1; }} ;;
"--build build") ln -sfn '{build}' build ;;
*) echo "no test knows: cmake $*"; exit 1 ;;
esac
"""


def shell_lines(document):
    """Returns the lines of the blocks that are marked as sh."""
    blocks = re.findall(r"^```sh\n(.*?)^```", document.read_text(), re.MULTILINE | re.DOTALL)
    return [line for block in blocks for line in block.splitlines() if line.strip()]


def program(path, text):
    path.write_text(text)
    path.chmod(0o755)


def wrong_runs(root, build):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        tree, stand_ins = folder / "overcast", folder / "stand-ins"
        tree.mkdir()
        stand_ins.mkdir()
        for entry in root.iterdir():
            if not entry.name.startswith((".git", "build", "out")):
                (tree / entry.name).symlink_to(entry)
        program(stand_ins / "cmake", CMAKE.format(cmake=shutil.which("cmake"), build=build))
        program(stand_ins / "apt-get", "#!/bin/sh\nexit 0\n")
        program(stand_ins / "sudo", '#!/bin/sh\nexec "$@"\n')
        environment = {**os.environ, "PATH": f"{stand_ins}:{os.environ['PATH']}"}
        for name in ["README.md", "docs/guide/start.md"]:
            lines = shell_lines(root / name)
            if not lines:
                yield f"{name} shows no command"
            for line in lines:
                run = subprocess.run(["bash", "-c", line], cwd=tree, env=environment,
                                     capture_output=True, text=True)
                if run.returncode != 0:
                    yield f"{name}: {line}\n  exit code {run.returncode}: {run.stdout}{run.stderr}"


def wrong_options(root, build):
    page = (root / "docs/reference/command.md").read_text()
    overcast = build / "bin/overcast"
    said = subprocess.run([overcast, "--help"], capture_output=True, text=True).stdout
    commands = re.findall(r"^  (\w+) ", said.split("Commands:\n")[1].split("\n\n")[0], re.MULTILINE)
    sections = dict(re.findall(r"^## ([\w ]+)\n(.*?)(?=^## |\Z)", page, re.MULTILINE | re.DOTALL))
    named = {name: text for heading, text in sections.items() for name in heading.split(" and ")}
    for command in commands:
        if command not in named:
            yield f"docs/reference/command.md has no section {command}"
    for command, text in named.items():
        said = subprocess.run([overcast, command, "--help"], capture_output=True, text=True).stdout
        for option in sorted(set(re.findall(r"(?<![\w-])--[a-z][\w-]*", text))):
            if not re.search(re.escape(option) + r"(?![\w-])", said):
                yield f"docs/reference/command.md, {command}: there is no {option}"


def main():
    root, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    wrong = [*wrong_options(root, build), *wrong_runs(root, build)]
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
