#!/usr/bin/env python3
"""gpu_day_test.py BUILD STUB: tests/gpu_day.sh with the programs of BUILD. STUB is the EGL library of stub_driver.c."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import bundles
from program import FolderTestCase

STUB = Path(sys.argv.pop())
BUILD = sys.argv.pop()
LAUNCHER = Path(__file__).resolve().parent / "with_libraries"
SHOW = """#!/bin/sh
echo "vendors=${__EGL_VENDOR_LIBRARY_FILENAMES-unset}"
echo "path=$LD_LIBRARY_PATH"
"""


class Launcher(FolderTestCase):
    """with_libraries in a bundle whose only program prints its environment, on a host below a folder."""
    def setUp(self):
        super().setUp()
        self.host, self.bundle = Path(self.folder) / "host", Path(self.folder) / "bundle"
        for name in ("bin", "lib", "lib-cxx", "lib-glvnd"):
            (self.bundle / name).mkdir(parents=True)
        shutil.copy(LAUNCHER, self.bundle)
        (self.bundle / "lib-cxx/libstdc++.so.6").write_text("GLIBCXX_3.4.30\n", "utf-8")
        (self.bundle / "bin/show").write_text(SHOW, "utf-8")
        (self.bundle / "bin/show").chmod(0o755)

    def put(self, path):
        """A file of the host. Returns its full path."""
        file = self.host / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("GLIBCXX_3.4.29\n", "utf-8")
        return str(file)

    def shown(self, **variables):
        """The vendor files and the folders of libraries that programs get."""
        clean = {name: value for name, value in os.environ.items()
                 if name != "LD_LIBRARY_PATH" and not name.startswith("__EGL")}
        done = subprocess.run([self.bundle / "with_libraries", "show"], capture_output=True, text=True, check=True,
                              env=clean | {"SPHERULE_HOST_ROOT": str(self.host)} | variables)
        self.assertEqual(done.stderr, "")
        vendors, path = (line.split("=", 1)[1] for line in done.stdout.splitlines())
        return vendors, [folder.removeprefix(f"{self.bundle}/") for folder in path.split(":")]

    def test_without_a_driver_the_libraries_of_the_bundle_are_used(self):
        self.assertEqual(self.shown(), ("unset", ["lib", "lib-cxx", "lib-glvnd"]))

    def test_a_driver_below_usr_local_is_found_with_its_vendor_file(self):
        library = self.put("usr/local/nvidia/lib64/libEGL_nvidia.so.0")
        vendor = self.put("usr/local/nvidia/share/glvnd/egl_vendor.d/10_nvidia.json")
        self.assertEqual(self.shown(), (vendor, ["lib", "lib-cxx", "lib-glvnd", str(Path(library).parent)]))

    def test_a_driver_without_a_vendor_file_gets_one(self):
        self.put("usr/local/nvidia/lib64/libEGL_nvidia.so.0")
        self.assertEqual(self.shown()[0], str(self.bundle / "lib-glvnd/nvidia.json"))

    def test_mesas_vendor_file_stays_beside_the_drivers(self):
        self.put("usr/local/nvidia/lib64/libEGL_nvidia.so.0")
        vendor = self.put("usr/local/nvidia/share/glvnd/egl_vendor.d/10_nvidia.json")
        mesa = self.put("usr/share/glvnd/egl_vendor.d/50_mesa.json")
        self.assertEqual(self.shown()[0], f"{vendor}:{mesa}")

    def test_a_driver_of_the_variable_is_found(self):
        folder = str(Path(self.put("opt/driver/libEGL_nvidia.so.0")).parent)
        self.put("opt/driver/libEGL.so.1")
        vendors, path = self.shown(LD_LIBRARY_PATH=folder)
        self.assertEqual(vendors, str(self.bundle / "lib-glvnd/nvidia.json"))
        self.assertEqual(path, ["lib", "lib-cxx", folder])

    def test_a_newer_library_of_the_host_is_used(self):
        folder = Path(self.put("opt/newer/libstdc++.so.6")).parent
        (folder / "libstdc++.so.6").write_text("GLIBCXX_3.4.33\n", "utf-8")
        self.assertNotIn("lib-cxx", self.shown(LD_LIBRARY_PATH=str(folder))[1])

    def test_vendor_files_that_egl_finds_or_the_user_names_are_left_alone(self):
        self.put("usr/local/nvidia/lib64/libEGL_nvidia.so.0")
        self.put("usr/local/nvidia/share/glvnd/egl_vendor.d/10_nvidia.json")
        self.assertEqual(self.shown(__EGL_VENDOR_LIBRARY_FILENAMES="/mine.json")[0], "/mine.json")
        self.put("usr/share/glvnd/egl_vendor.d/10_nvidia.json")
        self.assertEqual(self.shown()[0], "unset")


class Script(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        made, cls.bundle = Path(cls.folder.name) / "made", Path(cls.folder.name) / "moved"
        bundles.make(made, BUILD)
        made.rename(cls.bundle)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_bundle(self, out, *options, **variables):
        return subprocess.run([self.bundle / "gpu_day.sh", "run", self.bundle, out, *options], capture_output=True,
                              text=True, check=False, env=os.environ | variables)

    def test_wrong_options_are_refused(self):
        out = Path(self.folder.name) / "unused"
        for options, message in ((("--only", "bench"), "--only bench: is no part; the parts are probe launches "),
                                 (("--only",), "--only needs a value"),
                                 (("--limit", "soon"), "--limit soon: is no number of seconds"),
                                 (("--fast",), "unknown option --fast")):
            done = self.run_bundle(out, *options)
            self.assertEqual(done.returncode, 2, options)
            self.assertIn(message, done.stderr)
        done = subprocess.run([bundles.SCRIPT, "run", self.folder.name, out], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("is no bundle", done.stderr)

    def test_the_help_names_every_part(self):
        done = subprocess.run([bundles.SCRIPT, "--help"], capture_output=True, text=True, check=True)
        for part in bundles.PARTS:
            self.assertIn(f"\n  {part} ", done.stdout)

    def test_parts_pass_in_a_moved_folder_in_the_order_of_the_options(self):
        out = Path(self.folder.name) / "software"
        parts = ("probe", "launches", "compile", "codec", "serve", "runs", "tests")
        done = self.run_bundle(out, "--device", "software", "--quick", *(x for part in parts for x in ("--only", part)))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr + bundles.contents(out))
        bundles.check_files(out)
        titles = [row[0] for row in bundles.outcomes(out)]
        self.assertEqual(titles[0], "probe")
        self.assertEqual(titles[-1], "gpu_device")
        self.assertRegex(bundles.outcomes(out)[-1][2], r"`tests.txt`, \d\d passed")
        self.assertIn("us", (out / "launches.txt").read_text("utf-8"))
        self.assertRegex((out / "launches.txt").read_text("utf-8"), r"\d s  list_order.comp\n")
        self.assertRegex((out / "serve.txt").read_text("utf-8"), r"\d+ steps in 1 s; device time: \d")

    def test_a_driver_that_refuses_its_device_fails_the_run(self):
        out, host = Path(self.folder.name) / "refused", Path(self.folder.name) / "host"
        library = host / "usr/local/nvidia/lib64/libEGL_nvidia.so.0"
        library.parent.mkdir(parents=True)
        shutil.copy(STUB, library)
        done = self.run_bundle(out, "--only", "probe", "--only", "runs", "--only", "serve",
                               SPHERULE_HOST_ROOT=str(host))
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        bundles.check_files(out)
        probe = (out / "probe.txt").read_text("utf-8")
        self.assertIn("libEGL_nvidia.so.0  opens", probe)
        self.assertRegex(probe, r"gpu:0 +cannot be used: .*EGL_BAD_ACCESS")
        self.assertEqual({row[1] for row in bundles.outcomes(out) if row[0] != "nvidia-smi"},
                         {"FAILED with exit code 3"})


if __name__ == "__main__":
    unittest.main()
