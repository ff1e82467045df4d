# SPDX-License-Identifier: BSD-3-Clause
"""The clock of a robot whose nodes do not take the time from this machine."""

import threading
import time

import rospy
from rosgraph_msgs.msg import Clock

from processes import clock_topic


class RobotClock:
    """Ticks as this machine's clock does, but is ahead of it by offset seconds; that may be changed
    while it runs. Its nodes know the time to a tick."""

    TICK = 0.004

    def __init__(self, robot, offset=0.0):
        self.offset = offset
        self._publisher = rospy.Publisher(clock_topic(robot), Clock, queue_size=1,
                                          tcp_nodelay=True)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def stop(self):
        self._stop.set()
        self._thread.join()

    def _run(self):
        while not self._stop.wait(self.TICK):
            self._publisher.publish(Clock(rospy.Time.from_sec(time.time() + self.offset)))
