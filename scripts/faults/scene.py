# SPDX-License-Identifier: BSD-3-Clause
"""Cameras of a pair that show a recording, and a judge of what the station makes of it."""

import collections
import copy
import pathlib
import sys
import threading
import time

import numpy
import rospy
from sensor_msgs.msg import CameraInfo, Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "radio"))
import cv2  # noqa: E402
from recording import Recording  # noqa: E402

from processes import A, B  # noqa: E402

RECEIVED, RECEIVED_DEPTH = 255, 208  # rprr_view/provenance.hpp
Truth = collections.namedtuple("Truth", "bgr depth played")


class Cameras:
    """Both robots' cameras, from a thread of its own: entry k is a's, k + 1 b's.

    What to show is changed while it runs: offset (seconds by which a robot's stamps are off),
    change (a function of colour and depth in mm), alter (a function of camera_info, colour and
    depth as messages, which gives those to be published; None: none), playing, and replay(), which
    shows again what was shown, with the same stamps.
    """

    def __init__(self, folder, rate):
        self.recording, self.rate = Recording(folder), rate
        self.offset = {A: 0.0, B: 0.0}
        self.change = {A: None, B: None}
        self.alter = {A: None, B: None}
        self.playing = threading.Event()
        self.truth = collections.OrderedDict()  # (robot, stamp in ns) to Truth
        self._lock = threading.Lock()
        self._replay = collections.deque()
        self._shown = collections.deque(maxlen=200)  # number and stamp
        self._images = [(cv2.imread(colour), cv2.imread(depth, cv2.IMREAD_UNCHANGED))
                        for colour, depth in zip(self.recording.colour, self.recording.depth)]
        self._publishers = {
            robot: [rospy.Publisher(f"/{robot}/camera/{name}", kind, queue_size=4)
                    for name, kind in (("rgb/camera_info", CameraInfo),
                                       ("rgb/image_rect_color", Image),
                                       ("depth_registered/image_rect", Image))]
            for robot in (A, B)}
        self._stop = False
        self._thread = threading.Thread(target=self._play, daemon=True)
        self._thread.start()

    def heard(self):
        """The nodes of both robots that look at their cameras do so."""
        return all(publisher.get_num_connections() >= 1 for publishers in
                   self._publishers.values() for publisher in publishers)

    def replay(self, seconds):
        """What was shown in the last seconds comes once more, as when a bag starts again."""
        with self._lock:
            self._replay.extend(list(self._shown)[-max(1, int(seconds * self.rate)):])

    def replaying(self):
        return bool(self._replay)

    def stop(self):
        self._stop = True
        self.playing.set()
        self._thread.join()

    def truth_of(self, robot, stamp):
        with self._lock:
            return self.truth.get((robot, stamp))

    def _play(self):
        number, due = 0, time.monotonic()
        while not self._stop:
            self.playing.wait()
            with self._lock:
                shown = self._replay.popleft() if self._replay else None
            if shown is None:
                shown = (number, time.time_ns())
                number += 1
                self._shown.append(shown)
            for robot in (B, A):
                self._show(robot, *shown)
            due = max(due + 1.0 / self.rate, time.monotonic())
            time.sleep(max(0.0, due - time.monotonic()))

    def _show(self, robot, number, stamp):
        bgr, depth = self._images[self.recording.entry(number, 1, robot == B)]
        if self.change[robot]:
            bgr, depth = self.change[robot](bgr, depth)
        stamp += int(self.offset[robot] * 1e9)
        with self._lock:
            self.truth[robot, stamp] = Truth(bgr, depth, time.monotonic())
            while len(self.truth) > 400:
                self.truth.popitem(last=False)
        header = rospy.Header(stamp=rospy.Time(stamp // 10**9, stamp % 10**9),
                              frame_id=robot + "_rgb_optical_frame")
        encoding = "16UC1" if depth.dtype == numpy.uint16 else "32FC1"
        messages = [camera_info(self.recording.camera, header),
                    image_message(bgr, "bgr8", header), image_message(depth, encoding, header)]
        if self.alter[robot]:
            messages = self.alter[robot](*(copy.deepcopy(message) for message in messages))
        for publisher, message in zip(self._publishers[robot], messages):
            if message is not None:
                publisher.publish(message)


def camera_info(camera, header):
    fx, fy, cx, cy = (float(camera[key]) for key in ("fx", "fy", "cx", "cy"))
    return CameraInfo(header=header, width=camera["width"], height=camera["height"],
                      distortion_model="plumb_bob", D=[0.0] * 5,
                      K=[fx, 0, cx, 0, fy, cy, 0, 0, 1], R=[1, 0, 0, 0, 1, 0, 0, 0, 1],
                      P=[fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0])


def image_message(pixels, encoding, header):
    pixels = numpy.ascontiguousarray(pixels)
    return Image(header=header, height=pixels.shape[0], width=pixels.shape[1], encoding=encoding,
                 step=pixels.strides[0], data=pixels.tobytes())


def pixels_of(image):
    kind, channels = {"bgr8": (numpy.uint8, 3), "mono8": (numpy.uint8, 1),
                      "16UC1": (numpy.uint16, 1), "32FC1": (numpy.float32, 1)}[image.encoding]
    rows = numpy.frombuffer(image.data, numpy.uint8).reshape(image.height, image.step)
    pixels = rows[:, :image.width * channels * numpy.dtype(kind).itemsize].copy().view(kind)
    return pixels.reshape(image.height, image.width, channels) if channels > 1 else pixels


def millimetres(depth):
    if depth.dtype == numpy.uint16:
        return depth.astype(numpy.float64)
    return numpy.nan_to_num(depth.astype(numpy.float64) * 1e3)


def psnr(image, truth):
    error = numpy.mean((image.astype(numpy.float64) - truth.astype(numpy.float64)) ** 2)
    return 99.0 if error == 0 else 10.0 * numpy.log10(255.0 ** 2 / error)


View = collections.namedtuple("View", "robot stamp came played sparse psnr far wrong")


class Judge:
    """Listens to the station and holds each view against what that robot's camera saw."""

    LEAST_PSNR = 27.0  # dB, of the whole view; rebuilt well it has some 31
    FAR_MM, MOST_FAR = 100.0, 0.1  # share of predicted depths that are so far off: at edges
    MEDIAN_MM = 25.0  # of predicted depths' errors; at a right pose a few

    def __init__(self, cameras):
        self.cameras = cameras
        self.views = collections.deque(maxlen=10000)  # View
        self.wrong = collections.deque(maxlen=1000)  # of these, ever
        self._parts = collections.OrderedDict()
        self._lock = threading.Lock()
        self._subscribers = [
            rospy.Subscriber(f"/station/{robot}/{topic}", Image, self._on_image, (robot, topic),
                             queue_size=20, buff_size=1 << 22)
            for robot in (A, B) for topic in ("rgb/image_rect_color",
                                              "depth_registered/image_rect", "provenance")]

    def connected(self):
        return all(subscriber.get_num_connections() for subscriber in self._subscribers)

    def rebuilt_since(self, moment):
        """The first view of b that was rebuilt from a's, of a frame that was shown after that."""
        views = [view for view in list(self.views)
                 if view.robot == B and view.sparse and view.played > moment]
        return views[0] if views else None

    def _on_image(self, image, place):
        robot, topic = place
        key = robot, image.header.stamp.to_nsec()
        with self._lock:
            parts = self._parts.setdefault(key, {})
            parts[topic] = image
            while len(self._parts) > 20:
                self._parts.popitem(last=False)
            if len(parts) < 3:
                return
            del self._parts[key]
        truth = self.cameras.truth_of(*key)
        if truth is None:
            return
        view = self._judge(key, parts, truth)
        self.views.append(view)
        if view.wrong:
            self.wrong.append(view)

    def _judge(self, key, parts, truth):
        bgr = pixels_of(parts["rgb/image_rect_color"])
        depth = millimetres(pixels_of(parts["depth_registered/image_rect"]))
        provenance = pixels_of(parts["provenance"])
        true_depth = millimetres(truth.depth)
        received = (provenance == RECEIVED) | (provenance == RECEIVED_DEPTH)
        guessed = ~received & (depth > 0) & (true_depth > 0)
        off = numpy.abs(depth - true_depth)[guessed]
        share_far = float(numpy.mean(off > self.FAR_MM)) if off.size else 0.0
        decibels = psnr(bgr, truth.bgr)
        wrong = ""
        if numpy.any(numpy.abs(depth - true_depth)[received] > 0.11):  # of a mm
            wrong = "received depth is not what the camera saw"
        elif decibels < self.LEAST_PSNR:
            wrong = f"PSNR {decibels:.1f} dB"
        elif share_far > self.MOST_FAR:
            wrong = f"{100 * share_far:.0f}% of the predicted depths are far off"
        elif off.size and numpy.median(off) > self.MEDIAN_MM:
            wrong = f"predicted depths are off by {numpy.median(off):.0f} mm"
        return View(*key, time.monotonic(), truth.played, not numpy.all(provenance == RECEIVED),
                    decibels, share_far, wrong)
