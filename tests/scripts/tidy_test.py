#!/usr/bin/env python3
"""tidy_test.py BUILD [PATTERN]: clang-tidy finds nothing in the sources that BUILD compiled, tests left out.

PATTERN is a regular expression of source names (default: all). Only version 14 is asked, that of Debian 12. BUILD/tidy remembers which
sources passed: they are read again once they were compiled again or .clang-tidy changed.
"""
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def main():
    program = shutil.which("clang-tidy-14") or shutil.which("clang-tidy")
    version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout if program else ""
    if "version 14." not in version:
        print("test skipped: there is no clang-tidy 14")
        return 0
    build = pathlib.Path(sys.argv[1]).resolve()
    folder = build / "tidy"
    folder.mkdir(exist_ok=True)
    commands, sources = [], {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        name, command = os.path.relpath(entry["file"], ROOT), entry["command"]
        if re.search(r"cmake_pch|/generated/|airlight_tests|^tests/", name) or not re.search("".join(sys.argv[2:3]), name):
            continue
        # GCC's precompiled headers are of no use to clang: it reads a copy of their source, which has none beside it. They must not count
        # as headers of the system, where nothing is found.
        for header in re.findall(r"-include (\S+/cmake_pch\.hxx)", command):
            copy = folder / (pathlib.Path(header).parent.name + ".h")
            copy.write_text(re.sub(r"(?m)^#pragma .*system_header$", "", pathlib.Path(header).read_text()))
            command = command.replace(header, str(copy))
        commands.append({**entry, "command": command})
        passed = folder / name.replace("/", "_")
        changed = max(os.path.getmtime(f) for f in (build / re.search(r" -o (\S+)", command)[1], ROOT / ".clang-tidy"))
        if not passed.exists() or passed.stat().st_mtime < changed:
            sources[entry["file"]] = passed
    (folder / "compile_commands.json").write_text(json.dumps(commands))

    def read(source):  # batches include .cpp files
        arguments = [program, "-p", str(folder), "--quiet", "--checks=-bugprone-suspicious-include", source]
        return source, subprocess.run(arguments, capture_output=True, text=True)

    status = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for i, (source, result) in enumerate(pool.map(read, sources), 1):
            print(f"{i} of {len(sources)}: {os.path.relpath(source, build)}", flush=True)
            if result.returncode or result.stdout.strip():
                print(result.stdout, result.stderr if result.returncode else "")
                status = 1
            else:
                sources[source].touch()
    return status


if __name__ == "__main__":
    sys.exit(main())
