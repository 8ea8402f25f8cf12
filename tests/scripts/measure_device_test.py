#!/usr/bin/env python3
"""scripts/measure_device with a stub in place of the program: which rows it runs, what it writes, how it resumes and refuses."""
import csv
import importlib.machinery
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPTS = os.environ.get("AIRLIGHT_TESTED_SCRIPTS", f"{SOURCE}/scripts")  # tests/mutants plants bugs in copies
sys.dont_write_bytecode = True

# Stands for the program: it notes its calls, and an experiment has one row for each scene and method of its file.
STUB = '''#!/usr/bin/env python3
import json, os, re, sys, time
root = os.path.dirname(os.path.abspath(__file__))
with open(f"{root}/calls", "a") as stream:
    stream.write(" ".join(sys.argv[1:]) + "\\n")
faults = os.environ.get("FAULTS", "")
device = "llvmpipe (LLVM 15), OpenGL 4.5 Mesa (surfaceless; a processor, no GPU)" if "soft" in faults else "GeForce 1/PCIe, OpenGL 4.6 N 1.2 (device 0)"
command = sys.argv[1]
if command == "doctor" and "--check" in sys.argv:
    print(device + "\\n  holds    a_gpu: fine\\n" + ("1" if "parity" in faults else "0") + " of 14 checks failed\\nkept in /x.json")
    sys.exit(1 if "parity" in faults else 0)
if command == "doctor":
    print("airlight 0.1.0 (abc)\\n  graphics   " + ("gpu: none is to be used, as asked for" if "nothing" in faults else "chosen: " + device))
if command == "verify":
    print("a.json: 3 vectors, 4 numbers compared: 4 ok, 0 out; 1 skipped\\nb.json: 2 vectors, 2 numbers compared: 2 ok, 0 out; 0 skipped\\n"
          "all files: 5 vectors, 6 numbers compared: 6 ok, 0 out; 1 skipped")
if command == "experiment":
    option = lambda name: sys.argv[sys.argv.index(name) + 1]
    name = sys.argv[3]
    if "slow" in faults and name.startswith("wavelet"):
        time.sleep(60)
    import tomllib
    with open(f"{option('--root')}/experiments/{name}.toml", "rb") as stream:
        file = tomllib.load(stream)
    if "like" in file:
        with open(f"{option('--root')}/experiments/{file['like']['experiment']}.toml", "rb") as stream:
            file = tomllib.load(stream)
    rows = []
    for scene in file.get("scene", [{"name": ""}]):
        for method in file["method"]:
            for setting in method.get("sweep", {"values": [""]})["values"]:
                film = [800, 600] if option("--profile") == "paper" else [16, 12]
                rows.append({"scene": scene.get("name", os.path.basename(scene.get("file", ""))[:-5]), "method": method["name"],
                             "setting": str(setting), "settings": "", "film": film, "seconds": [0.002, 0.0019, 0.0021], "runs": 31, "note": ""})
    folder = f"{option('--results')}/{name}" + (".paper" if option("--profile") == "paper" else "")
    os.makedirs(folder, exist_ok=True)
    with open(f"{folder}/run.json", "w") as stream:
        json.dump({"rows": rows}, stream)
'''


def script():
    loader = importlib.machinery.SourceFileLoader("measure_device", f"{SCRIPTS}/measure_device")
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("measure_device", loader))
    loader.exec_module(module)
    return module


def text_of(experiment):
    with open(f"{SOURCE}/experiments/{experiment}.toml") as stream:
        return stream.read()


