# SPDX-License-Identifier: Apache-2.0
"""plugin/overcast.h in ctypes: the structs and the table, name by name. The header says what they
mean."""

from __future__ import annotations

import ctypes as c

from ._built import STATISTICS

ABI_VERSION = 1
NONE = 0xFFFFFFFF
"""The mesh and the prim of a miss."""

WriteFunction = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_void_p, c.c_size_t)
ProgressFunction = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_double, c.c_char_p)
FilterFunction = c.CFUNCTYPE(c.c_int, c.c_void_p, c.c_size_t, c.c_void_p, c.c_void_p, c.c_void_p)
LogFunction = c.CFUNCTYPE(None, c.c_void_p, c.c_int, c.c_char_p)


class Sized(c.Structure):
    """A struct whose first field is its size; all other fields begin as 0."""

    def __init__(self, **values: object) -> None:
        super().__init__(struct_size=c.sizeof(self), **values)


class ovc_device_config(Sized):
    _fields_ = [("struct_size", c.c_size_t), ("name", c.c_char_p), ("log", LogFunction),
                ("log_user", c.c_void_p), ("error", c.c_void_p), ("error_user", c.c_void_p),
                ("gpu_memory_bytes", c.c_uint64), ("threads", c.c_uint32), ("reserved", c.c_uint32)]


class ovc_device_info(Sized):
    _fields_ = [("struct_size", c.c_size_t), ("renderer", c.c_char * 128),
                ("vendor", c.c_char * 64),
                ("version", c.c_char * 128), ("is_software", c.c_uint32),
                ("max_texture_size", c.c_uint32),
                ("max_buffer_texels", c.c_uint64), ("memory_bytes", c.c_uint64),
                ("default_budget_bytes", c.c_uint64),
                ("is_tested", c.c_uint32), ("reserved", c.c_uint32)]


class ovc_scene_config(Sized):
    _fields_ = [("struct_size", c.c_size_t), ("gpu_memory_bytes", c.c_uint64),
                ("leaf_triangles", c.c_uint64),
                ("leaves", c.c_uint32), ("precision", c.c_uint32), ("kernel", c.c_uint32),
                ("structure", c.c_uint32),
                ("level1", c.c_uint32), ("level1_build", c.c_uint32),
                ("progress", ProgressFunction),
                ("progress_user", c.c_void_p), ("tell_active", c.c_uint32),
                ("reserved", c.c_uint32),
                ("saved", c.c_void_p), ("saved_bytes", c.c_uint64),
                ("host_memory_bytes", c.c_uint64), ("read_saved", c.c_void_p),
                ("read_user", c.c_void_p), ("communicator", c.c_int32), ("ranks_own", c.c_uint32),
                ("rank_timeout", c.c_double), ("sample", c.c_void_p), ("sample_rays", c.c_uint64),
                ("kernel_variant", c.c_char_p)]


MESH_SHARED, MESH_TEMPLATE, MESH_MOVES = 1, 2, 4


class ovc_mesh(Sized):
    _fields_ = [("struct_size", c.c_size_t), ("positions", c.c_void_p), ("stride", c.c_size_t),
                ("vertex_count", c.c_uint64), ("indices", c.c_void_p),
                ("triangle_count", c.c_uint64),
                ("origin", c.c_double * 3), ("flags", c.c_uint32), ("reserved", c.c_uint32),
                ("positions_double", c.c_void_p), ("transform", c.c_void_p),
                ("mask", c.c_uint32), ("reserved1", c.c_uint32),
                ("read_corners", c.c_void_p), ("read_user", c.c_void_p),
                ("reads_doubles", c.c_uint32), ("reserved2", c.c_uint32)]


class ovc_instance(Sized):
    _fields_ = [("struct_size", c.c_size_t), ("mesh", c.c_uint32), ("reserved", c.c_uint32),
                ("transform", c.c_void_p), ("mask", c.c_uint32), ("reserved1", c.c_uint32)]


