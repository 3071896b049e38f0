# SPDX-License-Identifier: Apache-2.0
"""Vertices and triangles as the library takes them, where they lie if that can be."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _abi
from ._arrays import as_uint32, numbers


def mesh_of(vertices: ArrayLike, triangles: ArrayLike | None, origin: ArrayLike, shared: bool) -> tuple[_abi.ovc_mesh, object]:
    """The struct for add_mesh, and the array that it points to for as long as the mesh is shared."""
    corners = numbers("vertices", vertices, 3)
    if corners.ndim == 3 and corners.shape[1] == 3 and triangles is None:
        corners = corners.reshape(-1, 3)
    if corners.ndim != 2:
        raise ValueError(f"vertices must be of shape (n, 3), not {corners.shape}")
    shift = numbers("origin", origin, 3).astype(np.float64)
    if shift.ndim != 1:
        raise ValueError(f"origin must be of shape (3,), not {shift.shape}")
    if shared:
        if triangles is not None or corners.dtype != np.float32 or not corners.flags.c_contiguous:
            raise ValueError("a shared mesh needs C-contiguous float32 vertices and no triangles")
    elif corners.dtype != np.float32 or not lies_well(corners):
        corners, shift = rounded(corners, shift)
    mesh = _abi.ovc_mesh(positions=corners.ctypes.data, vertex_count=len(corners), origin=tuple(shift),
                         stride=corners.strides[0] if len(corners) > 1 else 0, flags=_abi.MESH_SHARED if shared else 0)
    mesh.arrays = [corners]  # live as long as the struct
    if triangles is not None:
        indices = as_uint32("triangles", triangles, 3)
        if indices.ndim != 2:
            raise ValueError(f"triangles must be of shape (m, 3), not {indices.shape}")
        mesh.indices, mesh.triangle_count = indices.ctypes.data, len(indices)
        mesh.arrays.append(indices)
    return mesh, corners


def lies_well(corners: NDArray) -> bool:
    """Whether the library can read these float32 corners where they are."""
    return corners.flags.aligned and corners.strides[1] == 4 and corners.strides[0] >= 12 or not corners.size


def rounded(corners: NDArray, shift: NDArray[np.float64]) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """float32 corners, and the origin that is added to them: the middle of the mesh where float32 does not hold it as it is."""
    with np.errstate(over="ignore"):
        exact = np.ascontiguousarray(corners, np.float32)
    finite = corners[np.isfinite(corners).all(axis=-1)].astype(np.float64)
    if not len(finite) or np.array_equal(exact, corners, equal_nan=True):
        return exact, shift
    middle = finite.min(axis=0) / 2 + finite.max(axis=0) / 2
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(corners - middle, np.float32), shift + middle
