#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The workspace installed into a folder, used from there alone: the devel space is out of reach.

What is built is installed as `catkin build` with an install space would do it, without a second
build.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree

import script_test
from script_test import free_port

SOURCES = script_test.ROOT / "src"
PACKAGES = sorted(file.parent.name for file in SOURCES.glob("*/package.xml"))
# build/<package>/test_results/<package>/<file of results>
BUILD = (pathlib.Path(sys.argv[1]).resolve().parents[3] if len(sys.argv) > 1
         else script_test.ROOT / "build")
PATHS = ("CMAKE_PREFIX_PATH", "LD_LIBRARY_PATH", "PATH", "PKG_CONFIG_PATH", "PYTHONPATH",
         "ROS_PACKAGE_PATH", "ROSLISP_PACKAGE_DIRECTORIES")


def within(folder, path):
    return pathlib.Path(folder) in pathlib.Path(path).resolve().parents


def installed_environment(prefix, home):
    """What a shell has that sourced the install space, with nothing else but the system's."""
    bare = {"HOME": str(home), "PATH": "/usr/bin:/bin", "LANG": "C.UTF-8",
            "ROS_HOSTNAME": "localhost", "ROS_HOME": str(home),
            "ROS_MASTER_URI": f"http://localhost:{free_port()}"}
    said = subprocess.run(["bash", "-c", f"source '{prefix}/setup.bash' && env -0"], env=bare,
                          check=True, stdout=subprocess.PIPE).stdout.decode()
    environment = dict(line.split("=", 1) for line in said.split("\0") if "=" in line)
    for name in PATHS:
        kept = [path for path in environment.get(name, "").split(":")
                if pathlib.Path(path) == prefix or within(prefix, path)
                or path.startswith(("/usr/", "/bin", "/opt/ros/")) or path == "/usr"]
        environment[name] = ":".join(kept)
    return environment


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="rprr_install_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        for package in PACKAGES:
            # Not --prefix, which catkin's own files do not heed.
            subprocess.run(["cmake", "--install", str(BUILD / package)], check=True,
                           env={**os.environ, "DESTDIR": str(cls.folder)},
                           stdout=subprocess.DEVNULL)
        cls.prefix = next(cls.folder.rglob("setup.bash")).parent
        cls.environment = installed_environment(cls.prefix, cls.folder)

    def run_installed(self, *command, seconds=120):
        """What the command said, if it ended well."""
        ended = subprocess.run([str(each) for each in command], env=self.environment,
                               cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, timeout=seconds, check=False)
        self.assertEqual(ended.returncode, 0, ended.stdout)
        return ended.stdout

    def expect_installed(self, path):
        self.assertTrue(within(self.prefix, path), f"{path} is not in the install space")
        self.assertTrue(pathlib.Path(path).exists(), f"there is no {path}")

    def test_packages_are_those_installed(self):
        for package in PACKAGES:
            self.expect_installed(self.run_installed("rospack", "find", package).strip())

    def test_launch_files_and_what_they_include(self):
        for file in sorted((script_test.ROOT / "launch").glob("*.launch")):
            arguments = ("rprr_bringup", file.name, "role:=a", "bag:=none", "output:=none")
            self.assertIn("/", self.run_installed("roslaunch", "--nodes", *arguments))
            for used in self.run_installed("roslaunch", "--files", *arguments).split():
                self.expect_installed(used)

    def test_every_header(self):
        for folder in SOURCES.glob("*/include"):
            for header in folder.rglob("*.hpp"):
                self.expect_installed(self.prefix / "include" / header.relative_to(folder))

    def test_parameters_and_settings(self):
        for file in SOURCES.glob("*/config/**/*.yaml"):
            self.expect_installed(self.prefix / "share" / file.relative_to(SOURCES))
        for file in SOURCES.glob("*/cfg/*.cfg"):
            module = f"{file.parts[-3]}.cfg.{file.stem}Config"
            said = self.run_installed("/usr/bin/python3", "-c",
                                      f"import {module} as it; print(it.__file__)")
            self.expect_installed(said.strip())

    def test_plugins_and_their_libraries(self):
        for kind in ("nodelet", "image_transport"):
            said = self.run_installed("rospack", "plugins", "--attrib=plugin", kind)
            files = [line.split()[1] for line in said.splitlines() if line.startswith("rprr_")]
            self.assertTrue(files, said)
            for file in files:
                self.expect_installed(file)
                for library in ElementTree.parse(file).getroot().iter("library"):
                    path = self.prefix / (library.get("path") + ".so")
                    self.expect_installed(path)
                    self.run_installed("/usr/bin/python3", "-c",
                                       f"import ctypes; ctypes.CDLL('{path}')")

    def test_image_transports(self):
        said = self.run_installed("rosrun", "image_transport", "list_transports")
        for name in ("dhcm", "pgf"):
            described = re.search(rf'"image_transport/{name}"\n(.*?)\n\n', said + "\n\n", re.S)
            self.assertIsNotNone(described, said)
            self.assertNotIn("could not be loaded", described.group(1).lower())

    def test_standalone_nodes(self):
        """Every node that docs/parameters.md names as an executable."""
        page = (script_test.ROOT / "docs" / "parameters.md").read_text(encoding="utf-8")
        names = set(re.findall(r"`([a-z_0-9]+_node)`", page))
        self.assertGreater(len(names), 7)
        installed = {path.name for path in (self.prefix / "lib").glob("rprr_*/*")}
        self.assertEqual(names - installed, set())

    def test_tools(self):
        recording, results = self.folder / "room", self.folder / "pairs.jsonl"
        self.run_installed("rosrun", "rprr_sensor", "synthetic_to_folder", recording, "--frames",
                           "3", "--width", "160", "--height", "120")
        self.run_installed("rosrun", "rprr_eval", "rprr_eval", "pairs", recording, "--step", "1",
                           "--json", results)
        pairs = [json.loads(line) for line in results.read_text(encoding="utf-8").splitlines()]
        self.assertTrue(any(pair.get("pose", {}).get("accepted") for pair in pairs), pairs)
        self.run_installed("rosrun", "rprr_codec", "dhcm", "encode", recording / "depth", "-o",
                           self.folder / "coded")
        self.assertIn("Usage", self.run_installed("rosrun", "rprr_bringup", "keep_running", "--help"))

    def start_demo(self, output, standalone):
        recording = self.folder / "synthetic.bag"
        if not recording.exists():
            self.run_installed("rosrun", "rprr_sensor", "synthetic_to_bag", recording, "--frames",
                               "8", "--rate", "1")
        port = free_port()
        with open(output / "roslaunch.log", "wb") as log:
            return subprocess.Popen(
                ["roslaunch", "--skip-log-check", "-p", str(port), "rprr_bringup", "demo.launch",
                 f"bag:={recording}", f"output:={output}", "exchanges:=4",
                 f"standalone:={standalone}"],
                env={**self.environment, "ROS_MASTER_URI": f"http://localhost:{port}",
                     "ROS_LOG_DIR": str(output / "log")},
                cwd=self.folder, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                start_new_session=True)

    def watch(self, process):
        """Libraries of ours that processes of that launch have mapped, until it has ended."""
        libraries = set()
        end = time.monotonic() + 180
        while process.poll() is None and time.monotonic() < end:
            for folder in pathlib.Path("/proc").glob("[0-9]*"):
                try:
                    if str(self.folder) not in (folder / "environ").read_text(errors="replace"):
                        continue
                    maps = (folder / "maps").read_text(errors="replace")
                except OSError:
                    continue
                libraries |= set(re.findall(r"\S*/librprr_\S*\.so", maps))
            time.sleep(0.5)
        self.assertIsNotNone(process.poll(), "the demo did not end")
        return libraries

    def expect_demo(self, standalone):
        output = self.folder / ("nodes" if standalone == "true" else "nodelets")
        output.mkdir()
        process = self.start_demo(output, standalone)
        try:
            libraries = self.watch(process)
        finally:
            if process.poll() is None:
                process.terminate()
                process.wait(30)
        said = (output / "roslaunch.log").read_text(encoding="utf-8", errors="replace")
        self.assertTrue((output / "summary.json").exists(), said)
        summary = json.loads((output / "summary.json").read_text(encoding="utf-8"))
        self.assertGreater(summary["exchanges"]["completed"], 0, said)
        self.assertTrue((output / "picture.png").exists(), said)
        self.assertGreater(len(libraries), 4)
        for library in libraries:
            self.expect_installed(library)

    def test_demo_of_nodelets(self):
        self.expect_demo("false")

    def test_demo_of_nodes(self):
        self.expect_demo("true")


if __name__ == "__main__":
    script_test.main(Install)
