# SPDX-License-Identifier: Apache-2.0
"""Overcast finds where rays hit triangles, in scenes larger than the GPU's memory.

    import numpy as np
    import overcast

    scene = overcast.Scene(gpu_memory=256 << 20)   # bytes of GPU memory, never more
    scene.add(vertices, triangles)                 # (n, 3) numbers, (m, 3) indices
    scene.commit()                                 # builds; from now on the scene takes rays

    hits = scene.intersect(origins, directions)    # (..., 3) each, say (3,) and (480, 640, 3)
    hits.hit                                       # True where something was hit, here (480, 640)
    hits.t, hits.u, hits.v, hits.mesh, hits.prim   # distance, where in which triangle and mesh

    points = origins + hits.t[..., None] * directions
    shadow = scene.occluded(points, light - points, t_max=1, skip=hits)

A ray is the points origin + t direction, t_min <= t <= t_max. Directions need not be of unit
length: t counts in their lengths. Answers are those of exact arithmetic on the doubles given, with
t, u and v rounded once to the nearest double: the same bits on any GPU and on Mesa's software
renderer, which serves where there is none.

The library reads arrays in place where it can: float32 vertices and uint32 indices, and rays in
records (see `rays`). It writes answers into NumPy arrays in place. A call releases Python's lock
while it computes; calls on one scene wait their turn. A wrong argument raises TypeError or
ValueError where this module sees it, and otherwise `Error` with the library's sentence. The library
logs warnings and information to logging's logger "overcast".
"""

from ._abi import NONE
from ._built import VERSION as __version__
from ._library import Error, Result
from ._query import Limits
from ._rays import RAY, RAY_FLOAT, rays
from .device import Device, DeviceInfo, devices, prepare_process
from .hits import HIT, Hits
from .scene import Scene

__all__ = ["Scene", "Hits", "Limits", "rays", "Device", "DeviceInfo", "devices", "prepare_process",
           "Error", "Result", "RAY", "RAY_FLOAT", "HIT", "NONE"]
