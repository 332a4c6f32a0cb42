#!/usr/bin/env python3
"""Checks that the Dockerfile agrees with the program, and packages.txt with the program's libraries:
dockerfile_test.py BINARY. deploy/verify_image.sh checks the image itself."""
import re
import subprocess
import sys
import unittest

from facts import Dockerfile, read

BINARY = sys.argv.pop()

# Packages of every Debian image: apt itself is linked with libgcc_s, libstdc++ and zlib.
EVERYWHERE = {"libc6", "libgcc-s1", "libstdc++6", "zlib1g"}


def section(name):
    body = re.search(rf"^# == {name} ==\n(.*?)(?=^# ==|\Z)", read("deploy/packages.txt"), re.MULTILINE | re.DOTALL)
    return {line.split()[0] for line in body.group(1).splitlines() if line and not line.startswith("#")}


def package_of(library):
    # If /lib is a link to /usr/lib, dpkg may know the file by either path.
    for path in (library, "/usr" + library):
        asked = subprocess.run(["dpkg-query", "--search", path], capture_output=True, text=True, check=False)
        if asked.returncode == 0:
            return asked.stdout.split(":")[0]
    raise AssertionError(f"{library} is of no Debian package")


class Image(unittest.TestCase):
    def setUp(self):
        self.image = Dockerfile()

    def test_it_runs_as_nobody_that_others_know(self):
        self.assertGreater(int(self.image.user), 9999)
        self.assertEqual(self.image.user, self.image.group)

    def test_it_listens_where_it_says_and_records_where_it_may_write(self):
        environment = self.image.environment
        self.assertEqual(environment["SPHERULE_LISTEN"], f"0.0.0.0:{self.image.port}")
        self.assertEqual(environment["SPHERULE_RECORDINGS"], self.image.volume)
        for cache in ("XDG_CACHE_HOME", "__GL_SHADER_DISK_CACHE_PATH"):
            self.assertEqual(environment[cache], "/tmp")

    def test_it_is_told_to_end_as_the_program_expects_and_asked_as_it_can_answer(self):
        self.assertEqual(self.image.only("STOPSIGNAL"), "SIGTERM")
        self.assertEqual(self.image.entrypoint, ["spherule"])
        self.assertEqual(self.image.healthcheck, ["spherule", "health"])


class Packages(unittest.TestCase):
    def test_run_is_what_the_program_is_linked_with(self):
        lines = subprocess.run(["ldd", BINARY], capture_output=True, text=True, check=True).stdout
        self.assertNotIn("not found", lines)
        libraries = set(re.findall(r"(/\S+\.so\S*)", lines))
        linked = {package_of(library) for library in libraries} - EVERYWHERE
        # EGL's loader and vendor libraries are linked with libglvnd0.
        self.assertEqual(linked | {"libglvnd0"}, section("run"))


if __name__ == "__main__":
    unittest.main()
