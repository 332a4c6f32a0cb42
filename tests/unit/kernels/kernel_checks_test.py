#!/usr/bin/env python3
"""kernel_checks_test.py PROJECT CMAKE: tests that server/compute/cpu/Kernels.cmake stops the build with a message when a
kernel is invalid."""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CMAKE = sys.argv.pop()
PROJECT = Path(sys.argv.pop())


class Kernels(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.shaders = Path(folder.name) / "shaders"
        shutil.copytree(PROJECT / "shaders", self.shaders)

    def append(self, name, text):
        with open(self.shaders / name, "a", encoding="utf-8") as file:
            file.write(text)

    def check(self):
        script = PROJECT / "server/compute/cpu/Kernels.cmake"
        done = subprocess.run([CMAKE, "-D", f"SPHERULE_SHADERS={self.shaders}", "-P", script],
                              capture_output=True, text=True, timeout=60, check=False)
        return done.returncode, " ".join(done.stderr.split())

    def refused(self, *parts):
        code, said = self.check()
        self.assertNotEqual(code, 0)
        for part in parts:
            self.assertIn(part, said)

    def test_those_of_the_project_pass(self):
        self.assertEqual(self.check(), (0, ""))

    def test_one_buffer_above_the_limit(self):
        self.append("apply_forces.comp", "".join(f"BUFFER(readonly, uint, extra{chr(97 + k)})\n" for k in range(13)))
        self.refused("shaders/apply_forces.comp declares 17 buffers; a kernel has at most 16")

    def test_a_flag_that_is_not_defined(self):
        self.append("apply_forces.comp", "// HAS(MAGNETISM)\n")
        self.refused("shaders/apply_forces.comp asks HAS(MAGNETISM), but shaders/features.def defines no feature MAGNETISM")

    def test_a_flag_that_is_not_defined_in_an_included_file(self):
        self.append("shared/spring.h", "// HAS(MAGNETISM)\n")
        self.refused("shaders/shared/spring.h asks HAS(MAGNETISM)")

    def test_more_features_than_bits(self):
        self.append("features.def", "".join(f'FEATURE(F_{chr(65 + k // 8)}{chr(65 + k % 8)}, F, "f")\n' for k in range(64)))
        self.refused("features; the bits of a launch hold 64")

    def test_a_buffer_in_an_included_file(self):
        self.append("shared/spring.h", "BUFFER(readonly, uint, extra)\n")
        self.refused("shaders/shared/spring.h declares a buffer; only .comp files do")

    def test_a_declaration_of_another_form(self):
        self.append("apply_forces.comp", "BUFFER(0, readonly, uint, extra)\n")
        self.refused("BUFFER(0, readonly, uint, extra) is not of the form BUFFER(access, type, name)")


if __name__ == "__main__":
    unittest.main()
