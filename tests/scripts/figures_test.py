#!/usr/bin/env python3
"""scripts/figures on a small tree of its own: what it writes, and what it objects to."""
import json
import sys
import unittest

from small_tree import TABLE, Tree, rows

PAGE = """# A page

| what | ours |
|---|---|
| error | from 0 with 8, below 0 and 0 with
16, or 0; |

It takes 0 ms, .1 times, and S wins.
"""
FIGURES = """[g/e rel_l2]
from {range([*|S|8])} with 8, below {[two|S|16]} and {percent([two|S|16])} with 16, or {one, large|S|16;8}
takes {[two|S|8|seconds] * 1000; 1} ms, {[g/e: one, large|S|8|seconds] / [two|S|16|seconds]; 3} times
S wins ?? [one, large|S|16] < [one, large|S|8]
"""


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


if __name__ == "__main__":
    unittest.main()
