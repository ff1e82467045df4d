# SPDX-License-Identifier: BSD-3-Clause
"""A pair with a relay, cameras and a judge, ready to be disturbed."""

import pathlib
import subprocess
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from dynamic_reconfigure.msg import BoolParameter, Config, DoubleParameter, StrParameter
from dynamic_reconfigure.srv import Reconfigure
from rprr_msgs.msg import PairStatistics

from processes import B, Processes, wait_for
from scene import Cameras, Judge

NO_FAULTS = {"down": False, "lose": 0.0, "duplicate": 0.0, "reorder": 0.0, "corrupt": 0.0,
             "delay": 0.0, "late": 0.15, "only": ""}


def make_recording(folder, frames=12, width=320, height=240):
    """A synthetic room, of which the truth is known."""
    folder = pathlib.Path(folder)
    if not (folder / "associations.txt").exists():
        subprocess.run(["rosrun", "rprr_sensor", "synthetic_to_folder", str(folder), "--frames",
                        str(frames), "--width", str(width), "--height", str(height)], check=True,
                       stdout=subprocess.DEVNULL)
    return folder


class Bench:
    def __init__(self, folder, recording, rate=4.0, seed=1, **options):
        self.processes = Processes(folder, seed, **options)
        try:
            self._begin(recording, rate)
        except BaseException:
            self.processes.stop()
            raise

    def _begin(self, recording, rate):
        self.processes.start()
        rospy.init_node("fault_bench", disable_signals=True, disable_rosout=True)
        self.cameras = Cameras(recording, rate)
        self.judge = Judge(self.cameras)
        self.statistics = []  # time, message; of b's frames
        self._diagnostics = []  # time, text
        self._counts = {}  # of diagnostics: by node, what to number
        self._lock = threading.Lock()
        rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics, queue_size=100)
        rospy.Subscriber("/station/statistics", PairStatistics, self._on_statistics,
                         queue_size=100)

    def stop(self):
        self.cameras.stop()
        self.processes.stop()

    def await_service(self, seconds):
        """Everything is connected and b's frames are rebuilt."""
        if not wait_for(lambda: self.cameras.heard() and self.judge.connected(), seconds):
            return False
        self.cameras.playing.set()
        start = time.monotonic()
        return wait_for(lambda: self.judge.rebuilt_since(start) is not None, seconds)

    def radio(self, **faults):
        """Faults of the radio from now on; without any it is well again."""
        self.configure("/fault_relay", **{**NO_FAULTS, **faults})

    @staticmethod
    def configure(node, **values):
        """Sets what the node lets be set while it runs."""
        config = Config()
        for name, value in values.items():
            if isinstance(value, bool):
                config.bools.append(BoolParameter(name, value))
            elif isinstance(value, str):
                config.strs.append(StrParameter(name, value))
            else:
                config.doubles.append(DoubleParameter(name, float(value)))
        rospy.wait_for_service(node + "/set_parameters", 20)
        rospy.ServiceProxy(node + "/set_parameters", Reconfigure)(config)

    def seconds_until_rebuilt(self, since, patience):
        """From that moment until a frame of b, shown later, is rebuilt; None: not in time."""
        if not wait_for(lambda: self.judge.rebuilt_since(since) is not None, patience):
            return None
        return self.judge.rebuilt_since(since).came - since

    def said(self, text, since):
        """What /diagnostics said with that text in it after that moment."""
        with self._lock:
            return [said for moment, said in self._diagnostics if moment > since and text in said]

    def counts(self):
        """Counters of /diagnostics as they are now: "<host> <node>: <key>" to number."""
        with self._lock:
            return {f"{node}: {what}": count for node, counts in self._counts.items()
                    for what, count in counts.items()}

    def heard_since(self, since):
        with self._lock:
            return sorted({said for moment, said in self._diagnostics
                           if moment > since and ": running" not in said})

    def _on_diagnostics(self, message):
        now = time.monotonic()
        with self._lock:
            for status in message.status:
                begin = f"{status.hardware_id} {status.name.split(':')[-1].strip()}"
                self._diagnostics.append((now, f"{begin}: {status.message}"))
                self._diagnostics += [(now, f"{begin}: {pair.key} = {pair.value}")
                                      for pair in status.values]
                self._counts[begin] = {pair.key: int(pair.value) for pair in status.values
                                       if pair.value.isdigit()}
            del self._diagnostics[:-20000]

    def _on_statistics(self, message):
        if message.robot == B:
            self.statistics.append((time.monotonic(), message))
            del self.statistics[:-5000]
