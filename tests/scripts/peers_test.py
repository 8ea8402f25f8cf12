#!/usr/bin/env python3
"""scripts/compare_mantaflow and compare_lbfgsb without their peers, and what they say of runs."""
import importlib.machinery
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


class Mantaflow(unittest.TestCase):
    script = f"{SOURCE}/scripts/compare_mantaflow"

    def test_without_blender(self):
        with tempfile.TemporaryDirectory() as folder:
            without = f"{folder}/blender"
            with open(without, "w") as stream:
                stream.write("#!/bin/sh\necho fluid False\n")
            os.chmod(without, 0o755)
            for blender, words in ((f"{folder}/none", "there is no Blender"), (without, "without fluids")):
                done = subprocess.run([sys.executable, self.script, "--blender", blender], capture_output=True, text=True)
                self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (3, "", 1))
                self.assertIn(words, done.stderr)
                self.assertIn("apt-get install -y --no-install-recommends blender", done.stderr)

    def test_ratios_are_of_the_same_round(self):
        loader = importlib.machinery.SourceFileLoader("compare_mantaflow", self.script)
        module = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare_mantaflow", loader))
        sys.dont_write_bytecode = True
        loader.exec_module(module)
        module.our_version = lambda program: "airlight"

        def runs(*seconds):
            return [{"seconds": s, "stages": {"projection": s / 4}, "divergence": 1e-6, "speed": 1, "height": 0.5, "mass": 0.01} for s in seconds]

        options = type("Options", (), {"cells": [10], "steps": 2, "rounds": 3, "threads": 2, "program": ""})
        text = module.report({10: {"ours": runs(1e-3, 4e-3, 2e-3), "theirs": runs(4e-3, 8e-3, 1e-2)}}, "ours", options, "3")
        self.assertIn("| 10 | ours | 1000 | 1.00 (1.00 to 1.00) | 250 |", text)
        self.assertIn("| 10 | theirs | 4000 | 4.00 (2.00 to 5.00) | 1000 |", text)


class Lbfgsb(unittest.TestCase):
    script = f"{SOURCE}/scripts/compare_lbfgsb"

    def test_without_scipy(self):
        # -S: without site packages, where SciPy would be.
        done = subprocess.run([sys.executable, "-S", self.script], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (3, "", 1))
        self.assertIn("has no SciPy", done.stderr)
        self.assertIn("apt-get install -y --no-install-recommends python3-scipy", done.stderr)

    def test_ratios_are_to_ours_that_is_as_close_in_the_same_round(self):
        loader = importlib.machinery.SourceFileLoader("compare_lbfgsb", self.script)
        module = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare_lbfgsb", loader))
        sys.dont_write_bytecode = True
        loader.exec_module(module)

        def runs(value, *seconds):
            return [{"value": value, "seconds": s, "evaluations": 9, "iterations": 5} for s in seconds]

        options = type("Options", (), {"size": 8, "octaves": 1, "gaussians": 2, "rounds": 3, "threads": 2})
        results = {(module.METHODS[0], 5): runs(0.04, 0.1, 0.1, 0.1), (module.METHODS[0], 10): runs(0.02, 1, 2, 4),
                   ("SciPy", 20): runs(0.03, 8, 6, 4), ("SciPy", 80): runs(0.01, 9, 9, 9)}
        text = module.report(results, options, "1", "airlight")
        self.assertIn("| SciPy | 5 | 9 | 3.000 | 6.000 | 3 (1 to 8) |", text)
        self.assertIn("| SciPy | 5 | 9 | 1.000 | 9.000 | ours was not |", text)


if __name__ == "__main__":
    unittest.main()
