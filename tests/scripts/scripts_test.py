#!/usr/bin/env python3
"""scripts/figures, tighten and gallery on a small tree of their own: what they write, and what they object to."""
import importlib.machinery
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPTS = os.environ.get("AIRLIGHT_TESTED_SCRIPTS", f"{SOURCE}/scripts")  # tests/mutants plants bugs in copies

TABLE = """scene,parameter,method,setting,rel_l2,rel_l2_low,rel_l2_high,seconds,note
"one, large",,S,8,0.01237,0.01237,0.01237,0.002,
"one, large",,S,16,0.00031,0.00031,0.00031,0.004,
two,,S,8,0.5,0.5,0.5,0.003,
two,,S,16,0.02,0,0.04,0.006,
two,,"S, GPU",8,,,,,not available on this machine
"""
PAGE = """# A page

| what | ours |
|---|---|
| error | from 0 with 8, below 0 and 0 with
16, or 0; |

It takes 0 ms, .1 times, and S wins.
"""
FIGURES = """[g/e rel_l2]
from {range([*|S|8])} with 8, below {below([two|S|16])} and {below(percent([two|S|16]))} with 16, or {one, large|S|16;8}
takes {[two|S|8|seconds] * 1000; 1} ms, {[g/e: one, large|S|8|seconds] / [two|S|16|seconds]; 3} times
S wins ?? [one, large|S|16] < [one, large|S|8]
"""
EXPERIMENT = """title = "a"
[[gate]]
method = "S"
scene = "two"
setting = 8
metric = "rel_l2"
at_least = 0.2
[[gate]]
metric = "rel_l2"
[[gate]]
metric = "wrong"
at_most = 0.1
[[gate]]
metric = "counter.rays"
"""


def rows(**changed):
    all_rows = []
    for scene, setting, value, low, high, wrong in (
            ("one, large", "8", 0.01237, 0.01237, 0.01237, 0.0), ("one, large", "16", 0.00031, 0.00031, 0.00031, 0.05),
            ("two", "8", 0.5, 0.5, 0.5, 0.0), ("two", "16", 0.02, 0.0, 0.04, 0.0)):
        value = changed.get(f"{scene} {setting}", value)
        errors = [{"metric": "rel_l2", "value": value, "low": min(low, value), "high": max(high, value) if low < high else value},
                  {"metric": "wrong", "value": wrong, "low": wrong, "high": wrong}]
        all_rows.append({"scene": scene, "method": "S", "setting": setting, "device": "", "errors": errors, "counters": {"rays": 1000.0}})
    return {"rows": all_rows}


