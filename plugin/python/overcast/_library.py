# SPDX-License-Identifier: Apache-2.0
"""Finds libovercast.so, loads it once, and turns its codes into exceptions."""

from __future__ import annotations

import contextlib
import ctypes
import enum
import functools
import os
import pathlib
import threading
import weakref
from collections.abc import Callable, Iterator
from typing import NoReturn

from . import _abi
from ._built import LIBRARY_FOLDER

SONAME = f"libovercast.so.{_abi.ABI_VERSION}"


class Result(enum.IntEnum):
    """What went wrong: ovc_result of the C header."""

    INVALID_ARGUMENT = 1
    INVALID_STATE = 2
    NO_DEVICE = 3
    OUT_OF_BUDGET = 4
    OUT_OF_MEMORY = 5
    DEVICE_LOST = 6
    INTERNAL = 7
    CANCELLED = 8
    UNREADABLE = 9


class Error(Exception):
    """A call that failed: str() is the library's sentence, `code` its Result, or None where this
    module found the error, for example because it could not load the library."""

    def __init__(self, sentence: str, code: Result | None = None) -> None:
        super().__init__(sentence)
        self.code = code


def _path() -> str:
    """Returns the file that OVC_PLUGIN names; else the one built or installed with this module;
    else the name that the system's loader looks for."""
    if named := os.environ.get("OVC_PLUGIN"):
        return named
    ours = pathlib.Path(__file__).resolve().parent / LIBRARY_FOLDER / SONAME
    return str(ours) if ours.exists() else SONAME


@functools.cache
def api() -> _abi.ovc_api:
    """Returns the library's table. The first call loads the library, which is never unloaded."""
    path = _path()
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise Error(f"cannot load the library: {error}; "
                    "the environment variable OVC_PLUGIN may name its file") from None
    try:
        get_api = library.ovc_get_api
    except AttributeError:
        raise Error(f"'{path}' is not Overcast's library: it has no ovc_get_api") from None
    get_api.restype = ctypes.POINTER(_abi.ovc_api)
    get_api.argtypes = [ctypes.c_uint32]
    table = get_api(_abi.ABI_VERSION)
    if not table:
        raise Error(f"the library '{path}' does not speak "
                    f"version {_abi.ABI_VERSION} of the interface")
    if table.contents.struct_size < ctypes.sizeof(_abi.ovc_api):
        raise Error(f"the library '{path}' is older than this module: "
                    f"its table has {table.contents.struct_size} bytes, "
                    f"{ctypes.sizeof(_abi.ovc_api)} are needed")
    contents: _abi.ovc_api = table.contents
    return contents


def check(result: int, device: int | None = None) -> None:
    """Raises Error with the library's sentence where a call's result is not OVC_OK.

    device: the handle on which this thread has just made the call; None: a call without a device.
    """
    if result:
        sentence = api().last_error(device).decode(errors="replace")
        raise Error(sentence or f"the library failed with code {result}", Result(result))


def is_called_back() -> bool:
    """Tells whether the library is calling a Python function on this thread. It then refuses all
    calls because of that, but this one otherwise because of its arguments."""
    return bool(api().list_devices(None, 0, None) == Result.INVALID_STATE)


class BoundToProcess:
    """The base of what opens a handle, which is good for nothing in another process."""

    def __reduce__(self) -> NoReturn:
        what = type(self).__name__.lower()
        raise TypeError(f"a {what} is neither pickled nor copied; "
                        "open one in the process that uses it")


class Handle:
    """Owns a device or a scene of the library, and destroys it once: in close(), when nobody refers
    to the handle any more, or at the end of the program. `kept_alive` live until then."""

    def __init__(self, what: str, value: int | None, destroy: Callable[[int | None], None],
                 *kept_alive: object) -> None:
        self._what = what
        self._value = value
        self._process = os.getpid()
        self._turn = threading.Lock()
        self._end = weakref.finalize(self, _destroy_here, self._process, destroy, value, kept_alive)

    def refuse_here(self) -> None:
        """Raises Error in a fork, and in a function that the library calls."""
        if self._process != os.getpid():
            raise Error(f"the {self._what} was opened by process {self._process} "
                        "and does not live on in its fork; "
                        "open one in the process that uses it")
        if is_called_back():
            raise Error(f"a function that the library calls may not use the {self._what}: "
                        "the call that it belongs to is still running")

    @contextlib.contextmanager
    def use(self) -> Iterator[int | None]:
        """A context that gives the handle for a call. One call runs at a time, and close() waits
        for it. Raises Error after close(), and as refuse_here() does."""
        self.refuse_here()
        with self._turn:
            if not self._end.alive:
                raise Error(f"the {self._what} is closed")
            yield self._value

    def close(self) -> None:
        if self._process != os.getpid():
            return  # where a thread that the fork lacks may hold the lock
        self.refuse_here()
        with self._turn:
            self._end()


def _destroy_here(process: int, destroy: Callable[[int | None], None], value: int | None,
                  kept_alive: tuple[object, ...]) -> None:
    if process != os.getpid():  # because a fork lacks the library's threads
        return
    if is_called_back():
        # Python collects garbage in any function, and the library destroys nothing in one that it
        # called itself.
        threading.Thread(target=_destroy_here, args=(process, destroy, value, kept_alive)).start()
    else:
        destroy(value)
