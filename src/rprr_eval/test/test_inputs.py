#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What people feed a pair: each fault is named on /diagnostics within seconds, with topic and
remedy, and the report goes when the fault goes. While all is well nothing is said.

INPUTS_LOGS=FOLDER keeps the nodes' logs.
"""

import subprocess
import sys
import time

import genpy
import numpy
import rospy

import script_test
from bench_test import BenchTest

from processes import A, B, Process, wait_for
from scene import image_message, pixels_of

WITHIN = 5.0 + 4.0  # seconds: a report comes within 5, diagnostics once a second, this machine is busy
GONE_WITHIN = 6.0   # seconds after it is mended
RGB, INFO, DEPTH = "camera/rgb/image_rect_color", "camera/rgb/camera_info", \
    "camera/depth_registered/image_rect"


def no_colour(info, _, depth):
    return info, None, depth


def no_depth(info, colour, _):
    return info, colour, None


def stamps_of_zero(*messages):
    for message in messages:
        message.header.stamp = genpy.Time(0)
    return messages


def stamps_that_stand_still(*messages):
    for message in messages:
        message.header.stamp = genpy.Time(1600000000, 5)
    return messages


def stamps_apart(info, colour, depth):
    depth.header.stamp += genpy.Duration(0, 90000000)
    return info, colour, depth


def tenths_of_a_millimetre(info, colour, depth):
    counts = numpy.minimum(pixels_of(depth).astype(numpy.uint32) * 10, 65535).astype(numpy.uint16)
    return info, colour, image_message(counts, "16UC1", depth.header)


def metres_as_kilometres(info, colour, depth):
    return info, colour, image_message((pixels_of(depth) * 1e-6).astype(numpy.float32), "32FC1",
                                       depth.header)


def a_hall(info, colour, depth):
    metres = (pixels_of(depth) * 0.0012).astype(numpy.float32)
    metres[:, ::3] = 20.0
    return info, colour, image_message(metres, "32FC1", depth.header)


def another_frame(info, colour, depth):
    depth.header.frame_id = "camera_depth_optical_frame"
    return info, colour, depth


def depth_of_half_the_size(info, colour, depth):
    return info, colour, image_message(pixels_of(depth)[::2, ::2], "16UC1", depth.header)


def info_of_another_size(info, colour, depth):
    info.width, info.height = 1280, 720
    return info, colour, depth


def distorted(info, colour, depth):
    info.D = [0.26, -0.95, 0.0, 0.0, 1.16]
    return info, colour, depth


def rotated(info, colour, depth):
    info.R = [0.9998, -0.02, 0, 0.02, 0.9998, 0, 0, 0, 1]
    return info, colour, depth


def uncalibrated(info, colour, depth):
    info.K = [0.0] * 9
    info.P = [0.0] * 12
    return info, colour, depth


def black_depth(info, colour, depth):
    return info, colour, image_message(pixels_of(depth) * 0, "16UC1", depth.header)


def depth_in_colour(info, colour, depth):
    return info, colour, image_message(pixels_of(colour), "bgr8", depth.header)


def cut_off(info, colour, depth):
    colour.data = colour.data[:len(colour.data) // 2]
    return info, colour, depth


# A fault of a camera, and what the report must hold beside the robot's name.
FAULTS = [
    (no_colour, [RGB, "start the camera"]),
    (no_depth, [DEPTH, "start the camera"]),
    (stamps_of_zero, [RGB, "are 0", "driver"]),
    (stamps_that_stand_still, ["do not move on", "driver"]),
    (stamps_apart, [RGB, DEPTH, "~max_stamp_difference"]),
    (tenths_of_a_millimetre, [DEPTH, "~depth_scale"]),
    (metres_as_kilometres, [DEPTH, "must be metres"]),
    (a_hall, [DEPTH, "beyond 13.1 m", "~depth_unit"]),
    (another_frame, [DEPTH, "camera_depth_optical_frame", "registered"]),
    (depth_of_half_the_size, [DEPTH, "320x240", "160x120", "registered"]),
    (info_of_another_size, [INFO, "320x240", "1280x720"]),
    (distorted, [INFO, "unrectified", "image_proc"]),
    (rotated, [INFO, "rotation R"]),
    (uncalibrated, [INFO, "intrinsics"]),
    (black_depth, [DEPTH, "no reading"]),
    (depth_in_colour, [DEPTH, "is not depth", "16UC1"]),
    (cut_off, [RGB, "check its publisher"]),
]


class Inputs(BenchTest):
    name = "inputs"
    rate = 4.0

    def tearDown(self):
        for robot in (A, B):
            self.bench.cameras.alter[robot] = None
        self.bench.radio()
        for process in self.bench.processes.all():
            if not process.alive():
                process.start()

    def problems(self, seconds):
        """What any node complained of in the last seconds."""
        return [text for text in self.bench.heard_since(time.monotonic() - seconds)
                if " = " not in text]

    def holding(self, parts, seconds):
        return [text for text in self.problems(seconds) if all(part in text for part in parts)]

    def expect_report(self, parts, what):
        begun = time.monotonic()
        self.assertTrue(wait_for(lambda: self.holding(parts, time.monotonic() - begun), WITHIN),
                        f"{what}: nothing with {parts} in\n" + "\n".join(self.problems(WITHIN)))
        return time.monotonic() - begun

    def expect_silence(self, parts, what):
        """The report goes: none for as long as every node says something twice."""
        self.assertTrue(wait_for(lambda: not self.holding(parts, 2.5), GONE_WITHIN + 2.5),
                        f"{what}: still said\n" + "\n".join(self.holding(parts, 2.5)))

    def test_1_nothing_is_said_while_all_is_well(self):
        # These cameras walk, which is told where an exchange takes long on a busy machine. What was
        # said of the first moments is shown for ten seconds.
        def complaints():
            return [text for text in self.problems(2.5) if "the camera moved" not in text]
        self.assertTrue(wait_for(lambda: not complaints(), 20.0), complaints())

    def test_2_faults_of_cameras_are_named_until_they_are_mended(self):
        # Two at a time: robots have nothing to do with each other's cameras.
        for first, second in zip(FAULTS[::2], FAULTS[1::2] + FAULTS[:1]):
            faults = {A: first, B: second}
            for robot, (fault, _) in faults.items():
                self.bench.cameras.alter[robot] = fault
            reports = {robot: [robot + " exchange", *parts] for robot, (_, parts) in faults.items()}
            for robot, (fault, _) in faults.items():
                with self.subTest(fault=fault.__name__):
                    seconds = self.expect_report(reports[robot], fault.__name__)
                    print(f"{fault.__name__}: named after {seconds:.1f} s", file=sys.stderr)
            for robot in faults:
                self.bench.cameras.alter[robot] = None
            for robot, (fault, _) in faults.items():
                with self.subTest(mended=fault.__name__):
                    self.expect_silence(reports[robot], fault.__name__)

    def test_3_robots_whose_frames_have_one_name_are_named(self):
        def common_frame(*messages):
            for message in messages:
                message.header.frame_id = "camera_color_optical_frame"
            return messages
        for robot in (A, B):
            self.bench.cameras.alter[robot] = common_frame
        self.expect_report([" exchange", A, B, "camera_color_optical_frame"], "one name")
        for robot in (A, B):
            self.bench.cameras.alter[robot] = None
        time.sleep(8.0)  # shown for a while after the last exchange of that kind
        self.expect_silence([" exchange", "camera_color_optical_frame"], "one name")

    def test_4_a_peer_and_a_station_that_are_gone_are_named(self):
        exchange = next(node for name, node in self.bench.processes.nodes.items()
                        if name.startswith(f"/{B}/") and "exchange" in name)
        exchange.kill()
        self.bench.radio(down=True, only="receipts")
        self.expect_report([A + " exchange", f"robot '{B}'", "start its nodes"], "no peer")
        self.expect_report([B + " redundancy", "exchanges", "rprr_pose/Exchange"], "half a robot")
        self.expect_report([A + " encoder", "/station/receipts", "look at the station"],
                           "no receipts")
        exchange.start()
        self.bench.radio()
        self.expect_silence([A + " exchange", f"robot '{B}'"], "no peer")
        self.expect_silence([A + " encoder", "/station/receipts"], "no receipts")

    def another_robot(self, name, *arguments):
        """An exchange node beside the pair's, which needs eyebug_d."""
        rospy.set_param(f"/{name}/peers", ["eyebug_d"])
        processes = self.bench.processes
        node = Process(name, ["rosrun", "rprr_pose", "exchange_node", f"__name:={name}",
                              *arguments],
                       processes.environment, processes.folder / f"{name}.log")
        node.start()
        self.addCleanup(node.stop)
        return node

    def test_5_a_transport_that_is_not_installed_is_named_with_those_that_are(self):
        node = self.another_robot("odd", "_robot:=eyebug_o", "_depth_transport:=compressedDepth")
        self.expect_report(["eyebug_o exchange", "'compressedDepth'", DEPTH, "installed", "dhcm"],
                           "no transport")
        self.assertTrue(node.alive(), "the process goes on for whoever shares it")

    def test_5_a_robot_that_hears_nothing_says_so(self):
        rospy.set_param("/lonely_time", True)
        begun = time.monotonic()
        self.another_robot("lonely", "_robot:=eyebug_c", "/use_sim_time:=/lonely_time")
        for part in (RGB, DEPTH, INFO, "/clock", "eyebug_d"):
            self.assertTrue(wait_for(
                lambda part=part: self.holding(["eyebug_c exchange", part],
                                               time.monotonic() - begun), WITHIN),
                f"nothing of {part} in\n" + "\n".join(self.problems(WITHIN)))

    def status(self, *options):
        done = subprocess.run(["rosrun", "rprr_bringup", "status", "--seconds", "3", *options],
                              stdout=subprocess.PIPE, text=True, check=False, timeout=60)
        return done.returncode, done.stdout

    def test_6_status_answers_whether_it_works(self):
        self.assertIsNotNone(self.bench.seconds_until_rebuilt(time.monotonic(), 20))
        code, said = self.status()
        self.assertEqual(code, 0, said)
        for part in (A + ": ", B + ": ", "predicted", "kB/s", "latency"):
            self.assertIn(part, said)
        self.assertTrue(said.endswith("working\n"), said)
        self.bench.cameras.alter[B] = no_colour
        time.sleep(WITHIN)
        code, said = self.status("--robots")
        self.assertEqual(code, 1, said)
        self.assertIn(f"no frame of '{B}'", said)
        self.assertIn(f"/{B}/{RGB}", said)


if __name__ == "__main__":
    script_test.main(Inputs)
