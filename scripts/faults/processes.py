# SPDX-License-Identifier: BSD-3-Clause
"""A ROS master and the nodes of a pair as processes of ours, each ended and started alone.

What a node is called, runs and is told comes from launch/pair.launch; only the topics that cross
the radio are remapped, so that who hears them on another host hears them through fault_relay.
"""

import os
import pathlib
import signal
import subprocess
import time
import xmlrpc.client

import roslaunch.config
import roslaunch.xmlloader
import roslib.packages

from ports import free_port

ROOT = pathlib.Path(__file__).resolve().parents[2]
A, B = "eyebug_a", "eyebug_b"
# By the host that sends it.
RADIO = {A: [f"/{A}/rprr/relative_pose", f"/{A}/rprr/prediction", f"/{A}/rprr/encoded"],
         B: [f"/{B}/rprr/preview", f"/{B}/rprr/encoded"],
         "station": ["/station/receipts"]}
RELAYED = "/relayed"


def wait_for(condition, seconds, period=0.02):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(period)
    return condition()


def clock_topic(host):
    return f"/{host}/clock"


class Process:
    """A command that can be killed and started again."""

    def __init__(self, name, command, environment, log):
        self.name, self.command, self.environment, self.log = name, command, environment, log
        self.child = None
        self.ended = []  # processes that were killed

    def start(self):
        with open(self.log, "ab") as log:
            self.child = subprocess.Popen(self.command, env=self.environment, stdout=log,
                                          stdin=subprocess.DEVNULL, stderr=log,
                                          start_new_session=True)

    def alive(self):
        return self.child is not None and self.child.poll() is None

    def stop(self, number=signal.SIGTERM, patience=10):
        if not self.alive():
            return
        self.child.send_signal(number)
        try:
            self.child.wait(patience)
        except subprocess.TimeoutExpired:
            self.child.kill()
            self.child.wait()

    def kill(self):
        self.stop(signal.SIGKILL)
        self.ended.append(self.child.pid)

    def resident_kb(self):
        """Memory that the process has in RAM; None if it is not there."""
        try:
            status = pathlib.Path(f"/proc/{self.child.pid}/status").read_text(encoding="ascii")
        except (AttributeError, OSError):
            return None
        lines = [line.split()[1] for line in status.splitlines() if line.startswith("VmRSS")]
        return int(lines[0]) if lines else None

    def descriptors(self):
        try:
            return len(os.listdir(f"/proc/{self.child.pid}/fd"))
        except (AttributeError, OSError):
            return None


class Processes:
    """Master, relay and the pair's nodes. Logs are in the folder."""

    def __init__(self, folder, seed=1, launch_arguments=(), parameters=None, own_clock=()):
        """parameters: values by full name, beyond those of the launch file. own_clock: hosts whose
        nodes take the time from clock_topic(host), not from this machine."""
        self.own_clock = own_clock
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.port = free_port()
        self.environment = {**os.environ, "ROS_MASTER_URI": f"http://localhost:{self.port}",
                            "ROS_HOSTNAME": "localhost", "ROS_HOME": str(self.folder),
                            "ROS_LOG_DIR": str(self.folder / "log")}
        for name in ("ROS_IP", "ROS_NAMESPACE"):
            self.environment.pop(name, None)
        os.environ.update(self.environment)  # for rospy in this process
        self.master = self._process("master", ["roscore", "-p", str(self.port)])
        self.relay = self._process(
            "relay", [self._executable("rprr_eval", "fault_relay"), "__name:=fault_relay"])
        self.nodes = {}  # by full name
        self._launch(list(launch_arguments))
        self.parameters.update(parameters or {})
        self.parameters["/fault_relay/topics"] = sum(RADIO.values(), [])
        self.parameters["/fault_relay/seed"] = seed
        self.parameters.update({f"/{host}/use_sim_time": True for host in self.own_clock})

    def _process(self, name, command, **environment):
        return Process(name, command, {**self.environment, **environment},
                       self.folder / (name.strip("/").replace("/", "_") + ".log"))

    @staticmethod
    def _executable(package, kind):
        found = roslib.packages.find_node(package, kind)
        if not found:
            raise RuntimeError(f"{package}/{kind} is not built: run scripts/setup")
        return found[0]

    def _launch(self, arguments):
        config = roslaunch.config.ROSLaunchConfig()
        roslaunch.xmlloader.XmlLoader(resolve_anon=True).load(
            str(ROOT / "launch" / "pair.launch"), config, verbose=False,
            argv=["standalone:=true", *arguments])
        self.parameters = {name: parameter.value for name, parameter in config.params.items()}
        for node in config.nodes:
            host = node.namespace.strip("/").split("/")[0]
            heard = sum((topics for sender, topics in RADIO.items() if sender != host), [])
            command = [self._executable(node.package, node.type), f"__name:={node.name}"]
            command += [f"{topic}:={RELAYED}{topic}" for topic in heard]
            if host in self.own_clock:
                command += [f"/clock:={clock_topic(host)}", f"/use_sim_time:=/{host}/use_sim_time"]
            name = node.namespace + node.name
            self.nodes[name] = self._process(name, command,
                                             ROS_NAMESPACE=node.namespace.rstrip("/"))

    def start(self):
        self.master.start()
        proxy = xmlrpc.client.ServerProxy(self.environment["ROS_MASTER_URI"], allow_none=True)

        def answers():
            try:
                return proxy.getPid("/faults")[0] == 1
            except (OSError, xmlrpc.client.Error):
                return False
        if not wait_for(answers, 30):
            raise RuntimeError(f"no ROS master; see {self.master.log}")
        for name, value in self.parameters.items():
            proxy.setParam("/faults", name, value)
        self.relay.start()
        for node in self.nodes.values():
            node.start()

    def of(self, host):
        return [node for name, node in self.nodes.items() if name.startswith(f"/{host}/")]

    def all(self):
        return [self.relay, *self.nodes.values()]

    def left_behind(self):
        """What processes that were killed had started and what runs on without them."""
        ended = {pid: process.name for process in self.all() for pid in process.ended}
        left = []
        for folder in pathlib.Path("/proc").iterdir():
            try:
                fields = (folder / "stat").read_text(encoding="utf-8").rpartition(")")[2].split()
                state, session = fields[0], int(fields[3])
            except (OSError, IndexError, ValueError):
                continue
            if session in ended and state != "Z":
                left.append(f"process {folder.name} of {ended[session]} runs on without it")
        return left

    def stop(self):
        for process in self.nodes.values():
            if process.alive():
                process.child.send_signal(signal.SIGTERM)
        for process in self.all():
            process.stop()
        self.master.stop(signal.SIGINT)
