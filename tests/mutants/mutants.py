#!/usr/bin/env python3
"""Planted bugs, each of which one named test must find.

mutants.py BUILD [NAME...]            plants each (or those whose name contains one of NAME), builds one object, runs its test
mutants.py BUILD --list               what there is: name, file and line, test; exit code 2 if one cannot be planted or
                                      names no test (BUILD is not looked at)
mutants.py BUILD --survey FILE --tests A_test.cpp,B_test.cpp [--only FROM-TO] [--skip TEST]
                                      plants what chance finds in FILE (signs, constants, comparisons, terms), lists survivors

BUILD is an up-to-date build folder. Nothing in the source or in BUILD is changed: the planted source is compiled beside it and linked
before the libraries. Where BUILD compiles sources in batches (preset release), functions of the batch may have the sound source's code
within their own: what survives is planted in the whole batch, too. Exit code 0: all were found; 1: some survived, or a test fails
without a bug; 2: one cannot be planted (its line has changed) or does not compile.
"""
import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # beside the sources
from planted import MUTANTS

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


class Cannot(Exception):
    pass


class Builder:
    def __init__(self, build):
        self.build = os.path.abspath(build)
        self.scratch = tempfile.TemporaryDirectory(prefix="airlight_mutants_")
        with open(os.path.join(self.build, "compile_commands.json")) as f:
            self.commands = {c["file"]: c for c in json.load(f)}
        # Objects of the program that lie in no library; a planted one stands for its own.
        self.objects, self.libraries = self.linked("tests/airlight_tests")
        # Library that the program loads for OpenVDB files.
        self.vdb_objects, self.vdb_libraries = self.linked("airlight_vdb.so")
        self.stands_for, self.planted_vdb = {}, set()
        self.root = os.path.commonpath([f for f in self.commands if f.endswith("/experiments/application/main.cpp")] or [ROOT])
        self.root = os.path.dirname(os.path.dirname(self.root)) if self.root.endswith("main.cpp") else self.root
        self.batches = {}  # of the sources that are compiled together, where the preset does so
        for batch in self.commands:
            if os.path.dirname(batch) == os.path.join(self.build, "batches"):
                for source in re.findall(r'^#include "(.+)"', read(batch), re.MULTILINE):
                    self.batches[source] = batch

    def linked(self, target):
        """The objects that a target is linked of, without tests; its options for the linker and its libraries."""
        found = subprocess.run(["ninja", "-C", self.build, "-t", "commands", target], capture_output=True, text=True, check=True).stdout
        link = [line for line in found.splitlines() if f" -o {target} " in line][-1]
        before, after = (shlex.split(part) for part in link.split(" && ")[1].split(f" -o {target} "))
        options = [w for w in before if w.startswith("-Wl,")]
        return ([w for w in before + after if w.endswith(".o") and not w.startswith("tests/")],
                options + [w for w in after if not w.endswith(".o")])

    def command(self, file):
        return self.commands.get(os.path.join(self.root, file)) or self.commands.get(self.batches.get(file))

    def compile(self, file, overlay, batch=True):
        """The object of a source file, or of the batch it is in, with the files of `overlay` before those of the tree."""
        c = self.command(file)
        if not c:
            raise Cannot(f"{file} is not compiled in {self.build}")
        words = shlex.split(c.get("command") or "")
        words = [w for i, w in enumerate(words) if w not in ("-MD",) and not
                 (w in ("-MT", "-MF") or (i and words[i - 1] in ("-MT", "-MF")))]
        own = os.path.join(overlay, file)
        alone = not batch or file not in self.batches  # a batch includes it by its name below the root
        source = (own if os.path.exists(own) else os.path.join(self.root, file)) if alone else c["file"]
        object_file = os.path.join(overlay, source.strip("/").replace("/", "_") + ".o")
        own_object = words[words.index("-o") + 1]
        if batch or file not in self.batches:
            self.stands_for[object_file] = own_object
        if own_object in self.vdb_objects:
            self.planted_vdb.add(object_file)
        words[words.index("-o") + 1] = object_file
        words[words.index("-c") + 1] = source
        first = next(i for i, w in enumerate(words) if w.startswith("-I"))
        words.insert(first, "-I" + overlay)
        run = subprocess.run(words, cwd=c["directory"], capture_output=True, text=True)
        if run.returncode:
            raise Cannot("does not compile:\n" + run.stderr[-2000:])
        return object_file

    def link(self, objects, tests, program):
        for test in dict.fromkeys("tests/" + t for t in tests):
            c = self.command(test)
            if not c:
                raise Cannot(f"{test} is not compiled in {self.build}")
            words = shlex.split(c["command"])
            objects = objects + [os.path.join(self.build, words[words.index("-o") + 1])]
        objects = list(dict.fromkeys(objects))  # several sources may be in one batch
        replaced = {self.stands_for.get(o) for o in objects}
        vdb = [o for o in objects if o in self.planted_vdb]
        folder = self.build
        if vdb:
            folder = os.path.join(self.scratch.name, "vdb")
            os.makedirs(folder, exist_ok=True)
            self.run_linker(["-shared"] + vdb + [o for o in self.vdb_objects if o not in replaced],
                            os.path.join(folder, "airlight_vdb.so"), self.vdb_libraries)
        self.run_linker([f"-Wl,-rpath,{folder}"] + [o for o in objects if o not in vdb] + [o for o in self.objects if o not in replaced],
                        program, self.libraries)

    def run_linker(self, words, out, libraries):
        # The first definition of a function is taken: the planted one.
        run = subprocess.run(["c++", "-Wl,-z,muldefs"] + words + ["-o", out] + libraries, cwd=self.build, capture_output=True, text=True)
        if run.returncode:
            raise Cannot("does not link:\n" + run.stderr[-2000:])

    def passes(self, program, tests):
        try:
            return subprocess.run([program, "-w", "NoTests"] + tests, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                  timeout=300).returncode == 0
        except subprocess.TimeoutExpired:
            return False


