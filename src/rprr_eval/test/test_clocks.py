#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A pair of which one robot has another clock: its nodes and its camera run by it. Exchanges go on,
and /diagnostics says by how much the clocks differ.

What is asserted of times is generous, for busy machines.
"""

import re
import sys
import time

import script_test
from bench_test import BenchTest

from clocks import RobotClock
from processes import B, wait_for

PATIENCE = 20.0  # seconds
APART = 3.7  # seconds
TOLERANCE_MS = 150  # a tick, and this machine's load


class Clocks(BenchTest):
    name = "clocks"
    options = {"own_clock": (B,)}

    @classmethod
    def begin(cls):
        cls.clock = RobotClock(B)
        cls.addClassCleanup(cls.clock.stop)

    def set_clock(self, offset):
        """b's clock, and so its camera's stamps; returns when."""
        self.clock.offset = self.bench.cameras.offset[B] = offset
        time.sleep(1.0)  # what is under way ends
        return time.monotonic()

    def told(self, what, since):
        """The last number that b told by that name, or None."""
        lines = self.bench.said(f"{B} exchange: clock of eyebug_a is {what} = ", since)
        return int(re.search(r"= (-?\d+)$", lines[-1]).group(1)) if lines else None

    def expect_offset(self, ms, since):
        def is_right():
            offset = self.told("ahead, ms", since)
            uncertainty = self.told("ahead, ms uncertain", since)
            return (offset is not None and uncertainty is not None
                    and abs(offset - ms) <= uncertainty + TOLERANCE_MS)
        right = wait_for(is_right, PATIENCE)
        offset, uncertainty = (self.told(what, since) for what in
                               ("ahead, ms", "ahead, ms uncertain"))
        print(f"clock of a ahead by {ms:.0f} ms: told {offset}, uncertain {uncertainty}",
              file=sys.stderr)
        self.assertTrue(right, f"b says {offset} ms, uncertain {uncertainty}, it is {ms}")

    def expect_said(self, text, since):
        self.assertTrue(wait_for(lambda: self.bench.said(text, since), PATIENCE),
                        f"/diagnostics did not say '{text}'\n"
                        + "\n".join(self.bench.heard_since(since)))

    def expect_poses(self):
        """Exchanges go on to end with accepted poses."""
        key = f"{B} exchange: poses accepted"
        before = self.bench.counts().get(key, 0)
        self.assertTrue(wait_for(lambda: self.bench.counts().get(key, 0) > before, PATIENCE),
                        "no pose is accepted any more")

    def test_clocks_that_agree(self):
        since = self.set_clock(0.0)
        self.expect_poses()
        self.expect_offset(0.0, since)

    def test_the_dependent_is_ahead(self):
        since = self.set_clock(APART)
        self.expect_poses()
        self.expect_offset(-APART * 1e3, since)
        self.expect_said("ms behind this robot's", since)

    def test_the_dependent_is_behind(self):
        since = self.set_clock(-APART)
        self.expect_offset(APART * 1e3, since)
        self.expect_said("ms ahead of this robot's", since)

    def test_a_clock_that_is_set_is_followed(self):
        for offset in (1.0, 0.0):
            since = self.set_clock(offset)
            self.expect_offset(-offset * 1e3, since)
        self.expect_poses()


if __name__ == "__main__":
    script_test.main(Clocks)
