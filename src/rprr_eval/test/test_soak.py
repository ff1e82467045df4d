#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/soak: what it says of an undisturbed pair, and that it leaves nothing."""

import json
import signal
import subprocess
import time

import script_test


class Soak(script_test.ScriptTest):
    script = "soak"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.options = ("--output", str(cls.folder))

    def left(self):
        """Command lines that name the tests' folder."""
        said = subprocess.run(["ps", "-eo", "args"], stdout=subprocess.PIPE, check=True, text=True)
        return [line for line in said.stdout.splitlines() if str(self.folder) in line]

    def test_a_short_run(self):
        process = self.start("--minutes", "0.1", "--no-faults", "--json",
                             str(self.folder / "out.json"))
        said = self.end(process, 0)
        self.assertIn("all was well", said)
        result = json.loads((self.folder / "out.json").read_text(encoding="utf-8"))
        self.assertGreater(result["rebuilt_per_second_between_faults"], 0.5, said)
        self.assertEqual(result["problems"], [], said)
        self.assertEqual(self.left(), [])

    def test_an_interrupted_run_leaves_nothing(self):
        log = self.folder / "nodes" / "station_rprr_station.log"
        log.unlink(missing_ok=True)
        process = self.start("--minutes", "10")
        script_test.wait_for(lambda: log.exists() or process.poll() is not None, 60)
        time.sleep(1.0)
        process.send_signal(signal.SIGTERM)
        self.assertIn("interrupted", self.end(process, 1))
        self.assertEqual(self.left(), [])

    def test_nonsense_is_refused(self):
        self.check_refused(("--minutes", "many"), ("--minutes", "0"), ("--rate", "-1"), ("--what",))


if __name__ == "__main__":
    script_test.main(Soak)
