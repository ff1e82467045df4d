#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/demo as people run it: with both profiles, two at once, interrupted at any moment."""

import os
import pathlib
import signal
import subprocess
import sys
import time

import script_test
from script_test import ScriptTest, wait_for

ENDS_WITHIN = 8.0  # seconds; 3 are the aim


def processes_of(sessions):
    """Command lines of what runs in these sessions."""
    found = []
    for folder in pathlib.Path("/proc").iterdir():
        try:
            state, session = (folder / "stat").read_text().rpartition(")")[2].split()[0:4:3]
            if int(session) in sessions and state != "Z":
                found.append((folder / "cmdline").read_text().replace("\0", " "))
        except (OSError, ValueError):
            continue
    return found


def sessions_below(pid):
    """Sessions of a process's children, and theirs: the demo starts some of its own."""
    sessions, parents = set(), {pid}
    stats = []
    for folder in pathlib.Path("/proc").iterdir():
        try:
            fields = (folder / "stat").read_text().rpartition(")")[2].split()
            stats.append((int(folder.name), int(fields[1]), int(fields[3])))
        except (OSError, ValueError, IndexError):
            continue
    for _ in range(6):
        parents |= {child for child, parent, _ in stats if parent in parents}
    for child, _, session in stats:
        if child in parents:
            sessions.add(session)
    return sessions


class Demo(ScriptTest):
    script = "demo"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.walk = cls.folder / "walk"
        subprocess.run(["rosrun", "rprr_sensor", "synthetic_to_folder", str(cls.walk), "--frames",
                        "9", "--width", "320", "--height", "240"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def test_both_profiles_lose_no_exchange(self):
        for profile in ("default", "paper"):
            with self.subTest(profile=profile):
                demo = self.start(str(self.walk), "--exchanges", "8", "--profile", profile)
                self.assertIn(" 0 lost", self.end(demo, 0))

    def test_two_run_side_by_side(self):
        demos = [self.start(str(self.walk), "--exchanges", "4") for _ in range(2)]
        said = [self.end(demo, 0) for demo in demos]
        pictures = {line for text in said for line in text.splitlines() if "picture: " in line}
        self.assertEqual(len(pictures), 2, said)

    def test_an_interrupt_ends_it_at_any_moment(self):
        for moment in (0.5, 1.2, 2.0, 3.0, 4.0, 7.0):
            with self.subTest(moment=moment):
                demo = subprocess.Popen(
                    [str(script_test.SCRIPTS / "demo"), str(self.walk), "--exchanges", "1000"],
                    stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL, start_new_session=True)
                time.sleep(moment)
                sessions = sessions_below(demo.pid)
                begun = time.monotonic()
                os.killpg(demo.pid, signal.SIGINT)
                demo.wait(60)
                seconds = time.monotonic() - begun
                print(f"interrupted after {moment} s: ended after {seconds:.1f} s",
                      file=sys.stderr)
                self.assertLess(seconds, ENDS_WITHIN)
                self.assertIn(demo.returncode, (130, -signal.SIGINT))
                self.assertTrue(wait_for(lambda sessions=sessions: not processes_of(sessions), 2),
                                processes_of(sessions))

    def test_what_is_wrong_is_said(self):
        self.check_refused(["/nowhere"], ["--step", "0"], ["--profile", "none"], ["--frob"])
        said = self.end(self.start(str(self.folder), "--timeout", "20"), 1)
        self.assertIn("associations.txt", said)

    def test_a_bag_without_the_topics_is_not_played(self):
        bag = str(self.folder / "two robots.bag")
        subprocess.run(["rosrun", "rprr_sensor", "synthetic_to_bag", bag, "--frames", "1",
                        "--width", "160", "--height", "120"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        colour = "/eyebug_a/camera/rgb/image_rect_color"

        def check(*topics, of=bag):
            return subprocess.run([str(script_test.SCRIPTS / "check_bag"), *topics, "--", "echo",
                                   "played", "--bags", of], stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, check=False)
        good = check(colour)
        self.assertEqual((good.returncode, good.stdout), (0, f"played --bags {bag}\n"))
        for wrong, said in ((check(colour, "/cam/rgb"), ("no /cam/rgb", "a_rgb:=", colour)),
                            (check(colour, of="/nowhere.bag"), ("/nowhere.bag",))):
            self.assertEqual(wrong.returncode, 1, wrong.stdout)
            for part in said:
                self.assertIn(part, wrong.stdout)
            self.assertNotIn("played", wrong.stdout)


if __name__ == "__main__":
    script_test.main(Demo)
