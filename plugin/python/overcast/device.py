# SPDX-License-Identifier: Apache-2.0
"""Devices: GPUs, and Mesa's software renderer."""

from __future__ import annotations

import ctypes
import dataclasses
import functools
import logging
import os

from . import _abi
from ._arrays import count as counted
from ._arrays import text
from ._library import BoundToProcess, Handle, api, check

_LOG = logging.getLogger("overcast")
_LOG_LEVELS = (logging.ERROR, logging.WARNING, logging.INFO)


@dataclasses.dataclass(frozen=True)
class DeviceInfo:
    """The properties and limits of a device."""

    renderer: str
    vendor: str
    version: str
    is_software: bool
    max_texture_size: int
    """Texels a side."""
    max_buffer_texels: int
    memory_bytes: int
    """Free GPU memory as the driver reports it; 1 GiB on a software renderer."""
    default_budget_bytes: int
    """The budget of a scene with gpu_memory=0."""
    is_tested: bool
    """Whether all of Overcast's tests have run on a driver of this kind."""

    @classmethod
    def _of(cls, info: _abi.ovc_device_info) -> DeviceInfo:
        renderer, vendor, version = (text.decode(errors="replace")
                                     for text in (info.renderer, info.vendor, info.version))
        return cls(renderer, vendor, version, bool(info.is_software), info.max_texture_size,
                   info.max_buffer_texels, info.memory_bytes, info.default_budget_bytes,
                   bool(info.is_tested))


def devices() -> list[DeviceInfo]:
    """Returns all devices, in the order of their numbers: Device("0") opens the first."""
    count = ctypes.c_uint32()
    check(api().list_devices(None, 0, count))
    infos = (_abi.ovc_device_info * count.value)()
    for info in infos:
        info.struct_size = ctypes.sizeof(info)
    check(api().list_devices(infos, count.value, count))
    return [DeviceInfo._of(info) for info in infos[:count.value]]


def prepare_process() -> None:
    """Lets Mesa's software renderer use vectors of 512 bits where the CPU has them.

    For programs that draw nothing by OpenGL themselves. Sets environment variables of the process
    (LP_NATIVE_VECTOR_WIDTH, and one for Mesa's cache) unless you have set the first; call it before
    the first device or scene, and before other threads. Raises Error afterwards.
    """
    check(api().prepare_process(0))


class Device(BoundToProcess):
    """An open device, with a thread of its own: your OpenGL context is left alone.

    name: a number as listed by devices(), or a part of the renderer's name in any case; None: the
    first GPU, else the software renderer. Raises Error where there is none.

    gpu_memory: bytes that all scenes on the device may use together; 0: each has a budget of its
    own. Scenes that have not been used for long make room for others.
    threads: on at most so many threads the library computes, and on as many cores a software
    renderer; 0: on all.
    """

    def __init__(self, name: str | int | None = None, *, gpu_memory: int = 0,
                 threads: int = 0) -> None:
        config = _abi.ovc_device_config(
            name=None if name is None else text("name", name), log=_log,
            gpu_memory_bytes=counted("gpu_memory", gpu_memory),
            threads=counted("threads", threads, most=2**32 - 1))
        handle = ctypes.c_void_p()
        check(api().create_device(config, handle))
        self._handle = Handle("device", handle.value, api().destroy_device)

    @property
    def info(self) -> DeviceInfo:
        """The device's properties and limits."""
        info = _abi.ovc_device_info()
        with self._handle.use() as handle:
            check(api().describe_device(handle, info), handle)
        return DeviceInfo._of(info)

    def __repr__(self) -> str:
        return f"<overcast.Device {self.info.renderer!r}>"


def _to_logging(_user: int, level: int, message: bytes) -> None:
    _LOG.log(_LOG_LEVELS[level], "%s", message.decode(errors="replace"))


_log = _abi.LogFunction(_to_logging)


def default_device() -> Device:
    """Returns the device of scenes that name none. The first such scene of a process opens it."""
    return _device_of_process(os.getpid())


@functools.cache
def _device_of_process(_process: int) -> Device:
    return Device()
