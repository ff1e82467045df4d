# SPDX-License-Identifier: BSD-3-Clause
"""What tests on a pair with a relay, cameras and a judge share: scripts/faults/bench.py."""

import os
import pathlib
import shutil
import sys
import tempfile
import unittest

import script_test

sys.path.insert(0, str(script_test.SCRIPTS / "faults"))
from bench import Bench, make_recording  # noqa: E402


class BenchTest(unittest.TestCase):
    """A pair that works before the first test. NAME_LOGS=FOLDER keeps the nodes' logs."""

    name = ""      # of the folder and of that variable
    rate = 5.0     # frames a second of each camera
    options = {}   # of Bench

    @classmethod
    def setUpClass(cls):
        kept = os.environ.get(cls.name.upper() + "_LOGS")
        cls.folder = pathlib.Path(kept or tempfile.mkdtemp(prefix=f"rprr_{cls.name}_"))
        if not kept:
            cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        recording = make_recording(cls.folder / "room")
        cls.bench = Bench(cls.folder / "nodes", recording, rate=cls.rate, **cls.options)
        cls.addClassCleanup(cls.bench.stop)
        cls.begin()
        if not cls.bench.await_service(60):
            raise AssertionError("the pair never worked\n" + "\n".join(cls.bench.heard_since(0)))

    @classmethod
    def begin(cls):
        """What the pair needs beside the bench to work."""