class ovc_query(Sized):
    _fields_ = [("struct_size", c.c_size_t), ("skip", c.c_void_p), ("leaf", c.c_void_p),
                ("passes", c.c_void_p),
                ("flagged", c.c_void_p), ("ray_format", c.c_uint32), ("reserved", c.c_uint32),
                ("progress", ProgressFunction), ("progress_user", c.c_void_p),
                ("after", c.c_void_p), ("masks", c.c_void_p),
                ("filter", FilterFunction), ("filter_user", c.c_void_p)]


class ovc_plan(Sized):
    _fields_ = [("struct_size", c.c_size_t), ("triangles", c.c_uint64), ("hittable", c.c_uint64),
                ("leaves", c.c_uint64), ("leaf_references", c.c_uint64),
                ("level2_bytes", c.c_uint64),
                ("largest_page_bytes", c.c_uint64), ("gpu_budget_bytes", c.c_uint64),
                ("smallest_budget_bytes", c.c_uint64), ("ray_bytes", c.c_uint64),
                ("level1_bytes", c.c_uint64),
                ("pool_bytes", c.c_uint64), ("resident_pages", c.c_uint64),
                ("host_bytes", c.c_uint64),
                ("batch_rays", c.c_uint64), ("fits", c.c_uint32), ("reserved", c.c_uint32),
                ("seconds", c.c_double), ("saved_bytes", c.c_uint64),
                ("smallest_host_bytes", c.c_uint64)]


class ovc_statistics(Sized):
    _fields_ = [("struct_size", c.c_size_t)] + [
        (name, getattr(c, kind)) for name, kind in STATISTICS]


def _call(*arguments: type) -> type:
    return c.CFUNCTYPE(c.c_int, *arguments)


_Handle, _Handles, _Pointer = c.c_void_p, c.POINTER(c.c_void_p), c.c_void_p


class ovc_api(c.Structure):
    """The table, whose functions that this module does not call are bare pointers."""

    _fields_ = [
        ("struct_size", c.c_size_t), ("abi", c.c_uint32), ("version", c.c_uint32),
        ("last_error", c.CFUNCTYPE(c.c_char_p, _Handle)),
        ("list_devices", _call(c.POINTER(ovc_device_info), c.c_uint32, c.POINTER(c.c_uint32))),
        ("create_device", _call(c.POINTER(ovc_device_config), _Handles)),
        ("describe_device", _call(_Handle, c.POINTER(ovc_device_info))),
        ("destroy_device", c.CFUNCTYPE(None, _Handle)),
        ("create_scene", _call(_Handle, c.POINTER(ovc_scene_config), _Handles)),
        ("add_mesh", _call(_Handle, c.POINTER(ovc_mesh), c.POINTER(c.c_uint32))),
        ("commit", _call(_Handle)),
        ("intersect", _call(_Handle, _Pointer, c.c_size_t, _Pointer, c.POINTER(ovc_query))),
        ("occluded", _call(_Handle, _Pointer, c.c_size_t, _Pointer, c.POINTER(ovc_query))),
        ("statistics", _call(_Handle, c.POINTER(ovc_statistics))),
        ("destroy_scene", c.CFUNCTYPE(None, _Handle)),
        ("stream", _Pointer), ("push", _Pointer),
        ("plan", _call(_Handle, c.POINTER(ovc_plan))),
        ("active", _Pointer),
        ("save", _call(_Handle, WriteFunction, c.c_void_p)),
        ("add_instance", _call(_Handle, c.POINTER(ovc_instance), c.POINTER(c.c_uint32))),
        ("purge", _call(_Handle)),
        ("intersect1", _Pointer), ("occluded1", _Pointer),
        ("submit_intersect", _Pointer), ("submit_occluded", _Pointer),
        ("wait", _Pointer), ("poll", _Pointer), ("cancel", _Pointer), ("release", _Pointer),
        ("all_hits", _call(_Handle, _Pointer, c.c_size_t, c.c_size_t, _Pointer, _Pointer,
                           c.POINTER(ovc_query))),
        ("update_mesh", _call(_Handle, c.c_uint32, c.POINTER(ovc_mesh), c.c_uint64)),
        ("update_instance", _call(_Handle, c.c_uint32, _Pointer)),
        ("remove_mesh", _call(_Handle, c.c_uint32)),
        ("save_streamed", _Pointer),
        ("prepare_process", _call(c.c_int)),
        ("plan_streamed", _Pointer),
    ]
