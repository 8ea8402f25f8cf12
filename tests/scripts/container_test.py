#!/usr/bin/env python3
"""Recipes of containers and of CI: they call the scripts that a user calls, in their order, and name files that are there.

This test builds no container. scripts/container/check runs both stages in an empty Debian, which takes minutes, root and a network."""
import os
import re
import subprocess
import unittest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def read(path):
    with open(f"{SOURCE}/{path}", encoding="utf-8") as stream:
        return stream.read()


class Recipes(unittest.TestCase):
    def test_both_containers_run_the_same_two_stages(self):
        for recipe in ("Dockerfile", "airlight.def"):
            text = read(f"scripts/container/{recipe}")
            steps = re.findall(r"^\s*(?:RUN )?(\S*/(?:build|run)_stage /opt/airlight)$", text, re.M)
            self.assertEqual(steps, ["scripts/container/build_stage /opt/airlight", "/opt/run_stage /opt/airlight"], recipe)
            self.assertEqual(len(re.findall("^(?:FROM|From:) ?debian:12", text, re.M)), 2, recipe)
        for script in ("build_stage", "run_stage", "runtime_packages", "check"):
            path = f"{SOURCE}/scripts/container/{script}"
            self.assertTrue(os.access(path, os.X_OK), script)
            self.assertEqual(subprocess.run(["bash", "-n", path]).returncode, 0, script)

    def test_check_says_what_is_wrong(self):
        for words in (["--nothing"], ["--installed"], ["--installed", "/nowhere"]):
            done = subprocess.run([f"{SOURCE}/scripts/container/check", *words], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), words)

    def test_ci_calls_the_two_scripts_alone(self):
        prepare = r"apt-get update && apt-get install -y --no-install-recommends ca-certificates git|git config .*safe\.directory.*"
        for path, line in ((".github/workflows/ci.yml", r"- run: (.*)"), (".gitlab-ci.yml", r"^    - (.*)")):
            commands = [c for c in re.findall(line, read(path), re.M) if not re.fullmatch(prepare, c)]
            self.assertEqual([c.split()[0] for c in commands], ["./scripts/test", "./scripts/reproduce"], path)
            self.assertRegex(commands[0], r"^./scripts/test --shard \S.*/\S+ --junit build/junit$")


if __name__ == "__main__":
    unittest.main()
