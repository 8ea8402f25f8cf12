#!/usr/bin/env python3
"""tests/scripts/python_test.py PROGRAM: the package scripts/python, installed by pip into a folder of its own, and its notebook.

It needs a Python with numpy, pandas, matplotlib, pip and setuptools: the one that runs this test, else /usr/bin/python3. Films are
read where the module OpenEXR is there as well; where it is not, the test holds that load_film says so."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else f"{SOURCE}/build/release/airlight"
NEEDED = ("numpy", "pandas", "matplotlib", "pip", "setuptools", "wheel")


def able(python, *modules):
    script = f"import importlib.util, sys; sys.exit(not all(map(importlib.util.find_spec, {modules})))"
    return subprocess.run([python, "-c", script], capture_output=True).returncode == 0


PYTHON = next((python for python in (sys.executable, "/usr/bin/python3") if os.path.exists(python) and able(python, *NEEDED)), None)


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        subprocess.run(["cp", "-r", f"{SOURCE}/scripts/python", f"{cls.folder}/source"], check=True)  # pip leaves build/ in it
        done = subprocess.run([PYTHON, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--no-index", "--target",
                               f"{cls.folder}/site", f"{cls.folder}/source"], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr

    def python(self, script, **more):
        path = os.pathsep.join(filter(None, (f"{self.folder}/site", os.environ.get("PYTHONPATH"))))
        environment = {**os.environ, "PYTHONPATH": path, "AIRLIGHT_PROGRAM": PROGRAM, "MPLBACKEND": "Agg", **more}
        done = subprocess.run([PYTHON, "-"], input=script, capture_output=True, text=True, env=environment, cwd=SOURCE)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_results_are_those_of_the_table(self):
        out = self.python("""
import airlight
table = airlight.load_results("headline/fogshop", metrics=["rel_l2", "seconds"])
print(len(table), sorted(table.metric.unique()))
print(table[(table.method == "slices") & (table["setting.K"] == "16") & (table.metric == "rel_l2")].value.item())
try:
    airlight.load_results("headline/fogshup")
except airlight.AirlightError as error:
    print(error)
""").splitlines()
        with open(f"{SOURCE}/results/headline/fogshop/run.json", encoding="utf-8") as stream:
            rows = json.load(stream)["rows"]
        self.assertEqual(out[0], f"{2 * len(rows)} ['rel_l2', 'seconds']")
        error = next(e["value"] for r in rows if r["method"] == "slices" and r["setting"] == "16" for e in r["errors"] if e["metric"] == "rel_l2")
        self.assertAlmostEqual(float(out[1]) / error, 1, places=8)
        self.assertIn("no record 'headline/fogshup'", out[2])
        self.assertIn("(nearest: headline/fogshop)", out[2])

    def test_a_program_that_is_not_there_is_named(self):
        out = self.python("""
import airlight
try:
    airlight.load_results()
except FileNotFoundError as error:
    print(error)
""", AIRLIGHT_PROGRAM="", PATH="/nowhere")
        self.assertIn("no program: put `airlight` on PATH", out)

    def test_films(self):
        out = self.python("""
import airlight
try:
    film = airlight.render("experiments/scenes/fogshop/f100.toml", "fogshop", {"K": 8, "prt": False}, {"film.width": 24, "film.height": 18})
    print(film.mean.shape, sorted(film.layers), film.header["renderer"], "K=8" in film.header["settings"], float(film.mean.min()) >= 0)
except ImportError as error:
    print(error)
""").strip()
        if able(PYTHON, "OpenEXR"):
            self.assertEqual(out, "(18, 24, 3) ['airlight', 'mean', 'surface', 'transmittance'] fogshop True True")
        else:
            self.assertEqual(out, "load_film and render need the Python module OpenEXR 3.3 or newer: pip install OpenEXR")

    def test_the_notebook_draws_a_figure_of_each_paper(self):
        with open(f"{SOURCE}/scripts/python/figures.ipynb", encoding="utf-8") as stream:
            notebook = json.load(stream)
        cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
        self.assertFalse(any(cell.get("outputs") for cell in notebook["cells"]))  # committed without output
        pictures = os.environ.get("AIRLIGHT_FIGURES", self.folder)
        out = self.python("\n".join(cells) + """
import os
for number in plt.get_fignums():
    lines = plt.figure(number).axes[0].get_lines()
    print(plt.figure(number).axes[0].get_title(), sum(len(line.get_xdata()) for line in lines))
    plt.figure(number).savefig(os.path.join(os.environ["AIRLIGHT_FIGURES"], f"{number}.png"))
""", AIRLIGHT_FIGURES=pictures).splitlines()
        self.assertEqual([line.split(":")[0] for line in out],
                         ["Fogshop", "Shadow planes", "Wavelet fog", "Legendre fluids", "Compensated ray marching"])
        self.assertTrue(all(int(line.split()[-1]) >= 5 for line in out), out)


if __name__ == "__main__":
    if not PYTHON:
        print(f"test skipped: there is no Python with {', '.join(NEEDED)} (Debian: python3-pandas, python3-matplotlib, python3-pip)")
        sys.exit(0)
    unittest.main()
