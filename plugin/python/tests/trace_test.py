# SPDX-License-Identifier: Apache-2.0
"""Compares the module's answers with a brute-force tracer in NumPy, for every form of arrays."""

import os
import tempfile
import threading
import unittest

import numpy as np

import overcast
from overcast._query import places_of
from overcast._rays import as_rays
from scenes_for_tests import brute_force, rays_at_unit_cube, skip_without_device, soup

setUpModule = skip_without_device

RAYS = 4000
TRIANGLES = 1500


def scene_of(*meshes, **options):
    scene = overcast.Scene(**options)
    for mesh in meshes:
        scene.add(*mesh)
    scene.commit()
    return scene


class Nearest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.corners = soup(1, TRIANGLES)
        cls.origins, cls.directions = rays_at_unit_cube(2, RAYS)
        cls.t, cls.u, cls.v, cls.prim = brute_force(cls.corners, cls.origins, cls.directions)
        assert RAYS / 4 < (cls.prim != overcast.NONE).sum() < RAYS, "some rays hit, some miss"

    def check(self, hits, prim_of=lambda hits: hits.prim):
        np.testing.assert_array_equal(prim_of(hits), self.prim)
        np.testing.assert_array_equal(hits.hit, self.prim != overcast.NONE)
        np.testing.assert_allclose(hits.t, self.t, rtol=1e-10)
        hit = hits[hits.hit]
        np.testing.assert_allclose(hit.u, self.u[hits.hit], atol=1e-10)
        np.testing.assert_allclose(hit.v, self.v[hits.hit], atol=1e-10)

    def test_small_budgets_and_many_leaves_change_nothing(self):
        for options in ({}, {"leaves": 20}, {"gpu_memory": 192 << 10}, {"kernel": "fragment"}):
            with self.subTest(options), scene_of([self.corners], **options) as scene:
                self.check(scene.intersect(self.origins, self.directions))

    def test_scenes_share_the_budget_of_their_device(self):
        device = overcast.Device(gpu_memory=300 << 10, threads=1)
        self.assertEqual(device.info.default_budget_bytes, 300 << 10)
        with self.assertRaisesRegex(overcast.Error, "share 307200"):
            overcast.Scene(device, gpu_memory=1 << 20)
        with scene_of([self.corners], device=device) as one, \
             scene_of([self.corners], device=device) as two:
            for scene in (one, two, one):
                self.check(scene.intersect(self.origins, self.directions))
                in_use = sum(s.statistics()["gpu_bytes"] for s in (one, two))
                self.assertLessEqual(in_use, 300 << 10)

    def test_scenes_that_change(self):
        """Corners, places and meshes that changed give the answers of a scene that is new."""
        up = np.eye(4)[:3]
        up[2, 3] = 0.5
        with scene_of([self.corners]) as scene:
            scene.update(0, self.corners[5:9] + np.float32(0.25), first=5)
            second = scene.add(self.corners, moves=True)
            scene.commit()
            scene.move(second, up)
            third = scene.add_instance(0, up)
            scene.commit()
            scene.remove(third)
            scene.commit()
            changed = self.corners.copy()
            changed[5:9] += np.float32(0.25)
            with scene_of([changed]) as new:
                new.add(self.corners, transform=up)
                new.commit()
                a, b = (s.intersect(self.origins, self.directions) for s in (scene, new))
                np.testing.assert_array_equal(a.records, b.records)
                self.assertTrue((a.mesh == second).any())

    def test_vertices_as_they_come(self):
        """Vertices by index, in columns of a wider array, in doubles, in other byte orders and
        layouts, backwards, read-only and as lists give the same answers."""
        flat = self.corners.reshape(-1, 3)
        shuffle = np.random.default_rng(3).permutation(len(flat))
        indices = np.argsort(shuffle).reshape(-1, 3)
        wide = np.zeros((len(flat), 7), np.float32)
        wide[:, 2:5] = flat
        frozen = flat.copy()
        frozen.flags.writeable = False
        for name, mesh in {"indexed": (flat[shuffle], indices),
                           "uint32": (flat[shuffle], indices.astype(np.uint32)),
                           "int16": (flat[shuffle], indices.astype(np.int16)),
                           "columns": (wide[:, 2:5],),
                           "doubles": (flat.astype(np.float64),),
                           "columns of doubles": (wide.astype(np.float64)[:, 2:5],),
                           "big-endian": (flat.astype(">f4"),),
                           "fortran": (np.asfortranarray(flat),),
                           "backwards": (flat[::-1],
                                         len(flat) - 1 - np.arange(len(flat)).reshape(-1, 3)),
                           "read-only": (frozen,),
                           "lists": (flat.tolist(), indices[:0].tolist())}.items():
            with self.subTest(name), scene_of(mesh) as scene:
                if name == "lists":  # It has vertices, but an empty list of triangles.
                    self.assertFalse(scene.intersect(self.origins, self.directions).hit.any())
                else:
                    self.check(scene.intersect(self.origins, self.directions))

    def test_a_shared_mesh_is_read_in_place_and_kept_alive(self):
        for dtype in (np.float32, np.float64):
            corners = self.corners.astype(dtype)
            scene = overcast.Scene()
            scene.add(corners, shared=True)
            del corners
            scene.commit()
            self.assertEqual(scene.statistics()["soup_bytes"], 0)
            self.check(scene.intersect(self.origins, self.directions))

    def test_meshes_are_numbered(self):
        half = TRIANGLES // 2
        with scene_of([self.corners[:half]], [np.empty((0, 3))], [self.corners[half:]]) as scene:
            self.check(scene.intersect(self.origins, self.directions),
                       lambda hits: np.where(hits.mesh == 2, hits.prim + half,
                                             hits.prim).astype(np.uint32))

    def test_shapes_broadcast(self):
        with scene_of([self.corners]) as scene:
            hits = scene.intersect(self.origins.reshape(40, -1, 3),
                                   self.directions.reshape(40, -1, 3))
            self.assertEqual(hits.shape, (40, RAYS // 40))
            self.check(overcast.Hits(hits.records.ravel()))
            fan = scene.intersect([0.5, 0.5, -2], self.directions)
            one_by_one = [scene.intersect([0.5, 0.5, -2], direction)
                          for direction in self.directions[:5]]
            self.assertEqual([hits.shape for hits in one_by_one], [()] * 5)
            self.assertEqual([hits.records.item() for hits in one_by_one], fan.records[:5].tolist())
            self.assertEqual(scene.intersect(np.empty((0, 3)), [0, 0, 1]).shape, (0,))

    def test_limits_of_t(self):
        t_min, t_max = 0.7, np.linspace(0.8, 1.2, RAYS)
        corners = self.corners
        expected = np.array([brute_force(corners, o[None], d[None], t_min, most)[3][0]
                             for o, d, most in zip(self.origins[:500], self.directions, t_max)])
        with scene_of([corners]) as scene:
            limits = t_min, t_max[:500]
            hits = scene.intersect(self.origins[:500], self.directions[:500], *limits)
            np.testing.assert_array_equal(hits.prim, expected)
            np.testing.assert_array_equal(scene.occluded(self.origins[:500], self.directions[:500],
                                                         *limits),
                                          expected != overcast.NONE)

    def test_skipped_triangles_are_not_seen(self):
        with scene_of([self.corners]) as scene:
            first = scene.intersect(self.origins, self.directions)
            second = scene.intersect(self.origins, self.directions, skip=first)
            self.assertTrue((second.t >= first.t).all())
            self.assertFalse(((second.prim == first.prim) & first.hit).any())
            by_name = scene.intersect(self.origins, self.directions,
                                      skip=np.stack([first.mesh, first.prim], axis=-1))
            np.testing.assert_array_equal(by_name.records, second.records)
            np.testing.assert_array_equal(scene.occluded(self.origins, self.directions, skip=first),
                                          second.hit)

    def test_records_are_traced_in_place(self):
        with scene_of([self.corners]) as scene:
            records = overcast.rays(self.origins, self.directions)
            out = scene.intersect_rays(records)
            self.check(out)
            memory = out.records.ctypes.data
            records["t_max"] = 0
            self.assertIs(scene.intersect_rays(records, out=out), out)
            self.assertEqual((out.records.ctypes.data, out.hit.any()), (memory, False))
            records["t_max"] = np.inf
            # An array that is not contiguous is copied.
            self.check(scene.intersect_rays(np.repeat(records, 2)[::2]))
            np.testing.assert_array_equal(scene.occluded_rays(records), self.prim != overcast.NONE)

    def test_records_at_odd_addresses_are_copied(self):
        rays = overcast.rays(self.origins, self.directions)
        packed = np.frombuffer(b"x" + rays.tobytes(), np.dtype(overcast.RAY.descr), offset=1)
        after = np.zeros(len(rays), overcast.HIT)
        after["t"] = -np.inf
        after = np.frombuffer(b"x" + after.tobytes(), np.dtype(overcast.HIT.descr), offset=1)
        with scene_of([self.corners]) as scene:
            self.check(scene.intersect_rays(packed, after=overcast.Hits(after)))
        for records in (as_rays(packed), places_of(overcast.Hits(after), after.shape)):
            self.assertEqual(records.ctypes.data % 8, 0)

    def test_float_records_are_the_doubles_that_they_are(self):
        with scene_of([self.corners]) as scene:
            short = overcast.rays(self.origins, self.directions, dtype=overcast.RAY_FLOAT)
            self.assertEqual(short.nbytes, 32 * RAYS)
            long = overcast.rays(short["origin"], short["direction"])
            np.testing.assert_array_equal(scene.intersect_rays(short).records,
                                          scene.intersect_rays(long).records)
            np.testing.assert_array_equal(scene.occluded_rays(short), scene.occluded_rays(long))
            eight = np.hstack([short["origin"], short["t_min"][:, None], short["direction"],
                               short["t_max"][:, None]])
            np.testing.assert_array_equal(eight.view(overcast.RAY_FLOAT)[..., 0], short)

    def test_saved_scenes_answer_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "soup.saved")
            with scene_of([self.corners]) as scene:
                scene.save(path)
            self.assertEqual(os.listdir(folder), ["soup.saved"])
            with scene_of([self.corners], saved=path) as scene:
                self.assertEqual(scene.statistics()["from_saved"], 1)
                self.check(scene.intersect(self.origins, self.directions))

    def test_threads_share_a_scene(self):
        answers = {}
        with scene_of([self.corners]) as scene:
            def trace(i):
                answers[i] = scene.intersect(self.origins, self.directions)
            threads = [threading.Thread(target=trace, args=(i,)) for i in range(8)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
        self.assertEqual(len(answers), 8)
        for hits in answers.values():
            self.check(hits)


class Numbers(unittest.TestCase):
    def test_doubles_far_from_the_origin_keep_their_detail(self):
        far = np.array([4.5e6, 6e6, 10])
        corners = soup(5, 300).astype(np.float64) + far
        origins, directions = rays_at_unit_cube(6, 1000)
        # These sums are rounded to the doubles there, so that subtracting `far` again is exact.
        origins += far
        t, _, _, prim = brute_force(corners - far, origins - far, directions)
        with scene_of([corners]) as scene:
            hits = scene.intersect(origins, directions)
        np.testing.assert_array_equal(hits.prim, prim)
        np.testing.assert_allclose(hits.t, t, rtol=1e-10)
        with scene_of([(corners - far).astype(np.float32)]) as scene:
            self.assertTrue((scene.intersect(origins - far, directions).t != t).any(),
                            "floats would not do")

    def test_plan_and_statistics_count(self):
        corners = soup(1, 500)
        corners[7] = np.nan
        scene = overcast.Scene(gpu_memory=1 << 20)
        scene.add(corners)
        plan = scene.plan()
        self.assertEqual((plan["triangles"], plan["hittable"], plan["fits"]), (500, 499, 1))
        scene.commit()
        scene.occluded([0, 0, 0], [0, 0, 1])
        scene.intersect([[0, 0, np.nan], [0, 0, 0]], [0, 0, 1])
        statistics = scene.statistics()
        self.assertEqual((statistics["dropped_not_finite"], statistics["nearest_rays"],
                          statistics["occlusion_rays"],
                          statistics["invalid_rays"]), (1, 2, 1, 1))
        self.assertLessEqual(statistics["gpu_peak_bytes"], 1 << 20)


class Instances(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(9)
        self.corners = soup(8, 200)
        self.transforms = random.normal(size=(5, 3, 4))
        self.moved = [(self.corners @ matrix[:, :3].T + matrix[:, 3]) for matrix in self.transforms]
        self.origins, self.directions = rays_at_unit_cube(10, 2000)

    def test_are_meshes_elsewhere(self):
        t, _, _, prim = brute_force(np.concatenate(self.moved), self.origins, self.directions)
        scene = overcast.Scene()
        template = scene.add(self.corners, template=True)
        numbers = [scene.add_instance(template, np.vstack([self.transforms[0], [0, 0, 0, 1]]))]
        numbers += [scene.add_instance(template, matrix) for matrix in self.transforms[1:4]]
        numbers.append(scene.add(self.corners, transform=self.transforms[4]))
        self.assertEqual(numbers, [1, 2, 3, 4, 5])
        scene.commit()
        hits = scene.intersect(self.origins, self.directions)
        self.assertGreater(hits.hit.sum(), 200)
        np.testing.assert_array_equal(hits.hit, np.isfinite(t))
        np.testing.assert_array_equal(hits.mesh[hits.hit], 1 + prim[hits.hit] // 200)
        np.testing.assert_array_equal(hits.prim[hits.hit], prim[hits.hit] % 200)
        np.testing.assert_allclose(hits.t, t, rtol=1e-9)

    def test_of_instances_come_after_theirs(self):
        scene = overcast.Scene()
        first = scene.add_instance(scene.add(self.corners, template=True), np.eye(3, 4) * 2)
        scene.add_instance(first, np.hstack([np.eye(3), [[3], [4], [5]]]))
        scene.commit()
        hits = scene.intersect(self.corners.mean(axis=1) * 2 + [3, 4, 5] - [0, 0, 9], [0, 0, 9])
        self.assertTrue((hits.mesh == 2).all())

    def test_memory_is_given_back_until_the_next_ray(self):
        with scene_of([self.corners]) as scene:
            before = scene.intersect(self.origins, self.directions)
            scene.purge()
            self.assertEqual(scene.statistics()["gpu_bytes"], 0)
            np.testing.assert_array_equal(scene.intersect(self.origins, self.directions).records,
                                          before.records)
            self.assertGreater(scene.statistics()["gpu_bytes"], 0)
