# SPDX-License-Identifier: Apache-2.0
"""Hands vertices, triangles and transforms to the library, in place where possible."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _abi
from ._arrays import as_uint32, numbers


def mesh_of(vertices: ArrayLike, triangles: ArrayLike | None, origin: ArrayLike,
            transform: ArrayLike | None, flags: int) -> _abi.ovc_mesh:
    """Returns the struct for add_mesh. Its `arrays` keep the memory that it points to alive."""
    corners = corners_of(vertices, triangles is None, shared=bool(flags & _abi.MESH_SHARED))
    shift = numbers("origin", origin, 3)
    if shift.ndim != 1:
        raise ValueError(f"origin must be of shape (3,), not {shift.shape}")
    mesh = _abi.ovc_mesh(vertex_count=len(corners), origin=tuple(map(float, shift)), flags=flags,
                         stride=corners.strides[0] if len(corners) > 1 else 0)
    setattr(mesh, "positions" if corners.dtype == np.float32 else "positions_double",
            corners.ctypes.data)
    mesh.arrays = [corners, transform_of(transform)]
    mesh.transform = address(mesh.arrays[1])
    if triangles is not None:
        indices = as_uint32("triangles", triangles, 3)
        if indices.ndim != 2:
            raise ValueError(f"triangles must be of shape (m, 3), not {indices.shape}")
        mesh.indices, mesh.triangle_count = indices.ctypes.data, len(indices)
        mesh.arrays.append(indices)
    return mesh


def corners_of(vertices: ArrayLike, are_triangles: bool, shared: bool) -> NDArray[Any]:
    """Returns (n, 3) numbers of float32 or float64, with rows at any distance: the caller's own
    array where it has that form, else a copy. Raises ValueError where `shared` forbids a copy."""
    corners = numbers("vertices", vertices, 3)
    if are_triangles and corners.ndim == 3 and corners.shape[1] == 3:
        corners = corners.reshape(-1, 3)
    if corners.ndim != 2:
        raise ValueError(f"vertices must be of shape (n, 3), not {corners.shape}")
    in_place = (corners.dtype in (np.float32, np.float64) and corners.flags.c_contiguous
                and corners.flags.aligned)
    if shared and not (are_triangles and in_place):
        raise ValueError("a shared mesh needs C-contiguous float32 or float64 vertices "
                         "and no triangles")
    size = 4 if corners.dtype in (np.float32, np.float16) else 8
    corners = np.require(corners, np.dtype(f"f{size}"), ["A"])
    rows_lie_well = (corners.strides[1] == size and corners.strides[0] >= 3 * size
                     and corners.strides[0] % size == 0)
    return corners if rows_lie_well or not corners.size else np.ascontiguousarray(corners)


def transform_of(transform: ArrayLike | None) -> NDArray[np.float64] | None:
    """Returns the matrix as twelve doubles, three rows of four; None for None."""
    if transform is None:
        return None
    matrix = numbers("transform", transform)
    if matrix.shape == (4, 4) and np.array_equal(matrix[3], (0, 0, 0, 1)):
        matrix = matrix[:3]
    if matrix.shape != (3, 4):
        raise ValueError("transform must be of shape (3, 4), or (4, 4) with the last row 0 0 0 1, "
                         + (f"not {matrix[3]}" if matrix.shape == (4, 4)
                            else f"not {matrix.shape}"))
    return np.ascontiguousarray(matrix, np.float64)


def address(array: NDArray[Any] | None) -> int | None:
    return None if array is None else array.ctypes.data
