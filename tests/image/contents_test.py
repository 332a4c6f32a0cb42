#!/usr/bin/env python3
"""Checks the content of the image: contents_test.py FACTS ROOT. FACTS has image.json, the output of buildah inspect,
and the layers in OCI's format. ROOT is the file system of the image. Started by deploy/verify_image.sh."""
import gzip
import json
import os
import pathlib
import re
import stat
import subprocess
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop())
FACTS = pathlib.Path(sys.argv.pop())
SOFTWARE = FACTS.name == "software"

IMAGE = json.loads((FACTS / "image.json").read_text())["Docker"]
CONFIG = IMAGE["config"]
REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
MEGABYTE = 1_000_000
BUDGET = 120 * MEGABYTE  # on top of the base, for the image without Mesa


def inside(*command):
    return subprocess.run(["chroot", ROOT, *command], capture_output=True, text=True, check=False)


def files():
    """Yields (path in the image, lstat) of all files and folders."""
    for folder, _, names in os.walk(ROOT):
        for name in names:
            path = os.path.join(folder, name)
            yield "/" + os.path.relpath(path, ROOT), os.lstat(path)


def blob(digest):
    return FACTS / "layers" / "blobs" / digest.replace(":", "/")


def layer_sizes():
    """Yields (packed, unpacked) of each layer, the base first."""
    index = json.loads((FACTS / "layers" / "index.json").read_text())
    manifest = json.loads(blob(index["manifests"][0]["digest"]).read_text())
    for layer in manifest["layers"]:
        with gzip.open(blob(layer["digest"])) as file:
            yield layer["size"], sum(len(part) for part in iter(lambda: file.read(MEGABYTE), b""))


def section(name):
    """Returns the packages of a section of deploy/packages.txt."""
    text = (REPOSITORY / "deploy/packages.txt").read_text()
    body = re.search(rf"^# == {name} ==\n(.*?)(?=^# ==|\Z)", text, re.MULTILINE | re.DOTALL)
    return {line.split()[0] for line in body.group(1).splitlines() if line and not line.startswith("#")}


class Contents(unittest.TestCase):
    def test_nobody_becomes_root(self):
        self.assertEqual(CONFIG["User"], "10001:10001")
        said = inside("getent", "passwd", "10001").stdout
        self.assertRegex(said, r"^spherule:x:10001:10001:.*:/usr/sbin/nologin$")
        raised = [path for path, status in files()
                  if stat.S_ISREG(status.st_mode) and status.st_mode & (stat.S_ISUID | stat.S_ISGID)]
        self.assertEqual(raised, [])

    def test_nothing_is_in_it_to_build_or_to_fetch_with(self):
        for program in ("cc", "gcc", "g++", "clang", "ld", "as", "make", "cmake", "ninja", "ccache", "npm", "node", "python3",
                        "git", "curl", "wget", "ssh", "sudo"):
            self.assertNotEqual(inside("sh", "-c", f"command -v {program}").returncode, 0, program)
        self.assertFalse((ROOT / "src").exists())

    def test_nothing_is_left_of_making_it(self):
        for folder in ("tmp", "data", "var/lib/apt/lists", "var/cache/apt/archives/partial", "var/log"):
            left = os.listdir(ROOT / folder) if (ROOT / folder).exists() else []
            self.assertEqual(left, [], folder)
        self.assertEqual(list((ROOT / "var/cache/apt/archives").glob("*.deb")), [])

    def test_the_program_and_egls_loader_have_all_their_libraries(self):
        loader = inside("sh", "-c", "echo /usr/lib/*-linux-gnu/libEGL.so.1").stdout.strip()
        for binary in ("/usr/bin/spherule", loader):
            said = inside("ldd", binary)
            self.assertEqual(said.returncode, 0, said.stderr)
            self.assertNotIn("not found", said.stdout)
        self.assertIn("libGLdispatch.so.0", said.stdout)

    def test_its_packages_are_those_of_the_list(self):
        said = inside("dpkg-query", "--show", "--showformat", "${Package}\n").stdout.split()
        self.assertLessEqual(section("run"), set(said))
        renderers = section("egl") | section("software")
        self.assertEqual(renderers & set(said), renderers if SOFTWARE else set())
        self.assertEqual([package for package in said if package.endswith("-dev")], [])

    def test_it_has_nvidias_vendor_file_and_mesas_only_when_asked_for(self):
        folder = ROOT / "usr/share/glvnd/egl_vendor.d"
        vendors = {file.name: json.loads(file.read_text())["ICD"]["library_path"] for file in folder.iterdir()}
        mesa = {"50_mesa.json": "libEGL_mesa.so.0"} if SOFTWARE else {}
        self.assertEqual(vendors, {"10_nvidia.json": "libEGL_nvidia.so.0", **mesa})
        drivers = [path for path, _ in files() if re.search(r"_dri\.so$|libEGL_mesa|libgallium|libLLVM|libgbm", path)]
        if SOFTWARE:
            self.assertIn("swrast_dri.so", {os.path.basename(path) for path in drivers})
        else:
            self.assertEqual(drivers, [])

    def test_it_says_how_to_run_it(self):
        environment = dict(pair.split("=", 1) for pair in CONFIG["Env"])
        self.assertEqual(set(environment["NVIDIA_DRIVER_CAPABILITIES"].split(",")), {"graphics", "compute", "utility"})
        self.assertNotIn("NVIDIA_VISIBLE_DEVICES", environment)
        self.assertEqual(environment["SPHERULE_LISTEN"], "0.0.0.0:8080")
        self.assertEqual(environment["SPHERULE_RECORDINGS"], "/data")
        self.assertEqual((CONFIG["Entrypoint"], CONFIG["Cmd"]), (["spherule"], ["serve"]))
        self.assertEqual((list(CONFIG["ExposedPorts"]), list(CONFIG["Volumes"])), (["8080/tcp"], ["/data"]))
        self.assertEqual((CONFIG["StopSignal"], CONFIG["WorkingDir"]), ("SIGTERM", "/data"))
        self.assertEqual(CONFIG["Healthcheck"]["Test"], ["CMD", "spherule", "health"])
        data = os.stat(ROOT / "data")
        self.assertEqual((data.st_uid, data.st_gid), (10001, 10001))

    def test_it_is_small(self):
        base, *ours = layer_sizes()
        packed, unpacked = (sum(sizes) for sizes in zip(*ours))
        print(f"size: {unpacked / MEGABYTE:.1f} MB over a base of {base[1] / MEGABYTE:.1f} MB; to download "
              f"{packed / MEGABYTE:.1f} MB over {base[0] / MEGABYTE:.1f} MB")
        if not SOFTWARE:
            self.assertLessEqual(unpacked, BUDGET)


if __name__ == "__main__":
    unittest.main()
