#!/usr/bin/env python3
"""The version of CMakeLists.txt stands in CITATION.cff, README.md and the Python package, and CHANGELOG.md says what is new in it."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PLACES = {
    "CITATION.cff": r"^version: (\S+)$",
    "README.md": r"version = \{(\S+)\}",
    "scripts/python/pyproject.toml": r'^version = "(\S+)"$',
    "CHANGELOG.md": r"^## (\d\S+)",
}


def main():
    version = re.search(r"^project\(airlight VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1]
    faults = 0
    for place, pattern in PLACES.items():
        found = re.search(pattern, (ROOT / place).read_text(), re.M)
        if found is None or found[1] != version:
            print(f"{place}: found {found and found[1]}, expected {version}, as CMakeLists.txt says")
            faults += 1
    return int(faults > 0)


if __name__ == "__main__":
    sys.exit(main())
