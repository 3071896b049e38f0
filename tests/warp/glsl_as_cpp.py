# SPDX-License-Identifier: Apache-2.0
"""Writes sources of the kernel as C++. usage: glsl_as_cpp.py SHADERS OUT [rebase]

Only the spelling changes: parameters that go out become references, arrays become values, swizzles
calls, and numbers with a point floats. What the kernel reads and writes is left to the C++ that
includes this. Without `rebase` that is all that replayed_kernel.cpp runs; with it, what
rebased.cpp runs: how rays change frames in pairs of floats.
"""
import pathlib
import re
import sys

# trace.glsl ends with ray refill, whose ballots need lanes; the model of a warp has its own.
FILES = ("config.glsl", "unit.glsl", "@reads", "box.glsl", "children.glsl",
         "triangle.glsl", "times.glsl", "found.glsl", "occluder.glsl", "pair.glsl",
         "traverse.glsl", "trace.glsl")
REBASE_FILES = ("float_pairs.glsl", "times_float_pairs.glsl", "@rays", "local_ray.glsl",
                "rebase_float_pairs.glsl")
READS = {"@reads": "Unit unit_at(int unit);\nuvec4 ray_texel(int texel);\n",
         "@rays": "uvec4 ray_texel(int texel);\nuvec4 portal_texel(int texel);\n"}
OCCLUDES = "OVC_ANY_HIT && OVC_CERTIFY"


def as_cpp(text):
    text = re.sub(r"//[^\n]*", "", text)
    text = re.sub(r"\bprecise ", "", text)
    text = re.sub(r'^#include "\w+\.glsl"$', "", text, flags=re.MULTILINE)
    text = re.sub(r"\b(?:inout|out) (\w+) (\w+)\[(\w+)\]", r"Array<\1, \3>& \2", text)
    text = re.sub(r"\b(?:inout|out) (\w+) (\w+)", r"\1& \2", text)
    text = re.sub(r"\b(\w+)\[(\w+)\]\(", r"Array<\1, \2>(", text)
    text = re.sub(r"\b(?!return\b|else\b)(\w+) (\w+)\[(\w+)\](?=[;,)]| =)",
                  r"Array<\1, \3> \2", text)
    text = re.sub(r"\.(xyz|xy|zw|zwxy)\b", r".\1()", text)
    text = re.sub(r"(?<![\w.])(\d+\.\d*(?:e[+-]?\d+)?|\d+e[+-]?\d+)(?![\w.])", r"\1f", text)
    # GLSL compares structures as they are.
    return re.sub(r"^struct Axes \{",
                  "struct Axes {\n    bool operator==(const Axes&) const = default;",
                  text, flags=re.MULTILINE)


def main():
    shaders, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    parts = []
    for name in REBASE_FILES if "rebase" in sys.argv[3:] else FILES:
        if name in READS:
            parts.append(READS[name])
            continue
        text = as_cpp((shaders / name).read_text())
        if name == "found.glsl":
            text = f"#if !({OCCLUDES})\n{text}\n#endif\n"
        elif name == "occluder.glsl":
            text = f"#if {OCCLUDES}\n{text}\n#endif\n"
        parts.append(f"// {name}\n{text}")
    out.write_text("\n".join(parts))


if __name__ == "__main__":
    main()
