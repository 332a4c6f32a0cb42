#!/usr/bin/env python3
"""Loads scenes of many sizes into a server in control groups of 1 and 4 GiB: memory_limits_test.py BINARY. Each load
runs or is refused, and the system never kills the server. Needs the right to create control groups.
SPHERULE_TEST_MILLIONS="1.5 2" selects sizes (millions of spheres)."""
import json
import os
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

BINARY = sys.argv.pop()
MILLIONS = [float(words) for words in os.environ.get("SPHERULE_TEST_MILLIONS", "0.5 1 1.5 2 3 4 6 8 12 16").split()]
RUNS_FOR = 10  # s
PATIENCE = 240  # s, for an answer


class ControlGroup:
    """A control group with `limit` bytes, of version 1 or 2, inside the group of this process."""

    def __init__(self, limit):
        groups = dict(line.split(":", 2)[1:] for line in Path("/proc/self/cgroup").read_text().splitlines())
        self._first = next((path for names, path in groups.items() if "memory" in names.split(",")), None)
        root = Path("/sys/fs/cgroup/memory" if self._first is not None else "/sys/fs/cgroup")
        path = self._first if self._first is not None else groups[""]
        self.folder = root / path.lstrip("/") / f"spherule-test-{os.getpid()}"
        self.folder.mkdir()
        try:
            if self._first is not None:
                (self.folder / "memory.limit_in_bytes").write_text(str(limit))
            else:
                (self.folder / "memory.max").write_text(str(limit))
                (self.folder / "memory.swap.max").write_text("0")
        except OSError:
            self.remove()
            raise

    def join(self):
        (self.folder / "cgroup.procs").write_text(str(os.getpid()))

    def killed(self):
        """Returns how many processes of the group the system has killed for lack of memory."""
        events = "memory.oom_control" if self._first is not None else "memory.events"
        return int(re.search(r"^oom_kill (\d+)$", (self.folder / events).read_text(), re.MULTILINE)[1])

    def most(self):
        name = "memory.max_usage_in_bytes" if self._first is not None else "memory.peak"
        return int((self.folder / name).read_text()) if (self.folder / name).exists() else 0

    def remove(self):
        end = time.monotonic() + 10
        while True:
            try:
                return self.folder.rmdir()
            except OSError:
                if time.monotonic() > end:
                    raise
                time.sleep(0.1)


def allowed():
    try:
        group = ControlGroup(1 << 30)
    except (OSError, KeyError) as error:
        return f"this machine lets nobody make a control group with a memory limit here: {error}"
    group.remove()
    return None


class Watcher:
    """A viewer that receives frames and discards them, until the server ends."""

    def __init__(self, port):
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=30)
        self._socket.sendall((f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                              "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n"
                              "Sec-WebSocket-Protocol: spherule.v1\r\n\r\n").encode())
        self._socket.recv(4096)
        hello = json.dumps({"hello": {"client": "test", "view": {"rate": 30}}}).encode()
        self._socket.sendall(bytes([0x81, 0x80 | len(hello), 0, 0, 0, 0]) + hello)  # the mask is zero
        self._socket.settimeout(None)
        self.bytes = 0
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        with self._socket:
            while chunk := self._receive():
                self.bytes += len(chunk)

    def _receive(self):
        try:
            return self._socket.recv(1 << 20)
        except OSError:
            return b""


def lattice(millions):
    spacing, spheres = 0.11, int(millions * 1e6)
    side = spacing * (int(round(spheres ** (1 / 3))) + 2)
    box = {"min": [0, 0, 0], "max": [side, side, side]}
    return {"name": f"{millions} M", "bounds": box, "step": 0.01, "quality": {"model": "BALANCED", "substeps": 1},
            "groups": [{"radius": {"constant": 0.05}, "lattice": {**box, "spacing": spacing, "count": spheres}}]}


def status(pid, name):
    return int(re.search(rf"^{name}:\s+(\d+) kB", Path(f"/proc/{pid}/status").read_text(), re.MULTILINE)[1]) >> 10


@unittest.skipIf(reason := allowed(), reason)
class Loads(unittest.TestCase):
    def check(self, limit):
        verdicts = []
        for millions in MILLIONS:
            with self.subTest(GiB=limit >> 30, millions=millions):
                verdicts.append(self.load(limit, millions))
        self.assertIn("runs", verdicts, "the smallest have room")
        self.assertIn("is refused", verdicts, "the largest have none")

    def load(self, limit, millions):
        group = ControlGroup(limit)
        self.addCleanup(lambda: group.folder.exists() and group.remove())
        with tempfile.NamedTemporaryFile("w", suffix=".json") as scene:
            json.dump(lattice(millions), scene)
            scene.flush()
            server = subprocess.Popen([BINARY, "serve", "box-4k", "--device", "cpu", "--listen", "127.0.0.1:0",
                                       "--watchdog", "0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                      preexec_fn=group.join)
            try:
                port = next(int(found[1]) for line in server.stdout
                            if (found := re.search(r"http://127\.0\.0\.1:(\d+)", line)))
                watcher = Watcher(port)
                done = subprocess.run([BINARY, "ctl", "--timeout", str(PATIENCE), f"ws://127.0.0.1:{port}/ws", "load",
                                       scene.name], capture_output=True, text=True, timeout=2 * PATIENCE, check=False)
                time.sleep(RUNS_FOR)
                self.assertIsNone(server.poll(), f"the server has ended; {done.stdout}{done.stderr}")
                self.assertEqual(group.killed(), 0)
                verdict = "runs" if done.returncode == 0 else "is refused"
                print(f"{limit >> 30} GiB, {millions} M spheres: {verdict}; the server held at most "
                      f"{status(server.pid, 'VmHWM')} MiB, its group {group.most() >> 20} MiB; the viewer got "
                      f"{watcher.bytes >> 10} KiB. {'' if verdict == 'runs' else (done.stdout + done.stderr).strip()}",
                      flush=True)
                if verdict == "is refused":
                    self.assertIn("of memory are needed", done.stdout + done.stderr)
                return verdict
            finally:
                server.kill()
                server.communicate()
                group.remove()

    def test_in_1_gib(self):
        self.check(1 << 30)

    def test_in_4_gib(self):
        self.check(4 << 30)


if __name__ == "__main__":
    unittest.main()
