#!/usr/bin/env python3
"""glsl_test.py SHADERS GLSLANG: every kernel in SHADERS must be GLSL 4.5 to the reference compiler GLSLANG, with all
features, with none, and with each of its features alone."""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import kernels

COMPILER = sys.argv.pop()
SHADERS = Path(sys.argv.pop())


def variants(lines):
    features = kernels.features_in(lines)
    yield "all features", dict.fromkeys(features, True)
    if features:
        yield "no feature", dict.fromkeys(features, False)
    if len(features) > 1:
        for alone in features:
            yield f"{alone} alone", {name: name == alone for name in features}


def messages(output, prologue, lines):
    """The compiler's messages, with our file and line in place of those of the expanded text."""
    def place(match):
        line = int(match.group(1)) - prologue - 1
        return f"{lines[line][0]}:" if 0 <= line < len(lines) else match.group(0)
    return [re.sub(r"\S+\.comp:(\d+):|0:(\d+):", lambda m: place(re.match(r".*?:?(\d+):$", m.group(0))), text)
            for text in output.splitlines() if "ERROR" in text or "WARNING" in text]


class Glsl(unittest.TestCase):
    def refused(self, kernel, title, features, lines):
        """Returns the compiler's messages, after a line that names the kernel; empty if it accepts the kernel."""
        head = kernels.prologue(features)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / kernel
            path.write_text("\n".join(head + [line for _, line in lines]) + "\n", encoding="utf-8")
            result = subprocess.run([COMPILER, str(path)], capture_output=True, text=True, check=False)
        if result.returncode == 0 and "WARNING" not in result.stdout:
            return []
        return [f"{kernel} ({title}):", *messages(result.stdout + result.stderr, len(head), lines)]

    def test_the_compiler_accepts_every_variant_of_every_kernel(self):
        failures = []
        self.assertTrue(kernels.names(SHADERS))
        for kernel in kernels.names(SHADERS):
            lines = list(kernels.declared(kernels.expand(SHADERS, kernel)))
            for title, features in variants(lines):
                failures += self.refused(kernel, title, features, lines)
        self.assertEqual(failures, [], "\n".join(failures))


if __name__ == "__main__":
    unittest.main()
