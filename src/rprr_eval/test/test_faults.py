#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A pair over a relay, disturbed: after each fault its service comes back by itself, no wrong view
was shown, memory stays, and /diagnostics says what happened.

The scene is synthetic, so every view is held against what the camera saw. Times are printed; what
is asserted is generous, for busy machines. FAULTS_LOGS=FOLDER keeps the nodes' logs.
"""

import sys
import time
import zlib

import numpy
import rospy

import script_test
from bench_test import BenchTest

from processes import A, B, RELAYED, wait_for

from rprr_msgs.msg import BlockPreview, EncodedFrame

PATIENCE = 10.0  # seconds until a new frame is rebuilt; 3 are the aim
OUTAGE = 4.0  # seconds; longer than every timeout
BAD_RADIO = 3.0  # seconds
MORE_MEMORY_KB = 24 << 10  # of a process, after all the faults


class Faults(BenchTest):
    name = "faults"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.memory = {process: process.resident_kb() for process in cls.bench.processes.all()}

    def setUp(self):
        self.cameras, self.processes = self.bench.cameras, self.bench.processes
        now = time.monotonic()
        self.assertIsNotNone(self.bench.seconds_until_rebuilt(now, 20),
                             "no service before the fault")
        self.begun, self.counts = time.monotonic(), self.bench.counts()

    def tearDown(self):
        self.bench.radio()
        for robot in (A, B):
            self.cameras.offset[robot], self.cameras.change[robot] = 0.0, None
        for process in self.processes.all():
            if not process.alive():
                process.start()

    def expect_service(self, since, what):
        """b's new frames are rebuilt again, and nothing wrong was shown meanwhile."""
        seconds = self.bench.seconds_until_rebuilt(since, PATIENCE)
        self.assertIsNotNone(seconds, f"no service {PATIENCE} s after: {what}\n" + self.said())
        print(f"{what}: back after {seconds:.2f} s", file=sys.stderr)
        time.sleep(0.6)  # what was late may still come
        self.expect_nothing_wrong()
        self.expect_memory()
        self.assertEqual(self.processes.left_behind(), [])

    def expect_nothing_wrong(self):
        wrong = [view for view in self.bench.judge.wrong if view.came > self.begun]
        self.assertEqual(wrong, [], "wrong views were shown")

    def expect_memory(self):
        for process in self.processes.all():
            now = process.resident_kb()
            self.assertIsNotNone(now, f"{process.name} is gone\n" + self.said())
            before = self.memory.setdefault(process, now)
            self.assertLess(now - before, MORE_MEMORY_KB, f"{process.name} grew from {before} kB")

    def expect_said(self, text, patience=5.0):
        self.assertTrue(wait_for(lambda: self.bench.said(text, self.begun), patience),
                        f"/diagnostics did not say '{text}'\n" + self.said())

    def expect_counted(self, what, text=""):
        """/diagnostics counted it since the test began, and said so in words."""
        def counted():
            return any(count > self.counts.get(key, 0)
                       for key, count in self.bench.counts().items() if what in key)
        self.assertTrue(wait_for(counted, 5.0),
                        f"/diagnostics did not count '{what}'\n" + self.said())
        if text:
            self.expect_said(text)

    def expect_silence_counted(self, robot):
        self.expect_counted(f"not heard: {RELAYED}/{robot}/rprr/encoded", f"no frame of '{robot}'")

    def said(self):
        return "\n".join(line for line in self.bench.heard_since(self.begun)
                         if " = " not in line or "reason" in line or "(times)" in line)

    def restart(self, host):
        """Killed in the middle of an exchange, gone for a moment, started again."""
        for process in self.processes.of(host):
            process.kill()
        time.sleep(OUTAGE)
        for process in self.processes.of(host):
            process.start()
            self.memory.pop(process, None)
        self.assertTrue(wait_for(self.connected, 30), "not connected again")
        return time.monotonic()

    def connected(self):
        return self.cameras.heard() and self.bench.judge.connected()

    # Processes.

    def test_reference_robot_restarts(self):
        since = self.restart(A)
        self.expect_said("no answer from eyebug_a")
        self.expect_silence_counted(A)
        self.expect_service(since, "a restarted")

    def test_dependent_robot_restarts(self):
        since = self.restart(B)
        self.expect_silence_counted(B)
        self.expect_service(since, "b restarted")

    def test_station_restarts(self):
        since = self.restart("station")
        self.expect_counted("encoder: no receipts", "the station sends no receipts")
        self.expect_service(since, "the station restarted")

    def test_each_node_of_a_robot_restarts_alone(self):
        for process in self.processes.of(A) + self.processes.of(B):
            process.kill()
            time.sleep(0.3)
            process.start()
            self.memory.pop(process, None)
            self.assertTrue(wait_for(self.connected, 30), "not connected again")
            self.expect_service(time.monotonic(), process.name + " restarted")

    # The radio.

    def test_radio_is_down_for_a_while(self):
        self.bench.radio(down=True)
        time.sleep(OUTAGE)
        self.bench.radio()
        since = time.monotonic()
        self.expect_said("no answer from eyebug_a")
        self.expect_counted("encoder: no receipts", "the station sends no receipts")
        self.expect_silence_counted(B)
        self.expect_service(since, "the radio was down")

    def test_messages_are_lost(self):
        self.bench.radio(lose=0.3)
        time.sleep(BAD_RADIO)
        self.bench.radio()
        since = time.monotonic()
        self.expect_counted(f"{B} exchange: frames sent whole", "no answer from eyebug_a")
        self.expect_service(since, "messages were lost")

    def test_only_references_are_lost(self):
        self.bench.radio(lose=1.0, only=f"{A}/rprr/encoded")
        time.sleep(OUTAGE)
        self.bench.radio()
        since = time.monotonic()
        self.expect_counted("reference not acknowledged", "did not acknowledge the frame of")
        self.expect_service(since, "a's frames were lost")

    def test_pieces_of_frames_are_lost(self):
        for robot in (A, B):
            self.bench.configure(f"/{robot}/rprr_encoder", bandwidth=60000.0)
        try:
            self.bench.radio(lose=0.4, only="encoded")
            self.expect_said("parts of a frame did not come", 15.0)
            self.bench.radio()
            since = time.monotonic()
            self.expect_service(since, "pieces of frames were lost")
        finally:
            for robot in (A, B):
                self.bench.configure(f"/{robot}/rprr_encoder", bandwidth=0.0)

    def test_messages_are_doubled_and_late(self):
        self.bench.radio(duplicate=0.3, reorder=0.3, late=0.4)
        time.sleep(BAD_RADIO)
        self.bench.radio()
        self.expect_service(time.monotonic(), "messages came twice and late")

    def test_messages_are_damaged(self):
        self.bench.radio(corrupt=0.5)
        time.sleep(BAD_RADIO)
        self.bench.radio()
        since = time.monotonic()
        self.expect_counted("refused (times)", "damaged")
        self.expect_counted("station: frame of eyebug_")
        self.expect_service(since, "messages were damaged")

    def test_only_poses_are_damaged(self):
        self.bench.radio(corrupt=1.0, only="relative_pose")
        time.sleep(2.0)
        self.bench.radio()
        since = time.monotonic()
        self.expect_counted("message of eyebug_a refused", "damaged pose")
        self.expect_service(since, "poses were damaged")

    def test_everything_at_once(self):
        self.bench.radio(lose=0.1, duplicate=0.1, reorder=0.1, corrupt=0.1, delay=0.05)
        time.sleep(BAD_RADIO)
        self.bench.radio()
        self.expect_service(time.monotonic(), "all of these at once")

    # Others on the radio.

    def forward_as(self, change):
        """b's messages do not come as they are, but as changed by that function."""
        publishers, subscribers = [], []
        for topic, kind in ((f"/{B}/rprr/preview", BlockPreview),
                            (f"/{B}/rprr/encoded", EncodedFrame)):
            publisher = rospy.Publisher(RELAYED + topic, kind, queue_size=10)
            publishers.append(publisher)
            subscribers.append(rospy.Subscriber(
                topic, kind, lambda message, out=publisher: out.publish(change(message))))
        self.assertTrue(wait_for(lambda: all(p.get_num_connections() for p in publishers), 10))

        def end():
            for one in subscribers + publishers:
                one.unregister()
        return end

    def test_another_version(self):
        def of_another_version(message):
            data = bytearray(message.data[:-4])
            data[0] += 1
            message.data = bytes(data) + zlib.crc32(data).to_bytes(4, "little")
            return message
        self.bench.radio(down=True, only=B)
        end = self.forward_as(of_another_version)
        time.sleep(2.0)
        end()
        self.bench.radio()
        since = time.monotonic()
        self.expect_counted("message of eyebug_b refused", "preview message of an unknown version")
        self.expect_counted("frame of eyebug_b", "encoded frame of an unknown version")
        self.expect_service(since, "b was of another version")

    def test_another_robot_of_the_same_name(self):
        def of_another_robot(message):
            message.header.stamp += rospy.Duration(5000.0)
            message.exchange += 1000000
            return message
        end = self.forward_as(of_another_robot)
        try:
            time.sleep(3.0)
            since = time.monotonic()
            self.expect_counted(f"{A} exchange: two senders",
                                "more than one node (/fault_bench, /fault_relay)")
            self.expect_counted("station: two senders")
            self.expect_service(since, "another robot called b is there still")
        finally:
            end()
        self.expect_service(time.monotonic(), "another robot called b was there")

    # Clocks and cameras.

    def test_clock_of_the_reference_jumps(self):
        self.check_jump(A)

    def test_clock_of_the_dependent_jumps(self):
        self.check_jump(B)

    def check_jump(self, robot):
        self.cameras.offset[robot] = 1000.0
        time.sleep(3.0)
        self.cameras.offset[robot] = 0.0
        since = time.monotonic()
        self.expect_counted("stamps leap", "a clock that was set")
        self.expect_service(since, f"the clock of {robot} was off")

    def test_recording_starts_again(self):
        self.cameras.replay(2.0)
        since = time.monotonic()
        self.expect_counted("stamps leap", "a recording that starts again")
        self.expect_service(since, "the same stamps came again, time went back")
        self.assertTrue(wait_for(lambda: not self.cameras.replaying(), 10))
        self.expect_service(time.monotonic(), "time went on")

    def show(self, robot, change, seconds=2.0):
        self.cameras.change[robot] = change
        time.sleep(seconds)
        self.cameras.change[robot] = None
        return time.monotonic()

    def test_depth_without_readings(self):
        for robot in (A, B):
            since = self.show(robot, lambda bgr, depth: (bgr, numpy.zeros_like(depth)))
            self.expect_counted("depth empty", f"/{robot}/camera/depth_registered")
            self.expect_service(since, f"depth of {robot} was empty")

    def test_depth_of_nan(self):
        def nan(bgr, depth):
            return bgr, numpy.full(depth.shape, numpy.nan, numpy.float32)
        for robot in (A, B):
            since = self.show(robot, nan)
            self.expect_counted("depth empty", f"/{robot}/camera/depth_registered")
            self.expect_service(since, f"depth of {robot} was NaN")

    def test_black_images(self):
        for robot in (A, B):
            since = self.show(robot, lambda bgr, depth: (numpy.zeros_like(bgr), depth))
            self.expect_counted(f"{B} exchange: frames sent whole", "pose rejected")
            self.expect_service(since, f"{robot} saw nothing but black")


if __name__ == "__main__":
    script_test.main(Faults)
