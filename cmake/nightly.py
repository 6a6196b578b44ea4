"""docs/nightly.md, from ctest's JUnit file.

nightly.py write REPORT ROOT           prints the page of these tests
nightly.py again REPORT ROOT TEST...   prints the page of ROOT with these tests anew; rows of others than TEST... are left out
nightly.py failed ROOT TEST...         prints a regular expression of those of TEST... that the page does not list as passed;
                                       nothing if it lists all of them as passed and has no other rows, ^$ if it has some
"""

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
    """What is checked out, and whether anything but the page is not committed."""
    def git(*words):
        return subprocess.run(["git", "-C", root, *words], capture_output=True, text=True, check=False).stdout.strip()
    changed = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/nightly.md")
    return (git("rev-parse", "--short=12", "HEAD") or "unknown") + ("-dirty" if changed else "")


def result_of(case):
    """The result of one test, and what the test says it has tried, where that depends on the machine."""
    results = {"run": "passed", "fail": "FAILED"}
    tried = re.search(r"^tried: (.+)$", case.findtext("system-out") or "", re.MULTILINE)
    return results.get(case.get("status"), case.get("status")) + (f", {tried.group(1)}" if tried else "")


def passed(cells):
    return cells[0].split(",")[0] == "passed"


def ran(report, root):
    """{name: cells} of the tests that ran: result, seconds, commit, date."""
    cases = ElementTree.parse(report).iter("testcase") if pathlib.Path(report).exists() else []
    when = [commit(root), datetime.date.today().isoformat()]
    return {case.get("name"): [result_of(case), f"{float(case.get('time')):.1f}", *when] for case in cases}


def told(root):
    """The same of the tests that the page tells of."""
    page = pathlib.Path(root) / "docs" / "nightly.md"
    lines = page.read_text().splitlines() if page.exists() else []
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("| ")]
    return {name: rest for name, *rest in cells if name != "test"}


def print_page(tests):
    print("# Nightly tests\n")
    print("Written by `./noether test --nightly`; rows of later commits by `./noether test --nightly --failed`.\n")
    print(f"- cpu: {cpu()}")
    print(f"- result: {sum(map(passed, tests.values()))} of {len(tests)} passed\n")
    print("| test | result | seconds | commit | date |\n|---|---|---|---|---|")
    for name, cells in sorted(tests.items()):
        print(f"| {' | '.join([name, *cells])} |")


def again(report, root, *names):
    """The page's rows of the tests that there are, with those that ran anew; says which rows are left out."""
    tests = told(root) | ran(report, root)
    for name in sorted(tests.keys() - set(names)):
        print(f"noether: docs/nightly.md: left out the row of {name}, which is not a nightly test any more", file=sys.stderr)
    return {name: cells for name, cells in tests.items() if name in names}


def not_passed(root, *names):
    """A regular expression of the tests that the page does not list as passed: failed, skipped, or new since it was written."""
    tests = told(root)
    again = [re.escape(name) for name in names if not passed(tests.get(name, [""]))]
    if not again:
        return "^$" if tests.keys() - set(names) else ""
    return f"^({'|'.join(again)})$"


if __name__ == "__main__":
    what, *arguments = sys.argv[1:]
    if what == "write":
        print_page(ran(*arguments))
    elif what == "again":
        print_page(again(*arguments))
    else:
        print(not_passed(*arguments))
