# SPDX-License-Identifier: Apache-2.0
"""Tests that a caller's mistake raises an exception with one sentence, and the program goes on."""

import copy
import inspect
import logging
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time
import typing
import unittest

import numpy as np

import overcast
from scenes_for_tests import rays_at_unit_cube, skip_without_device, soup

setUpModule = skip_without_device

DOWN = ([0.25, 0.25, 1], [0, 0, -1])
TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)


def committed():
    scene = overcast.Scene()
    scene.add(TRIANGLE)
    scene.commit()
    return scene


class Sentences(unittest.TestCase):
    """Checks rows of (exception, sentence, call): the sentences are part of the contract."""

    def check(self, cases):
        for error, sentence, call in cases:
            with self.subTest(sentence):
                with self.assertRaises(error) as raised:
                    call()
                self.assertEqual(str(raised.exception), sentence)

    def test_of_rays(self):
        scene = committed()
        self.check([
            (ValueError, "origins must be real numbers of shape (..., 3), not of shape (2,)",
             lambda: scene.intersect([0, 0], [0, 0, 1])),
            (ValueError, "directions must be real numbers of shape (..., 3), not of shape ()",
             lambda: scene.intersect([0, 0, 0], 1)),
            (TypeError, "directions must be real numbers of shape (..., 3), not complex128",
             lambda: scene.occluded([0, 0, 0], [0, 0, 1j])),
            (TypeError, "origins must be real numbers of shape (..., 3), not <U1",
             lambda: scene.intersect(["x"] * 3, DOWN[1])),
            (ValueError,
             "origins must be real numbers of shape (..., 3), not rows of different lengths",
             lambda: scene.intersect([[0, 0, 0], [0]], DOWN[1])),
            (ValueError,
             "the rays' shapes do not go together: origins (4,) + (3,), directions (5,) + (3,), "
             "t_min (), t_max ()",
             lambda: scene.intersect(np.zeros((4, 3)), np.zeros((5, 3)))),
            (TypeError, "t_max must be real numbers, not object",
             lambda: scene.intersect(*DOWN, t_max=None)),
            (TypeError,
             "rays must be an array of overcast.RAY or RAY_FLOAT, as overcast.rays() makes it, "
             "not an array of float64",
             lambda: scene.intersect_rays(np.zeros((3, 8)))),
            (TypeError,
             "rays must be an array of overcast.RAY or RAY_FLOAT, as overcast.rays() makes it, "
             "not list",
             lambda: scene.occluded_rays([1])),
            (TypeError, "skip must be whole numbers of shape (..., 2), not float64",
             lambda: scene.intersect(*DOWN, skip=[0.0, 1.0])),
            (ValueError, "skip names triangles for rays of shape (3,), not ()",
             lambda: scene.intersect(*DOWN, skip=np.zeros((3, 2), int))),
            (ValueError,
             "out must be Hits of the rays' shape (), not <overcast.Hits of shape (2,), 1 hit>",
             lambda: scene.intersect(*DOWN, out=two_hits())),
            (ValueError, "out must be Hits of the rays' shape (), not array(1)",
             lambda: scene.intersect(*DOWN, out=np.array(1))),
            (TypeError, "records must be an array of overcast.HIT, not float64",
             lambda: scene.intersect(*DOWN, after=overcast.Hits(np.zeros(())))),
            (ValueError, "out must be Hits whose records are contiguous, aligned and writeable",
             lambda: scene.intersect(*DOWN, out=overcast.Hits(amiss(overcast.HIT)))),
            (ValueError,
             f"max_hits must be from 0 to {sys.maxsize // 32}, not {sys.maxsize}",
             lambda: scene.all_hits(*DOWN, max_hits=sys.maxsize)),
        ])

    def test_of_names_of_arguments(self):
        scene, records = committed(), overcast.rays(*DOWN)
        sentence = "there is no argument '{}'; skip, after, masks and filter say which hits count"
        self.check([(TypeError, sentence.format(name), lambda name=name, call=call: call(name))
                    for name in ("skp", "rays", "limits")
                    for call in (lambda name: scene.intersect(*DOWN, **{name: 1}),
                                 lambda name: scene.occluded(*DOWN, **{name: 1}),
                                 lambda name: scene.all_hits(*DOWN, **{name: 1}))])
        self.check([(TypeError, sentence.format("mask"), lambda call=call: call(records, mask=1))
                    for call in (scene.intersect_rays, scene.occluded_rays,
                                 scene.all_hits_of_rays)])
        self.check([(TypeError, sentence.format("out"), lambda: scene.occluded(*DOWN, out=None))])

    def test_of_pickles_and_copies(self):
        scene, device = committed(), overcast.Device()
        sentence = ("a {} is neither pickled nor copied; "
                    "open one in the process that uses it")
        self.check([(TypeError, sentence.format(name), lambda call=call, of=of: call(of))
                    for name, of in (("scene", scene), ("device", device),
                                     ("scene", scene.intersect), ("scene", [scene]))
                    for call in (pickle.dumps, copy.deepcopy)
                    if call is pickle.dumps or not callable(of)])
        self.check([(TypeError, sentence.format("scene"), lambda: copy.copy(scene))])
        hits = scene.intersect(*DOWN)
        self.assertEqual(pickle.loads(pickle.dumps(hits)).records, hits.records)
        error = pickle.loads(pickle.dumps(overcast.Error("so", overcast.Result.NO_DEVICE)))
        self.assertEqual((str(error), error.code), ("so", overcast.Result.NO_DEVICE))

    def test_hints_of_types_are_resolved(self):
        if sys.version_info < (3, 11):
            self.skipTest("Unpack is of Python 3.11")
        for holder in (overcast.Scene, overcast.Device, overcast.Hits):
            for name, function in inspect.getmembers(holder, inspect.isfunction):
                with self.subTest(f"{holder.__name__}.{name}"):
                    typing.get_type_hints(function)

    def test_of_meshes(self):
        scene = overcast.Scene()
        self.check([
            (ValueError, "vertices must be of shape (n, 3), not (3,)",
             lambda: scene.add([1, 2, 3])),
            (ValueError, "vertices must be real numbers of shape (..., 3), not of shape (3, 2)",
             lambda: scene.add(TRIANGLE[:, :2])),
            (TypeError, "vertices must be real numbers of shape (..., 3), not bool",
             lambda: scene.add(TRIANGLE == 1)),
            (TypeError, "triangles must be whole numbers of shape (..., 3), not float64",
             lambda: scene.add(TRIANGLE, [[0, 1, 2.0]])),
            (ValueError, "triangles must be of shape (m, 3), not (3,)",
             lambda: scene.add(TRIANGLE, [0, 1, 2])),
            (ValueError, "triangles must be whole numbers from 0 to 4294967295, not -1",
             lambda: scene.add(TRIANGLE, [[0, 1, -1]])),
            (overcast.Error, "ovc_mesh.indices[2] is 3, expected less than vertex_count = 3",
             lambda: scene.add(TRIANGLE, [[0, 1, 3]])),
            (overcast.Error, "ovc_mesh.vertex_count is 2 without indices, expected a multiple of 3",
             lambda: scene.add(TRIANGLE[:2])),
            (ValueError,
             "a shared mesh needs C-contiguous float32 or float64 vertices and no triangles",
             lambda: scene.add(TRIANGLE.astype(int), shared=True)),
            (ValueError,
             "transform must be of shape (3, 4), or (4, 4) with the last row 0 0 0 1, not (3, 3)",
             lambda: scene.add(TRIANGLE, transform=np.eye(3))),
            (ValueError,
             "transform must be of shape (3, 4), or (4, 4) with the last row 0 0 0 1, "
             "not [1. 1. 1. 1.]",
             lambda: scene.add_instance(0, np.ones((4, 4)))),
            (TypeError, "mesh must be a whole number, not str", lambda: scene.add_instance("0")),
            (ValueError, "origin must be of shape (3,), not (1, 3)",
             lambda: scene.add(TRIANGLE, origin=[[0, 0, 0]])),
        ])
        self.assertEqual(scene.add(TRIANGLE), 0, "the scene is as it was")

    def test_of_scenes_and_devices(self):
        self.check([
            (ValueError, "gpu_memory must be from 0 to 18446744073709551615, not -1",
             lambda: overcast.Scene(gpu_memory=-1)),
            (TypeError, "gpu_memory must be a whole number, not str",
             lambda: overcast.Scene(gpu_memory="1G")),
            (ValueError, "precision must be 'certified' or 'fast', not 'exact'",
             lambda: overcast.Scene(precision="exact")),
            (ValueError, "leaves must be from 0 to 4294967295, not 4294967296",
             lambda: overcast.Scene(leaves=2**32)),
            (TypeError, "device must be an overcast.Device, not str",
             lambda: overcast.Scene("llvmpipe")),
            (ValueError, "name must be without NUL, not '0\\x00'",
             lambda: overcast.Device("0\0")),
            (TypeError, "name must be text or a whole number, not bytes",
             lambda: overcast.Device(b"llvmpipe")),
        ])
        with self.assertRaisesRegex(overcast.Error,
                                    "^a GPU budget of 1 bytes is too small: "
                                    "the smallest that works is"):
            overcast.Scene(gpu_memory=1)
        with self.assertRaisesRegex(overcast.Error, "no device is called 'nonsense'") as raised:
            overcast.Device("nonsense")
        self.assertEqual(raised.exception.code, overcast.Result.NO_DEVICE)

    def test_of_order(self):
        scene = overcast.Scene()
        early = "intersect: the scene is not committed yet, or has changed since it was"
        self.check([(overcast.Error, early, lambda: scene.intersect(*DOWN))])
        scene.commit()
        scene.commit()  # does nothing
        self.assertFalse(scene.intersect(*DOWN).hit)
        scene.add(TRIANGLE)
        self.check([(overcast.Error, early, lambda: scene.intersect(*DOWN))])
        scene.close()
        scene.close()
        self.check([(overcast.Error, "the scene is closed", lambda: scene.intersect(*DOWN)),
                    (overcast.Error, "the scene is closed", scene.statistics)])

    def test_of_files(self):
        scene = committed()
        with self.assertRaises(FileNotFoundError):
            overcast.Scene(saved="/no/such/file")
        with self.assertRaises(FileNotFoundError):
            scene.save("/no/such/folder/file")


