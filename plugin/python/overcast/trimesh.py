# SPDX-License-Identifier: Apache-2.0
"""A ray engine for trimesh:

    import overcast.trimesh

    mesh.ray = overcast.trimesh.RayMeshIntersector(mesh)
    mesh.ray.intersects_location(origins, directions)

It has the interface of trimesh's own engines. Rays and vertices are the doubles that they are: no
scaling to a box, no offsets, no tolerances. A ray that starts on a triangle hits it, at t = 0.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .device import Device
from .hits import Hits
from .scene import Scene

_MAX_DIRECTIONS = 8
"""That contains_points() tries for a point, until one meets no side of a triangle."""


class RayMeshIntersector:
    """Rays against a mesh with `vertices` (n, 3) and `faces` (m, 3), such as trimesh.Trimesh.

    The scene is built at the first query, and again where the mesh has changed since.

    geometry: the mesh. scale_to_box: is there for trimesh, and changes nothing. device: as in
    overcast.Scene.
    """

    def __init__(self, geometry: Any, scale_to_box: bool = True,
                 device: Device | None = None) -> None:
        self.mesh = geometry
        self._scale_to_box = scale_to_box
        self._device = device
        self._scene: Scene | None = None
        self._built_of: object = None

    def intersects_id(self, ray_origins: ArrayLike, ray_directions: ArrayLike,
                      multiple_hits: bool = True, max_hits: int | None = None,
                      return_locations: bool = False) -> tuple[NDArray[Any], ...]:
        """Returns the triangle (m,) and the ray (m,) of each hit, by ray and then along it; with
        return_locations also where it is, (m, 3).

        A ray that meets several triangles in one point, at a side or a corner, hits the first of
        them there. multiple_hits: all hits of a ray, not only the nearest. max_hits: of a ray at
        most; None: any number.
        """
        origins, directions = _pair(ray_origins, ray_directions)
        if multiple_hits:
            hits, _ = self._committed().all_hits(origins, directions)
        else:
            hits = self._committed().intersect(origins, directions)[:, None]
        counts = _first_of_each_point(hits)
        if max_hits is not None:
            counts &= np.cumsum(counts, axis=1) <= max_hits
        index_ray, place = np.nonzero(counts)
        index_tri = hits.prim[index_ray, place].astype(np.int64)
        if not return_locations:
            return index_tri, index_ray
        t = hits.t[index_ray, place]
        return index_tri, index_ray, origins[index_ray] + t[:, None] * directions[index_ray]

    def intersects_location(self, ray_origins: ArrayLike, ray_directions: ArrayLike,
                            multiple_hits: bool = True) -> tuple[NDArray[Any], ...]:
        """Returns where each hit is, (m, 3), its ray (m,) and its triangle (m,), as
        intersects_id() finds them."""
        index_tri, index_ray, locations = self.intersects_id(
            ray_origins, ray_directions, multiple_hits=multiple_hits, return_locations=True)
        return locations, index_ray, index_tri

    def intersects_first(self, ray_origins: ArrayLike,
                         ray_directions: ArrayLike) -> NDArray[np.int64]:
        """Returns the triangle that each ray hits first, (n,); -1: none."""
        hits = self._committed().intersect(*_pair(ray_origins, ray_directions))
        return np.where(hits.hit, hits.prim.astype(np.int64), -1)

    def intersects_any(self, ray_origins: ArrayLike,
                       ray_directions: ArrayLike) -> NDArray[np.bool_]:
        """Returns whether each ray hits anything, (n,)."""
        return self._committed().occluded(*_pair(ray_origins, ray_directions))

    def contains_points(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Returns whether each of the points (n, 3) is inside the mesh, (n,): a ray from it and the
        one the other way both hit the mesh an odd number of times. It is undefined for points on
        the mesh.

        Where the rays meet a side or a corner of a triangle, which counts for two, or disagree, as
        they may where the mesh has holes, others are tried.
        """
        points = np.asarray(points, np.float64)
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError(f"points must be of shape (n, 3), not {points.shape}")
        contains = np.zeros(len(points), np.bool_)
        left = np.arange(len(points))
        random = np.random.default_rng(1)
        for _ in range(_MAX_DIRECTIONS):
            if not len(left):
                break
            direction = random.normal(size=3)
            directions = np.stack([direction, -direction])[:, None]
            hits, counts = self._committed().all_hits(points[left], directions)
            odd = counts % 2 == 1
            clear = (odd[0] == odd[1]) & ~_meet_sides(hits).any(axis=(0, 2))
            contains[left[clear]] = odd[0][clear]
            left = left[~clear]
        return contains

    def _committed(self) -> Scene:
        key = hash(self.mesh)
        if self._scene is None or self._built_of != key:
            scene = Scene(self._device)
            scene.add(np.asarray(self.mesh.vertices), np.asarray(self.mesh.faces))
            scene.commit()
            self._scene, self._built_of = scene, key
        return self._scene

    def __getstate__(self) -> dict[str, object]:
        return {**self.__dict__, "_scene": None, "_device": None}

    def __copy__(self) -> RayMeshIntersector:
        return RayMeshIntersector(self.mesh, self._scale_to_box, self._device)

    def __deepcopy__(self, _: object) -> RayMeshIntersector:
        return self.__copy__()


def _pair(ray_origins: ArrayLike,
          ray_directions: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    origins = np.asarray(ray_origins, np.float64)
    directions = np.asarray(ray_directions, np.float64)
    if origins.shape != directions.shape or origins.ndim != 2 or origins.shape[1] != 3:
        raise ValueError("ray_origins and ray_directions must be of the same shape (n, 3), not "
                         f"{origins.shape} and {directions.shape}")
    return origins, directions


def _first_of_each_point(hits: Hits) -> NDArray[np.bool_]:
    """Returns True for hits, (n, m) of n rays, that do not lie in the same point as the one before
    them."""
    first: NDArray[np.bool_] = hits.hit.copy()
    first[:, 1:] &= hits.t[:, 1:] != hits.t[:, :-1]
    return first


def _meet_sides(hits: Hits) -> NDArray[np.bool_]:
    """Returns True for hits on a side or a corner of their triangles."""
    sides: NDArray[np.bool_] = hits.hit & ((hits.u <= 0) | (hits.v <= 0) | (hits.u + hits.v >= 1))
    return sides
