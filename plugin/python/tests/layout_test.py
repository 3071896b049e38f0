# SPDX-License-Identifier: Apache-2.0
"""Compares the structs in ctypes and the records in NumPy with the C header, field by field, by
assertions that a C compiler checks."""

import ctypes
import os
import shutil
import subprocess
import unittest

import overcast
from overcast import _abi

COMPILER = os.environ.get("CC", "cc")
RAY_NAMES = {"origin": "org", "direction": "dir"}
RECORDS = {"ovc_ray": (overcast.RAY, RAY_NAMES), "ovc_ray_float": (overcast.RAY_FLOAT, RAY_NAMES),
           "ovc_hit": (overcast.HIT, {})}


def claims():
    """Yields (struct, field, offset, size) of every field that the module knows."""
    structs = [_abi.ovc_api] + _abi.Sized.__subclasses__()
    for struct in structs:
        for name, *_ in struct._fields_:
            field = getattr(struct, name)
            yield struct.__name__, name, field.offset, field.size
    for struct, (dtype, names) in RECORDS.items():
        for name, (field, offset) in dtype.fields.items():
            yield struct, names.get(name, name), offset, field.itemsize


def refused(lines):
    source = '#include "plugin/overcast.h"\n#include <stddef.h>\n' + "\n".join(lines)
    return subprocess.run([COMPILER, "-std=c11", "-fsyntax-only", "-I",
                           os.environ["OVC_SOURCE_DIR"], "-x", "c", "-"],
                          input=source, text=True, capture_output=True).stderr


def assertion(struct, name, offset, size):
    return (f'_Static_assert(offsetof({struct}, {name}) == {offset} && '
            f'sizeof((({struct}*)0)->{name}) == {size}, '
            f'"{struct}.{name} lies elsewhere");')


@unittest.skipUnless(shutil.which(COMPILER), "no C compiler")
class Layout(unittest.TestCase):
    def test_every_field_lies_where_c_has_it(self):
        self.assertEqual(refused(assertion(*claim) for claim in claims()), "")

    def test_a_field_elsewhere_would_be_noticed(self):
        self.assertIn("ovc_mesh.stride lies elsewhere",
                      refused([assertion("ovc_mesh", "stride", 24, 8)]))

    def test_records_have_the_size_of_c(self):
        for struct, (dtype, _) in RECORDS.items():
            claim = f'_Static_assert(sizeof({struct}) == {dtype.itemsize}, "{struct}");'
            self.assertEqual(refused([claim]), "")

    def test_results_are_those_of_c(self):
        for result in overcast.Result:
            claim = f'_Static_assert(OVC_ERROR_{result.name} == {result.value}, "{result.name}");'
            self.assertEqual(refused([claim]), "")

    def test_the_version_is_that_of_c(self):
        major, minor, patch = map(int, overcast.__version__.split("."))
        number = major * 10000 + minor * 100 + patch
        self.assertEqual(refused([f'_Static_assert(OVC_VERSION == {number}, "OVC_VERSION");']), "")

    def test_the_table_holds_all_that_the_module_calls(self):
        from overcast._library import api
        self.assertGreaterEqual(api().struct_size, ctypes.sizeof(_abi.ovc_api))