def amiss(dtype):
    """Returns one zero record at an address that C would not put it at."""
    room = np.zeros(dtype.itemsize + 1, np.uint8)
    return room[1:].view(np.dtype(dtype.descr))[0:1].reshape(())


def two_hits():
    records = np.zeros(2, overcast.HIT)
    records["mesh"][1] = overcast.NONE
    return overcast.Hits(records)


class Running(unittest.TestCase):
    def test_what_progress_raises_ends_the_commit_and_is_raised(self):
        scene = overcast.Scene()
        scene.add(TRIANGLE)
        with self.assertRaisesRegex(ZeroDivisionError, "division by zero"):
            scene.commit(lambda done, stage: 1 / 0)
        told = []
        scene.commit(lambda done, stage: told.append((done, stage)))
        self.assertEqual(told[-1][0], 1)
        self.assertEqual(sorted(told, key=lambda step: step[0]), told)
        self.assertTrue(scene.intersect(*DOWN).hit)

    def test_progress_may_not_use_the_scene(self):
        scene = overcast.Scene()
        scene.add(TRIANGLE)
        with self.assertRaisesRegex(overcast.Error,
                                    "^a function that the library calls may not use the scene: "
                                    "the call that it belongs to is"):
            scene.commit(lambda done, stage: scene.statistics())
        scene.commit()
        self.assertTrue(scene.intersect(*DOWN).hit)

    def test_control_c_ends_a_commit(self):
        scene = overcast.Scene()
        scene.add(soup(1, 300000, 0.01))
        done = threading.Event()

        def interrupt():
            if not done.wait(0.1):
                os.kill(os.getpid(), signal.SIGINT)
        sender = threading.Thread(target=interrupt)
        sender.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                scene.commit()
                done.set()
                self.skipTest("built before it could be interrupted")
        finally:
            sender.join()
        scene.commit()
        self.assertTrue(scene.intersect([0.5, 0.5, -1], [0, 0, 1]).hit)

    def test_control_c_ends_a_call(self):
        scene = overcast.Scene()
        scene.add(soup(1, 100000, 0.01))
        scene.commit()
        # Tracing five million rays takes far longer than the signal.
        records = np.repeat(overcast.rays(*rays_at_unit_cube(2, 10000)), 500)
        untouched = 12345
        out = overcast.Hits(np.full(records.shape, untouched, overcast.HIT))
        timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            scene.intersect_rays(records, out=out)
        timer.join()
        self.assertEqual(out.mesh[-1], untouched, "it went on to the end")
        self.assertEqual(scene.intersect_rays(records[:10]).shape, (10,))

    def test_close_waits_for_a_call(self):
        scene = overcast.Scene()
        scene.add(soup(1, 100000, 0.01))
        began = threading.Event()
        failures = []

        def build():
            try:
                scene.commit(lambda done, stage: began.set())
            except overcast.Error as error:
                failures.append(error)
        thread = threading.Thread(target=build)
        thread.start()
        began.wait()
        scene.close()
        self.assertEqual(failures, [])
        thread.join()
        with self.assertRaisesRegex(overcast.Error, "the scene is closed"):
            scene.intersect(*DOWN)

    def test_a_scene_outlives_the_name_of_its_device(self):
        scene = overcast.Scene(overcast.Device())
        scene.add(TRIANGLE)
        scene.commit()
        self.assertTrue(scene.intersect(*DOWN).hit)

    def test_a_fork_is_told_and_ends(self):
        scene = committed()
        child = os.fork()
        if child == 0:
            code = 1
            try:
                scene.intersect(*DOWN)
            except overcast.Error as error:
                code = 0 if "does not live on in its fork" in str(error) else 2
            scene.close()
            del scene
            os._exit(code)
        deadline = time.monotonic() + 60
        while (ended := os.waitpid(child, os.WNOHANG))[0] == 0 and time.monotonic() < deadline:
            time.sleep(0.01)
        if ended[0] == 0:
            os.kill(child, signal.SIGKILL)
        self.assertEqual(os.waitstatus_to_exitcode(ended[1]), 0)
        self.assertTrue(scene.intersect(*DOWN).hit)

    def test_the_library_logs_to_logging(self):
        with self.assertLogs("overcast", logging.WARNING) as logs:
            scene = overcast.Scene()
            scene.add(np.full((3, 3), np.nan))
            scene.commit()
        self.assertRegex("\n".join(logs.output), "1 triangle")


