# SPDX-License-Identifier: Apache-2.0
"""Fails when a file includes what its folder may not know. usage: layering.py ROOT

The graph is that of docs/design/overview.md: core <- importers; core <- kdtree <- gpu <- plugin;
core <- testscenes; shaders/layout.h is a leaf; host -> plugin/overcast.h and
textures/overcast_textures.h only; tests -> anything.
Only the files in PLACES may name the third-party headers there.
"""
import pathlib
import re
import sys

MAY_INCLUDE = {
    "core": {"core"},
    "importers": {"core", "importers"},
    "kdtree": {"core", "kdtree"},
    "shaders": {"shaders"},
    "gpu": {"core", "kdtree", "gpu", "shaders"},
    "plugin": {"core", "kdtree", "gpu", "shaders", "plugin"},
    "testscenes": {"core", "testscenes"},
    "textures": {"textures"},
    "host": {"core", "importers", "testscenes", "kdtree", "host"},
}

# The neighbours within its folder that each part may include. A part that is not named here may
# include them all.
PARTS = {
    "gpu/budget": set(),
    "gpu/driver": set(),
    "gpu/gl": {"gpu/budget", "gpu/driver"},
    "gpu/bvh": set(),
    "gpu/frame": set(),
    "gpu/page": {"gpu/bvh", "gpu/frame"},
    "gpu/late": {"gpu/gl", "gpu/trace"},
    "gpu/tuning": {"gpu/gl"},
    "gpu/walk": {"gpu/bvh", "gpu/frame", "gpu/page", "gpu/trace"},
    "gpu/trace": {"gpu/budget", "gpu/driver", "gpu/frame", "gpu/gl", "gpu/page", "gpu/tuning"},
    "plugin/structure": {"plugin"},
    "plugin/abi": {"plugin", "plugin/structure", "plugin/leaf_store"},
    "plugin/leaf_store": set(),
    "plugin/build": {"plugin", "plugin/plan", "plugin/leaf_store"},
    "plugin/plan": {"plugin", "plugin/build"},
    "plugin/fallback": {"plugin", "plugin/build", "plugin/leaf_store"},
    "plugin/out_of_core": {"plugin", "plugin/structure", "plugin/build", "plugin/plan",
                           "plugin/leaf_store"},
    "plugin/resolve": {"plugin", "plugin/structure", "plugin/build", "plugin/plan",
                       "plugin/fallback"},
    "plugin/two_level": {"plugin", "plugin/structure", "plugin/build", "plugin/plan",
                         "plugin/out_of_core", "plugin/leaf_store", "plugin/fallback",
                         "plugin/resolve"},
    "plugin/ranks": {"plugin", "plugin/abi", "plugin/structure", "plugin/build", "plugin/plan",
                     "plugin/two_level", "plugin/leaf_store", "plugin/ranks/transport"},
    "plugin/ranks/transport": set(),
}

# Header pattern -> the files that may include such headers. Tests may include any.
PLACES = {
    r"glm/": ["core/vec.h", "importers/pbrt/interpret/motion.cpp"],
    r"(oneapi/)?tbb/": ["core/system/parallel.cpp"],
    r"xxhash\.h": ["core/file/checksum.cpp"],
    r"assimp/": ["importers/mesh/assimp.cpp", "importers/mesh/assimp_look.h",
                 "importers/mesh/assimp_look.cpp"],
    r"isa-l": ["importers/file/gzip_file.cpp"],
    r"epoxy/": ["gpu/gl/gl.h"],
    r"(EGL|GL|GLES\d?|KHR)/": [],
    r"(OpenEXR/|Imf)": ["host/output/image_exr.cpp"],
    r"png\.h": ["importers/png.cpp"],
    r"OpenImageIO/": ["textures/"],
    r"embree": ["host/backend/embree.h"],
    r"mpi\.h": ["plugin/ranks/transport/mpi_transport.cpp", "plugin/examples/ranks.c"],
    r"boost/": ["importers/csg/exact.h"],
    r"tachyon\.h": ["plugin/hosts/tachyon/tachyon_triangle.h"],
    r"(gtest|gmock)/": [],
}

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)


def allowed(path, places):
    return any(path.startswith(p) if p.endswith("/") else path == p for p in places)


def check(root, path):
    name = path.relative_to(root).as_posix()
    folder = name.split("/")[0]
    is_test = folder == "tests" or "test" in path.stem
    for quote, target in INCLUDE.findall(path.read_text()):
        if quote == '"':
            other = target.split("/")[0]
            if folder == "tests" or (is_test and other == "tests"):
                continue
            if folder == "host" and target in (
                    "plugin/overcast.h", "plugin/overcast_ranks.h", "statistics_fields.inc",
                    "textures/overcast_textures.h"):
                continue
            if name == "plugin/overcast.hpp" and target == "overcast.h":
                continue
            hosts = "/".join(name.split("/")[:3])
            if (not is_test and hosts.startswith("plugin/hosts/")
                    and target != "plugin/overcast.h" and not target.startswith(hosts)):
                yield f"{name} includes {target}; a host knows its own folder and plugin/overcast.h"
            part, known = name.rpartition("/")[0], target.rpartition("/")[0]
            if (part in PARTS and not is_test and known != part and known.startswith(folder)
                    and known not in PARTS[part]):
                yield (f"{name} includes {target}; {part} may include "
                       f"{sorted(PARTS[part]) or 'none of its neighbours'}")
            if name == "plugin/overcast_ranks.h" and target == "overcast.h":
                continue
            if folder == "plugin" and name.endswith("overcast.h"):
                yield f"{name} includes {target}; the C header includes nothing of ours"
            elif folder not in MAY_INCLUDE or other not in MAY_INCLUDE[folder]:
                if not (folder in ("shaders", "gpu") and "/" not in target
                        and target.endswith(".h")):
                    yield (f"{name} includes {target}; {folder} may include "
                           f"{sorted(MAY_INCLUDE.get(folder, []))}")
        else:
            for pattern, places in PLACES.items():
                if re.match(pattern, target) and not is_test and not allowed(name, places):
                    yield f"{name} includes <{target}>; only {places or 'nobody'} may"


def main():
    root = pathlib.Path(sys.argv[1])
    files = [f for folder in [*MAY_INCLUDE, "tests"] for f in sorted((root / folder).rglob("*"))
             if f.suffix in (".h", ".cpp", ".c", ".hpp")]
    wrong = [line for f in files for line in check(root, f)]
    print(f"{len(files)} files, {len(wrong)} includes against the graph")
    for line in wrong:
        print(line)
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main())