def named(test):
    """The test's name, escaped for Catch2: a comma would begin another name."""
    return test.replace(",", "\\,").replace("[", "\\[")


def planted(text, changes):
    for old, new in changes:
        if text.count(old) != 1:
            raise Cannot(f"'{old}' is there {text.count(old)} times, expected once")
        text = text.replace(old, new)
    return text


def overlay_of(builder, number, file, text):
    folder = os.path.join(builder.scratch.name, str(number))
    os.makedirs(os.path.dirname(os.path.join(folder, file)))
    with open(os.path.join(folder, file), "w") as f:
        f.write(text)
    return folder


def is_script(m):
    return m.tests.endswith(".py")


def passes_sound(builder, m):
    if is_script(m):
        return script_passes(m, os.path.join(ROOT, "scripts"))
    program = os.path.join(builder.scratch.name, "tests")
    builder.link([], [m.tests], program)
    return builder.passes(program, [named(m.test)])


def passes_planted(builder, m, number):
    overlay = overlay_of(builder, number, m.file, planted(read(m.file), m.changes))
    if is_script(m):
        return script_passes(m, os.path.join(overlay, "scripts"))
    program = os.path.join(builder.scratch.name, "tests")
    files = m.compiled or [m.file]
    for batch in (False, True) if any(f in builder.batches for f in files) else (True,):
        builder.link([builder.compile(f, overlay, batch) for f in files], [m.tests], program)
        if not builder.passes(program, [named(m.test)]):
            return False
    return True


def script_passes(m, scripts):
    return subprocess.run([sys.executable, "tests/" + m.tests, m.test], cwd=ROOT, capture_output=True,
                          env={**os.environ, "AIRLIGHT_TESTED_SCRIPTS": scripts}).returncode == 0


def read(file):
    with open(os.path.join(ROOT, file)) as f:
        return f.read()


def line_of(m):
    return read(m.file)[:max(read(m.file).find(m.changes[0][0]), 0)].count("\n") + 1


def run(builder, names):
    wrong = broken = 0
    sound = {}
    chosen = [m for m in MUTANTS if not names or any(n in m.name for n in names)]
    for number, m in enumerate(chosen):
        where = f"{m.name}: {m.file}:{line_of(m)}: \"{m.test}\""
        try:
            if (m.tests, m.test) not in sound:
                sound[m.tests, m.test] = passes_sound(builder, m)
            if not sound[m.tests, m.test]:
                wrong += 1
                print(f"FAILS WITHOUT  {where}", flush=True)
                continue
            found = not passes_planted(builder, m, number)
            wrong += not found
            print(f"{'found   ' if found else 'SURVIVED'}  {where}", flush=True)
        except Cannot as reason:
            broken += 1
            print(f"CANNOT    {where}: {reason}", flush=True)
    print(f"{len(chosen)} planted, {len(chosen) - wrong - broken} found, {wrong} survived, {broken} could not be planted")
    return 2 if broken else 1 if wrong else 0