class Programs(unittest.TestCase):
    """Runs whole programs, because mistakes about lifetimes show at the end of a program."""

    def run_program(self, text, **environment):
        return subprocess.run([sys.executable, "-c", text], env={**os.environ, **environment},
                              capture_output=True, text=True, timeout=120)

    def test_a_program_may_end_with_all_open(self):
        program = ("import overcast, numpy; device = overcast.Device(); "
                   "scene = overcast.Scene(device); scene.add(numpy.eye(3)); scene.commit(); "
                   "print(scene.intersect([1, 1, 1], [-1, -1, -1]).hit)")
        ended = self.run_program(program)
        self.assertEqual((ended.returncode, ended.stdout), (0, "True\n"), ended.stderr)

    def test_a_process_is_prepared_for_the_software_renderer(self):
        program = ("import overcast; overcast.prepare_process(); "
                   "print(overcast.Device().info.renderer); overcast.prepare_process()")
        environment = {name: value for name, value in os.environ.items()
                       if name != "LP_NATIVE_VECTOR_WIDTH"}
        ended = subprocess.run([sys.executable, "-c", program], env=environment,
                               capture_output=True, text=True, timeout=120)
        flags = pathlib.Path("/proc/cpuinfo").read_text(encoding="ascii").split()
        if "llvmpipe" in ended.stdout and {"avx512f", "avx512dq", "avx512bw",
                                           "avx512vl"}.issubset(flags):
            self.assertIn("512 bits", ended.stdout)
        self.assertIn("a device was listed or opened before", ended.stderr)

    def test_a_library_that_is_none_is_said_so(self):
        for library, sentence in {"/no/such.so": "cannot load the library: /no/such.so",
                                  "libm.so.6": "'libm.so.6' is not Overcast's library: "
                                               "it has no ovc_get_api"}.items():
            ended = self.run_program("import overcast; overcast.devices()", OVC_PLUGIN=library)
            self.assertEqual(ended.returncode, 1)
            self.assertIn(sentence, ended.stderr)
