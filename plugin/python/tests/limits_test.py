# SPDX-License-Identifier: Apache-2.0
"""Which hits count: behind others, by masks and by a filter; and all hits of a ray."""

import math
import unittest

import numpy as np

import overcast

LAYERS = 20


def layers():
    """A scene of triangles over the origin: mesh m lies at the height m + 1, and has two triangles
    in the same place."""
    scene = overcast.Scene()
    for m in range(LAYERS):
        corners = [(-1, -1, m + 1), (3, -1, m + 1), (-1, 3, m + 1)]
        scene.add(np.array([corners, corners], float), mask=1 << (m % 2))
    scene.commit()
    return scene


UP = ([0.0, 0, 0], [0.0, 0, 1])


class Limits(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = layers()

    def test_hits_come_one_after_the_other(self):
        hits, found = self.scene.intersect(*UP), []
        while hits.hit:
            found.append((float(hits.t), int(hits.mesh), int(hits.prim)))
            hits = self.scene.intersect(*UP, after=hits)
        self.assertEqual(found, [(m + 1, m, prim) for m in range(LAYERS) for prim in (0, 1)])

    def test_all_hits(self):
        origins = np.zeros((2, 3, 3))
        origins[1, 2] = 100, 0, 0
        hits, counts = self.scene.all_hits(origins, [0, 0, 1], t_max=7)
        self.assertEqual(hits.shape, (2, 3, 14))
        self.assertEqual(counts.tolist(), [[14, 14, 14], [14, 14, 0]])
        self.assertEqual(hits.t[0, 0].tolist(), [1 + i // 2 for i in range(14)])
        self.assertFalse(hits.hit[1, 2].any())
        first, counts = self.scene.all_hits(origins, [0, 0, 1], max_hits=3)
        self.assertEqual(first.prim[1, 0].tolist(), [0, 1, 0])
        self.assertEqual(counts.max(), 2 * LAYERS)
        none, counts = self.scene.all_hits(*UP, max_hits=0)
        self.assertEqual((none.shape, int(counts)), ((0,), 2 * LAYERS))

    def test_masks(self):
        hits = self.scene.intersect(np.zeros((4, 3)), [0, 0, 1], masks=[0, 1, 2, 4])
        self.assertEqual(hits.mesh.tolist(), [0, 0, 1, overcast.NONE])
        blocked = self.scene.occluded(np.zeros((4, 3)), [0, 0, 1], masks=[0, 1, 2, 4])
        self.assertEqual(blocked.tolist(), [True, True, True, False])

    def test_filter(self):
        asked = []

        def odd(rays, hits):
            asked.extend(zip(rays.tolist(), hits.mesh.tolist(), hits.prim.tolist()))
            return hits.mesh > rays  # ray i sees the meshes above i
        origins = np.zeros((15, 3))
        hits = self.scene.intersect(origins, [0, 0, 1], filter=odd)
        self.assertEqual(hits.mesh.tolist(), list(range(1, 16)))
        self.assertEqual(len(asked), len(set(asked)))
        self.assertEqual(len(asked), sum(2 * (i + 1) + 1 for i in range(15)))
        blocked = self.scene.occluded(origins, [0, 0, 1], t_max=5, filter=odd)
        self.assertEqual(blocked.tolist(), [i < 4 for i in range(15)])
        _, counts = self.scene.all_hits(origins, [0, 0, 1], filter=odd)
        self.assertEqual(counts.tolist(), [2 * (LAYERS - 1 - i) for i in range(15)])

    def test_what_a_filter_raises_is_raised(self):
        def fails(rays, hits):
            raise ZeroDivisionError("on purpose")
        for call in (self.scene.intersect, self.scene.occluded, self.scene.all_hits):
            with self.assertRaisesRegex(ZeroDivisionError, "on purpose"):
                call(*UP, filter=fails)
        with self.assertRaisesRegex(ValueError, "filter must return 1 True or False"):
            self.scene.intersect(*UP, filter=lambda rays, hits: [1.5])
        self.assertTrue(self.scene.intersect(*UP).hit)

    def test_wrong_arguments(self):
        for limits, error in (({"after": 3}, "after must be overcast.Hits"),
                              ({"masks": [1, 2]}, "masks must go with rays of shape"),
                              ({"masks": -1}, "masks must be whole numbers"),
                              ({"filter": 3}, "filter must be a function")):
            with self.assertRaisesRegex((TypeError, ValueError), error):
                self.scene.intersect(*UP, **limits)

    def test_behind_a_miss_there_is_nothing(self):
        miss = self.scene.intersect([0, 0, 0], [0, 0, -1])
        self.assertEqual(float(miss.t), math.inf)
        self.assertFalse(self.scene.intersect(*UP, after=miss).hit)


if __name__ == "__main__":
    unittest.main()
