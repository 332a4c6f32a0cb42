#!/usr/bin/env python3
"""Every SPHERULE_... that the files of deploy/ and docs/operations.md name is an option of `spherule serve`:
settings_test.py BINARY"""
import re
import subprocess
import sys
import unittest

from facts import ROOT

BINARY = sys.argv.pop()


class Settings(unittest.TestCase):
    def test_each_is_an_option_of_serve(self):
        said = subprocess.run([BINARY, "serve", "--help"], capture_output=True, text=True, check=True).stdout
        options = set(re.findall(r"--[a-z-]+", said))
        files = [path for path in (ROOT / "deploy").rglob("*") if path.is_file() and "secrets" not in path.parts]
        named = {}
        for path in (*files, ROOT / "docs/operations.md"):
            for name in re.findall(r"SPHERULE_([A-Z_]+)", path.read_text(encoding="utf-8")):
                named.setdefault("--" + name.lower().replace("_", "-"), path.name)
        self.assertIn("--listen", named)
        # Of the build: -D SPHERULE_TESTS.
        unknown = {option: where for option, where in named.items() if option not in options | {"--tests"}}
        self.assertEqual(unknown, {})


if __name__ == "__main__":
    unittest.main()