class Files(unittest.TestCase):
    def test_rows_on_the_device_and_no_others(self):
        measure = script()
        for experiment in measure.EXPERIMENTS:
            text = text_of(experiment["id"])
            whole = tomllib.loads(text)
            if experiment.get("whole"):
                kept = tomllib.loads(measure.without_gates(text))
                self.assertTrue(kept["like"]["device"])
                self.assertFalse({"gate", "plot", "expected", "claim", "conclusion"} & set(kept))
                self.assertIn(kept["like"]["experiment"], experiment["needs"])
                continue
            for profile in ("quick", "paper"):
                def here(tables):
                    return [t for t in tables if profile in t.get("profiles", [profile])]
                file = tomllib.loads(measure.on_device(text, experiment.get("twin"), profile, False))
                twin = experiment.get("twin")
                expected = [m["name"] for m in here(whole["method"])
                            if twin or m.get("renderer", m.get("probe", "")).endswith("_gpu")]
                self.assertEqual([m["name"] for m in file["method"]], expected)
                self.assertTrue(all(m.get("renderer", m.get("probe", "")).endswith("_gpu") for m in file["method"]))
                self.assertEqual([s["file"] for s in file.get("scene", [])], [s["file"] for s in here(whole.get("scene", []))])
                self.assertFalse({"reference", "gate", "plot", "expected", "claim", "in_tests"} & set(file))
                small = tomllib.loads(measure.on_device(text, twin, profile, True))
                self.assertLessEqual(len(small.get("scene", [])), 1)
                self.assertTrue(small["method"])

    def test_printed_rates(self):
        measure = script()
        self.assertEqual(measure.printed(text_of("fogshop/table1"))["box", "S, GPU", ""][:2], ([34.0], [800, 600]))
        rates = measure.printed(text_of("compensated_ray_marching/frame"))
        self.assertEqual(rates["fitted", "grid, GPU", ""][0], [19.1, 95.1])
        self.assertEqual(measure.printed(text_of("wavelet_fog/table2"))["smooth", "paper, 3 levels", "0.8"][0], [39.0])
        self.assertEqual(measure.printed(text_of("shadow_planes/table1_table2"))["pens", "rule, GPU", ""][0], [23.0])


