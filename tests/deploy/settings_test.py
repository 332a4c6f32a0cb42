#!/usr/bin/env python3
"""Checks that every SPHERULE_... in the files of deploy/ and in docs/operations.md is a setting of `spherule serve`:
settings_test.py BINARY"""
import re
import subprocess
import sys
import unittest

from facts import ROOT

BINARY = sys.argv.pop()
# Tokens and the path of the settings file are only read from the environment. SPHERULE_TESTS is an option of the build.
BESIDES = {"SPHERULE_VIEWER_TOKEN", "SPHERULE_CONTROLLER_TOKEN", "SPHERULE_CONFIG", "SPHERULE_TESTS"}


class Settings(unittest.TestCase):
    def test_each_is_an_option_of_serve(self):
        helps = [subprocess.run([BINARY, *words, "--help"], capture_output=True, text=True, check=True).stdout
                 for words in ((), ("serve",))]
        settings = {name for text in helps for name in re.findall(r"Env:(SPHERULE_[A-Z_]+)", text)}
        files = [path for path in (ROOT / "deploy").rglob("*") if path.is_file() and "secrets" not in path.parts]
        named = {}
        for path in (*files, ROOT / "docs/operations.md"):
            for name in re.findall(r"SPHERULE_[A-Z_]+", path.read_text(encoding="utf-8")):
                named.setdefault(name, path.name)
        self.assertIn("SPHERULE_LISTEN", named)
        self.assertEqual({name: where for name, where in named.items() if name not in settings | BESIDES}, {})


if __name__ == "__main__":
    unittest.main()
