# SPDX-License-Identifier: BSD-3-Clause
"""Tests of scripts in unittest: what they share, and results as JUnit writes them, reasons of skips
as well."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCRIPTS = ROOT / "scripts"
sys.path.append(str(SCRIPTS / "faults"))

from ports import free_port  # noqa: E402,F401: tests of scripts take it from here


def wait_for(condition, seconds):
    """Whether the condition came true within so long."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.1)
    return False


class ScriptTest(unittest.TestCase):
    """One script of scripts/, run as people run it. Its tests share a folder, which is removed."""

    script = ""   # its name
    options = ()  # before those of each run; setUpClass may set them

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix=f"rprr_{cls.script}_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)

    def start(self, *options):
        """The process; what it says waits for end()."""
        return subprocess.Popen([str(SCRIPTS / self.script), *self.options, *options],
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)

    def end(self, process, status):
        """Waits until it ends, which must be with this status; what it said."""
        said, _ = process.communicate()
        self.assertEqual(process.returncode, status, said)
        return said

    def check_refused(self, *wrong):
        """Each of these lists of options ends the script with an error in words."""
        for options in wrong:
            with self.subTest(options=options):
                self.assertIn("error: ", self.end(self.start(*options), 1))


class _Result(unittest.TextTestResult):
    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.suite = ElementTree.Element("testsuite", name="scripts")
        self.case, self.started = None, 0.0

    def startTest(self, test):
        super().startTest(test)
        class_name, name = test.id().rsplit(".", 1)
        self.case = ElementTree.SubElement(self.suite, "testcase", classname=class_name, name=name)
        self.started = time.monotonic()

    def stopTest(self, test):
        super().stopTest(test)
        self.case.set("time", f"{time.monotonic() - self.started:.3f}")

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self._note("failure", self.failures[-1][1])

    def addError(self, test, err):
        super().addError(test, err)
        if self.case is None:  # in setUpClass
            self.case = ElementTree.SubElement(self.suite, "testcase", name=str(test))
        self._note("error", self.errors[-1][1])

    def addSubTest(self, test, subtest, err):
        super().addSubTest(test, subtest, err)
        if err is not None:
            failed = issubclass(err[0], test.failureException)
            self._note("failure" if failed else "error",
                       (self.failures if failed else self.errors)[-1][1])

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        if self.case is None:
            self.case = ElementTree.SubElement(self.suite, "testcase", name=str(test))
        self._note("skipped", reason)

    def _note(self, kind, text):
        plain = "".join(each if each.isprintable() or each == "\n" else " " for each in text)
        ElementTree.SubElement(self.case, kind, message=plain)


def main(test_case):
    """Runs all tests of the class; the only argument is the file for the results."""
    suite = unittest.defaultTestLoader.loadTestsFromTestCase(test_case)
    result = unittest.TextTestRunner(resultclass=_Result, verbosity=2).run(suite)
    for outcome in ("tests", "failures", "errors", "skipped"):
        count = result.testsRun if outcome == "tests" else len(getattr(result, outcome))
        result.suite.set(outcome, str(count))
    if len(sys.argv) > 1:
        os.makedirs(os.path.dirname(sys.argv[1]), exist_ok=True)
        ElementTree.ElementTree(result.suite).write(sys.argv[1])
    sys.exit(not result.wasSuccessful())
