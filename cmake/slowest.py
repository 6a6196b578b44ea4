"""Prints the ten files that took longest to compile: slowest.py BUILD_FOLDER."""

import pathlib
import sys


def compile_times(log):
    """{object file: seconds} of the last compilation of each, from ninja's log."""
    times = {}
    for line in log.read_text().splitlines():
        fields = line.split("\t")
        if len(fields) >= 4 and fields[3].endswith((".o", ".gch", ".pch")):
            times[fields[3]] = (int(fields[1]) - int(fields[0])) / 1000
    return times


if __name__ == "__main__":
    times = compile_times(pathlib.Path(sys.argv[1]) / ".ninja_log")
    print(f"slowest of {len(times)} files, {sum(times.values()):.0f} s of compiling in all:")
    for name, seconds in sorted(times.items(), key=lambda item: -item[1])[:10]:
        print(f"{seconds:8.1f} s  {name}")
