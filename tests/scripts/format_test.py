#!/usr/bin/env python3
"""clang-format changes nothing in C++. Only version 14 is asked, that of Debian 12: others break lines elsewhere."""
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def main():
    program = shutil.which("clang-format-14") or shutil.which("clang-format")
    version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout if program else ""
    if "version 14." not in version:
        print("test skipped: there is no clang-format 14")
        return 0
    folders = ("scene", "methods", "reference", "experiments", "gpu", "tests")
    files = sorted(str(f) for folder in folders for kind in ("*.cpp", "*.h") for f in (ROOT / folder).rglob(kind))
    found = subprocess.run([program, "--dry-run", "-Werror", *files], capture_output=True, text=True)
    print(found.stderr[:4000] or f"{len(files)} files")
    return found.returncode


if __name__ == "__main__":
    sys.exit(main())
