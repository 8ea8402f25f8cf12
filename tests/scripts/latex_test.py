#!/usr/bin/env python3
"""tests/scripts/latex_test.py PROGRAM [KEEP.pdf]: the document of experiments/README.md, made by its commands and compiled by pdflatex."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PACKAGES = ("booktabs", "siunitx", "pgfplots")


def found(package):
    return subprocess.run(["kpsewhich", f"{package}.sty"], capture_output=True).returncode == 0


def fail(text):
    print(f"failed: {text}")
    sys.exit(1)


if not shutil.which("pdflatex") or not all(map(found, PACKAGES)):
    print(f"test skipped: there is no pdflatex with {', '.join(PACKAGES)} (Debian: texlive-latex-recommended, texlive-pictures, texlive-science)")
    sys.exit(0)
program = os.path.abspath(sys.argv[1])
with open(f"{SOURCE}/experiments/README.md", encoding="utf-8") as stream:
    page = stream.read()
commands, document = re.search(r"A document with three tables.*?```\n(.*?)```\n\n```latex\n(.*?)```", page, re.S).groups()
with tempfile.TemporaryDirectory() as folder:
    for command in commands.replace("\\\n", "").splitlines():
        line = command.replace("airlight results", f"'{program}' results --root '{SOURCE}'", 1)
        done = subprocess.run(line, shell=True, cwd=folder, capture_output=True, text=True)
        if done.returncode != 0 or done.stderr:
            fail(f"{command}: {done.stderr}")
    with open(f"{folder}/document.tex", "w", encoding="utf-8") as stream:
        stream.write(document)
    done = subprocess.run(["pdflatex", "-halt-on-error", "-interaction=nonstopmode", "document.tex"], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        fail("\n".join(done.stdout.splitlines()[-20:]))
    with open(f"{folder}/document.log", encoding="latin-1") as stream:
        log = stream.read()
    for wrong in ("Undefined control sequence", "Overfull", "Missing character", "Package pgfplots Warning", "Package siunitx Warning"):
        if wrong in log:
            fail(log[log.index(wrong):][:300])
    with open(f"{folder}/document.aux", encoding="latin-1") as stream:
        aux = stream.read()
    counts = [aux.count("\\contentsline {" + kind + "}") for kind in ("table", "figure")]
    if counts != [3, 1]:
        fail(f"{counts} tables and figures, expected [3, 1]")
    with open(f"{folder}/plots.tex", encoding="utf-8") as stream:
        if stream.read().count("\\begin{axis}") != 2:
            fail("expected two plots")
    if len(sys.argv) > 2:
        shutil.copy(f"{folder}/document.pdf", sys.argv[2])
print("three tables and two plots, compiled")
