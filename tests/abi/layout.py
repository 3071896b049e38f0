# SPDX-License-Identifier: Apache-2.0
"""Fails unless a C compiler puts every field of the C ABI where a released header had it.

usage: layout.py ROOT [--write]     --write: appends the fields added since, for a release

layout.txt has a line for each field (struct.field, offset, size) and each enumerator (name, value).
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

COMPILER = os.environ.get("CC", "cc")


def names(header):
    """Yields the fields of all structs and the enumerators of all enums."""
    text = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)
    for body, struct in re.findall(r"typedef struct \w+ \{(.*?)\} (\w+);", text, re.DOTALL):
        for line in body.split(";"):
            field = re.search(r"\(\*(\w+)\)\(", line) or re.search(r"(\w+)(?:\[\w+\])*\s*$", line)
            if field:
                yield f"{struct}.{field[1]}"
    for body in re.findall(r"typedef enum \w+ \{(.*?)\}", text, re.DOTALL):
        yield from re.findall(r"^\s*(OVC_\w+)", body, re.MULTILINE)


def run_c(root, statements):
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder, "layout.c")
        source.write_text('#include "plugin/overcast.h"\n#include <stddef.h>\n#include <stdio.h>\n'
                          "int main(void) {\n" + "\n".join(statements) + "\nreturn 0;\n}\n")
        program = f"{folder}/layout"
        subprocess.run([COMPILER, "-std=c99", "-I", root, source, "-o", program], check=True)
        return subprocess.check_output([program], text=True).splitlines()


def statement(name):
    if "." not in name:
        return f'printf("{name} %lld\\n", (long long){name});'
    struct, field = name.split(".")
    return (f'printf("{name} %zu %zu\\n", offsetof({struct}, {field}), '
            f"sizeof((({struct}*)0)->{field}));")


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    file = root / "tests/abi/layout.txt"
    released = file.read_text().splitlines() if file.exists() else []
    header = (root / "plugin/overcast.h").read_text()
    told = run_c(root, [statement(name) for name in names(header)])
    now = {line.split()[0]: line for line in told}
    moved = [line for line in released if line not in told]
    for line in moved:
        print(f"a released header has {line}; plugin/overcast.h has "
              f"{now.get(line.split()[0], 'nothing of this name')}")
    if sys.argv[2:] == ["--write"] and not moved:
        added = [line for line in told if line not in released]
        file.write_text("\n".join(released + added) + "\n")
    return 1 if moved or not released else 0


if __name__ == "__main__":
    sys.exit(main())
