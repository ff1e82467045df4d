#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/radio_test: robots and station on three hosts, all bytes of the radio explained."""

import json
import signal
import subprocess
import time
import unittest

import script_test


def spaces():
    listed = subprocess.run(["ip", "netns", "list"], stdout=subprocess.PIPE, check=True, text=True)
    names = {line.split()[0] for line in listed.stdout.splitlines() if "rprr_radio_" in line}
    return {name for name in names if not name.endswith("_probe")}  # asks whether it can be done


class RadioTest(script_test.ScriptTest):
    script = "radio_test"

    @classmethod
    def setUpClass(cls):
        why_not = subprocess.run([str(script_test.SCRIPTS / cls.script), "--why-not"],
                                 stdout=subprocess.PIPE, check=False, text=True)
        if why_not.returncode != 0:
            raise unittest.SkipTest("no radio can be made: " + why_not.stdout.strip())
        super().setUpClass()
        cls.options = ("--output", str(cls.folder / "run"), "--folder", str(cls.folder / "room"))
        subprocess.run(["rosrun", "rprr_sensor", "synthetic_to_folder", str(cls.folder / "room"),
                        "--frames", "6"], stdout=subprocess.DEVNULL, check=True)

    def test_every_byte_on_the_radio_is_accounted_for(self):
        process = self.start("--seconds", "5", "--fps", "2", "--json", str(self.folder / "out"))
        said = self.end(process, 0)
        run, = json.loads((self.folder / "out").read_text(encoding="utf-8"))["runs"]
        self.assertGreater(run["frames"]["b"]["rebuilt"], 2, said)
        self.assertGreater(run["quality"]["psnr"], 25.0, said)
        counted = run["bytes"]
        self.assertTrue(run["agree"], said)
        # What an exchange cost that a busy machine lost is on the radio but in no account; nothing
        # is in an account that was not on the radio.
        self.assertLessEqual(counted["accounted"], counted["messages"], said)
        self.assertGreater(counted["accounted"], 0.8 * counted["messages"], said)
        self.assertLess(counted["rprr_wire"], 1.15 * counted["messages"], said)
        self.assertLess(counted["ros_wire"], 1000 * run["seconds"], said)
        self.check_topics(run, said)

    def check_topics(self, run, said):
        """No image crosses, nor anything else that is not meant to."""
        topics = {line["name"] for line in run["lines"] + run["start"]["lines"]
                  if line["name"].startswith("/")}
        meant = {f"/{robot}/rprr/{name}" for robot in ("eyebug_a", "eyebug_b")
                 for name in ("preview", "samples", "update", "relative_pose", "prediction",
                              "encoded")}
        self.assertLessEqual(topics, meant | {"/station/receipts", "/rosout"}, said)

    def test_after_a_silent_radio_subscriptions_are_made_anew(self):
        process = self.start("--seconds", "28", "--fps", "2", "--outage", "10",
                             "--json", str(self.folder / "silent"))
        said = self.end(process, 0)
        run, = json.loads((self.folder / "silent").read_text(encoding="utf-8"))["runs"]
        self.assertIsNotNone(run["after_silence"]["new exchange"], said)
        logs = [(self.folder / "run" / "rprr" / f"{host}.log").read_text(encoding="utf-8")
                for host in ("station", "a", "b")]
        # What was under way may come by itself; not everything does.
        self.assertIn("made anew", "".join(logs), said)

    def test_an_interrupted_run_leaves_nothing(self):
        before = spaces()
        process = self.start("--seconds", "60")
        script_test.wait_for(lambda: spaces() != before or process.poll() is not None, 60)
        self.assertNotEqual(spaces(), before, "it made no namespaces")
        time.sleep(2)
        process.send_signal(signal.SIGINT)
        said = self.end(process, 130)
        self.assertLessEqual(spaces(), before, said)

    def test_nonsense_is_refused(self):
        self.check_refused(("--rate-kbit", "much"), ("--master", "c"), ("--folder", "/nowhere"),
                           ("--bandwidth", "-1"), ("--what",))


if __name__ == "__main__":
    script_test.main(RadioTest)
