# SPDX-License-Identifier: Apache-2.0
"""Rays in records, which the library reads in place."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import numbers

RAY = np.dtype([("origin", "f8", 3), ("t_min", "f8"), ("direction", "f8", 3), ("t_max", "f8")],
               align=True)  # without which NumPy takes records at any address for aligned
"""A ray: 64 bytes, the ovc_ray of the C header."""

RAY_FLOAT = np.dtype([("origin", "f4", 3), ("t_min", "f4"), ("direction", "f4", 3),
                      ("t_max", "f4")], align=True)
"""The same in 32 bytes, the ovc_ray_float of the C header. The library converts its numbers to
doubles, which is exact."""

FORMATS = (RAY, RAY_FLOAT)  # by ovc_ray_format


def rays(origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = 0.0,
         t_max: ArrayLike = math.inf, *, dtype: np.dtype[np.void] = RAY) -> NDArray[np.void]:
    """Makes records of the rays origins + t directions, t_min <= t <= t_max, for intersect_rays and
    occluded_rays.

    origins, directions: (..., 3); t_min, t_max: (...). Each is broadcast, so one origin serves all
        directions.
    dtype: RAY, or RAY_FLOAT, to which numbers are rounded. RAY_FLOAT takes half the bytes, and is
        exact for numbers that are float32 already.

    Returns an array of dtype in the shape that the arguments have together. Calls on records copy
    nothing: make them once, and write to their fields (records["t_max"] = 5) from then on. A
    float32 array (..., 8) of origin, t_min, direction, t_max, as a GPU may hold it, becomes records
    by array.view(overcast.RAY_FLOAT)[..., 0].

    A ray misses if it contains NaN or infinity (though t_max may be infinite), if its direction is
    zero or if t_min > t_max.
    """
    origins, directions = numbers("origins", origins, 3), numbers("directions", directions, 3)
    t_min, t_max = numbers("t_min", t_min), numbers("t_max", t_max)
    shapes = (origins.shape[:-1], directions.shape[:-1], t_min.shape, t_max.shape)
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        raise ValueError("the rays' shapes do not go together: origins {} + (3,), "
                         "directions {} + (3,), t_min {}, t_max {}".format(*shapes)) from None
    if dtype not in FORMATS:
        raise ValueError("dtype must be overcast.RAY or overcast.RAY_FLOAT")
    records = np.empty(shape, dtype)
    records["origin"], records["direction"] = origins, directions
    records["t_min"], records["t_max"] = t_min, t_max
    return records


def as_rays(records: NDArray[np.void]) -> NDArray[np.void]:
    """Returns the same array where it is contiguous and aligned, as the library needs it; else a
    copy. Raises TypeError for anything but records."""
    if not isinstance(records, np.ndarray) or records.dtype not in FORMATS:
        found = (f"an array of {records.dtype}" if isinstance(records, np.ndarray)
                 else type(records).__name__)
        raise TypeError("rays must be an array of overcast.RAY or RAY_FLOAT, "
                        f"as overcast.rays() makes it, not {found}")
    return np.require(records, FORMATS[FORMATS.index(records.dtype)], ["C", "A"])
