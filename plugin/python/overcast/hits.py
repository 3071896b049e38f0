# SPDX-License-Identifier: Apache-2.0
"""Hits of rays."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._abi import NONE

HIT = np.dtype([("t", "f8"), ("u", "f8"), ("v", "f8"), ("mesh", "u4"), ("prim", "u4")], align=True)
"""A hit: 32 bytes, the ovc_hit of the C header."""


class Hits:
    """Hits, one for each ray, in the rays' shape; of all_hits() several for each. All fields are
    views of `records`, an array of HIT.

    A hit lies at origin + t direction = (1 - u - v) a + u b + v c, where a, b, c are the corners of
    triangle `prim` of mesh `mesh`. Where hits are equally far, it is the one of the smaller (mesh,
    prim). A miss has t = inf and mesh = prim = NONE. Hits are indexed like arrays: hits[i] are the
    Hits of the rays there.
    """

    __slots__ = ("records",)

    def __init__(self, records: NDArray[np.void]) -> None:
        if getattr(records, "dtype", None) != HIT:
            raise TypeError("records must be an array of overcast.HIT, not "
                            f"{getattr(records, 'dtype', type(records).__name__)}")
        self.records = records

    @property
    def hit(self) -> NDArray[np.bool_]:
        """True where there is a hit."""
        hit: NDArray[np.bool_] = self.records["mesh"] != NONE
        return hit

    @property
    def t(self) -> NDArray[np.float64]:
        """The distance, in lengths of the ray's direction; inf: a miss."""
        return self.records["t"]

    @property
    def u(self) -> NDArray[np.float64]:
        """The weight of the triangle's second corner."""
        return self.records["u"]

    @property
    def v(self) -> NDArray[np.float64]:
        """The weight of the triangle's third corner."""
        return self.records["v"]

    @property
    def mesh(self) -> NDArray[np.uint32]:
        """The number that Scene.add returned; NONE: a miss."""
        return self.records["mesh"]

    @property
    def prim(self) -> NDArray[np.uint32]:
        """The triangle in its mesh; NONE: a miss."""
        return self.records["prim"]

    @property
    def shape(self) -> tuple[int, ...]:
        return self.records.shape

    def __len__(self) -> int:
        return len(self.records)

    def __getitem__(self, index: Any) -> Hits:
        return Hits(self.records[index])

    def __repr__(self) -> str:
        return f"<overcast.Hits of shape {self.shape}, {np.count_nonzero(self.hit)} hit>"
