#!/usr/bin/env python3
"""Lists the tests that were skipped, with reasons, from the XML files that googletest and rostest leave in a folder.

Usage: skipped_tests.py FOLDER
Exits with 77 when some were skipped, which ctest shows as a skipped test.
"""
import os
import sys
import xml.etree.ElementTree

EXIT_SKIPPED = 77


def reason_of(case):
    """googletest begins the message with a line that holds the file and the line number."""
    skipped = case.find("skipped")
    lines = ((skipped.get("message") if skipped is not None else None) or "").strip().splitlines()
    return " ".join(lines[1:] if len(lines) > 1 else lines) or "no reason given"


def skipped_in(path):
    """Yields "test: reason" for the skipped and the disabled tests of a result file."""
    for case in xml.etree.ElementTree.parse(path).iter("testcase"):
        name = case.get("classname", "") + "." + case.get("name", "")
        if case.get("status") == "notrun":
            yield name + ": disabled"
        elif case.get("result") == "skipped" or case.find("skipped") is not None:
            yield name + ": " + reason_of(case)


def main():
    folder = sys.argv[1]
    files = [file for file in sorted(os.listdir(folder)) if file.endswith(".xml")] if os.path.isdir(folder) else []
    if not files:
        print("No test results in %s." % folder)
        return 0
    lines = []
    for file in files:
        if file.startswith("rostest-"):  # sums up what rosunit's file holds
            continue
        program = os.path.splitext(file)[0].split("-", 1)[-1]
        lines += ["  " + program + ": " + line for line in skipped_in(os.path.join(folder, file))]
    if not lines:
        print("No test was skipped.")
        return 0
    print("Skipped tests (%d):" % len(lines))
    print("\n".join(lines))
    return EXIT_SKIPPED


if __name__ == "__main__":
    sys.exit(main())