class Runs(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.root)
        os.mkdir(f"{self.root}/scripts")
        shutil.copy(f"{SCRIPTS}/measure_device", f"{self.root}/scripts")
        for name in (n for e in script().EXPERIMENTS for n in (e["id"], *e.get("needs", []))):
            os.makedirs(os.path.dirname(f"{self.root}/experiments/{name}"), exist_ok=True)
            shutil.copy(f"{SOURCE}/experiments/{name}.toml", f"{self.root}/experiments/{name}.toml")
        with open(f"{self.root}/experiments/README.md", "w"):
            pass
        os.makedirs(f"{self.root}/tests/vectors")
        with open(f"{self.root}/tests/vectors/shadow_planes.json", "w"):
            pass
        with open(f"{self.root}/airlight", "w") as stream:
            stream.write(STUB)
        os.chmod(f"{self.root}/airlight", 0o755)

    def run_script(self, *options, faults=""):
        done = subprocess.run([sys.executable, f"{self.root}/scripts/measure_device", *options], capture_output=True, text=True, cwd="/",
                              env={"PATH": os.environ["PATH"], "HOME": self.root, "FAULTS": faults})
        return done.returncode, done.stdout, done.stderr

    def calls(self):
        with open(f"{self.root}/calls") as stream:
            return stream.read().splitlines()

    def read(self, name):
        with open(f"{self.root}/results/device/geforce-1/{name}") as stream:
            return stream.read()

    def test_a_whole_run(self):
        code, out, err = self.run_script()
        self.assertEqual((code, err), (0, ""), out)
        self.assertIn("parity: 0 of 14 checks failed\nvectors: 6 numbers ok, 0 out\nfogshop/table1: ", out)
        page = self.read("README.md")
        self.assertIn("| GPU tests | a bundle has none |  |\n", page)
        self.assertIn("| gargoyle | paper, GPU | 800x600 | 101 on a GeForce 8800 GTX, 800x600 | 2 ms [1.9 ms, 2.1 ms] | 5 |\n", page)
        self.assertIn("| fitted | grid, GPU | 800x600 | 1/95.1 to 1/19.1 on an 8800 GTX, 800x600 "
                      "| 2 ms [1.9 ms, 2.1 ms] | 5.3 to 26 |\n", page)
        self.assertIn("| smooth | paper, 3 levels 0.8 | 800x600 | 1/39 on a GTX 280, 800x600 | ", page)
        rows = list(csv.DictReader(self.read("frames.csv").splitlines()))
        nave = next(r for r in rows if (r["scene"], r["method"]) == ("nave", "rule, GPU"))
        self.assertAlmostEqual(float(nave["times_faster_least"]), 500 / 12)
        self.assertFalse(os.path.exists(f"{self.root}/results/device/geforce-1/unfinished"))
        self.assertTrue(all(" --gpu auto" in call for call in self.calls()))
        # Whatever ended is kept.
        count = len(self.calls())
        code, out, err = self.run_script("--resume")
        self.assertEqual((code, err, len(self.calls())), (0, "", count + 1), out)
        self.assertEqual(self.read("README.md"), page)

    def test_out_of_time_and_resumed(self):
        code, out, err = self.run_script("--minutes", "0.13", faults="slow")
        self.assertEqual((code, err), (4, ""), out)
        self.assertIn("wavelet_fog/table1: out of time\n", out)
        self.assertIn("not measured: wavelet_fog/table1, wavelet_fog/table2, wavelet_fog/table3, common/device, common/large_film_device; "
                      "--resume goes on with them\n", out)
        self.assertIn("| gargoyle |", self.read("README.md"))
        code, out, err = self.run_script("--resume")
        self.assertEqual((code, err), (0, ""), out)
        self.assertIn("fogshop/table1: kept\n", out)
        self.assertIn("| Haar 16x16 | direct | 800x600 | 1/199 on a GTX 280, 800x600 |", self.read("README.md"))

    def test_small_sizes_have_no_factor(self):
        self.assertEqual(self.run_script("--small")[0], 0)
        page = self.read("README.md")
        self.assertIn("| gargoyle | paper, GPU | 16x12 | 101 on a GeForce 8800 GTX, 800x600 | 2 ms [1.9 ms, 2.1 ms] |  |\n", page)
        self.assertNotIn("| box |", page)
        code, out, err = self.run_script("--resume")
        self.assertEqual((code, err.count("\n")), (2, 1), out)
        self.assertIn("measure without --resume", err)

    def test_a_check_that_fails(self):
        code, out, _ = self.run_script(faults="parity")
        self.assertEqual(code, 1)
        self.assertIn("parity: 1 of 14 checks failed\n", out)
        self.assertIn("1 of 14 checks failed", self.read("README.md"))

    def test_software_is_measured_only_by_name(self):
        code, out, err = self.run_script(faults="soft")
        self.assertEqual((code, out, err.count("\n")), (3, "", 1))
        self.assertIn("no GPU: the device would be llvmpipe", err)
        self.assertEqual(self.run_script("llvmpipe", "--small", "--name", "soft", faults="soft")[0], 0)
        with open(f"{self.root}/results/device/soft/README.md") as stream:
            self.assertIn("This device is a software renderer: its times are times of a CPU.\n", stream.read())

    def test_no_device_no_program_and_bad_usage(self):
        code, out, err = self.run_script(faults="nothing")
        self.assertEqual((code, out, err), (3, "", "scripts/measure_device: gpu: none is to be used, as asked for\n"))
        for options, found in ((["--minutes", "0"], "--minutes: expected more than 0, found 0"), (["--name", "a/b"], "found 'a/b'"),
                               ([""], "DEVICE is empty")):
            code, out, err = self.run_script(*options)
            self.assertEqual((code, out, err.count("\n")), (2, "", 1))
            self.assertIn(found, err)
        os.remove(f"{self.root}/airlight")
        code, out, err = self.run_script()
        self.assertEqual((code, out, err.count("\n")), (3, "", 1))
        self.assertIn("scripts/build makes it", err)


if __name__ == "__main__":
    unittest.main()
