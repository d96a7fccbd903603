#!/usr/bin/env python3
"""Tests scripts/install_dependencies with an apt, dpkg and npm that only write down how they are called."""

import os
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FAKES = {
    "dpkg-query": 'for package in $INSTALLED; do echo "$package installed"; done; echo "removed config-files"; exit 1',
    "apt-get": """
        echo "apt-get $*" >>"$CALLS"
        case "$*" in
        *--assume-no*)
            echo "0 upgraded, 7 newly installed, 0 to remove and 0 not upgraded."
            echo "Need to get 1,234 kB/5,678 kB of archives."
            echo "After this operation, 12.3 MB of additional disk space will be used."
            exit 1 ;;
        *install*) echo "dlstatus:1:50.5:Retrieving file 1 of 2"; echo "pmstatus:zsh:20.0:Unpacking zsh (amd64)"
                   echo "E: $BROKEN"; [ -z "$BROKEN" ] ;;
        esac""",
    "npm": 'echo "npm $*" >>"$CALLS"; mkdir -p "$3/node_modules"',
    "node": "",
    "sudo": 'exec "$@"',
}


class InstallDependencies(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        for name in ("scripts/install_dependencies", "web/package-lock.json", "tests/mavlink_peer/package-lock.json"):
            os.makedirs(os.path.dirname(os.path.join(self.folder, name)), exist_ok=True)
            shutil.copy(os.path.join(ROOT, name), os.path.join(self.folder, name))
        os.mkdir(os.path.join(self.folder, "bin"))
        for name, script in FAKES.items():
            path = os.path.join(self.folder, "bin", name)
            with open(path, "w", encoding="utf-8") as file:
                file.write("#!/bin/bash\n" + script + "\n")
            os.chmod(path, 0o755)

    def run_script(self, *arguments, installed=(), broken=""):
        """Exit code, calls of apt-get and npm, messages."""
        calls = os.path.join(self.folder, "calls")
        open(calls, "w", encoding="utf-8").close()
        environment = {**os.environ, "PATH": os.path.join(self.folder, "bin") + os.pathsep + os.environ["PATH"],
                       "CALLS": calls, "INSTALLED": " ".join(installed), "BROKEN": broken}
        done = subprocess.run([os.path.join(self.folder, "scripts/install_dependencies"), *arguments],
                              env=environment, capture_output=True, text=True, check=False)
        with open(calls, encoding="utf-8") as file:
            return done.returncode, file.read().splitlines(), done.stderr, done.stdout.split()

    def test_without_a_tier_only_what_the_build_needs(self):
        code, calls, _, _ = self.run_script()
        self.assertEqual(code, 0)
        packages = calls[-2].split()
        self.assertIn("libceres-dev", packages)
        for other in ("libgtest-dev", "libroscpp-dev", "clang-tidy", "chromium", "snakemake"):
            self.assertNotIn(other, packages)
        self.assertTrue(calls[-1].startswith("npm ci --prefix web"), calls[-1])

    def test_only_missing_packages_are_installed(self):
        _, _, _, ros = self.run_script("--list", "ros")
        code, calls, messages, _ = self.run_script("ros", installed=ros[1:])
        self.assertEqual(code, 0, messages)
        self.assertTrue(calls[-1].endswith("Status-Fd=1 " + ros[0]), calls)

    def test_nothing_is_done_where_all_is_there(self):
        _, _, _, packages = self.run_script("--list", "tests", "check")
        code, calls, _, _ = self.run_script("tests", "check", installed=packages)
        self.assertEqual((code, [call.split(" --no")[0] for call in calls]), (0, ["npm ci --prefix tests/mavlink_peer"]))
        self.assertEqual(self.run_script("tests", "check", installed=packages)[:3], (0, [], ""))

    def test_says_how_many_packages_and_megabytes(self):
        messages = self.run_script("cluster")[2]
        self.assertIn("7 packages with those that they need, 1,234 kB to fetch, 12.3 MB on disk", messages)

    def test_a_failure_of_apt_is_shown(self):
        code, _, messages, _ = self.run_script("arm64", broken="no space left")
        self.assertEqual(code, 1)
        self.assertIn("install_dependencies: error: apt-get install failed: E: no space left", messages)

    def test_an_unknown_tier_is_wrong_usage(self):
        code, calls, messages, _ = self.run_script("build", "everything")
        self.assertEqual((code, calls), (2, []))
        self.assertIn("unknown tier 'everything'", messages)

    def test_the_build_installs_only_libraries_that_it_finds(self):
        _, _, _, packages = self.run_script("--list", "build")
        with open(os.path.join(ROOT, "CMakeLists.txt"), encoding="utf-8") as file:
            text = re.sub(r"[^a-z]", "", file.read().lower())
        for package in [name for name in packages if name.endswith("-dev")]:
            library = re.sub(r"^lib|\d*-dev$", "", package).replace("boost-", "").replace("-", "")
            self.assertIn(re.sub(r"[^a-z]", "", library), text, f"{package} is installed, but CMake does not find it")


if __name__ == "__main__":
    unittest.main()
