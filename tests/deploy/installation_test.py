#!/usr/bin/env python3
"""installation_test.py BUILD BASE: installs the Debian package in a bare Debian, runs its service there under systemd,
upgrades, removes and purges it. BASE is the tar file of the bare Debian, which is made if it is missing
(tests/image/make_base.sh). Needs root, and the right to make namespaces with control groups."""
import json
import os
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import packing
from booted import Booted
from debian_root import DebianRoot, make_base, obstacle
from program import wait_for

BASE = Path(sys.argv.pop())
BUILD = sys.argv.pop()
SETTINGS = "etc/spherule/serve.toml"
SECRETS = "etc/spherule/secrets"
STATE = ("var/lib/spherule", "var/cache/spherule")
# The package manager and systemd write here for themselves.
OTHERS = re.compile(r"/(dev|proc|sys|run|tmp|root)/|/var/(log|cache/(apt|debconf|ldconfig)|lib/(apt|dpkg|private))/|"
                    r"/var/lib/systemd/(?!deb-systemd-helper)|/etc/(machine-id|(passwd|group|shadow|gshadow)-)$")


def files(root):
    """The paths of all files and folders of the root, except those that others write."""
    found = set()
    for folder, folders, names in os.walk(root.path):
        found |= {"/" + os.path.relpath(os.path.join(folder, name), root.path) for name in folders + names}
    return {path for path in found if not OTHERS.search(path)}


