#!/usr/bin/env python3
"""What a first-time user meets: --help and unknown options of every script, and what setup and build say before they begin.

Neither CMake nor Ninja nor apt is run: PATH is a folder of the test's own, with the common tools and stubs for the rest."""
import os
import pty
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPTS = os.environ.get("AIRLIGHT_TESTED_SCRIPTS", f"{SOURCE}/scripts")  # tests/mutants plants bugs in copies
TOOLS = ("bash", "env", "sed", "grep", "awk", "cat", "cp", "dirname", "ln", "mkdir", "mktemp", "nproc", "rm", "tail", "realpath")
PROCESSOR = 'case "$*" in *cpuinfo*) echo "flags : fpu avx2 bmi2 fma" ;; *) exec /bin/grep "$@" ;; esac'
SIZES = """[ "$*" != update ] || exit 0
case "$*" in
  *--print-uris*) echo '1 upgraded, 87 newly installed, 0 to remove and 3 not upgraded.'
    echo 'Need to get 20.5 MB/210 MB of archives.'; echo 'After this operation, 1021 MB of additional disk space will be used.' ;;
esac"""
NOT_INSTALLED = ("ccache", "libhwy-dev", "spirv-tools")
INSTALLED = f"""for package in "$@"; do case "$package" in -W | -f | '$'* | {' | '.join(NOT_INSTALLED)}) ;; *) echo "installed $package" ;; esac; done
exit 1"""


class Machine(unittest.TestCase):
    """A small copy of the project, and a PATH on which stubs stand for the machine's own programs."""

    def setUp(self):
        self.root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.root)
        self.bin = f"{self.root}/bin"
        shutil.copytree(f"{SOURCE}/scripts", f"{self.root}/scripts")
        for script in os.listdir(SCRIPTS):
            if os.path.isfile(f"{SCRIPTS}/{script}"):
                shutil.copyfile(f"{SCRIPTS}/{script}", f"{self.root}/scripts/{script}")
        shutil.copy(f"{SOURCE}/CMakePresets.json", self.root)
        os.mkdir(self.bin)
        for tool in TOOLS:
            os.symlink(shutil.which(tool), f"{self.bin}/{tool}")
        os.symlink(sys.executable, f"{self.bin}/python3")

    def stub(self, name, text):
        """Stands for a program; every call of it goes to the log."""
        if os.path.lexists(f"{self.bin}/{name}"):
            os.remove(f"{self.bin}/{name}")
        with open(f"{self.bin}/{name}", "w") as stream:
            stream.write(f'#!/bin/bash\necho "{name} $*" >>"{self.root}/log"\n{text}\n')
        os.chmod(f"{self.bin}/{name}", 0o755)

    def calls(self, name):
        if not os.path.exists(f"{self.root}/log"):
            return []
        with open(f"{self.root}/log") as stream:
            return [line.strip() for line in stream if line.startswith(name + " ")]

    def run_script(self, *command):
        done = subprocess.run([f"{self.root}/scripts/{command[0]}", *command[1:]], capture_output=True, text=True, cwd="/",
                              stdin=subprocess.DEVNULL, env={"PATH": self.bin, "LC_ALL": "C.UTF-8"})
        return done.returncode, done.stdout, done.stderr


