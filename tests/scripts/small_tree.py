"""A small project for the tests of scripts: folders, a table and its record."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPTS = os.environ.get("AIRLIGHT_TESTED_SCRIPTS", f"{SOURCE}/scripts")  # tests/mutants plants bugs in copies

TABLE = """scene,parameter,method,setting,rel_l2,rel_l2_low,rel_l2_high,seconds,note
"one, large",,S,8,0.01237,0.01237,0.01237,0.002,
"one, large",,S,16,0.00031,0.00031,0.00031,0.004,
two,,S,8,0.5,0.5,0.5,0.003,
two,,S,16,0.02,0,0.04,0.006,
two,,"S, GPU",8,,,,,not available on this machine
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
