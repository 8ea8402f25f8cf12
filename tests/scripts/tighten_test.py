#!/usr/bin/env python3
"""scripts/tighten on a small tree of its own: what it writes, and what it objects to."""
import json
import sys
import unittest

from small_tree import EXPERIMENT, Tree, rows

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


if __name__ == "__main__":
    unittest.main()
