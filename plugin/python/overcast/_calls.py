# SPDX-License-Identifier: Apache-2.0
"""Lets the library call Python functions, and Ctrl-C end calls of the library."""

from __future__ import annotations

import concurrent.futures
import contextlib
import ctypes
import threading
from collections.abc import Callable, Iterator
from typing import BinaryIO

from . import _abi
from ._library import Error, Result, called_back


class Raised:
    """Carries an exception across the library: a Python function that the library called raised it,
    the library's call ends because of it, and that call raises it in turn."""

    def __init__(self) -> None:
        self.error: BaseException | None = None

    def run(self, function: Callable[[], object]) -> int:
        """Calls the function; returns 0, or 1 where it raised and the library must stop."""
        called_back.now = True
        try:
            function()
        except BaseException as error:  # because no exception may pass through C
            self.error = error
        finally:
            called_back.now = False
        return int(self.error is not None)

    @contextlib.contextmanager
    def raising(self) -> Iterator[None]:
        """A context for the library's call: replaces the library's error, that the call was
        cancelled, by the exception that made run() cancel it."""
        self.error = None
        try:
            yield
        except Error as stopped:
            if stopped.code != Result.CANCELLED or self.error is None:
                raise
            raise self.error from None


class Progress:
    """A function for ovc_scene_config.progress and ovc_query.progress."""

    def __init__(self) -> None:
        self._told: Callable[[float, str], object] | None = None
        raised = self._raised = Raised()

        def tell(_user: int, done: float, stage: bytes) -> int:
            return raised.run(lambda: self._told
                              and self._told(done, stage.decode(errors="replace")))

        self.function = _abi.ProgressFunction(tell)

    def watch(self, call: Callable[[], object],
              told: Callable[[float, str], object] | None = None) -> None:
        """Runs a call of the library, which calls told(done, stage); Ctrl-C stops it.

        Python delivers Ctrl-C only to the main thread, and not while that is in C. A call from the
        main thread therefore runs on a second thread, while the main thread waits.
        """
        self._told = told
        with self._raised.raising():
            if threading.current_thread() is not threading.main_thread():
                call()
                return
            outcome: concurrent.futures.Future[None] = concurrent.futures.Future()
            threading.Thread(target=_run, args=(call, outcome)).start()
            try:
                outcome.result()
            except KeyboardInterrupt as interrupt:
                self._raised.error = interrupt
                concurrent.futures.wait([outcome])
                raise


def _run(call: Callable[[], object], outcome: concurrent.futures.Future[None]) -> None:
    try:
        call()
        outcome.set_result(None)
    except BaseException as error:
        outcome.set_exception(error)


class Writer:
    """An ovc_write_function that writes to a file."""

    def __init__(self, file: BinaryIO) -> None:
        raised = self._raised = Raised()

        def write(_user: int, data: int, size: int) -> int:
            return raised.run(
                lambda: file.write(memoryview((ctypes.c_char * size).from_address(data))))

        self.function = _abi.WriteFunction(write)
        self.raising = raised.raising