class Options(Machine):
    def scripts(self):
        names = sorted(f for f in os.listdir(f"{SOURCE}/scripts") if os.path.isfile(f"{SOURCE}/scripts/{f}"))
        self.assertGreater(len(names), 15)
        return names

    def test_help_comes_first_and_at_once(self):
        for script in self.scripts():
            for option in ("--help", "-h"):
                before = resource.getrusage(resource.RUSAGE_CHILDREN)
                code, out, err = self.run_script(script, option)
                after = resource.getrusage(resource.RUSAGE_CHILDREN)
                self.assertEqual((code, err), (0, ""), script)
                self.assertIn(script, out)
                self.assertGreater(out.count("\n"), 3, script)
                # Processor time is measured, because other processes may keep the processor busy.
                self.assertLess(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 1, script)
        self.assertFalse(os.path.exists(f"{self.root}/build"))

    def test_unknown_options_are_refused_before_anything_is_built(self):
        operands = {"check_shaders": ["x"], "shader_statistics": ["x"]}
        for script in self.scripts():
            code, out, err = self.run_script(script, *operands.get(script, []), "--no-such-option")
            self.assertEqual((code, out, err.count("\n")), (2, "", 1), script + out + err)
            self.assertIn("--no-such-option", err)
            self.assertIn(f"scripts/{script} --help", err)
        self.assertFalse(os.path.exists(f"{self.root}/build"))

    def test_an_empty_name_is_refused_before_anything_is_built(self):
        code, out, err = self.run_script("reproduce", "")
        self.assertEqual((code, out, err), (2, "", "scripts/reproduce: a name is empty; see scripts/reproduce --help\n"))

    def test_a_report_without_renders_needs_no_program(self):
        os.makedirs(f"{self.root}/results/g/e")
        with open(f"{self.root}/results/g/e/run.json", "w") as stream:
            stream.write('{"title": "E", "pictures": [{"title": "P", "pictures": [{"label": "a", "file": "a.exr"}]}]}')
        code, out, err = self.run_script("report")
        self.assertEqual((code, err), (0, ""))
        self.assertIn("results/report/index.html: 1 experiments", out)
        open(f"{self.root}/results/g/e/a.exr", "w").close()
        code, out, err = self.run_script("report")
        self.assertEqual((code, out, err.count("\n")), (3, "", 1))
        self.assertIn("no program at", err)


