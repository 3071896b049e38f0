# SPDX-License-Identifier: Apache-2.0
"""Fails where two files define types of the same name in the same namespace.
usage: one_definition.py ROOT

Sooner or later such types meet in one program. The linker then silently takes the inline functions
of one for both, and the program frees memory that it never allocated.
"""
import collections
import pathlib
import re
import sys

import tree

# parallel.h defines it for oneTBB and parallel_threads.h without oneTBB; a program has only one of
# the two.
EITHER_OR = {"ovc::Fork"}
OPEN = re.compile(r"(?:inline )?namespace ?([\w:]*) ?\{\s*$")
CLOSE = re.compile(r"\} +// namespace")
TYPE = re.compile(r"(?:struct|class|union)(?: \[\[\w+\]\])? (\w+)(?: final)?(?: : [^;]*)?(?: \{|$)")


def definitions(path):
    namespaces = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if opened := OPEN.match(line):
            namespaces.append(opened.group(1) or "<unnamed>")
        elif CLOSE.match(line) and namespaces:
            namespaces.pop()
        elif (found := TYPE.match(line)) and "<unnamed>" not in namespaces:
            yield "::".join([*namespaces, found.group(1)]), number


def main():
    root = pathlib.Path(sys.argv[1])
    places = collections.defaultdict(list)
    for name, path in tree.files(root, (".cpp", ".h", ".hpp")):
        for type_name, number in definitions(path):
            places[type_name].append(f"{name}:{number}")
    twice = {name: where for name, where in places.items()
             if len(where) > 1 and name not in EITHER_OR}
    print(f"{len(places)} types, {len(twice)} of them defined more than once")
    for name, where in sorted(twice.items()):
        print(f"{name}: {', '.join(where)}")
    return 1 if twice or not places else 0


if __name__ == "__main__":
    sys.exit(main())
