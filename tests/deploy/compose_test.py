#!/usr/bin/env python3
"""Checks deploy/compose.yaml: Docker Compose accepts it, it agrees with the Dockerfile, and the container has no
unnecessary rights."""
import os
import re
import subprocess
import unittest

import yaml

from facts import ROOT, STOP_S, VERSION, Dockerfile


class Compose(unittest.TestCase):
    def setUp(self):
        done = subprocess.run(
            ["docker-compose", "-f", str(ROOT / "deploy/compose.yaml"), "--profile", "gpu", "--profile", "cpu", "config"],
            capture_output=True, text=True, check=False, env={**os.environ, "PYTHONWARNINGS": "ignore"})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.made = yaml.safe_load(done.stdout)
        self.image = Dockerfile()

    def services(self):
        return self.made["services"].values()

    def test_there_is_one_with_a_gpu_and_one_without(self):
        services = self.made["services"]
        self.assertEqual({name: service["profiles"] for name, service in services.items()}, {"gpu": ["gpu"], "cpu": ["cpu"]})
        (gpu,) = services["gpu"]["deploy"]["resources"]["reservations"]["devices"]
        self.assertEqual(gpu, {"driver": "nvidia", "count": 1, "capabilities": ["gpu"]})
        self.assertNotIn("deploy", services["cpu"])
        devices = {name: service["environment"]["SPHERULE_DEVICE"] for name, service in services.items()}
        self.assertEqual(devices, {"gpu": "gpu", "cpu": "cpu"})

    def test_it_builds_our_image(self):
        for service in self.services():
            self.assertEqual(service["image"], f"spherule:{VERSION}")
            self.assertEqual(service["build"], {"context": str(ROOT), "dockerfile": "deploy/Dockerfile"})

    def test_it_may_do_nothing_that_it_need_not(self):
        for service in self.services():
            self.assertIs(service["read_only"], True)
            self.assertEqual(service["cap_drop"], ["ALL"])
            self.assertEqual(service["security_opt"], ["no-new-privileges:true"])
            self.assertIn("mem_limit", service)
            self.assertFalse({"privileged", "cap_add", "user", "network_mode", "pid"} & set(service))

    def test_only_this_machine_reaches_it_where_the_image_listens(self):
        for service in self.services():
            self.assertEqual(service["ports"], [f"127.0.0.1:8080:{self.image.port}/tcp"])

    def test_it_has_the_folders_that_it_writes_and_the_tokens(self):
        for service in self.services():
            self.assertEqual(service["volumes"], [f"recordings:{self.image.volume}:rw"])
            self.assertTrue(service["tmpfs"][0].startswith(self.image.environment["XDG_CACHE_HOME"] + ":"))
            secrets = {"/run/secrets/" + secret["source"] for secret in service["secrets"]}
            files = {service["environment"][f"SPHERULE_{role}_TOKEN_FILE"] for role in ("VIEWER", "CONTROLLER")}
            self.assertEqual(files, secrets)
            self.assertLessEqual({secret["source"] for secret in service["secrets"]}, set(self.made["secrets"]))

    def test_it_has_time_to_end(self):
        for service in self.services():
            seconds = int(re.fullmatch(r"(\d+)s", service["stop_grace_period"]).group(1))
            self.assertIn("SPHERULE_CHECKPOINTS", service["environment"])
            self.assertGreater(seconds, STOP_S)


if __name__ == "__main__":
    unittest.main()
