#!/usr/bin/env python3
"""gpu_day_roots_test.py BUILD STUB BASE: a bundle of tests/gpu_day.sh with the programs of BUILD, in a bare Debian with
Mesa and in one without, both without this repository. BASE is the tar file of the bare Debian, which is made if it is
missing (tests/image/make_base.sh). Needs root. STUB is the EGL library of stub_driver.c."""
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import bundles
from debian_root import DebianRoot, make_base, obstacle

BASE = Path(sys.argv.pop())
STUB = Path(sys.argv.pop())
BUILD = sys.argv.pop()
VENDOR = '{"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_nvidia.so.0"}}'


class Root(DebianRoot):
    """A bare Debian with a bundle in /opt/bundle."""
    def __init__(self, bundle):
        super().__init__(BASE)
        shutil.copytree(bundle, self.path / "opt/bundle")

    def run_bundle(self, name, *options):
        """Returns the process and the folder of the results."""
        done = self.call("/opt/bundle/gpu_day.sh", "run", "/opt/bundle", f"/opt/{name}", *options)
        return done, self.path / "opt" / name


@unittest.skipIf(reason := obstacle(), reason)
class Roots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        make_base(BASE)
        cls.bundle = tempfile.TemporaryDirectory()
        bundles.make(cls.bundle.name, BUILD)

    @classmethod
    def tearDownClass(cls):
        cls.bundle.cleanup()

    def setUp(self):
        self.root = Root(self.bundle.name)
        self.addCleanup(self.root.close)

    def test_with_mesa_everything_passes_on_software(self):
        self.root.install("libegl1", "libegl-mesa0", "libgl1-mesa-dri")
        done, out = self.root.run_bundle("out", "--device", "software", "--quick")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr + bundles.contents(out))
        bundles.check_files(out)
        self.assertEqual({row[1] for row in bundles.outcomes(out)}, {"done"})

    def test_without_mesa_the_driver_is_found_and_each_part_fails_as_documented(self):
        for path, bytes_of in (("usr/local/nvidia/lib64/libEGL_nvidia.so.0", STUB.read_bytes()),
                               ("usr/local/nvidia/share/glvnd/egl_vendor.d/10_nvidia.json", VENDOR.encode())):
            file = self.root.path / path
            file.parent.mkdir(parents=True)
            file.write_bytes(bytes_of)
        self.assertEqual(list(self.root.path.glob("usr/lib/*/libEGL*")), [])
        for part in bundles.PARTS:
            with self.subTest(part):
                done, out = self.root.run_bundle(part, "--quick", "--only", part)
                self.assertEqual(done.returncode, 1, done.stdout + done.stderr + bundles.contents(out))
                self.assertNotIn("not found", done.stderr)
                bundles.check_files(out)
                for what, outcome, _ in bundles.outcomes(out):
                    self.assertRegex(outcome, r"^FAILED with exit code [13]$", what)
        probe = (self.root.path / "opt/probe/probe.txt").read_text("utf-8")
        self.assertIn("10_nvidia.json  libEGL_nvidia.so.0  opens", probe)
        self.assertTrue(re.search(r"gpu:0 +cannot be used: .*EGL_BAD_ACCESS", probe), probe)


if __name__ == "__main__":
    unittest.main()