@unittest.skipIf(reason := obstacle(), reason)
class Installation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """Makes the package, and a root that already has the packages on which it depends."""
        make_base(BASE)
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.package = packing.make(BUILD, cls.folder)
        cls.prepared = DebianRoot(BASE)
        cls.addClassCleanup(cls.prepared.close)
        # The base leaves documentation out. systemd-sysv, python3 and others are not needed.
        (cls.prepared.path / "etc/dpkg/dpkg.cfg.d/image").unlink()
        for command in (("apt-get", "update"), ("apt-get", "satisfy", "-y", "--no-install-recommends",
                                                packing.field(cls.package, "Depends"))):
            done = cls.prepared.call(*command)
            assert done.returncode == 0, done.stdout + done.stderr

    def setUp(self):
        self.root = DebianRoot(self.prepared.path)
        self.addCleanup(self.root.close)

    def install(self):
        shutil.copy(self.package, self.root.path / "opt/spherule.deb")
        self.done(self.root.call("apt-get", "install", "-y", "--no-install-recommends", "/opt/spherule.deb"))
        (self.root.path / "opt/spherule.deb").unlink()

    def done(self, process):
        self.assertEqual(process.returncode, 0, process.stdout + process.stderr)
        return process.stdout

    def boot(self):
        booted = Booted(self.root)
        self.enterContext(booted)
        return booted

    def until_ready(self, booted):
        if not wait_for(lambda: booted.get("/readyz")[0] == 200):
            self.fail(booted.log("spherule"))

    def change_settings(self, *pairs):
        path = self.root.path / SETTINGS
        text = path.read_text(encoding="utf-8")
        for old, new in pairs:
            self.assertIn(old, text)
            text = text.replace(old, new)
        path.write_text(text, encoding="utf-8")

    def override(self, *lines):
        """Adds settings of the unit, as `systemctl edit` does."""
        folder = self.root.path / "etc/systemd/system/spherule.service.d"
        folder.mkdir(exist_ok=True)
        (folder / "override.conf").write_text("[Service]\n" + "\n".join(lines) + "\n", encoding="utf-8")

    def control(self, booted, token, *words):
        return booted.call("env", f"SPHERULE_TOKEN={token}", "spherule", "ctl", "ws://127.0.0.1:8080/ws", *words)

    def token(self, role):
        return (self.root.path / SECRETS / f"{role}-token").read_text(encoding="ascii")

    def test_it_makes_the_user_and_two_tokens_that_only_the_service_reads(self):
        self.install()
        self.assertEqual(self.done(self.root.call("dpkg", "--verify", "spherule")), "")
        user = self.done(self.root.call("getent", "passwd", "spherule"))
        self.assertRegex(user, r"^spherule:[^:]*:\d+:\d+:[^:]*:/var/lib/spherule:/usr/sbin/nologin\n$")
        self.assertEqual(set(self.done(self.root.call("id", "-Gn", "spherule")).split()), {"spherule", "video", "render"})
        modes = self.done(self.root.call("stat", "-c", "%a %U:%G %n", *(f"/{SECRETS}{name}" for name in
                                                                         ("", "/viewer-token", "/controller-token"))))
        self.assertEqual(re.findall(r"^(\S+ \S+) ", modes, re.MULTILINE),
                         ["750 root:spherule", "640 root:spherule", "640 root:spherule"])
        tokens = {self.token("viewer"), self.token("controller")}
        self.assertEqual({len(token) for token in tokens}, {64})
        self.assertEqual(len(tokens), 2)
        for page in ("man1/spherule.1.gz", "man1/spherule-serve.1.gz"):
            self.assertTrue((self.root.path / "usr/share/man" / page).is_file(), page)

    def test_the_command_of_the_unit_starts_as_its_user_without_systemd(self):
        self.install()
        unit = (self.root.path / "lib/systemd/system/spherule.service").read_text(encoding="utf-8")
        command = re.search(r"^ExecStart=(.*)", unit, re.MULTILINE).group(1)
        self.done(self.root.call("install", "-d", "-o", "spherule", *(f"/{folder}" for folder in STATE)))
        script = f"""cd /var/lib/spherule
            setpriv --reuid spherule --regid spherule --init-groups --no-new-privs --bounding-set -all {command} &
            for attempt in $(seq 600); do spherule health && break; sleep 0.1; done
            kill $!; wait $!"""
        said = self.done(self.root.call("sh", "-c", script))
        self.assertEqual(json.loads(re.findall(r"^\{.*\}$", said, re.MULTILINE)[-1])["device"], "cpu", said)

    def test_the_service_runs_after_a_boot_without_rights(self):
        self.install()
        booted = self.boot()
        self.until_ready(booted)
        self.assertEqual(booted.get("/healthz"), (200, "alive\n"))
        self.assertEqual(json.loads(booted.get("/readyz")[1])["device"], "cpu")
        self.assertEqual(booted.get("/metrics")[0], 401)
        self.assertEqual(booted.show("spherule", "User"), "spherule")
        process = booted.show("spherule", "MainPID")
        status = self.done(booted.call("cat", f"/proc/{process}/status"))
        user = self.done(booted.call("id", "-u", "spherule")).strip()
        self.assertRegex(status, rf"(?m)^Uid:\s+{user}\s+{user}\s+{user}\s+{user}$")
        self.assertEqual(set(re.findall(r"(?m)^Cap\w+:\s+(\w+)$", status)), {"0" * 16})
        self.assertRegex(status, r"(?m)^NoNewPrivs:\s+1$")
        self.assertRegex(status, r"(?m)^Seccomp:\s+2$")
        for words in (["record"], ["record", "stop"]):
            self.done(self.control(booted, self.token("controller"), *words))
        recordings = list((self.root.path / "var/lib/spherule/recordings").glob("*.sph"))
        self.assertEqual(len(recordings), 1)
        mounts = self.done(booted.call("cat", f"/proc/{process}/mounts"))
        self.assertRegex(mounts, r"(?m)^\S+ / \S+ ro\b")
        self.done(booted.call("systemctl", "stop", "spherule"))
        self.assertEqual(booted.show("spherule", "Result"), "success", booted.log("spherule"))

    def test_mesa_compiles_shaders_in_it(self):
        self.install()
        self.root.install("libegl1", "libegl-mesa0", "libgl1-mesa-dri")
        self.change_settings(('device = "auto"', 'device = "software"'), ('scene = "rapids"', 'scene = "box-4k"'))
        booted = self.boot()
        self.until_ready(booted)
        self.assertIn("llvmpipe", booted.log("spherule"))
        self.assertNotEqual(list((self.root.path / "var/cache/spherule").rglob("*")), [])

    def test_a_reload_changes_the_tokens_and_nothing_else(self):
        self.install()
        booted = self.boot()
        self.until_ready(booted)
        before = self.token("controller"), booted.show("spherule", "MainPID")
        self.done(self.control(booted, before[0], "pause"))
        (self.root.path / SECRETS / "controller-token").write_text("another-token-of-the-test\n", encoding="ascii")
        self.done(booted.call("systemctl", "reload", "spherule"))
        self.assertTrue(wait_for(lambda: self.control(booted, "another-token-of-the-test", "resume").returncode == 0, 20))
        self.assertNotEqual(self.control(booted, before[0], "pause").returncode, 0)
        self.assertEqual(booted.show("spherule", "MainPID"), before[1])

    def test_it_goes_on_after_a_restart_and_after_a_crash(self):
        self.install()
        self.override("RestartSec=10ms")
        booted = self.boot()
        self.until_ready(booted)

        def step():
            return json.loads(self.done(self.control(booted, self.token("controller"), "query")))["step"]

        self.assertTrue(wait_for(lambda: int(step()) > 10))
        self.done(self.control(booted, self.token("controller"), "pause"))
        paused = step()
        self.done(booted.call("systemctl", "restart", "spherule"))
        self.until_ready(booted)
        self.assertEqual(step(), paused)
        self.done(booted.call("systemctl", "kill", "--signal", "KILL", "spherule"))
        self.assertTrue(wait_for(lambda: booted.show("spherule", "NRestarts") == "1"))
        self.until_ready(booted)
        self.assertEqual(step(), paused)

    def test_wrong_settings_end_it_with_a_reason(self):
        self.install()
        self.change_settings(('device = "auto"', 'device = "abacus"'))
        self.override("RestartSec=10ms")
        booted = self.boot()
        self.assertTrue(wait_for(lambda: booted.show("spherule", "ActiveState") == "failed", 20))
        self.assertEqual((booted.show("spherule", "ExecMainStatus"), booted.show("spherule", "NRestarts")), ("2", "0"))
        self.assertIn("--device", booted.log("spherule"))

    def test_systemd_starts_it_again_after_a_fault_and_a_lost_device_only(self):
        self.install()
        booted = self.boot()
        for code, restarts in ((0, 0), (1, 10), (2, 0), (3, 0), (4, 0), (5, 0), (75, 10), (130, 0), (143, 0)):
            self.override("RestartSec=10ms", "ExecStart=", f"ExecStart=/bin/sh -c 'exit {code}'")
            for command in ("daemon-reload", "stop spherule", "reset-failed spherule", "start spherule"):
                booted.call("systemctl", *command.split())
            self.assertTrue(wait_for(lambda: booted.show("spherule", "ActiveState") in ("failed", "inactive"), 20))
            self.assertEqual(booted.show("spherule", "NRestarts"), str(restarts), code)

    def test_an_upgrade_keeps_changed_settings_and_restarts_the_service(self):
        self.install()
        self.change_settings(('scene = "rapids"', 'scene = "bounce"'))
        booted = self.boot()
        self.until_ready(booted)
        before = booted.show("spherule", "MainPID"), self.token("viewer")
        upgrade = packing.next_version(self.package, self.folder / "next", lambda text: text + "\n# Newer.\n")
        shutil.copy(upgrade, self.root.path / "opt/next.deb")
        self.done(booted.call("dpkg", "--force-confdef", "--force-confold", "--install", "/opt/next.deb"))
        self.until_ready(booted)
        self.assertNotEqual(booted.show("spherule", "MainPID"), before[0])
        self.assertEqual(self.token("viewer"), before[1])
        settings = (self.root.path / SETTINGS).read_text(encoding="utf-8")
        self.assertIn('scene = "bounce"', settings)
        self.assertNotIn("Newer", settings)
        self.assertTrue((self.root.path / (SETTINGS + ".dpkg-dist")).is_file())

    def test_a_removal_keeps_settings_and_state_and_a_purge_only_the_user(self):
        before = files(self.root)
        self.install()
        booted = self.boot()
        self.until_ready(booted)
        self.done(booted.call("dpkg", "--remove", "spherule"))
        self.assertEqual(booted.get("/healthz")[0], 0)
        self.assertEqual(booted.show("spherule", "ActiveState"), "inactive")
        kept = files(self.root) - before
        for path in (SETTINGS, f"{SECRETS}/viewer-token", *STATE):
            self.assertIn("/" + path, kept)
        self.assertEqual([path for path in kept if path.startswith(("/usr", "/lib/"))], [])
        self.done(booted.call("dpkg", "--purge", "spherule"))
        self.assertEqual(files(self.root) ^ before, set())
        self.assertIn("spherule", self.done(self.root.call("getent", "passwd", "spherule")))


if __name__ == "__main__":
    unittest.main()