class Setup(Machine):
    def setUp(self):
        super().setUp()
        self.stub("grep", PROCESSOR)
        self.stub("dpkg-query", INSTALLED)
        self.stub("apt-get", SIZES)
        self.stub("id", "echo 0")

    def installs(self):
        return [call for call in self.calls("apt-get") if "--print-uris" not in call]

    line = "apt-get update && apt-get install -y --no-install-recommends " + " ".join(NOT_INSTALLED)

    def test_check_lists_and_installs_nothing(self):
        code, out, err = self.run_script("setup", "--check")
        self.assertEqual((code, err), (3, ""))
        self.assertIn("airlight needs 2 packages that are not installed, and 1 for one test only: " + " ".join(NOT_INSTALLED), out)
        self.assertIn("with what they depend on: 88 packages, 20.5 MB to download, 1021 MB on disk\n", out)
        self.assertIn(self.line, out)
        self.assertEqual(self.installs(), [])
        self.stub("apt-get", "exit 100")  # as before the first apt-get update
        code, out, err = self.run_script("setup", "--check")
        self.assertEqual((code, err), (3, ""))
        self.assertIn("before apt-get update", out)

    def test_check_where_everything_is_installed(self):
        self.stub("dpkg-query", INSTALLED.replace("| " + " | ".join(NOT_INSTALLED), "").replace("exit 1", ""))
        code, out, err = self.run_script("setup", "--check")
        self.assertEqual((code, err, out.count("\n")), (0, "", 1))
        self.assertIn("packages that airlight needs are installed", out)
        self.assertEqual(self.run_script("setup"), (0, "", ""))
        self.assertEqual(self.calls("apt-get"), [])

    def test_without_a_terminal_it_installs_and_says_so(self):
        for options in ([], ["--yes"]):
            code, out, err = self.run_script("setup", *options)
            self.assertEqual((code, err), (0, ""))
            self.assertIn("88 packages, 20.5 MB to download", out)
            self.assertIn("installing them\ninstalled in ", out)
        self.assertEqual(self.installs(), ["apt-get update", "apt-get install -y --no-install-recommends " + " ".join(NOT_INSTALLED)] * 2)

    def test_what_apt_says_when_it_fails(self):
        self.stub("apt-get", 'case "$*" in install\\ -y*) echo "E: no space left"; exit 100 ;; esac')
        code, _, err = self.run_script("setup")
        self.assertEqual(code, 3)
        self.assertIn("E: no space left\nscripts/setup: apt-get could not install them", err)

    def test_without_root(self):
        self.stub("id", "echo 1000")
        code, _, err = self.run_script("setup")
        self.assertEqual(code, 3)
        self.assertIn(self.line, err)
        self.stub("sudo", "exit 1")  # it would ask for a password, and nobody is there
        self.assertEqual(self.run_script("setup")[0], 3)
        self.assertEqual(self.installs(), [])
        self.stub("sudo", 'case "$1" in -*) exit 0 ;; *) exec "$@" ;; esac')
        self.assertEqual(self.run_script("setup")[0], 0)
        self.assertEqual(len(self.installs()), 2)

    def test_without_apt(self):
        os.remove(f"{self.bin}/apt-get")
        for options in ([], ["--check"]):
            code, out, err = self.run_script("setup", *options)
            self.assertEqual((code, out, err.count("\n")), (3, "", 1))
            self.assertIn("knows Debian 12 only: no apt-get here; install these libraries yourself: g++ cmake", err)

    def test_a_processor_without_avx2(self):
        self.stub("grep", PROCESSOR.replace("avx2 ", ""))
        for script in ("setup", "build"):
            code, out, err = self.run_script(script)
            self.assertEqual((code, out, err.count("\n")), (3, "", 1))
            self.assertIn("this processor lacks avx2", err)
        self.assertEqual(self.installs(), [])

    def on_a_terminal(self, answer, *options):
        """Exit code and what was shown, with an answer typed after the question."""
        pid, terminal = pty.fork()
        if pid == 0:
            os.execve(f"{self.root}/scripts/setup", ["setup", *options], {"PATH": self.bin, "LC_ALL": "C.UTF-8"})
        shown, end = b"", time.monotonic() + 60
        while time.monotonic() < end:
            try:
                part = os.read(terminal, 4096)
            except OSError:  # the other side is closed
                break
            if not part:
                break
            shown += part
            if answer and b"[Y/n]" in shown:
                os.write(terminal, answer)
                answer = b""
        os.close(terminal)
        return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), shown.decode()

    def test_on_a_terminal_it_asks_once(self):
        code, shown = self.on_a_terminal(b"n\n")
        self.assertEqual((code, shown.count("[Y/n]")), (3, 1), shown)
        self.assertIn("88 packages", shown)
        self.assertIn(self.line, shown)
        self.assertEqual(self.installs(), [])
        code, shown = self.on_a_terminal(b"\n")
        self.assertEqual((code, shown.count("[Y/n]"), len(self.installs())), (0, 1, 2), shown)
        code, shown = self.on_a_terminal(b"", "--yes")
        self.assertEqual((code, shown.count("[Y/n]"), len(self.installs())), (0, 0, 4), shown)


