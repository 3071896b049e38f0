# SPDX-License-Identifier: Apache-2.0
"""Tests where Scene.save() writes, and what Scene(saved=) makes of damaged files."""

import os
import pathlib
import tempfile
import threading
import unittest

import numpy as np

import overcast
from scenes_for_tests import skip_without_device

setUpModule = skip_without_device


class Saving(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="overcast_saving_")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        self.scene = self.committed()
        self.scene.save(self.folder / "expected")
        self.expected = (self.folder / "expected").read_bytes()

    def committed(self, **options):
        scene = overcast.Scene(**options)
        scene.add(np.eye(3))
        scene.commit()
        return scene

    def test_a_link_stays_one(self):
        link = self.folder / "link"
        link.symlink_to("file")
        self.scene.save(link)
        self.assertTrue(link.is_symlink())
        self.assertEqual((self.folder / "file").read_bytes(), self.expected)

    def test_a_pipe_is_written_to(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        thread = threading.Thread(target=self.scene.save, args=(pipe,))
        thread.start()
        self.assertEqual(pipe.read_bytes(), self.expected)
        thread.join()
        self.assertTrue(pipe.is_fifo())

    def test_names_may_be_bytes_and_are_all_that_is_written(self):
        other = self.folder / "file.unfinished"
        other.write_text("somebody else's")
        self.scene.save(os.fsencode(self.folder / "file"))
        self.assertEqual((self.folder / "file").read_bytes(), self.expected)
        self.assertEqual(other.read_text(), "somebody else's")
        self.assertEqual(len(os.listdir(self.folder)), 3)

    def test_an_empty_file_is_damaged(self):
        (self.folder / "empty").touch()
        with self.assertLogs("overcast") as logs:
            scene = self.committed(saved=self.folder / "empty")
        self.assertIn("building anew", "\n".join(logs.output))
        self.assertTrue(scene.intersect([1, 1, 1], [-1, -1, -1]).hit)


if __name__ == "__main__":
    unittest.main()
