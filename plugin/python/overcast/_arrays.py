# SPDX-License-Identifier: Apache-2.0
"""Checks arguments that callers hand over as arrays: a wrong type or shape raises an exception with
one sentence that names the argument."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def numbers(name: str, value: ArrayLike, columns: int = 0, kinds: str = "fiu") -> NDArray[Any]:
    """Returns the value as an array of real numbers, without a copy where it is one already.

    columns: the shape must be (..., columns); 0: any shape. kinds: the kinds of numbers, as NumPy
    names them, that are allowed. Raises TypeError or ValueError.
    """
    expected = ("whole numbers" if "f" not in kinds
                else "real numbers") + (f" of shape (..., {columns})" if columns else "")
    try:
        array = np.asarray(value)
    except ValueError:
        raise ValueError(f"{name} must be {expected}, not rows of different lengths") from None
    if array.dtype.kind not in kinds and array.size:
        raise TypeError(f"{name} must be {expected}, not {array.dtype}")
    if columns and array.shape == (0,):  # an empty list has no columns
        array = array.reshape(0, columns)
    if columns and array.shape[-1:] != (columns,):
        raise ValueError(f"{name} must be {expected}, not of shape {array.shape}")
    return array


def as_uint32(name: str, value: ArrayLike, columns: int) -> NDArray[np.uint32]:
    """Returns the value, (..., columns) whole numbers, as a C-contiguous array of 32 bits, without
    a copy where it is one already. Raises ValueError for numbers that do not fit."""
    array = numbers(name, value, columns, "iu")
    if array.dtype != np.uint32 and array.size and (array.min() < 0 or array.max() > 0xFFFFFFFF):
        wrong = array.min() if array.min() < 0 else array.max()
        raise ValueError(f"{name} must be whole numbers from 0 to 4294967295, not {wrong}")
    return np.require(array, np.uint32, ["C", "A"])


def count(name: str, value: int, most: int = 2**64 - 1) -> int:
    """Returns the value, which must be a whole number from 0 to `most`."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {type(value).__name__}") from None
    if not 0 <= number <= most:
        raise ValueError(f"{name} must be from 0 to {most}, not {number}")
    return number


def text(name: str, value: str | int) -> bytes:
    """Returns the value, text or a whole number, as the library takes it."""
    try:
        as_text = value if isinstance(value, str) else str(operator.index(value))
    except TypeError:
        raise TypeError(f"{name} must be text or a whole number, "
                        f"not {type(value).__name__}") from None
    if "\0" in as_text:
        raise ValueError(f"{name} must be without NUL, not {as_text!r}")
    return as_text.encode(errors="replace")


def choice(name: str, value: str, choices: tuple[str, ...]) -> int:
    """Returns the value's place among the choices."""
    if value not in choices:
        raise ValueError(f"{name} must be {' or '.join(map(repr, choices))}, not {value!r}")
    return choices.index(value)
