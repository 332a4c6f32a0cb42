#!/usr/bin/env python3
"""Checks the unit, the user and the settings of deploy/systemd, without root and without a running systemd:
service_test.py BINARY. installation_test.py runs the service."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from facts import ROOT, STOP_S, found, read

BINARY = os.path.abspath(sys.argv.pop())
UNIT = "deploy/systemd/spherule.service"
SETTINGS = ROOT / "deploy/systemd/serve.toml"
MOST_EXPOSED = 2.0  # of 10


def call(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False)


def values(name):
    """The values of a setting of the unit."""
    return re.findall(rf"^{name}=(.*)", read(UNIT), re.MULTILINE)


def value(name):
    (only,) = values(name)
    return only


class Unit(unittest.TestCase):
    def test_systemd_understands_all_of_it(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = Path(folder) / "spherule.service"
            copy.write_text(read(UNIT).replace("/usr/bin/spherule", BINARY), encoding="utf-8")
            done = call("systemd-analyze", "verify", "--man=no", "--recursive-errors=no", copy)
        self.assertEqual((done.returncode, done.stdout + done.stderr), (0, ""))

    def test_it_is_hardened_and_sees_gpus(self):
        done = call("systemd-analyze", "security", "--offline=true", "--no-pager",
                    f"--threshold={MOST_EXPOSED * 10:.0f}", ROOT / UNIT)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(values("DeviceAllow"), ["char-nvidia* rw", "char-drm rw"])
        self.assertEqual(values("PrivateDevices") + values("MemoryDenyWriteExecute") + values("ProcSubset"), [])

    def test_only_codes_restart_it_after_which_a_new_start_may_help(self):
        codes = dict(re.findall(r"constexpr int (exit\w+) = (\d+);", read("server/cli/exit_codes.h")))
        self.assertEqual(value("Restart"), "on-failure")
        never = {codes[name] for name in ("exitInput", "exitNoDevice", "exitRefused", "exitDiverged")}
        self.assertEqual(set(value("RestartPreventExitStatus").split()), never)
        signals = {str(int(codes["exitBySignal"]) + number) for number in (2, 15)}
        self.assertEqual(set(value("SuccessExitStatus").split()), signals)
        # The server does not end with exitDiffers, which is a result of other commands.
        others = {codes[name] for name in ("exitDone", "exitBySignal", "exitDiffers")}
        self.assertEqual(set(codes.values()) - never - others, {codes["exitFault"], codes["exitDeviceLost"]})

    def test_it_has_time_to_end(self):
        self.assertGreater(int(value("TimeoutStopSec").removesuffix("s")), STOP_S)

    def test_its_user_is_made_with_the_groups_of_gpus(self):
        with tempfile.TemporaryDirectory() as folder:
            done = call("systemd-sysusers", "--dry-run", f"--root={folder}", ROOT / "deploy/systemd/sysusers.conf")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"Creating user '{value('User')}'", done.stderr)
        for group in ("render", "video"):
            self.assertRegex(read("deploy/systemd/sysusers.conf"), rf"(?m)^m {value('User')} {group}$")


class Settings(unittest.TestCase):
    def settings(self, text):
        with tempfile.NamedTemporaryFile("w", suffix=".toml", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            done = call(BINARY, "serve", "--config", file.name, "--print-config")
        self.assertEqual(done.returncode, 0, done.stderr)
        return dict(re.findall(r'^([a-z-]+)="?(.*?)"?$', done.stdout, re.MULTILINE))

    def test_the_program_accepts_all_of_them_also_those_that_are_off(self):
        text = SETTINGS.read_text(encoding="utf-8")
        settings = self.settings(text)
        for name, given in re.findall(r'^([a-z-]+) = "?(.*?)"?$', text, re.MULTILINE):
            self.assertEqual(settings[name], given.replace("4GiB", str(4 << 30)))
        for folder in ("recordings", "checkpoints"):
            self.assertEqual(settings[folder].rsplit("/", 1)[0], "/var/lib/" + value("StateDirectory"))
        self.assertEqual(settings["resume"], "true")
        every = self.settings(re.sub(r"^#(?=[a-z-]+ = )", "", text, flags=re.MULTILINE))
        self.assertEqual(every["tls-key"], "/etc/spherule/secrets/key.pem")

    def test_the_unit_names_the_file_and_the_package_makes_the_tokens(self):
        self.assertIn("--config /etc/spherule/serve.toml", value("ExecStart"))
        folder = found("deploy/package/postinst", r"(?m)^secrets=(.*)$")
        for role in ("viewer", "controller"):
            self.assertIn(f'{role}-token-file = "{folder}/{role}-token"', SETTINGS.read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
