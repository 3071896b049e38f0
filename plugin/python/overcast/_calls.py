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
from ._library import Error, Result


class Raised:
    """Carries an exception across the library: a Python function that the library called raised it,
    the library's call ends because of it, and that call raises it in turn."""

    def __init__(self) -> None:
        self.error: BaseException | None = None

    def run(self, function: Callable[[], object]) -> int:
        """Calls the function; returns 0, or 1 where it raised and the library must stop."""
        try:
            function()
        except BaseException as error:  # because no exception may pass through C
            self.error = error
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
        finally:
            self.error = None  # because its frames refer to the scene


class Progress:
    """A function for ovc_scene_config.progress and ovc_query.progress."""

    def __init__(self) -> None:
        self._told: Callable[[float, str], object] | None = None
        self._turn = threading.Lock()
        raised = self._raised = Raised()

        def tell(_user: int, done: float, stage: bytes) -> int:
            return raised.run(lambda: self._told
                              and self._told(done, stage.decode(errors="replace")))

        self.function = _abi.ProgressFunction(tell)

    def watch(self, call: Callable[[], object],
              told: Callable[[float, str], object] | None = None) -> None:
        """Runs a call of the library, which calls told(done, stage); Ctrl-C stops it, and so does
        any exception of a signal's handler. One call is watched at a time.

        Python delivers Ctrl-C only to the main thread, and not while that is in C. A call from the
        main thread therefore runs on a second thread, while the main thread waits.
        """
        with self._turn, self._raised.raising():
            self._told = told
            try:
                if threading.current_thread() is threading.main_thread():
                    self._run_beside(call)
                else:
                    call()
            finally:
                self._told = None  # The scene keeps this object, and the function may keep it.

    def _run_beside(self, call: Callable[[], object]) -> None:
        outcome: concurrent.futures.Future[None] = concurrent.futures.Future()
        try:
            threading.Thread(target=_run, args=(call, outcome)).start()
            concurrent.futures.wait([outcome])
        except BaseException as interrupt:
            self._raised.error = interrupt
            if not outcome.cancel():  # which it does where the call has not begun
                _wait_in_any_case(outcome)
            raise
        outcome.result()


def _wait_in_any_case(outcome: concurrent.futures.Future[None]) -> None:
    """Waits until a call that is to stop has ended, however often Ctrl-C is pressed meanwhile,
    because it writes to the caller's arrays until then."""
    while not outcome.done():
        with contextlib.suppress(BaseException):
            concurrent.futures.wait([outcome])


def _run(call: Callable[[], object], outcome: concurrent.futures.Future[None]) -> None:
    if not outcome.set_running_or_notify_cancel():
        return
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
