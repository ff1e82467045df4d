#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/soak: what it says of an undisturbed pair, and that it leaves nothing."""

import json
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import script_test

SOAK = str(script_test.SCRIPTS / "soak")


class Soak(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="rprr_soak_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def start(self, *options):
        return subprocess.Popen([SOAK, "--output", str(self.folder), *options],
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)

    def left(self):
        """Command lines that name this run's folder."""
        said = subprocess.run(["ps", "-eo", "args"], stdout=subprocess.PIPE, check=True, text=True)
        return [line for line in said.stdout.splitlines() if str(self.folder) in line]

    def test_a_short_run(self):
        process = self.start("--minutes", "0.1", "--no-faults", "--json",
                             str(self.folder / "out.json"))
        said, _ = process.communicate()
        self.assertEqual(process.returncode, 0, said)
        self.assertIn("all was well", said)
        result = json.loads((self.folder / "out.json").read_text(encoding="utf-8"))
        self.assertGreater(result["rebuilt_per_second_between_faults"], 0.5, said)
        self.assertEqual(result["problems"], [], said)
        self.assertEqual(self.left(), [])

    def test_an_interrupted_run_leaves_nothing(self):
        process = self.start("--minutes", "10")
        end = time.monotonic() + 60
        log = self.folder / "nodes" / "station_rprr_station.log"
        while not log.exists() and process.poll() is None and time.monotonic() < end:
            time.sleep(0.1)
        time.sleep(1.0)
        process.send_signal(signal.SIGTERM)
        said, _ = process.communicate()
        self.assertEqual(process.returncode, 1, said)
        self.assertIn("interrupted", said)
        self.assertEqual(self.left(), [])

    def test_nonsense_is_refused(self):
        for options in (("--minutes", "many"), ("--minutes", "0"), ("--rate", "-1"), ("--what",)):
            process = self.start(*options)
            said, _ = process.communicate()
            self.assertEqual(process.returncode, 1, said)
            self.assertIn("error: ", said)


if __name__ == "__main__":
    script_test.main(Soak)
