# SPDX-License-Identifier: AGPL-3.0-or-later
"""Writes the include files that the scenes name: meshes of the real data, or of test scenes in
their place, as mesh2."""
import array
import hashlib
import math
import pathlib
import struct
import subprocess

# Include file -> the file in the real data, and the test scene where there is none.
SOURCES = {
    "dragon": ("meshes/stanford-dragon/dragon_vrip.ply.gz", "knot"),
    "dragon_small": ("meshes/stanford-dragon/dragon_vrip_res3.ply.gz", "sphere-5"),
    "bunny": ("meshes/stanford-bunny/bun_zipper.ply", "sphere-4"),
    "armadillo": ("meshes/armadillo-86k/armadillo.obj", "sphere-5"),
    "buddha": ("meshes/buddha-horse-dragon-100k-obj/buddha.obj", "sphere-5"),
    "lucy": ("meshes/pyvista/lucy.ply", "sphere-4"),
    "kitchen": ("meshes/kitchen-fathirmutfak/fatihrmutfak", "glass"),
    "plants": ("plants", "plants"),
}

# The types of a vertex's numbers in a PLY that `overcast convert` writes. x, y and z come first.
TYPES = {"float": "f", "double": "d"}


def read_ply(path):
    """Reads a binary PLY that `overcast convert` wrote. Returns 3 numbers for each vertex, and 3
    indices for each triangle."""
    data = path.read_bytes()
    header, _, body = data.partition(b"end_header\n")
    lines = [line.split() for line in header.decode().splitlines()]
    counts = {words[1]: int(words[2]) for words in lines if words[0] == "element"}
    types = [TYPES[words[1]] for words in lines if words[0] == "property" and words[1] in TYPES]
    vertex = struct.Struct("<" + "".join(types))
    size = vertex.size * counts["vertex"]
    vertices = array.array("d", (v for numbers in vertex.iter_unpack(body[:size])
                                 for v in numbers[:3]))
    faces = body[size:size + 13 * counts["face"]]
    corners = array.array("l", (i for numbers in struct.iter_unpack("<B3i", faces)
                                for i in numbers[1:]))
    return vertices, corners


def without_holes(vertices, corners):
    """Removes triangles with a corner that is not finite, because POV-Ray cannot read them."""
    bad = {i // 3 for i, v in enumerate(vertices) if not math.isfinite(v)}
    if not bad:
        return vertices, corners
    kept = array.array("l")
    for at in range(0, len(corners), 3):
        if bad.isdisjoint(corners[at:at + 3]):
            kept.extend(corners[at:at + 3])
    return array.array("d", (v if math.isfinite(v) else 0 for v in vertices)), kept


def normals_of(vertices, corners):
    """Returns a normal for each vertex, 3 numbers: the mean of its triangles' normals, by area."""
    normals = [0.0] * len(vertices)
    for at in range(0, len(corners), 3):
        a, b, c = (3 * i for i in corners[at:at + 3])
        e = [vertices[b + k] - vertices[a + k] for k in range(3)]
        f = [vertices[c + k] - vertices[a + k] for k in range(3)]
        normal = [e[(k + 1) % 3] * f[(k + 2) % 3] - e[(k + 2) % 3] * f[(k + 1) % 3]
                  for k in range(3)]
        for corner in (a, b, c):
            for k in range(3):
                normals[corner + k] += normal[k]
    for at in range(0, len(normals), 3):
        size = sum(n * n for n in normals[at:at + 3]) ** 0.5
        normals[at:at + 3] = [n / size for n in normals[at:at + 3]] if size else [0.0, 1.0, 0.0]
    return normals


def triples(name, numbers, form):
    """Returns a list as POV-Ray reads it, such as face_indices { 1, <0,1,2> }."""
    one = "<" + ",".join([form] * 3) + ">"
    rows = (one % tuple(numbers[at:at + 3]) for at in range(0, len(numbers), 3))
    return f"{name} {{ {len(numbers) // 3},\n" + ",\n".join(rows) + "\n}\n"


def mesh2(vertices, corners, smooth, end=""):
    """Returns a mesh2, which is solid if the scene declares Solid.

    smooth: the mesh2 has normals if the scene declares Smooth.
    """
    text = "mesh2 {\n" + triples("vertex_vectors", vertices, "%.9g")
    if smooth:
        normals = triples("normal_vectors", normals_of(vertices, corners), "%.7g")
        text += f"#ifdef (Smooth)\n{normals}#end\n"
    text += triples("face_indices", corners, "%d")
    return f"{text}#ifdef (Solid) inside_vector Solid #end\n{end}}}\n"


def converted(overcast, source, folder):
    ply = folder / "mesh.ply"
    subprocess.run([overcast, "convert", source, ply], check=True, capture_output=True)
    mesh = without_holes(*read_ply(ply))
    ply.unlink()
    return mesh


def colored_parts(overcast, source, folder):
    """Returns a union of all .obj files in a folder, each in a color made from its name."""
    parts = []
    for part in sorted(source.rglob("*.obj")):
        vertices, corners = converted(overcast, part, folder)
        if corners:
            color = hashlib.md5(part.name.encode()).digest()
            finish = "finish { reflection 0.15 specular 0.4 }" if color[3] % 3 == 0 else ""
            rgb = tuple(0.3 + 0.6 * c / 255 for c in color[:3])
            look = "pigment { rgb <%.2f,%.2f,%.2f> }" % rgb
            parts.append(mesh2(vertices, corners, False, look + finish))
    return "union {\n" + "".join(parts) + "}"


def write_include(name, overcast, data, folder):
    """Writes folder/NAME.inc unless it is there. data: the folder of the real data, or None."""
    path = folder / f"{name}.inc"
    if path.exists():
        return
    real, stand_in = SOURCES[name]
    source = data / real if data and (data / real).exists() else stand_in
    if isinstance(source, pathlib.Path) and source.is_dir():
        text = colored_parts(overcast, source, folder)
    else:
        vertices, corners = converted(overcast, source, folder)
        text = mesh2(vertices, corners, smooth=name in ("buddha", "dragon_small"))
    new = path.with_suffix(".new")
    new.write_text(f"#declare {name} = {text}")
    new.rename(path)
