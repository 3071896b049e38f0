# SPDX-License-Identifier: Apache-2.0
"""Scenes, which take meshes, are committed, and then answer rays."""

from __future__ import annotations

import ctypes
import math
import mmap
import os
import secrets
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _abi
from ._arrays import choice, count, numbers
from ._calls import Progress, Writer
from ._library import BoundToProcess, Handle, api, check
from ._mesh import address, mesh_of, transform_of
from ._query import Limits, Query
from ._rays import as_rays, rays
from .device import Device, default_device
from .hits import HIT, Hits

if sys.version_info >= (3, 11):
    from typing import Unpack
elif TYPE_CHECKING:
    from typing_extensions import Unpack


class Scene(BoundToProcess):
    """Triangles that rays are traced against: add() meshes, commit(), intersect() and occluded().

    device: the device that traces; None: the first GPU, else the software renderer, shared by all
        scenes of this process that name none.
    gpu_memory: bytes that pages, rays and answers may take on the device together; 0: the device's
        free memory, less headroom. Larger scenes are traced in parts. A budget too small for any
        part raises an Error that names the smallest that works.
    precision: "certified": the answers of exact arithmetic, rounded once; "fast": float32 chooses
        the triangle, and near sides and ties another than the nearest may be named, or none.
    leaf_triangles, leaves: the max number of triangles in a part of the scene, or instead about how
        many parts there are; 0: as suits the budget.
    kernel: "auto", "fragment" or "compute".
    saved: a file that save() wrote of a scene with the same meshes; commit() then need not build.

    A scene is closed when nobody refers to it any more, at the end of a `with` block, or by
    close().
    """

    def __init__(self, device: Device | None = None, *, gpu_memory: int = 0,
                 precision: str = "certified", leaf_triangles: int = 0, leaves: int = 0,
                 kernel: str = "auto", saved: str | os.PathLike[str] | None = None) -> None:
        self._progress = Progress()
        # The library reads these until the scene is destroyed.
        self._kept: list[object] = [self._progress]
        config = _abi.ovc_scene_config(
            gpu_memory_bytes=count("gpu_memory", gpu_memory),
            leaf_triangles=count("leaf_triangles", leaf_triangles),
            leaves=count("leaves", leaves, 2**32 - 1),
            precision=choice("precision", precision, ("certified", "fast")),
            kernel=choice("kernel", kernel, ("auto", "fragment", "compute")),
            progress=self._progress.function)
        if saved is not None:
            mapped = _mapped(saved)
            self._kept.append(mapped)
            config.saved, config.saved_bytes = mapped.ctypes.data, mapped.size
        if device is not None and not isinstance(device, Device):
            raise TypeError(f"device must be an overcast.Device, not {type(device).__name__}")
        self._device = device or default_device()
        self._meshes: dict[int, _Form] = {}
        handle = ctypes.c_void_p()
        with self._device._handle.use() as device_handle:
            self._device_handle = device_handle
            check(api().create_scene(device_handle, config, handle), device_handle)
        self._handle = Handle("scene", handle.value, api().destroy_scene, self._device, self._kept)

    def _call(self, function: str, *arguments: object) -> None:
        with self._handle.use() as scene:
            check(getattr(api(), function)(scene, *arguments), self._device_handle)

    def _watch(self, function: str, *arguments: object,
               told: Callable[[float, str], object] | None = None) -> None:
        self._handle.refuse_here()  # before it waits for another call that is watched
        self._progress.watch(lambda: self._call(function, *arguments), told)

    def add(self, vertices: ArrayLike, triangles: ArrayLike | None = None, *,
            transform: ArrayLike | None = None, origin: ArrayLike = (0, 0, 0),
            template: bool = False, shared: bool = False, moves: bool = False,
            mask: int = 0) -> int:
        """Adds a mesh and returns its number: 0, 1, 2, ...

        vertices: (n, 3) real numbers. float32 is kept as it is, all else as float64, in twice the
            memory.
        triangles: (m, 3) whole numbers below n; None: each three vertices are a triangle, and
            vertices may be (m, 3, 3).
        transform: (3, 4) or (4, 4), applied to each vertex after `origin` is added to it, all in
            double precision.
        template: no ray hits the mesh itself; it is there for add_instance().
        shared: the library reads the array in place instead of a copy. The array must be
            C-contiguous, float32 or float64, and without triangles; do not change it until the
            scene is closed, except as update() says.
        moves: move() is to be called on it: the mesh is built by itself from the start, so that the
            first move is as quick as others.
        mask: which rays see the mesh (see overcast.Limits); 0: all.
        """
        flags = (_abi.MESH_SHARED * bool(shared) | _abi.MESH_TEMPLATE * bool(template)
                 | _abi.MESH_MOVES * bool(moves))
        mesh = mesh_of(vertices, triangles, origin, transform, flags)
        mesh.mask = count("mask", mask, 2**32 - 1)
        number = ctypes.c_uint32()
        self._call("add_mesh", mesh, number)
        if shared:
            self._kept.append(mesh)
        self._meshes[number.value] = _Form(
            bool(shared), np.dtype("f4" if mesh.positions else "f8"), tuple(mesh.origin))
        return number.value

    def add_instance(self, mesh: int, transform: ArrayLike | None = None, *,
                     mask: int = 0) -> int:
        """Adds a mesh, or an instance, once more, and returns the new one's number, which is `mesh`
        in its hits.

        transform: (3, 4) or (4, 4), applied to the mesh where it is; to an instance after its own
            transform. All instances share the vertices and pages of their mesh. Instances of small
            meshes, and with transforms that doubles cannot invert well enough, have pages of their
            own.
        mask: which rays see the instance (see overcast.Limits); 0: all.
        """
        matrix = transform_of(transform)
        instance = _abi.ovc_instance(mesh=count("mesh", mesh, 2**32 - 1),
                                     transform=address(matrix),
                                     mask=count("mask", mask, 2**32 - 1))
        number = ctypes.c_uint32()
        self._call("add_instance", instance, number)
        return number.value

    def update(self, mesh: int, vertices: ArrayLike, triangles: ArrayLike | None = None, *,
               first: int = 0) -> None:
        """Gives triangles of a mesh new corners, from triangle `first` on. All its instances
        follow. commit() then brings the scene up to date; until then it takes no rays.

        vertices, triangles: the corners of the triangles that change, in one of the forms of add().
            They are rounded to float32 if the mesh was added in float32. Of a shared mesh: the part
            of the array that the caller has changed, which is where it was.
        """
        number = count("mesh", mesh, 2**32 - 1)
        before = self._meshes.get(number, _Form())
        if not before.shared:
            vertices = np.asarray(numbers("vertices", vertices, 3), before.kind)
        update = mesh_of(vertices, triangles, before.origin, None,
                         _abi.MESH_SHARED * before.shared)
        self._call("update_mesh", number, update, count("first", first, 2**64 - 1))

    def move(self, mesh: int, transform: ArrayLike | None = None) -> None:
        """Replaces the transform of a mesh or an instance. commit() then brings the scene up to
        date; until then it takes no rays."""
        matrix = transform_of(transform)
        self._call("update_instance", count("mesh", mesh, 2**32 - 1), address(matrix))

    def remove(self, mesh: int) -> None:
        """Removes a mesh or an instance. Numbers of others stay; instances of a removed mesh stay
        too. commit() then brings the scene up to date; until then it takes no rays."""
        number = count("mesh", mesh, 2**32 - 1)
        self._call("remove_mesh", number)
        self._meshes.pop(number, None)

    def commit(self, progress: Callable[[float, str], object] | None = None) -> None:
        """Builds the scene, or brings it up to date with what has changed since the last commit.
        Afterwards it takes rays.

        progress(done, stage): called up to fifty times a second, from any thread, with done from 0
        to 1; it may not use the scene. An exception from it ends the commit and is raised here; so
        does Ctrl-C. Afterwards the scene may be committed again.
        """
        self._watch("commit", told=progress)

    def intersect(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = 0.0,
                  t_max: ArrayLike = math.inf, *, out: Hits | None = None,
                  **limits: Unpack[Limits]) -> Hits:
        """Finds the nearest hit of each ray origins + t directions, t_min <= t <= t_max.

        origins, directions: (..., 3) real numbers; t_min, t_max: (...). Each is broadcast: one
            origin serves all directions.
        out: Hits of the rays' shape, for example of an earlier call, which this call overwrites.
        skip, after, masks, filter: which hits count; see overcast.Limits.
        Returns Hits in the rays' shape.
        """
        return self._intersect(rays(origins, directions, t_min, t_max), out, limits)

    def intersect_rays(self, rays: NDArray[np.void], *, out: Hits | None = None,
                       **limits: Unpack[Limits]) -> Hits:
        """intersect() of rays in records (see overcast.rays): nothing is copied."""
        return self._intersect(rays, out, limits)

    def _intersect(self, rays: NDArray[np.void], out: Hits | None, limits: Limits) -> Hits:
        rays = as_rays(rays)
        hits = Hits(np.empty(rays.shape, HIT)) if out is None else out
        answers = getattr(hits, "records", None)
        if (not isinstance(answers, np.ndarray)
                or (answers.dtype, answers.shape) != (HIT, rays.shape)):
            raise ValueError(f"out must be Hits of the rays' shape {rays.shape}, not {out!r}")
        if not answers.view(HIT).flags.carray:
            raise ValueError("out must be Hits whose records are contiguous, aligned and writeable")
        self._trace("intersect", rays, limits, answers)
        return hits

    def occluded(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = 0.0,
                 t_max: ArrayLike = math.inf, **limits: Unpack[Limits]) -> NDArray[np.bool_]:
        """Tells which rays hit anything: True or False for each, in the rays' shape. The arguments
        are those of intersect()."""
        return self._occluded(rays(origins, directions, t_min, t_max), limits)

    def occluded_rays(self, rays: NDArray[np.void], **limits: Unpack[Limits]) -> NDArray[np.bool_]:
        """occluded() of rays in records (see overcast.rays): nothing is copied."""
        return self._occluded(rays, limits)

    def _occluded(self, rays: NDArray[np.void], limits: Limits) -> NDArray[np.bool_]:
        rays = as_rays(rays)
        answers = np.empty(rays.shape, np.bool_)
        self._trace("occluded", rays, limits, answers)
        return answers

    def all_hits(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = 0.0,
                 t_max: ArrayLike = math.inf, *, max_hits: int | None = None,
                 **limits: Unpack[Limits]) -> tuple[Hits, NDArray[np.uint64]]:
        """Finds the hits of each ray, in the order of t, mesh and prim.

        max_hits: how many of a ray are returned; None: as many as the ray with the most has, for
            which rays may be traced, and a filter asked, a second time.
        All else is as in intersect().
        Returns Hits of shape (..., max_hits), with misses where a ray has fewer, and how many hits
        each ray has in all.
        """
        return self._all_hits(rays(origins, directions, t_min, t_max), max_hits, limits)

    def all_hits_of_rays(self, rays: NDArray[np.void], *, max_hits: int | None = None,
                         **limits: Unpack[Limits]) -> tuple[Hits, NDArray[np.uint64]]:
        """all_hits() of rays in records (see overcast.rays): nothing is copied."""
        return self._all_hits(rays, max_hits, limits)

    def _all_hits(self, rays: NDArray[np.void], max_hits: int | None,
                  limits: Limits) -> tuple[Hits, NDArray[np.uint64]]:
        rays = as_rays(rays)
        counts = np.zeros(rays.shape, np.uint64)

        def find(most: int) -> Hits:
            hits = Hits(np.empty((*rays.shape, most), HIT))
            self._trace("all_hits", rays, limits, most, hits.records, counts)
            return hits
        if max_hits is not None:
            most = sys.maxsize // (HIT.itemsize * max(rays.size, 1))
            return find(count("max_hits", max_hits, most)), counts
        hits = find(_FIRST_HITS)
        most = int(counts.max(initial=0))
        return (hits[..., :most] if most <= _FIRST_HITS else find(most)), counts

    def _trace(self, function: str, rays: NDArray[np.void], limits: Limits,
               *answers: int | NDArray[Any]) -> None:
        query = Query(rays, limits)

        def call() -> None:  # It keeps the arrays alive that the library reads and writes.
            places = (answer if isinstance(answer, int) else answer.ctypes.data
                      for answer in answers)
            with query.raising():
                self._call(function, rays.ctypes.data, rays.size, *places, query.struct)
        if rays.size < _WORTH_WATCHING:
            call()
        else:
            progress = Progress()
            query.struct.progress = progress.function
            progress.watch(call)

    def plan(self) -> dict[str, int | float]:
        """Forecasts what commit() would build of the meshes added so far, without building it:
        leaves, bytes, the smallest budget that works, whether it fits. ovc_plan of the C header
        says what each number is."""
        plan = _abi.ovc_plan()
        self._watch("plan", plan)
        return _as_dict(plan)

    def statistics(self) -> dict[str, int | float]:
        """Returns what commit() built and what all rays since have cost: triangles, bytes, passes,
        seconds. ovc_statistics of the C header says what each number is."""
        statistics = _abi.ovc_statistics()
        self._call("statistics", statistics)
        return _as_dict(statistics)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes what commit() has built to a file, for Scene(saved=path) with the same meshes.
        Replaces an existing file only when all is written; a device or a pipe is written to."""
        target = os.path.realpath(os.fsdecode(path))  # a link stays one
        if os.path.exists(target) and not os.path.isfile(target):
            with open(target, "wb") as file:
                self._save_into(file)
            return
        unfinished = os.path.join(os.path.dirname(target), f".{secrets.token_hex(8)}.unfinished")
        try:
            with open(unfinished, "xb") as file:
                self._save_into(file)
            os.replace(unfinished, target)
        finally:
            if os.path.exists(unfinished):
                os.remove(unfinished)

    def _save_into(self, file: BinaryIO) -> None:
        writer = Writer(file)
        with writer.raising():
            self._call("save", writer.function, None)

    def purge(self) -> None:
        """Gives the GPU memory back, all of it, until rays are traced again."""
        self._call("purge")

    def close(self) -> None:
        """Frees all that the scene holds; waits for a call that is still running. A closed scene
        answers no more calls."""
        self._handle.close()

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


_WORTH_WATCHING = 100_000
"""In rays. Smaller batches end before anyone could press Ctrl-C, and starting a thread to watch for
it would take noticeably long."""

_FIRST_HITS = 8
"""For all_hits() without max_hits, which asks again where a ray has more."""


class _Form(NamedTuple):
    """What update() must know of a mesh: how add() took it."""

    shared: bool = False
    kind: np.dtype[Any] = np.dtype("f8")
    origin: tuple[float, ...] = (0.0, 0.0, 0.0)


def _mapped(path: str | os.PathLike[str]) -> NDArray[np.uint8]:
    """Returns the bytes of a file. An empty one, which cannot be mapped, has a zero: to the library
    that is damage like any other."""
    if os.path.getsize(path):
        return np.memmap(path, mode="r")
    return np.frombuffer(mmap.mmap(-1, 1), np.uint8)


def _as_dict(struct: ctypes.Structure) -> dict[str, int | float]:
    return {name: getattr(struct, name) for name, *_ in struct._fields_
            if name not in ("struct_size", "reserved")}
