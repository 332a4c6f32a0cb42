#!/usr/bin/env python3
"""Tests the program without the libraries or files that a device needs: no_device_test.py BINARY."""
import json
import os
import sys
import tempfile
import unittest

from program import runner

BINARY = sys.argv.pop()


call = runner(BINARY, timeout=60)


class NoDevice(unittest.TestCase):
    def hints(self, *arguments, **more):
        done = call("probe", "--json", *arguments, **more)
        found = json.loads(done.stdout)
        for hint in found["hints"]:
            self.assertIn(f"  {hint}\n", call("probe", *arguments, **more).stdout)
        return done.returncode, found

    def test_a_gpu_that_is_not_there_ends_with_3_and_what_to_do(self):
        for command in ["run", "bounce", "--for", "1s"], ["serve", "bounce", "--listen", "127.0.0.1:0"]:
            done = call(*command, "--device", "gpu:99")
            self.assertEqual(done.returncode, 3)
            self.assertRegex(done.stderr, r"^spherule: gpu:99: no GPU here computes with OpenGL 4.5.* or use --device cpu\n$")

    def test_without_egl_it_runs_on_the_cpu_and_says_what_to_install(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in "libEGL.so.1", "libEGL.so":  # empty, and found first
                with open(os.path.join(folder, name), "w", encoding="utf-8"):
                    pass
            missing = {"LD_LIBRARY_PATH": folder}
            done = call("run", "bounce", "--for", "0.1s", "--json", **missing)
            self.assertEqual((done.returncode, json.loads(done.stdout)["device"]), (0, "cpu"))
            done = call("run", "bounce", "--for", "0.1s", "--device", "gpu", **missing)
            self.assertEqual(done.returncode, 3)
            self.assertRegex(done.stderr, r"^spherule: libEGL.so.1: cannot be opened; install it \(on Debian: apt install "
                                          r"libegl1\)\n$")
            code, found = self.hints(**missing)
            self.assertEqual((code, found["chosen"]["kind"]), (0, "cpu"))
            self.assertRegex(found["hints"][0], "^There is no EGL on this host")
            self.assertEqual(self.hints("--device", "gpu", **missing)[0], 3)

    def test_without_vendor_files_there_is_no_software_renderer(self):
        with tempfile.TemporaryDirectory() as folder:
            missing = {"__EGL_VENDOR_LIBRARY_DIRS": folder}
            done = call("run", "bounce", "--for", "0.1s", "--device", "software", **missing)
            self.assertEqual(done.returncode, 3)
            self.assertRegex(done.stderr, r"^spherule: software: no software renderer.*apt install libegl-mesa0 libgl1-mesa-dri"
                                          r"\)\n$")
            code, found = self.hints("--device", "software", **missing)
            self.assertEqual((code, found["chosen"], found["vendors"]), (3, None, []))
            self.assertRegex(found["hints"][-1], "^Mesa's software renderer is not here")

    def test_vendors_that_do_not_open_are_listed_with_the_reason(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "10_gone.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump({"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_gone.so.0"}}, file)
            _, found = self.hints(__EGL_VENDOR_LIBRARY_FILENAMES=path)
            self.assertEqual([(one["library"], one["problem"].split(":")[0]) for one in found["vendors"]],
                             [("libEGL_gone.so.0", "libEGL_gone.so.0")])
            self.assertEqual(found["chosen"]["kind"], "cpu")


if __name__ == "__main__":
    unittest.main()
