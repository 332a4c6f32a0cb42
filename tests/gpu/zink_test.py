#!/usr/bin/env python3
"""zink_test.py FORM SPHERULE PROGRAM...: runs tests on a second OpenGL: Mesa's zink, which translates it to Vulkan,
over Mesa's software renderer for Vulkan. The programs are gpu_device, bits_test and, with the FORM `all`,
unit_encode. The FORM `short` runs the tests of SHORT; `all` runs all tests. bits_test and unit_encode compare zink with
the CPU device, on which the physics tests run."""
import glob
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FORM, SPHERULE, *PROGRAMS = sys.argv[1:]
PROGRAMS = {Path(program).name: program for program in PROGRAMS}

SHORT = {
    "gpu_device": ["*"],
    "bits_test": ["*SceneBits*/box_4k", "*.OfAMixtureAreTheSameOnAllDevices/*"],
}


def environment(driver):
    icd = glob.glob("/usr/share/vulkan/icd.d/lvp_icd.*.json")
    assert icd, "no /usr/share/vulkan/icd.d/lvp_icd.*.json; install mesa-vulkan-drivers"
    all_scenes = {} if FORM == "short" else {"SPHERULE_BITS_SECONDS": "0.1"}  # bits_test runs all with this renderer
    return os.environ | all_scenes | {
        "GALLIUM_DRIVER": driver, "LIBGL_ALWAYS_SOFTWARE": "true", "VK_ICD_FILENAMES": icd[0],
        "SPHERULE_TEST_DEVICE": "software", "XDG_RUNTIME_DIR": tempfile.gettempdir()}


def renderer(driver):
    done = subprocess.run([SPHERULE, "probe", "--device", "software", "--json"], capture_output=True, text=True,
                          check=True, timeout=60, env=environment(driver))
    return json.loads(done.stdout)["chosen"]["renderer"]


class Zink(unittest.TestCase):
    def setUp(self):
        self.assertRegex(renderer("zink"), r"^zink \(llvmpipe")

    def test_the_other_renderer_is_not_taken_for_zink(self):
        self.assertRegex(renderer("llvmpipe"), r"^llvmpipe")

    def passes(self, name):
        wanted = SHORT[name] if FORM == "short" else ["*"]
        done = subprocess.run([PROGRAMS[name], f"--gtest_filter={':'.join(wanted)}"],
                              capture_output=True, text=True, check=False, env=environment("zink"))
        text = done.stdout + done.stderr
        passed = re.search(r"^\[  PASSED  \] (\d+) tests?\.$", text, re.M)
        self.assertTrue(done.returncode == 0 and passed, f"exit code {done.returncode}\n{text[-20000:]}")
        print(f"{name}: {passed.group(1)} tests passed on {renderer('zink')}")
        return int(passed.group(1))

    def test_programs_pass(self):
        for name in PROGRAMS:
            with self.subTest(name):
                self.assertGreaterEqual(self.passes(name), len(SHORT.get(name, ["*"])))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
