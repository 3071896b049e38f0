#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Validates the kernels' sources with glslang, for OpenGL 4.5 and 4.6 core, and makes SPIR-V of
them, which spirv-val validates. Finds what glslang takes and NVIDIA's compiler does not: literals
beyond their type's range, which it refuses, and arrays of doubles, of which it loses bits.

usage: compilers.py KERNEL_SOURCES [FOLDER]

KERNEL_SOURCES is the program build/bin/kernel_sources. Sources and SPIR-V stay in FOLDER, if it is
given. Without glslang-tools or spirv-tools the script exits with 77.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile


def refusal_of(*command):
    """Returns what a compiler says where it fails, else nothing."""
    done = subprocess.run(command, text=True, capture_output=True)
    return done.stdout + done.stderr if done.returncode else ""


LITERAL = re.compile(r"(?<![\w.])(\d+\.\d*(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+)(lf|LF|f|F)?")


def out_of_range(text):
    """Returns the literals that are no normal float, and do not say that they are doubles."""
    numbers = [m for m in LITERAL.finditer(re.sub("//.*", "", text)) if m[2] not in ("lf", "LF")]
    return [m[0] for m in numbers if float(m[1]) and not 1.17e-38 < float(m[1]) < 3.4028236e38]


ARRAY = re.compile(r"\b(?:double|dvec[234]|dmat\w+)\s*(?:\w+\s*)?\[")


def arrays_of_doubles(text):
    return ARRAY.findall(re.sub("//.*", "", text))


def check(source):
    """Yields for each compiler its name and its refusal of a source."""
    yield "literals", " ".join(out_of_range(source.read_text()))
    yield "arrays of doubles", " ".join(arrays_of_doubles(source.read_text()))
    yield "GLSL 4.50", refusal_of("glslangValidator", source)
    later = source.with_name("later_" + source.name)
    later.write_text(source.read_text().replace("#version 450 core", "#version 460 core"))
    yield "GLSL 4.60", refusal_of("glslangValidator", later)
    later.unlink()
    module = source.with_name(source.name + ".spv")
    yield "SPIR-V", refusal_of("glslangValidator", "-G", "-o", module, source)
    if module.exists():
        yield "spirv-val", refusal_of("spirv-val", "--target-env", "opengl4.5", module)


def main():
    for tool, package in {"glslangValidator": "glslang-tools", "spirv-val": "spirv-tools"}.items():
        if not shutil.which(tool):
            print(f"skipped: {package} is not installed")
            return 77
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else temporary)
        folder.mkdir(exist_ok=True)
        subprocess.run([sys.argv[1], folder], check=True)
        broken = folder / "broken.comp"
        broken.write_text("#version 450 core\nvoid main() { nothing(); }\n")
        if not refusal_of("glslangValidator", broken):
            print("glslangValidator takes a source that calls a function that is not there")
            return 1
        if not out_of_range("double d = 1.0e300;") or out_of_range("double d = 1.0e300lf + 2.0;"):
            print("literals beyond the range of floats are not told from others")
            return 1
        if not all(map(arrays_of_doubles, ("dvec2 d[9];", "dvec3[3](a, b, c)"))) or \
                arrays_of_doubles("dvec3 a; uvec4 b[9];"):
            print("arrays of doubles are not told from others")
            return 1
        broken.unlink()
        sources = sorted(path for path in folder.iterdir()
                         if path.suffix in (".comp", ".vert", ".frag"))
        refused = 0
        for source in sources:
            for compiler, refusal in check(source):
                if refusal:
                    refused += 1
                    print(f"{source.name}, {compiler}: {refusal}")
        print(f"{len(sources)} sources, {refused} refusals")
        return 1 if refused or not sources else 0


if __name__ == "__main__":
    sys.exit(main())