class Build(Machine):
    def setUp(self):
        super().setUp()
        self.stub("grep", PROCESSOR)
        self.stub("dpkg-query", INSTALLED.replace("| " + " | ".join(NOT_INSTALLED), "").replace("exit 1", ""))
        self.stub("apt-get", "exit 100")
        self.stub("nproc", "echo 8")
        self.stub("cmake", "")
        self.memory(64000)

    def memory(self, mb):
        """Free memory of the machine, as awk finds it in /proc/meminfo."""
        self.stub("awk", f"cat >/dev/null; echo {mb}")

    def built(self, *options):
        code, out, err = self.run_script("build", *options)
        self.assertEqual((code, err), (0, ""), out)
        return self.calls("cmake")[-1], out

    def test_what_is_built(self):
        call, out = self.built()
        self.assertEqual(self.calls("cmake")[0], "cmake --preset release")
        self.assertEqual(call, "cmake --build --preset release --target all --parallel 8")
        self.assertRegex(out, r"built in \d s: build/release/airlight\n$")
        call, out = self.built("debug", "--target", "airlight_tests", "--jobs", "3")
        self.assertEqual(call, "cmake --build --preset debug --target airlight_tests --parallel 3")
        self.assertRegex(out, r"built in \d s: airlight_tests\n$")

    def test_fewer_jobs_where_memory_is_short(self):
        self.memory(5000)
        call, out = self.built()
        self.assertTrue(call.endswith("--parallel 3"), call)
        self.assertIn("5000 MB of memory are free and a job takes up to 1500 MB: 3 at a time instead of 8\n", out)
        self.assertTrue(self.built("--jobs", "5")[0].endswith("--parallel 3"))
        call, out = self.built("--jobs", "2")
        self.assertTrue(call.endswith("--parallel 2"))
        self.assertNotIn("memory", out)
        self.memory(100)
        self.assertTrue(self.built()[0].endswith("--parallel 1"))

    def test_bad_usage(self):
        for words, found in ((["relese"], "unknown preset 'relese', expected one of release, "), (["--jobs", "0"], "a positive number, found '0'"),
                             (["--jobs"], "a positive number, found ''"), (["--target"], "--target needs a name"),
                             (["release", "debug"], "one preset, found release and debug")):
            code, out, err = self.run_script("build", *words)
            self.assertEqual((code, out, err.count("\n")), (2, "", 1))
            self.assertIn(found, err)
        self.assertEqual(self.calls("cmake"), [])
        code, out, err = self.run_script("test", "--jobs", "many")
        self.assertEqual((code, out, err.count("\n")), (2, "", 1))

    def test_progress_in_a_pipe(self):
        self.stub("cmake", 'case "$1" in --build) for i in {1..40}; do echo "[$i/40] Building CXX object a.o"; [ $i != 7 ] || '
                  'echo "FAILED: a.o: what the compiler said"; done; exit 1 ;; esac')
        code, out, err = self.run_script("build")
        self.assertEqual(code, 1)
        self.assertEqual(out.count(" of 40 steps after "), 10, out)
        self.assertIn("FAILED: a.o: what the compiler said\n", out)
        self.assertNotIn("Building CXX", out)
        self.assertNotIn("built in", out)

    def test_a_build_that_cannot_be_configured(self):
        self.stub("cmake", "echo 'CMake Error: what is missing'; exit 1")
        code, out, err = self.run_script("build")
        self.assertEqual((code, err), (2, "CMake Error: what is missing\n"))

    def test_tests_get_the_jobs(self):
        self.stub("ctest", "")
        os.makedirs(f"{self.root}/build/release")
        with open(f"{self.root}/build/release/airlight", "w") as stream:
            stream.write("#!/bin/bash\n")
        os.chmod(f"{self.root}/build/release/airlight", 0o755)
        code, out, err = self.run_script("test", "--jobs", "3")
        self.assertEqual((code, err), (0, ""), out)
        self.assertTrue(self.calls("cmake")[-1].endswith("--parallel 3"))
        self.assertTrue(self.calls("ctest")[-1].endswith("-j 3 --label-exclude thorough"))
        self.assertEqual(self.run_script("test", "--all")[0], 0)
        self.assertNotIn("thorough", self.calls("ctest")[-1])
        with open(f"{self.root}/build/release/airlight", "w") as stream:
            stream.write(f'#!/bin/bash\necho "airlight $*" >>"{self.root}/log"\n')
        self.assertEqual(self.run_script("test", "--junit", f"{self.root}/reports")[0], 0)
        self.assertTrue(self.calls("ctest")[-1].endswith(f"--output-junit {self.root}/reports/tests.xml"))
        self.assertTrue(self.calls("airlight")[-1].endswith(f"--junit {self.root}/reports/gates.xml"))
        self.assertEqual(self.run_script("test", "--shard", "2/3")[0], 0)
        self.assertIn("--tests-information 2,,3", self.calls("ctest")[-1])
        self.assertEqual(len(self.calls("airlight")), 1)  # part 1 judges the gates
        for wrong in ("3/2", "0/2", "2", ""):
            code, out, err = self.run_script("test", "--shard", wrong)
            self.assertEqual((code, out), (2, ""), wrong)
            self.assertIn("--shard needs I/N", err)


if __name__ == "__main__":
    unittest.main()
