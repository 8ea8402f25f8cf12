#!/usr/bin/env python3
"""No line beyond 140 columns in what people read and write: TOML, shaders, scripts, pages. C++ has clang-format; programs of the
tests are left alone, and so are the tables that scripts/figures writes between two comments."""
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
GREATEST = 140
GENERATED = re.compile(r"^<!-- (?:claims: \w+|failing claims|verdicts|errata) -->\n.*?^<!-- end -->$", re.M | re.S)
KINDS = (".toml", ".glsl", ".comp", ".vert", ".frag", ".py", ".md")


def files():
    for path, folders, names in os.walk(ROOT):
        inside = os.path.relpath(path, ROOT).split(os.sep)
        if inside == ["."]:
            folders[:] = [f for f in folders if f not in ("build", ".git", "shared")]
        elif inside[0] == "results":
            folders[:] = [f for f in folders if f not in ("cache", "images", "report")]
            names = [n for n in names if n not in ("table.md", "sweep.md") and inside[1:] not in (["common"], ["gallery"])]  # programs wrote them
        for name in sorted(names):
            if inside[0] == "scripts" or name.endswith(KINDS) and not (inside[0] == "tests" and name.endswith(".py")):
                yield os.path.join(path, name)


def main():
    count = long = 0
    for file in files():
        with open(file, encoding="utf-8") as stream:
            text = GENERATED.sub(lambda table: "\n" * table.group().count("\n"), stream.read())
            for number, line in enumerate(text.split("\n"), 1):
                if len(line) > GREATEST:
                    long += 1
                    print(f"{os.path.relpath(file, ROOT)}:{number}: {len(line)} columns, expected {GREATEST} at most", file=sys.stderr)
        count += 1
    print(f"{count} files, {long} lines too long")
    return 1 if long or count < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
