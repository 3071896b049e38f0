# SPDX-License-Identifier: Apache-2.0
"""The ray engine for trimesh: trimesh's own tests of rays, unchanged, where ../shared/data has
them; and what its engines are known to get wrong."""

import copy
import importlib
import os
import pathlib
import pickle
import subprocess
import sys
import tempfile
import types
import unittest

import numpy as np

from overcast.trimesh import RayMeshIntersector

ARCHIVE = (pathlib.Path(os.environ["OVC_SOURCE_DIR"]).parent / "shared" / "data"
           / "trimesh.tar.zst")


class Mesh:
    """A mesh as trimesh has it, as far as the engine asks."""

    def __init__(self, vertices, faces):
        self.vertices, self.faces = np.array(vertices, np.float64), np.array(faces)

    def __hash__(self):
        return hash((self.vertices.tobytes(), self.faces.tobytes()))


def grid_box(n, scale=1.0, center=(0.0, 0.0, 0.0)):
    """A closed cube of two triangles for each of n x n squares a side."""
    quads = []
    steps = np.linspace(-0.5, 0.5, n + 1)
    for axis in range(3):
        for side in (-0.5, 0.5):
            for i in range(n):
                for j in range(n):
                    corners = []
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        p = np.empty(3)
                        p[axis] = side
                        p[(axis + 1) % 3], p[(axis + 2) % 3] = steps[a], steps[b]
                        corners.append(p)
                    quads.append(corners if side > 0 else corners[::-1])
    vertices = np.array(quads).reshape(-1, 3) * scale + np.array(center)
    first = 4 * np.arange(len(quads))[:, None]
    faces = np.concatenate([first + [0, 1, 2], first + [0, 2, 3]])
    return Mesh(vertices, faces)


class Engine(unittest.TestCase):
    def test_rays_from_the_surface_hit_it_and_the_other_side_at_any_scale(self):
        for scale in (1e-30, 1e-4, 1.0, 1e4, 1e8, 1e30):
            engine = RayMeshIntersector(grid_box(4, scale))
            triangles, rays = engine.intersects_id([[0, 0, scale / 2]], [[0, 0, -1]])
            self.assertEqual(len(triangles), 2, scale)
            self.assertEqual(rays.tolist(), [0, 0])

    def test_huge_coordinates_lose_nothing(self):
        center = np.array([4.5e6, 6e6, -1e9])
        engine = RayMeshIntersector(grid_box(4, 1e-3, center))
        offsets = np.random.default_rng(1).uniform(-4e-4, 4e-4, (1000, 2))
        origins = center + np.column_stack([offsets, np.full(1000, -1.0)])
        directions = np.tile([0.0, 0.0, 1.0], (1000, 1))
        locations, rays, _ = engine.intersects_location(origins, directions)
        self.assertEqual(np.bincount(rays).tolist(), [2] * 1000)
        self.assertTrue((locations[:, :2] == origins[rays][:, :2]).all())

    def test_layers_within_a_rounding_of_float32_are_all_found(self):
        heights = 1 + 1e-12 * np.arange(50)
        corners = [[(-1, -1, z), (3, -1, z), (-1, 3, z)] for z in heights]
        engine = RayMeshIntersector(Mesh(np.reshape(corners, (-1, 3)),
                                         np.arange(150).reshape(-1, 3)))
        triangles, _ = engine.intersects_id([[0, 0, 0]], [[0, 0, 1]])
        self.assertEqual(triangles.tolist(), list(range(50)))
        triangles, _ = engine.intersects_id([[0, 0, 0]], [[0, 0, 1]], max_hits=7)
        self.assertEqual(triangles.tolist(), list(range(7)))

    def test_first_and_any(self):
        engine = RayMeshIntersector(grid_box(2))
        origins, directions = [[0.1, 0.2, 2], [3, 3, 3]], [[0, 0, -1], [0, 0, 1]]
        first = engine.intersects_first(origins, directions)
        self.assertGreaterEqual(first[0], 0)
        self.assertEqual(first[1], -1)
        self.assertEqual(engine.intersects_any(origins, directions).tolist(), [True, False])

    def test_points_inside(self):
        engine = RayMeshIntersector(grid_box(8))
        points = np.random.default_rng(2).uniform(-1, 1, (20000, 3))
        inside = np.abs(points).max(axis=1) < 0.5
        self.assertTrue((engine.contains_points(points) == inside).all())

    def test_a_mesh_that_changes_is_built_again(self):
        mesh = grid_box(1)
        engine = RayMeshIntersector(mesh)
        self.assertTrue(engine.intersects_any([[0, 0, 5]], [[0, 0, -1]])[0])
        mesh.vertices += 10
        self.assertFalse(engine.intersects_any([[0, 0, 5]], [[0, 0, -1]])[0])

    def test_copies_and_pickles_answer_alike(self):
        engine = RayMeshIntersector(grid_box(1))
        engine.intersects_any([[0, 0, 5]], [[0, 0, -1]])
        for other in (copy.deepcopy(engine), pickle.loads(pickle.dumps(engine))):
            self.assertTrue(other.intersects_any([[0, 0, 5]], [[0, 0, -1]])[0])

    def test_no_rays_and_wrong_shapes(self):
        engine = RayMeshIntersector(grid_box(1))
        for answers in (engine.intersects_id(np.empty((0, 3)), np.empty((0, 3))),
                        engine.intersects_location(np.empty((0, 3)), np.empty((0, 3)))):
            self.assertEqual([len(answer) for answer in answers], [0] * len(answers))
        with self.assertRaisesRegex(ValueError, "same shape"):
            engine.intersects_any([[0, 0, 0]], [[0, 0, 1], [0, 0, 1]])


@unittest.skipUnless(ARCHIVE.exists(), "no ../shared/data")
class OwnTestsOfTrimesh(unittest.TestCase):
    """Runs trimesh's test_ray.py with this engine in the place of both of trimesh's."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        unpacked = subprocess.run(["zstd", "-dc", ARCHIVE], capture_output=True, check=True).stdout
        subprocess.run(["tar", "-x", "-C", cls.folder.name], input=unpacked, check=True)
        package = next(pathlib.Path(cls.folder.name).glob("trimesh-*"))
        (package / "models" / "2D").mkdir()  # which the archive leaves out, and tests look into
        sys.path[:0] = [str(package), str(package / "tests")]
        trimesh = importlib.import_module("trimesh")
        engine = types.SimpleNamespace(RayMeshIntersector=RayMeshIntersector)
        trimesh.ray.ray_triangle.RayMeshIntersector = RayMeshIntersector
        trimesh.ray.ray_pyembree, trimesh.ray.has_embree = engine, True
        cls.tests = importlib.import_module("test_ray")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_all_pass(self):
        ran = 0
        box = self.tests.g.trimesh.creation.box()
        self.assertIs(type(box.ray), RayMeshIntersector)
        for name in sorted(vars(self.tests)):
            if not name.startswith("test_"):
                continue
            with self.subTest(name):
                try:
                    getattr(self.tests, name)()
                    ran += 1
                except ImportError as missing:  # a package that the test itself wants
                    print(f"{name}: {missing}")
        self.assertGreaterEqual(ran, 10)


if __name__ == "__main__":
    unittest.main()
