# SPDX-License-Identifier: Apache-2.0
"""Tests who keeps what alive, and for how long: arrays of calls that end early, arrays of meshes,
scenes that nobody refers to any more, and locks in forks."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time
import unittest
import weakref

import numpy as np

import overcast
from scenes_for_tests import rays_at_unit_cube, skip_without_device, soup

setUpModule = skip_without_device

DOWN = ([0.25, 0.25, 1], [0, 0, -1])
TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)


def committed(corners=TRIANGLE):
    scene = overcast.Scene()
    scene.add(corners)
    scene.commit()
    return scene


class Timeout(Exception):
    pass


def raise_timeout(_signal, _frame):
    raise Timeout


class Interrupted(unittest.TestCase):
    """A call that a signal's handler ends has ended when the handler's exception is raised: until
    then it writes to arrays that the caller may free."""

    def interrupt(self, signals, error):
        scene = committed(soup(1, 100000, 0.01))
        # Tracing five million rays takes far longer than the signals.
        records = np.repeat(overcast.rays(*rays_at_unit_cube(2, 10000)), 500)
        threads = threading.active_count()

        def send():
            for name, seconds in signals:
                time.sleep(seconds)
                os.kill(os.getpid(), name)
        sender = threading.Thread(target=send)
        sender.start()
        with self.assertRaises(error):
            scene.intersect_rays(records)
        sender.join()
        self.assertEqual(threading.active_count(), threads, "the call goes on")
        self.assertEqual(scene.intersect_rays(records[:10]).shape, (10,))

    def test_by_any_exception(self):
        before = signal.signal(signal.SIGALRM, raise_timeout)
        self.addCleanup(signal.signal, signal.SIGALRM, before)
        self.interrupt([(signal.SIGALRM, 0.1)], Timeout)

    def test_by_control_c_pressed_twice(self):
        self.interrupt([(signal.SIGINT, 0.1), (signal.SIGINT, 0.003)], KeyboardInterrupt)


class CalledBack(unittest.TestCase):
    """Functions that the library calls."""

    def test_they_may_not_close_the_scene(self):
        scene = overcast.Scene()
        scene.add(TRIANGLE)
        with self.assertRaisesRegex(overcast.Error, "may not use the scene"):
            scene.commit(lambda done, stage: scene.close())
        scene.commit()
        with self.assertRaisesRegex(overcast.Error, "may not use the scene"):
            scene.intersect(*DOWN, filter=lambda rays, hits: scene.close())
        self.assertTrue(scene.intersect(*DOWN).hit)

    def test_scenes_that_end_in_them_are_destroyed(self):
        program = ("import overcast, numpy\n"
                   "def committed(device):\n"
                   "    scene = overcast.Scene(device)\n"
                   "    scene.add(numpy.eye(3))\n"
                   "    scene.commit()\n"
                   "    return scene\n"
                   "device = overcast.Device()\n"
                   "held = [committed(device)]\n"
                   "def drop(rays, hits):\n"
                   "    held.clear()\n"
                   "    return hits.hit\n"
                   "print(committed(device).intersect([1, 1, 1], [-1, -1, -1], filter=drop).hit)\n")
        ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                               timeout=120)
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "True\n", ""),
                         "the library says which scenes are still alive")

    def test_a_plan_leaves_the_progress_of_a_commit_alone(self):
        scene = overcast.Scene()
        scene.add(soup(1, 100000, 0.01))
        began = threading.Event()
        told = []

        def tell(done, _stage):
            told.append(done)
            began.set()
        thread = threading.Thread(target=scene.commit, args=(tell,))
        thread.start()
        began.wait()
        scene.plan()
        thread.join()
        self.assertEqual(told[-1], 1)


class Arrays(unittest.TestCase):
    def test_a_mesh_that_is_copied_is_not_kept(self):
        scene = overcast.Scene()
        corners, triangles = TRIANGLE.copy(), np.array([[0, 1, 2]], np.uint32)
        gone = [weakref.ref(corners), weakref.ref(triangles)]
        mesh = scene.add(corners, triangles)
        del corners, triangles
        gc.collect()
        self.assertEqual([reference() for reference in gone], [None, None])
        scene.update(mesh, TRIANGLE + 1)
        scene.commit()
        self.assertEqual(scene.intersect([1.25, 1.25, 2], [0, 0, -1]).t, 1)

    def test_a_shared_mesh_is_kept(self):
        scene = overcast.Scene()
        corners = TRIANGLE.copy()
        kept = weakref.ref(corners)
        scene.add(corners, shared=True)
        del corners
        gc.collect()
        self.assertIsNotNone(kept())
        scene.close()
        del scene
        gc.collect()
        self.assertIsNone(kept())


class Scenes(unittest.TestCase):
    """A scene ends when nobody refers to it any more but what it keeps itself."""

    def ends(self, progress):
        class Renderer:
            def __init__(self):
                self.scene = overcast.Scene()
                self.scene.add(TRIANGLE)
                self.scene.commit(lambda done, stage: progress(self))
        renderer = None
        try:
            renderer = Renderer()
        except ZeroDivisionError as error:
            renderer = error.__traceback__.tb_next.tb_frame.f_locals["self"]
        scene = weakref.ref(renderer.scene)
        del renderer
        gc.collect()
        self.assertIsNone(scene())

    def test_whose_progress_function_refers_to_it(self):
        self.ends(lambda renderer: None)

    def test_whose_progress_function_raised(self):
        self.ends(lambda renderer: 1 / 0)


class Forks(unittest.TestCase):
    def test_closing_in_a_fork_waits_for_no_call_of_the_parent(self):
        scene = committed()
        asked, go_on = threading.Event(), threading.Event()

        def wait(_rays, hits):
            asked.set()
            go_on.wait()
            return hits.hit
        thread = threading.Thread(target=scene.intersect, args=DOWN, kwargs={"filter": wait})
        thread.start()
        asked.wait()
        child = os.fork()
        if child == 0:
            signal.alarm(60)  # ends a child that waits
            scene.close()
            os._exit(0)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)
        go_on.set()
        thread.join()


if __name__ == "__main__":
    unittest.main()
