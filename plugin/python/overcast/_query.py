# SPDX-License-Identifier: Apache-2.0
"""Which hits of a call's rays count, as the library takes it: ovc_query."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _abi
from ._arrays import as_uint32
from ._calls import Raised
from ._rays import FORMATS
from .hits import HIT, Hits

Filter = Callable[[NDArray[np.uint64], Hits], ArrayLike]
"""Takes the numbers of rays and a hit of each; returns True for each hit that counts."""


class Limits(TypedDict, total=False):
    """The arguments of Scene's functions that tell which hits count.

    skip: the triangle that each ray starts on and does not see: Hits, or (..., 2) of mesh and prim;
        NONE, NONE: none.
    after: Hits of the rays' shape. Only hits behind these count, in the order of t, mesh and prim;
        so the hits of a ray, those in the same point too, come one after the other. Behind a miss
        there are none.
    masks: (...) whole numbers of 32 bits. A ray sees a mesh where its mask and the mesh's have a
        bit in common, or where one of them is 0.
    filter: filter(rays, hits) is called with the numbers of some rays, counted through their array
        in C order, and the hit that each would be answered with; it returns True for each hit that
        counts. The others are passed by, and the rays go on behind them. It is called from threads
        of the library, and at most once for each hit of a ray; an exception from it ends the call
        and is raised there. It may not use the scene.
    """

    skip: Hits | ArrayLike | None
    after: Hits | None
    masks: ArrayLike | None
    filter: Filter | None


class Query:
    """An ovc_query, and the arrays and functions that it points to."""

    def __init__(self, rays: NDArray[np.void], limits: Limits) -> None:
        for name in limits:
            if name not in Limits.__annotations__:
                raise TypeError(f"there is no argument {name!r}; "
                                "skip, after, masks and filter say which hits count")
        skip, after, masks, filter = (limits.get("skip"), limits.get("after"),
                                      limits.get("masks"), limits.get("filter"))
        self.struct = _abi.ovc_query(ray_format=FORMATS.index(rays.dtype))
        self._kept: list[Any] = []
        self._raised = Raised()
        if skip is not None:
            self.struct.skip = self._keep(names_of(skip, rays.shape))
        if after is not None:
            self.struct.after = self._keep(places_of(after, rays.shape))
        if masks is not None:
            self.struct.masks = self._keep(
                _spread("masks", as_uint32("masks", masks, 0), rays.shape))
        if filter is not None:
            if not callable(filter):
                raise TypeError(f"filter must be a function, not {type(filter).__name__}")
            self.struct.filter = _abi.FilterFunction(_asking(filter, self._raised))
        self.raising = self._raised.raising

    def _keep(self, array: NDArray[Any]) -> int:
        self._kept.append(array)
        return array.ctypes.data


def _asking(filter: Filter, raised: Raised) -> Callable[..., int]:
    def keep(_user: int, count: int, rays: int, hits: int, kept: int) -> int:
        def ask() -> None:
            numbers_of_rays = np.ctypeslib.as_array(
                ctypes.cast(rays, ctypes.POINTER(ctypes.c_uint64)), (count,))
            size = count * HIT.itemsize
            records = np.frombuffer(memoryview((ctypes.c_char * size).from_address(hits)), HIT)
            # Copies, because a filter may keep what it is given, and the library's arrays end.
            answers = np.asarray(filter(numbers_of_rays.copy(), Hits(records.copy())))
            if answers.shape != (count,) or answers.dtype != np.bool_:
                raise ValueError(f"filter must return {count} True or False, not "
                                 f"{answers.dtype} of shape {answers.shape}")
            np.ctypeslib.as_array(ctypes.cast(kept, ctypes.POINTER(ctypes.c_uint8)),
                                  (count,))[:] = answers
        return raised.run(ask)
    return keep


def _spread(name: str, values: NDArray[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    try:
        return np.ascontiguousarray(np.broadcast_to(values, shape))
    except ValueError:
        raise ValueError(f"{name} must go with rays of shape {shape}, "
                         f"not be of shape {values.shape}") from None


def places_of(after: Hits, shape: tuple[int, ...]) -> NDArray[np.void]:
    if not isinstance(after, Hits):
        raise TypeError(f"after must be overcast.Hits, not {type(after).__name__}")
    return np.require(_spread("after", after.records, shape), HIT, ["C", "A"])


def names_of(skip: Hits | ArrayLike, shape: tuple[int, ...]) -> NDArray[np.uint32]:
    """Returns (*shape, 2): the mesh and the prim that each ray skips."""
    names = (np.stack([skip.mesh, skip.prim], axis=-1) if isinstance(skip, Hits)
             else as_uint32("skip", skip, 2))
    try:
        return np.ascontiguousarray(np.broadcast_to(names, (*shape, 2)))
    except ValueError:
        raise ValueError(f"skip names triangles for rays of shape {names.shape[:-1]}, "
                         f"not {shape}") from None
