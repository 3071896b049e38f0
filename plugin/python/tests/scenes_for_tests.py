# SPDX-License-Identifier: Apache-2.0
"""Soups and rays for the tests, and a brute-force tracer in NumPy, in double precision."""

import unittest

import numpy as np

import overcast


def skip_without_device():
    """Skips a module's tests where there is no device; the modules call it as setUpModule."""
    try:
        overcast.Scene().close()
    except overcast.Error as error:
        if error.code == overcast.Result.NO_DEVICE:
            raise unittest.SkipTest(str(error)) from None
        raise


def soup(seed, triangles, size=0.1):
    """Returns the corners (triangles, 3, 3), float32, of small triangles around points of the unit
    cube."""
    random = np.random.default_rng(seed)
    centres = random.random((triangles, 1, 3))
    return (centres + size * random.normal(size=(triangles, 3, 3))).astype(np.float32)


def rays_at_unit_cube(seed, count):
    """Returns origins and directions, (count, 3) each, from around the cube to points within it."""
    random = np.random.default_rng(seed)
    origins = 0.5 + 3 * random.normal(size=(count, 3))
    return origins, random.random((count, 3)) - origins


def brute_force(corners, origins, directions, t_min=0.0, t_max=np.inf):
    """Returns t, u, v and the triangle of each ray's nearest hit, (count) each: inf, 0, 0, NONE for
    a miss.

    Source: Moeller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997.
    """
    a, b, c = np.moveaxis(corners.astype(np.float64), 1, 0)
    answers = np.empty((4, len(origins)))
    for i, (origin, direction) in enumerate(zip(origins, directions)):
        p = np.cross(direction, c - a)
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = 1 / np.einsum("ij,ij->i", b - a, p)
            u = scale * ((origin - a) * p).sum(axis=1)
            q = np.cross(origin - a, b - a)
            v, t = scale * (q @ direction), scale * ((c - a) * q).sum(axis=1)
            t[~((u >= 0) & (v >= 0) & (u + v <= 1) & (t >= t_min) & (t <= t_max))] = np.inf
        nearest = np.argmin(t)
        hit = t[nearest], u[nearest], v[nearest], nearest
        answers[:, i] = hit if np.isfinite(t[nearest]) else (np.inf, 0, 0, overcast.NONE)
    return answers[0], answers[1], answers[2], answers[3].astype(np.uint32)
