#!/usr/bin/env python3
"""Tests running containers of the image: running_test.py FACTS ROOT, as root in its own mount and network namespaces.
FACTS has image.json, the output of buildah inspect. ROOT is the file system of the image. Started by
deploy/verify_image.sh."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.request

from container import Container, without_control_groups

ROOT = sys.argv.pop()
FACTS = pathlib.Path(sys.argv.pop())
SOFTWARE = FACTS.name == "software"

CONFIG = json.loads((FACTS / "image.json").read_text())["Docker"]["config"]
RELEASE = pathlib.Path(__file__).resolve().parents[2] / "build/release"
GRACE = 20  # s within which the server must end; orchestrators wait 30 s
ADDRESS = "127.0.0.1:8080"

# A server that listens beyond loopback without tokens needs SPHERULE_OPEN.
OPEN = {"SPHERULE_OPEN": "true", "SPHERULE_DEVICE": "cpu"}


def get(path):
    try:
        with urllib.request.urlopen(f"http://{ADDRESS}{path}", timeout=10) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()
    except OSError:
        return None, ""


def call(program, *arguments):
    return subprocess.run([RELEASE / program, *arguments], capture_output=True, text=True, timeout=120, check=False)


class Running(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.data = folder.name
        os.chown(self.data, 10001, 10001)

    def start(self, arguments=None, settings=None):
        container = Container(CONFIG, ROOT, self.data, arguments, settings).start()
        self.addCleanup(container.remove)
        return container

    def until_ready(self, container):
        end = time.monotonic() + 60
        while get("/readyz")[0] != 200:
            self.assertIsNone(container.code(), container.said())
            self.assertLess(time.monotonic(), end, container.said())
            time.sleep(0.1)

    def ends(self, container):
        """Sends SIGTERM to the first process of the container; returns the time until its end (s)."""
        begun = time.monotonic()
        container.signal(signal.SIGTERM)
        self.assertEqual(container.wait(GRACE), 0, container.said())
        return time.monotonic() - begun

    def test_it_serves_a_world_to_viewers_and_ends_well(self):
        container = self.start(settings=OPEN)
        self.until_ready(container)
        self.assertEqual(get("/healthz"), (200, "alive\n"))
        self.assertEqual(json.loads(get("/readyz")[1])["device"], "cpu")
        self.assertRegex(get("/metrics")[1], r"(?m)^spherule_\w+ ")
        self.assertIn("<title>", get("/")[1])
        watched = call("spherule_load", f"ws://{ADDRESS}/ws", "--viewers", "3", "--decode", "1", "--warm-up", "2",
                       "--seconds", "3", "--markdown")
        self.assertEqual(watched.returncode, 0, watched.stdout + watched.stderr)
        frames = int(re.search(r"joins \| frames.*\n.*\n\| healthy \| \d+ \| (\d+) \|", watched.stdout).group(1))
        self.assertGreater(frames, 0)
        print(f"running: {frames} frames to 3 viewers, end {self.ends(container):.1f} s after SIGTERM")

    def test_its_health_check_tells_a_server_from_none(self):
        check = CONFIG["Healthcheck"]["Test"]
        self.assertEqual(check[0], "CMD")
        container = self.start(settings=OPEN)
        self.until_ready(container)
        asked = container.execute(*check[1:])
        self.assertEqual(asked.returncode, 0, asked.stdout + asked.stderr)
        self.ends(container)
        alone = self.start(arguments=check[2:])
        self.assertNotEqual(alone.wait(30), 0)

    def test_it_records_in_its_volume_and_nowhere_else(self):
        container = self.start(settings=OPEN)
        self.until_ready(container)
        for words in (["record"], ["record", "stop"]):
            done = call("spherule", "ctl", f"ws://{ADDRESS}/ws", *words)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        recordings = [path for path in pathlib.Path(self.data).rglob("*.sph")]
        self.assertEqual([os.stat(path).st_uid for path in recordings], [10001])
        self.assertNotEqual(container.execute("touch", "/usr/bin/other").returncode, 0)
        self.assertEqual(container.execute("touch", "/tmp/other").returncode, 0)
        self.ends(container)

    def test_it_has_no_rights(self):
        container = self.start(settings=OPEN)
        self.until_ready(container)
        said = container.execute("cat", "/proc/1/status").stdout
        self.assertRegex(said, r"(?m)^Uid:\s+10001\s+10001\s+10001\s+10001$")
        self.assertEqual(set(re.findall(r"(?m)^Cap\w+:\s+(\w+)$", said)), {"0" * 16})
        self.assertRegex(said, r"(?m)^NoNewPrivs:\s+1$")
        self.assertRegex(said, r"(?m)^Seccomp:\s+2$")
        self.ends(container)

    def test_strangers_are_not_let_in_by_default(self):
        container = self.start()
        self.assertNotEqual(container.wait(20), 0)
        self.assertIn("token", container.said())

    def test_it_computes_on_mesa_where_that_is_in_it(self):
        container = self.start(arguments=["run", "two-spheres", "--for", "0.1s", "--device", "software"])
        self.assertEqual(container.wait(120), 0 if SOFTWARE else 3, container.said())
        if SOFTWARE:
            self.assertIn("llvmpipe", container.said())


if __name__ == "__main__":
    without_control_groups()
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    unittest.main()
