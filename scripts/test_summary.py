#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Adds up the results of gtest and rostest, and says what failed and what was skipped and why.

Usage: test_summary.py BUILD_SPACE [--failed=CHECK]...

Prints `N passed, N failed, N skipped` as the last line. A check given as failed counts as one
failure. Exits with 1 on any failure, or if no test ran.
"""

import argparse
import collections
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

Case = collections.namedtuple("Case", "package name outcome message")


def cases_of(path, package):
    """The test cases of one JUnit file; one failed case if it cannot be read."""
    try:
        suites = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, OSError) as error:
        return [Case(package, path.name, "failed", f"unreadable result: {error}")]
    cases = []
    for case in suites.iter("testcase"):
        if case.get("status") == "notrun":  # disabled in the source
            continue
        name = f"{case.get('classname', '')}.{case.get('name', '')}".lstrip(".")
        faults = case.findall("failure") + case.findall("error")
        skipped = case.find("skipped")
        if faults:
            texts = [fault.get("message") or fault.text or "" for fault in faults]
            cases.append(Case(package, name, "failed", "\n".join(texts).strip()))
        elif skipped is not None or case.get("result") == "skipped":
            text = "" if skipped is None else skipped.get("message") or skipped.text or ""
            cases.append(Case(package, name, "skipped", text.strip()))
        else:
            cases.append(Case(package, name, "passed", ""))
    return cases


def collect(build):
    """All cases under build/<package>/test_results."""
    cases = []
    for folder in sorted(build.glob("*/test_results")):
        package = folder.parent.name
        files = sorted(folder.rglob("*.xml"))
        # rostest writes a test's own results as rosunit-*.xml and repeats them in rostest-*.xml,
        # which alone tells of tests that died or never came up.
        repeats = [path for path in files if path.name.startswith("rostest-")]
        own = [case for path in files if path not in repeats for case in cases_of(path, package)]
        cases += own
        known_failures = {case.name.rsplit(".", 1)[-1] for case in own if case.outcome == "failed"}
        for path in repeats:
            cases += [
                case._replace(name=f"{path.stem}: {case.name}")
                for case in cases_of(path, package)
                if case.outcome == "failed"
                and case.name.rsplit(".", 1)[-1] not in known_failures
            ]
    return cases


def show_skipped(cases):
    """Skipped tests, grouped by their reason."""
    by_reason = collections.defaultdict(list)
    for case in cases:
        if case.outcome == "skipped":
            lines = [line for line in case.message.splitlines() if line.strip()]
            by_reason[lines[-1].strip() if lines else "no reason given"].append(case)
    for reason, group in by_reason.items():
        print(f"skipped, {reason}:")
        for case in group:
            print(f"  {case.package}: {case.name}")


def show_failed(cases):
    """Failed tests with what they said."""
    for case in cases:
        if case.outcome == "failed":
            print(f"FAILED {case.package}: {case.name}")
            for line in case.message.splitlines()[:20]:
                print(f"    {line}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--failed", action="append", default=[], metavar="CHECK")
    arguments = parser.parse_args()
    cases = collect(arguments.build)
    show_skipped(cases)
    show_failed(cases)
    for check in arguments.failed:
        print(f"FAILED {check}")
    counts = collections.Counter(case.outcome for case in cases)
    if not cases:
        print("no test ran")
    failed = counts["failed"] + len(arguments.failed)
    print(f"{counts['passed']} passed, {failed} failed, {counts['skipped']} skipped", flush=True)
    return 1 if failed or not counts["passed"] else 0


if __name__ == "__main__":
    sys.exit(main())