class Tree(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.root)
        for script in ("figures", "tighten", "gallery"):
            os.makedirs(f"{self.root}/scripts", exist_ok=True)
            shutil.copy(next(f for f in (f"{SCRIPTS}/{script}", f"{SOURCE}/scripts/{script}") if os.path.exists(f)), f"{self.root}/scripts")
        shutil.copytree(f"{SOURCE}/scripts/gallery_page", f"{self.root}/scripts/gallery_page")

    def write(self, name, text):
        os.makedirs(os.path.dirname(f"{self.root}/{name}"), exist_ok=True)
        with open(f"{self.root}/{name}", "w") as stream:
            stream.write(text)

    def read(self, name):
        with open(f"{self.root}/{name}") as stream:
            return stream.read()

    def run_script(self, *command):
        done = subprocess.run([sys.executable, f"{self.root}/scripts/{command[0]}", *command[1:]], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr


class FiguresTree(Tree):
    def objects(self, *words):
        code, text = self.run_script("figures", "--check")
        self.assertEqual(code, 1, text)
        for word in words:
            self.assertIn(word, text)


class Figures(FiguresTree):
    def setUp(self):
        super().setUp()
        self.write("results/g/e/table.csv", TABLE)
        self.write("methods/PAGE.md", PAGE)
        self.write("methods/PAGE.figures", FIGURES)
        self.assertEqual(self.run_script("figures")[0], 0)

    def test_puts_the_figures_in(self):
        page = self.read("methods/PAGE.md")
        self.assertIn("from 0.012 to 0.50 with 8, below < 0.040 and < 4.0 with\n16, or 3.1e-4, 0.012; |", page)
        self.assertIn("takes 3 ms, .333 times", page)
        code, text = self.run_script("figures", "--check")
        self.assertEqual((code, text), (0, "6 figures in 1 pages: 0 differ from the tables, 0 lines cannot be read\n"))

    def test_functions(self):
        rows = [f"s,,m,{i},{x},{y}" for i, (x, y) in enumerate(((4, 0.5), (1, -0.25), (2, 0.125), (9, -1.0)))]
        self.write("results/g/f/table.csv", "scene,parameter,method,setting,x,y\n" + "\n".join(rows) + "\n")
        for expression, expected in {
                "min([*|m])": "1.0", "max([*|m])": "9.0", "median([*|m])": "3.0", "sum([*|m]); 3": "16.0", "count([*|m])": "4",
                "shares([*|m]); 3": "25.0, 6.25, 12.5, 56.2", "percent([*|m|*|y]); 3": "50.0, -25.0, 12.5, -100",
                "above([*|m], 2)": "1.0, 0, 0, 1.0", "signed([*|m|*|y])": "+0.50, -0.25, +0.12, -1.0", "abs([*|m|*|y])": "0.50, 0.25, 0.12, 1.0",
                "range([*|m] - [*|m|3])": "-8.0 to 0", "1 / [*|m|2]": "0.50", "every([*|m|0], [*|m|3])": "4.0, 9.0"}.items():
            self.write("methods/PAGE.md", "It is 0.\n")
            self.write("methods/PAGE.figures", "[g/f x]\nIt is {" + expression + "}.\n")
            code, text = self.run_script("figures")
            self.assertEqual((code, self.read("methods/PAGE.md")), (0, f"It is {expected}.\n"), expression + text)

    def test_a_changed_table(self):
        self.write("results/g/e/table.csv", TABLE.replace("two,,S,8,0.5,", "two,,S,8,0.6,"))
        self.objects("methods/PAGE.md:5: found 0.012 to 0.50, expected 0.012 to 0.60")

    def test_lines_stay_short(self):
        words = "many words " * 12
        self.write("methods/PAGE.md", f"- {words}0.1,\n  0.2 and {words[:-1]}\n")
        self.write("methods/PAGE.figures", "[g/e rel_l2]\n{[one, large|S|8]}, {[one, large|S|16]} and many\n")
        self.run_script("figures")
        page = self.read("methods/PAGE.md")
        self.assertTrue(all(len(line) <= 140 for line in page.split("\n")), page)
        self.assertTrue(all(line.startswith("  ") for line in page.split("\n")[1:-1]), page)
        self.assertEqual(self.run_script("figures", "--check")[0], 0)

    def test_a_changed_page(self):
        self.write("methods/PAGE.md", self.read("methods/PAGE.md").replace(".333", ".334"))
        self.objects("methods/PAGE.md:8: found .334, expected .333")

    def test_words_that_are_no_longer_true(self):
        self.write("results/g/e/table.csv", TABLE.replace("0.00031", "0.031"))
        self.objects("'S wins' does not hold")

    def test_words_that_are_gone(self):
        self.write("methods/PAGE.md", self.read("methods/PAGE.md").replace("S wins", "S is better"))
        self.objects("methods/PAGE.figures:4: 'S wins' is 0 times in methods/PAGE.md")

    def test_a_row_that_is_gone_and_one_without_figures(self):
        self.write("methods/PAGE.figures", FIGURES.replace("{one, large|S|16;8}", "{three|S}"))
        self.objects("PAGE.figures:2: results/g/e/table.csv has no row three|S")
        self.write("methods/PAGE.figures", FIGURES.replace("{one, large|S|16;8}", "{two|S, GPU}"))
        code, text = self.run_script("figures", "--check")
        self.assertEqual(code, 0, text)
        self.assertIn("left as it is", text)
        self.write("results/g/e/table.csv", TABLE.replace("not available on this machine", ""))
        self.objects("no row two|S, GPU with a number")
        self.assertEqual(self.run_script("figures")[0], 0)  # of a user's own tables there is nothing to put in

    def test_a_number_that_nothing_gives(self):
        self.write("methods/PAGE.figures", "!after Ours:\n" + FIGURES)
        page = self.read("methods/PAGE.md")
        self.write("methods/PAGE.md", page + "- one, 12 % on paper. Ours: It\n  has none\n- 3 items\n")
        self.assertEqual(self.run_script("figures", "--check")[0], 0)
        self.write("methods/PAGE.md", page + "- one, 12 % on paper. Ours: some\n  or 13 %.\n")
        self.objects("methods/PAGE.md:10: no line of methods/PAGE.figures covers 'or 13 %.'")


CLAIMS = """metrics = ["rel_l2"]
[[claim]]
where = "Figure 10"
claim = "accurate"
published = "{two|S|8; %} off"
improved = "{one, large|S|16; %} off in {one, large|S|16|seconds; ms}"
verdict = "holds only where it is large"
holds = "[two|S|8] > 0.4 and [one, large|S|8] < 0.1"
[[claim]]
where = "Figure 9"
claim = "fast"
verdict = "not comparable: other hardware"
[[erratum]]
where = "Eq. 1"
printed = "a"
right = "b"
proof = "{[one, large|S|8] / [one, large|S|16]; 3} times"
"""
CLAIMED = """# Claims
<!-- verdicts -->
<!-- end -->
<!-- claims: g -->
<!-- end -->
<!-- failing claims -->
<!-- end -->
<!-- errata -->
<!-- end -->
"""


@unittest.skipIf(sys.version_info < (3, 11), "no tomllib")
class Claims(FiguresTree):
    def setUp(self):
        super().setUp()
        self.write("results/g/e/table.csv", TABLE)
        self.write("results/gallery/g_fig9.png", "")
        self.write("experiments/g/e.toml", CLAIMS)
        self.write("results/README.md", CLAIMED)
        self.assertEqual(self.run_script("figures")[0], 0)

    def test_writes_the_tables(self):
        page = self.read("results/README.md")
        figure_9 = "| Figure 9 | fast | - | - | not comparable: other hardware | [e](g/e), [picture](gallery/g_fig9.png) |\n"
        figure_10 = "| Figure 10 | accurate | 50 % off | 0.031 % off in 4.0 ms | holds only where it is large | [e](g/e) |\n"
        self.assertIn(figure_9 + figure_10, page)
        self.assertIn("| G | 0 | 0 | 1 | 0 | 1 |\n", page)
        self.assertIn("| G | Figure 10 | accurate | 50 % off | holds only where it is large | [e](g/e) |\n", page)
        self.assertIn("| G | Eq. 1 | a | b | 39.9 times | [e](g/e) |\n", page)
        self.assertEqual(self.run_script("figures", "--check")[0], 0)
        self.assertEqual(self.run_script("figures")[0], 0)
        self.assertEqual(self.read("results/README.md"), page)

    def test_a_changed_table_and_a_changed_page(self):
        self.write("results/g/e/table.csv", TABLE.replace("two,,S,8,0.5,", "two,,S,8,0.6,"))
        self.objects("results/README.md:11: found | Figure 10 | accurate | 50 % off", "expected | Figure 10 | accurate | 60 % off")
        self.write("results/g/e/table.csv", TABLE)
        self.write("results/README.md", self.read("results/README.md").replace("| fast | - |", "| fast | 1 |"))
        self.objects("results/README.md:10: found | Figure 9 | fast | 1 |")

    def test_a_verdict_that_is_no_longer_true(self):
        self.write("results/g/e/table.csv", TABLE.replace("two,,S,8,0.5,", "two,,S,8,0.3,"))
        self.objects("experiments/g/e.toml: claim 1: 'holds only where it is large' does not hold")

    def test_a_row_without_figures_keeps_what_it_says(self):
        page = self.read("results/README.md")
        self.write("results/g/e/table.csv", TABLE.replace("two,,S,8,0.5,0.5,0.5,0.003,", "two,,S,8,,,,,no such device"))
        code, text = self.run_script("figures", "--check")
        self.assertEqual(code, 0, text)
        self.assertIn("claim 1: results/g/e/table.csv has no row two|S|8 with a number in rel_l2: the page is left as it is", text)
        self.assertEqual(self.read("results/README.md"), page)

    def test_a_verdict_with_a_time_of_a_disturbed_run(self):
        for warning, sign in (("", ""), ("Times are disturbed: in 1 of 2 timed rows", " †")):
            self.write("results/g/e/run.json", json.dumps({"machine": {"load_warning": warning, "threads": 2}}))
            self.assertEqual(self.run_script("figures")[0], 0)
            page = self.read("results/README.md")
            self.assertIn(f"| 50 % off | 0.031 % off in 4.0 ms | holds only where it is large{sign} | [e](g/e) |\n", page)
            self.assertIn("| fast | - | - | not comparable: other hardware | [e](g/e)", page)  # it quotes no time
            self.assertIn("| G | 0 | 0 | 1 | 0 | 1 |\n", page)

    def test_a_conclusion(self):
        conclusion = '[conclusion]\ntext = "It is large."\nholds = "[two|S|8] > 0.4"\n'
        self.write("experiments/g/e.toml", CLAIMS + conclusion)
        self.assertEqual(self.run_script("figures", "--check")[0], 0)
        self.write("experiments/g/e.toml", CLAIMS + conclusion.replace("> 0.4", "> 0.6"))
        self.objects("experiments/g/e.toml: conclusion: 'It is large.' does not hold: [two|S|8] > 0.6")

    def test_a_row_that_is_gone(self):
        self.write("experiments/g/e.toml", CLAIMS.replace("{two|S|8; %}", "{three|S; %}"))
        self.objects("experiments/g/e.toml: claim 1: results/g/e/table.csv has no row three|S")


@unittest.skipIf(sys.version_info < (3, 11), "no tomllib")
class Tighten(Tree):
    def setUp(self):
        super().setUp()
        self.write("experiments/g/e.toml", EXPERIMENT)
        self.write("results/g/e/run.json", json.dumps(rows()))
        code, text = self.run_script("tighten")
        self.assertEqual(code, 0, text)

    def test_bounds(self):
        self.assertEqual(self.read("experiments/g/e.bounds.csv").split("\n")[1:-1], [
            "two,S,8,rel_l2,,0.5,0.34,0.75",  # must be reproduced: both ends
            '"one, large",S,8,rel_l2,,0.0124,,0.018',  # 1.5 times, never rounded up
            '"one, large",S,16,rel_l2,,0.00031,,0.00058',  # 1.9 times
            "two,S,16,rel_l2,,0.02,,0.04",  # the end of the interval
            '"one, large",S,8,wrong,,0,,0', '"one, large",S,16,wrong,,0.05,,0.075', "two,S,8,wrong,,0,,0", "two,S,16,wrong,,0,,0",
            '"one, large",S,8,counter.rays,,1e+03,990,1010', '"one, large",S,16,counter.rays,,1e+03,990,1010',
            "two,S,8,counter.rays,,1e+03,990,1010", "two,S,16,counter.rays,,1e+03,990,1010"])
        self.assertEqual(self.run_script("tighten", "--check"), (0, "12 bounds, 0 faults\n"))

    def objects(self, words):
        code, text = self.run_script("tighten", "--check")
        self.assertEqual(code, 1)
        self.assertIn(words, text)

    def test_an_experiment_that_is_not_there(self):
        code, text = self.run_script("tighten", "g/nosuch")
        self.assertEqual(code, 2, text)
        self.assertIn("unknown experiment 'g/nosuch'", text)

    def test_a_figure_that_became_better_leaves_a_loose_bound(self):
        self.write("results/g/e/run.json", json.dumps(rows(**{"one, large 8": 0.005})))
        self.objects("one, large, S, 8, rel_l2: at_most 0.018, expected 0.0075 (measured 0.005)")

    def test_a_loosened_bound(self):
        self.write("experiments/g/e.bounds.csv", self.read("experiments/g/e.bounds.csv").replace(",0.018", ",0.03"))
        self.objects("at_most 0.03, expected 0.018")

    def test_a_row_without_a_bound_and_a_bound_without_a_row(self):
        self.write("experiments/g/e.bounds.csv", self.read("experiments/g/e.bounds.csv").replace("two,S,16,rel_l2", "two,S,17,rel_l2"))
        self.objects("no bound for two, S, 16, rel_l2")
        self.objects("two, S, 17, rel_l2: no gate covers such a row")

    def bounds_of(self, gate, *figures, counter=1000.0):
        """{setting: line of the bounds} for rows of settings 0, 1, ... that have these figures (value, low, high)."""
        self.write("experiments/g/e.toml", gate)
        self.write("results/g/e/run.json", json.dumps({"rows": [
            {"scene": "s", "method": "S", "setting": str(i), "device": "", "counters": {"rays": counter},
             "errors": [{"metric": "bias", "value": v, "low": low, "high": high}]}
            for i, (v, low, high) in enumerate(f if isinstance(f, tuple) else (f, f, f) for f in figures)]}))
        self.run_script("tighten")
        lines = self.read("experiments/g/e.bounds.csv").split("\n")[1:-1]
        return {int(line.split(",")[2]): ",".join(line.split(",")[5:]) for line in lines}

    def test_the_rule_at_its_ends(self):
        self.assertEqual(self.bounds_of('[[gate]]\nmetric = "bias"\n', 1e-3, 5e-4, 1e-6, 5e-7, 3e-8, 2e-8, 0.0, -0.03), {
            0: "0.001,,0.0019", 1: "0.0005,,0.00095",  # 1.9 times
            2: "1e-06,,3e-06", 3: "5e-07,,1.5e-06", 4: "3e-08,,9e-08",  # 3 times
            5: "2e-08,,6e-08", 6: "0,,6e-08",  # the rounding of floats
            7: "-0.03,,-0.02"})  # a bias that must not come closer to 0 than to 1 / 1.5

    def test_the_rule_of_intervals(self):
        self.assertEqual(self.bounds_of('[[gate]]\nmetric = "bias"\nat_least = -9\n', (0.1, 0.09, 0.11), (0.1, 0.0413, 0.1712),
                                        (-0.3, -0.32, -0.28), 0.3, -0.3), {
            0: "0.1,0.067,0.15",  # 0.1 / 1.5, never rounded down
            1: "0.1,0.041,0.18",  # the ends of the interval, outwards
            2: "-0.3,-0.45,-0.2", 3: "0.3,0.2,0.45", 4: "-0.3,-0.45,-0.2"})

    def test_the_rule_of_counters_and_laws(self):
        self.assertEqual(self.bounds_of('[[gate]]\nmetric = "counter.rays"\n', 0.1, counter=150.0), {0: "150,148,152"})
        laws = ""
        for side, bound in (("at_most", 0.12), ("at_most", 0.14), ("at_least", 0.07), ("at_least", 0.08)):
            laws += f'[[gate]]\nmetric = "bias"\n{side} = {bound}\n'
        self.assertEqual(self.bounds_of(laws, 0.1), {0: "0.1,0.08,0.12"})  # the strictest of each
        self.assertEqual(self.bounds_of(laws, (0.11, 0.06, 0.13)), {0: "0.11,0.08,0.12"})  # an interval may touch them
        self.assertEqual(self.bounds_of('[[gate]]\nmetric = "bias"\nprofiles = ["paper"]\n[[gate]]\nsetting = 1\nmetric = "bias"\n', 0.1, 0.2),
                         {1: "0.2,,0.3"})

    def test_how_far_a_bound_may_be(self):
        bounds = self.read("experiments/g/e.bounds.csv")
        for bound, fine in ((0.0197, True), (0.0199, False), (0.001, True)):  # 1.1 times 0.018 is 0.0198
            self.write("experiments/g/e.bounds.csv", bounds.replace(",0.018", f",{bound}"))
            self.assertEqual(self.run_script("tighten", "--check")[0] == 0, fine, bound)
        for bound, fine in ((0.307, True), (0.305, False), (0.5, True)):  # 0.34 less a tenth of itself is 0.306
            self.write("experiments/g/e.bounds.csv", bounds.replace(",0.34,", f",{bound},"))
            self.assertEqual(self.run_script("tighten", "--check")[0] == 0, fine, bound)

    def test_no_bound_beyond_that_of_the_gate(self):
        self.write("results/g/e/run.json", json.dumps(rows(**{"two 8": 0.1})))
        code, text = self.run_script("tighten")
        self.assertEqual(code, 1)
        self.assertIn("two, S, 8, rel_l2: 0.1 lies beyond the gate's own bound", text)
        self.assertNotIn("two,S,8,rel_l2", self.read("experiments/g/e.bounds.csv"))


GALLERY = """[[picture]]
name = "one"
title = "One"
caption = "a picture"
exposure = 0
height = 2
[[picture.scene]]
file = "scenes/a.toml"
[[picture.panel]]
label = "truth"
method = "exact"
[[picture.panel]]
label = "ours"
method = "fast"
settings = { K = 3 }
"""
# In place of the program: writes down what it is asked for, and pictures of 960x4 pixels, 0 and 1 in turns. A frame takes as many seconds as
# the file "seconds" said when it was rendered; without the file 0.5.
PROGRAM = """#!/usr/bin/env python3
import array, os, struct, sys, zlib
here = os.path.dirname(os.path.abspath(__file__))
with open(here + "/log", "a") as log:
    log.write(" ".join(sys.argv[1:]) + "\\n")
if sys.argv[1] == "render":
    seconds = open(here + "/seconds").read() if os.path.exists(here + "/seconds") else "0.5"
    open(sys.argv[sys.argv.index("--out") + 1], "w").write(seconds)
elif sys.argv[1] == "info":
    print("  seconds =", open(sys.argv[2]).read())
elif sys.argv[1] == "doctor":
    print("  processor  A Processor, 2 threads")
elif sys.argv[1] == "compare":
    print("rel_l2                   0.25 [0.24, 0.26]  (floor 0.004)")
    if "--map" in sys.argv:
        chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        with open(sys.argv[sys.argv.index("--map") + 1], "wb") as png:
            png.write(b"\\x89PNG\\r\\n\\x1a\\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 480, 2, 8, 2, 0, 0, 0)))
            png.write(chunk(b"IDAT", zlib.compress((b"\\0" + bytes([253, 231, 37]) * 480) * 2)) + chunk(b"IEND", b""))
else:
    with open(sys.argv[3], "wb") as pfm:
        pfm.write(b"PF\\n960 4\\n-1.0\\n" + array.array("f", [0, 0, 0, 1, 1, 1] * 1920).tobytes())
"""


@unittest.skipIf(sys.version_info < (3, 11) or not shutil.which("gnuplot"), "no tomllib or no gnuplot")
class Gallery(Tree):
    def setUp(self):
        super().setUp()
        self.write("experiments/gallery.toml", GALLERY)
        self.write("experiments/scenes/a.toml", "[camera]\n")
        self.write("results/README.md", "![one](gallery/one.png)\n")
        self.write("build/release/airlight", PROGRAM)
        os.chmod(f"{self.root}/build/release/airlight", 0o755)

    def renders(self):
        return [line.split() for line in self.read("build/release/log").split("\n") if line.startswith("render")]

    def test_renders_what_has_changed(self):
        code, text = self.run_script("gallery")
        self.assertEqual(code, 0, text)
        self.assertEqual(self.run_script("gallery", "--check"), (0, "1 pictures, 0 faults\n"))
        self.assertEqual([r[r.index("--method") + 1] for r in self.renders()], ["exact", "fast"])
        self.assertIn("film.width=960", self.renders()[0])
        self.assertEqual(self.run_script("gallery")[0], 0)
        self.assertEqual(len(self.renders()), 2)
        self.write("experiments/gallery.toml", GALLERY.replace("K = 3", "K = 4"))
        self.objects(1, "results/gallery/one.png was drawn of another entry", "--check")
        self.assertEqual(self.run_script("gallery")[0], 0)
        self.assertEqual(self.run_script("gallery", "--check")[0], 0)
        self.assertEqual(["--set" in r and r[r.index("--set") + 1] for r in self.renders()[2:]], ["K=4"])
        self.write("experiments/scenes/a.toml", "[camera] # another\n")
        self.assertEqual(self.run_script("gallery", "--check")[0], 0)
        self.assertEqual(self.run_script("gallery")[0], 0)
        self.assertEqual(len(self.renders()), 5)
        self.write("experiments/scenes/a.toml", "[camera]\nvertical_fov = 1\n")
        self.objects(1, "or other scenes", "--check")

    def test_panels_are_means_over_pixels(self):
        picture = self.module("picture", "scripts/gallery_page/picture.py")
        pfm = f"{self.root}/x.pfm"
        subprocess.run([f"{self.root}/build/release/airlight", "convert", "x.exr", pfm], check=True)
        # The mean of two zeros and two ones is 0.5, in sRGB 1.055 * 0.5^(1/2.4) - 0.055 = 0.7354, of 255: 187.5.
        self.assertEqual(picture.shown(pfm, 2, 0), bytes([188]) * (480 * 2 * 3))
        self.assertEqual(picture.shown(pfm, 2, 1), bytes([255]) * (480 * 2 * 3))

    def module(self, name, file):
        loader = importlib.machinery.SourceFileLoader(name, f"{self.root}/{file}")
        module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
        sys.dont_write_bytecode = True
        loader.exec_module(module)
        return module

    def test_maps_stand_below_the_methods(self):
        self.assertEqual(self.run_script("gallery")[0], 0)
        log = self.read("build/release/log")
        self.assertIn("--map-top 1.0 --map-shrink 2", log)  # the first of 1, 2, 5 times a power of ten from 3 times the error on
        self.assertEqual(log.count("--map "), 1)  # none of the reference
        height = self.height()
        self.write("experiments/gallery.toml", GALLERY.replace("height = 2", "height = 2\nmaps = false"))
        self.assertEqual(self.run_script("gallery")[0], 0)
        self.assertEqual(self.read("build/release/log").count("--map "), 1)
        self.assertEqual(height - self.height(), 24 + 80)  # a line of text, and the scale, which is higher than the map

    def test_a_film(self):
        film = 'maps = false\nrate = 5\nfilm = { "light.0.scale" = [1, 2, 3] }'
        self.write("experiments/gallery.toml", GALLERY.replace("height = 2", f"height = 2\n{film}"))
        code, text = self.run_script("gallery")
        self.assertEqual(code, 0, text)
        self.assertEqual(self.run_script("gallery", "--check"), (0, "1 pictures, 0 faults\n"))
        self.assertEqual([next(v for v in r if v.startswith("light")) for r in self.renders()],
                         [f"light.0.scale={scale}" for scale in (1, 1, 2, 2, 3, 3)])
        self.assertIn("a looping film of 3 frames, 5 a second: `light.0.scale` from 1 to 3.", self.read("results/gallery/README.md"))
        with open(f"{self.root}/results/gallery/one.png", "rb") as stream:
            parts = list(self.module("picture", "scripts/gallery_page/picture.py").chunks(stream.read()))
        kinds = [kind for kind, _ in parts if kind in (b"acTL", b"fcTL", b"fdAT")]
        self.assertEqual(kinds, [b"acTL", b"fcTL", b"fcTL", b"fdAT", b"fcTL", b"fdAT"])
        self.assertEqual([int.from_bytes(c[:4], "big") for kind, c in parts if kind in (b"fcTL", b"fdAT")], [0, 1, 2, 3, 4])
        later = [c for kind, c in parts if kind == b"fcTL"][1]
        self.assertEqual([int.from_bytes(later[i:i + 4], "big") for i in (4, 8, 12, 16)], [964, 2, 4, 114])  # two panels and what is between
        data = zlib.decompress([c for kind, c in parts if kind == b"fdAT"][0][4:])
        self.assertEqual([c for kind, c in parts if kind == b"tRNS"], [b"\0\xff\0\0\0\xff"])  # what does not change: here every pixel
        row = b"\xff\0\xff" * 964
        self.assertEqual((data[0], data[1 + 964 * 3]), (1, 2))  # less the pixel to the left, less the row above
        self.assertEqual(data[1:1 + 964 * 3], bytes((a - b) & 255 for a, b in zip(row, bytes(3) + row)))
        self.assertEqual(data[2 + 964 * 3:], bytes(964 * 3))

    def height(self):
        with open(f"{self.root}/results/gallery/one.png", "rb") as stream:
            return int.from_bytes(stream.read(24)[20:], "big")

    def test_colours_are_those_of_the_program(self):
        with open(f"{SOURCE}/experiments/judging/error_map.cpp") as stream:
            listed = re.findall(r"\{(\d+), (\d+), (\d+)\}", stream.read())
        self.assertEqual(self.module("picture", "scripts/gallery_page/picture.py").VIRIDIS, [tuple(map(int, colour)) for colour in listed])

    def test_times(self):
        gallery = self.module("gallery", "scripts/gallery")
        gallery.disturbed = lambda before, after: False  # other tests run beside this one
        self.write("build/release/seconds", "12")
        row = "| {} | {} | once | {} | {} | {} |\n"
        reference = row.format("truth", "exact", "defaults", "reference, noise 0.4 %", "12 s *")
        self.assertEqual(gallery.main([]), 0)
        self.assertIn(reference + row.format("ours", "fast", "K = 3", "25 %", "12 s *"), self.read("results/gallery/README.md"))
        self.assertEqual(gallery.main(["--times"]), 0)
        self.assertEqual(len(self.renders()), 2)  # frames of 12 s are timed once
        self.write("experiments/gallery.toml", GALLERY.replace("K = 3", "K = 4"))
        self.write("build/release/seconds", "0.5")
        self.assertEqual(gallery.main([]), 0)
        self.assertIn(reference + row.format("ours", "fast", "K = 4", "25 %", "500 ms *"), self.read("results/gallery/README.md"))
        self.assertEqual(gallery.main(["--times"]), 0)
        self.assertEqual(len(self.renders()), 6)  # three of the second panel
        page = self.read("results/gallery/README.md")
        self.assertIn(row.format("ours", "fast", "K = 4", "25 %", "500 ms"), page)
        self.assertIn("Film: 960x4 pixels, each pixel of a panel (480x2) is the mean of 2x2. Processor: A Processor, 2 threads.", page)
        os.remove(f"{self.root}/build/release/airlight")  # the page comes from the picture alone
        self.assertEqual(self.run_script("gallery", "--page")[0], 0)
        self.assertEqual(self.read("results/gallery/README.md"), page)
        self.assertEqual(self.run_script("gallery", "--check")[0], 0)

    def test_no_times_of_a_busy_machine(self):
        gallery = self.module("gallery", "scripts/gallery")
        self.assertFalse(gallery.disturbed((1, 10, 100), (3, 12.1, 102)))  # others used 0.1 s of 2 s
        self.assertTrue(gallery.disturbed((1, 10, 100), (2, 12, 102)))
        gallery.disturbed = lambda before, after: True
        self.assertEqual(gallery.main(["--times"]), 0)
        self.assertIn("| ours | fast | once | K = 3 | 25 % |  |\n", self.read("results/gallery/README.md"))

    def objects(self, code, word, *command):
        got, text = self.run_script("gallery", *command)
        self.assertEqual(got, code, text)
        self.assertIn(word, text)
        return text

    def test_bad_input(self):
        for old, new, word in (
                ("exposure = 0", "exposur = 0", "gallery.toml:5: unknown key 'exposur' of a picture (nearest: exposure)"),
                ("exposure = 0", "exposure = '0'", "gallery.toml:5: 'exposure' of a picture is '0', expected a number"),
                ("K = 3 }", "K = 3 }\nmetod = 'x'", "gallery.toml:16: unknown key 'metod' of a panel (nearest: method)"),
                ("caption = \"a picture\"\n", "", "gallery.toml:1: a picture has no 'caption'"),
                ("height = 2", "height = 0", "gallery.toml:1: 'height' is 0, expected 1 to 1024"),
                ("height = 2", "height = 2\nwidth = 0", "gallery.toml:1: 'width' is 0, expected 1 to 1024"),
                ("height = 2", 'height = 2\nmaps = false\nfilm = { "a.b" = [1, 2], "a.c" = [1] }', "gallery.toml:1: each key of 'film' needs a list"),
                ("height = 2", 'height = 2\nfilm = { "a.b" = [1, 2] }', "gallery.toml:1: a film has one scene, maps = false, and no"),
                ("title = ", "title ", "experiments/gallery.toml: Expected '='")):
            self.write("experiments/gallery.toml", GALLERY.replace(old, new))
            self.assertEqual(self.objects(2, word, "--check").count("\n"), 1)
        self.write("experiments/gallery.toml", GALLERY)
        self.objects(2, "unknown picture 'on' (nearest: one)", "on")

    def test_what_is_missing(self):
        self.assertEqual(self.run_script("gallery")[0], 0)
        self.write("results/README.md", "")
        self.objects(1, "neither README.md nor results/README.md links to results/gallery/one.png", "--check")
        self.write("results/gallery/README.md", "")
        self.objects(1, "results/gallery/README.md is not what experiments/gallery.toml says", "--check")
        self.assertEqual(self.run_script("gallery", "--page")[0], 0)
        self.write("results/gallery/two.png", "")
        self.objects(1, "results/gallery/two.png: no entry of experiments/gallery.toml draws it", "--check")
        os.remove(f"{self.root}/results/gallery/one.png")
        self.objects(1, "results/gallery/one.png is missing", "--check")
        os.remove(f"{self.root}/experiments/scenes/a.toml")
        self.objects(1, "one: there is no experiments/scenes/a.toml", "--check")
        self.objects(2, "scenes/a.toml: No such file or directory")


if __name__ == "__main__":
    unittest.main()