def listed():
    broken = 0
    for m in MUTANTS:
        print(f"{m.name} -> {m.file}:{line_of(m)} -> {m.tests}: {m.test}")
        try:
            planted(read(m.file), m.changes)
            sought = f"def {m.test.split('.')[-1]}(" if is_script(m) else f'TEST_CASE("{m.test}"'
            if sought not in read("tests/" + m.tests):
                raise Cannot("there is no such test")
        except (Cannot, OSError) as reason:
            broken += 1
            print(f"CANNOT {m.name}: {reason}")
    return 2 if broken else 0


# Possible changes of a line. Strings, comments and includes are left alone.
SWAPS = [(r"<=", "<"), (r">=", ">"), (r"(?<![<\-=])<(?![<=])(?= )", "<="), (r"(?<![>\-=])>(?![>=])(?= )", ">="), (r"==", "!="),
         (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "), (r"&&", "||"), (r"\|\|", "&&"),
         (r"\+= ", "-= "), (r"std::max\(", "std::min("), (r"std::min\(", "std::max("), (r"std::abs\(", "("),
         (r"std::sqrt\(", "("), (r"(?<![\w.])(\d+\.\d+|\d+e-\d+)(?![\w.])", r"(2 * \1)"), (r"(?<![\w.\[])1(?![\w.])", "2"),
         (r"(?<![\w.\[])0(?![\w.])", "1"), (r"(?<![\w.])2(?![\w.])", "3"), (r"!(?=[\w(])", "")]


def candidates(text, lines):
    for number, line in enumerate(text.split("\n"), 1):
        if not lines[0] <= number <= lines[1] or re.match(r"\s*(//|#)", line):
            continue
        code = re.sub(r'"(\\.|[^"\\])*"', lambda q: "\0" * len(q.group()), line.split(" // ")[0])
        for pattern, by in SWAPS:
            for at in re.finditer(pattern, code):
                changed = code[:at.start()] + at.expand(by) + code[at.end():]
                out, quoted = "", iter(re.findall(r'"(?:\\.|[^"\\])*"', line))
                for part in re.split("(\0+)", changed):
                    out += next(quoted) if part.startswith("\0") else part
                yield number, line.strip(), out
        if re.match(r"\s+[\w.\[\]>-]+ (\+=|-=|\*=|=) .*;$", code) or re.match(r"\s+(if|return|continue|\+\+).*;$", code):
            yield number, line.strip(), "" if "return" not in code else re.sub(r"return .*;", "return {};", code)


def survey(builder, file, tests, lines, skip):
    program = os.path.join(builder.scratch.name, "tests")
    spec = ["".join("~" + named(s) for s in skip)] if skip else []
    builder.link([], tests, program)
    if not builder.passes(program, spec):
        raise Cannot("the tests fail without a bug")
    text, counts = read(file), [0, 0, 0]
    for number, (at, old, new) in enumerate(candidates(text, lines)):
        all_lines = text.split("\n")
        all_lines[at - 1] = new
        try:
            overlay = overlay_of(builder, "s" + str(number), file, "\n".join(all_lines))
            builder.link([builder.compile(file, overlay)], tests, program)
        except Cannot:
            counts[2] += 1
            continue
        if builder.passes(program, spec):
            counts[1] += 1
            print(f"SURVIVED {file}:{at}: {old}  ->  {new.strip()}", flush=True)
        else:
            counts[0] += 1
    print(f"{file}: {counts[0]} found, {counts[1]} survived, {counts[2]} do not compile", flush=True)
    return 1 if counts[1] else 0


def main():
    p = argparse.ArgumentParser()
    p.add_argument("build")
    p.add_argument("names", nargs="*")
    p.add_argument("--list", action="store_true")
    p.add_argument("--survey")
    p.add_argument("--tests", default="")
    p.add_argument("--only", default="1-100000")
    p.add_argument("--skip", action="append", default=[])
    a = p.parse_args()
    if a.list:
        return listed()
    builder = Builder(a.build)
    if a.survey:
        first, last = map(int, a.only.split("-"))
        return survey(builder, a.survey, a.tests.split(","), (first, last), a.skip)
    return run(builder, a.names)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Cannot, OSError) as reason:
        print(f"mutants: {reason}", file=sys.stderr)
        sys.exit(2)
