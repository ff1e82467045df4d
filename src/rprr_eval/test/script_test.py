# SPDX-License-Identifier: BSD-3-Clause
"""Runs the tests of a script in unittest, and writes what JUnit would: reasons of skips as well."""

import os
import pathlib
import sys
import time
import unittest
import xml.etree.ElementTree as ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCRIPTS = ROOT / "scripts"


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
