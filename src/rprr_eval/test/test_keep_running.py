#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/keep_running with a master of its own that is ended and started again."""

import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import xmlrpc.client

import script_test
from script_test import free_port, wait_for

KEEP = str(script_test.SCRIPTS / "keep_running")


class KeepRunning(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="rprr_keep_running_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.port = free_port()
        self.uri = f"http://localhost:{self.port}"
        self.environment = {**os.environ, "ROS_MASTER_URI": self.uri, "ROS_HOSTNAME": "localhost",
                            "ROS_HOME": str(self.folder), "ROS_LOG_DIR": str(self.folder / "log")}
        self.log = open(self.folder / "output", "w+", encoding="utf-8")
        self.addCleanup(self.log.close)

    def start(self, *command):
        process = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL,
                                   stdout=self.log, stderr=self.log, start_new_session=True)
        self.addCleanup(self.stop, process)
        return process

    def stop(self, process, number=signal.SIGTERM):
        if process.poll() is None:
            process.send_signal(number)
            try:
                process.wait(40)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        return process.returncode

    def said(self):
        return (self.folder / "output").read_text(encoding="utf-8")

    def output(self):
        """The end of what was said: what a failure shows."""
        return self.said()[-3000:]

    def start_master(self):
        core = self.start("roscore", "-p", str(self.port))
        self.assertTrue(wait_for(lambda: self.published() is not None, 20), self.output())
        return core

    def published(self):
        """Topics that the master knows a publisher of; None without a master."""
        try:
            code, _, state = xmlrpc.client.ServerProxy(self.uri).getSystemState("/test")
            return {topic for topic, _ in state[0]} if code == 1 else None
        except (OSError, xmlrpc.client.Error):
            return None

    def await_exchange(self, seconds):
        """Whether the station speaks of an exchange within that time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            echo = subprocess.run(
                ["timeout", "20", "rostopic", "echo", "-n", "1", "/station/statistics/exchange"],
                env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                check=False, text=True)
            words = echo.stdout.split()
            if words and words[0].isdigit() and int(words[0]) > 0:
                return True
        return False

    def test_nodes_come_back_after_the_master_did(self):
        frames = str(self.folder / "frames")
        subprocess.run(["rosrun", "rprr_sensor", "synthetic_to_folder", frames, "--frames", "4",
                        "--width", "320", "--height", "240"], check=True, env=self.environment,
                       stdout=self.log)
        core = self.start_master()
        keeper = self.start(KEEP, "roslaunch", "--skip-log-check", "--no-summary",
                            str(script_test.ROOT / "launch" / "freiburg.launch"),
                            f"bag:={frames}", "step:=1", "loop:=true",
                            "measure_independent:=false")
        self.assertTrue(self.await_exchange(60), "no exchange at first\n" + self.output())
        self.stop(core)
        self.start_master()
        self.assertTrue(wait_for(lambda: "/station/statistics" in (self.published() or ()), 60),
                        "the station did not register with the new master\n" + self.output())
        self.assertTrue(self.await_exchange(60), "no exchange afterwards\n" + self.output())
        self.assertEqual(self.said().count("another master answers"), 1, self.output())
        self.assertEqual(self.stop(keeper), 0, self.output())
        self.assertTrue(wait_for(lambda: "/station/statistics" not in (self.published() or ()), 10),
                        "nodes are left behind\n" + self.output())

    def test_a_command_that_ends_is_started_again(self):
        self.start_master()
        runs = self.folder / "runs"
        keeper = self.start(KEEP, "sh", "-c", f"echo run >> {runs}; exit 3")
        self.assertTrue(wait_for(lambda: runs.exists() and runs.read_text().count("run") >= 2, 20),
                        self.output())
        self.assertIn("the launch ended with 3", self.said())
        self.assertEqual(self.stop(keeper), 0, self.output())

    def test_it_waits_for_a_master_and_ends_cleanly_meanwhile(self):
        ran = self.folder / "ran"
        keeper = self.start(KEEP, "touch", str(ran))
        self.assertTrue(wait_for(lambda: "waiting for the master" in self.said(), 10))
        self.assertFalse(ran.exists(), "it did not wait for the master")
        self.assertEqual(self.stop(keeper), 0, self.output())

    def test_what_the_command_leaves_behind_is_ended(self):
        self.start_master()
        mark = self.folder / "orphan"
        keeper = self.start(KEEP, "sh", "-c", f"setsid sleep 1000 & echo $! > {mark}; wait")
        self.assertTrue(wait_for(lambda: mark.exists() and mark.read_text().strip(), 20),
                        self.output())
        orphan = int(mark.read_text())
        self.assertEqual(self.stop(keeper), 0, self.output())
        self.assertFalse(pathlib.Path(f"/proc/{orphan}").exists(), "a process was left behind")


if __name__ == "__main__":
    script_test.main(KeepRunning)
