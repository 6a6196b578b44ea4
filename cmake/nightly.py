"""Prints docs/nightly.md from ctest's JUnit file: nightly.py REPORT ROOT."""

import datetime
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree


def cpu():
    """The processor's name as the system gives it."""
    text = subprocess.run(["lscpu"], capture_output=True, text=True, check=False).stdout
    model = re.search(r"^Model name:\s*(.+)$", text, re.MULTILINE)
    return model.group(1) if model else "unknown"


def commit(root):
    command = ["git", "-C", root, "describe", "--always", "--dirty", "--abbrev=12", "--exclude", "*"]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip() or "unknown"


def rows(report):
    """(name, result, seconds) of every test, in the order of their names."""
    for case in sorted(ElementTree.parse(report).iter("testcase"), key=lambda case: case.get("name")):
        result = {"run": "passed", "fail": "FAILED"}.get(case.get("status"), case.get("status"))
        yield case.get("name"), result, float(case.get("time"))


def main(report, root):
    cases = list(rows(report)) if pathlib.Path(report).exists() else []
    failed = sum(result != "passed" for _, result, _ in cases)
    print("# Nightly tests\n")
    print("Written by `./noether test --nightly`.\n")
    print(f"- date: {datetime.date.today().isoformat()}")
    print(f"- commit: {commit(root)}")
    print(f"- cpu: {cpu()}")
    print(f"- result: {len(cases) - failed} of {len(cases)} passed\n")
    print("| test | result | seconds |\n|---|---|---|")
    for name, result, seconds in cases:
        print(f"| {name} | {result} | {seconds:.1f} |")


if __name__ == "__main__":
    main(*sys.argv[1:3])
