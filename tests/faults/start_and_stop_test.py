#!/usr/bin/env python3
"""Tests start and end of the server, as clients and supervisors see them: start_and_stop_test.py [CLASS...] BINARY."""
import http.client
import json
import os
import signal
import socket
import subprocess
import sys
import time
import unittest
from contextlib import contextmanager

from faults import HeldThread
from program import FolderTestCase, runner
from serving import Server
from viewer import Viewer, answers

BINARY = sys.argv.pop()
call = runner(BINARY, timeout=60)
SLOW = {"bounds": {"min": [0, 0, 0], "max": [100, 100, 100]},  # takes seconds to build
        "groups": [{"radius": {"constant": 0.1}, "fill": {"count": 2_000_000, "min": [0, 0, 0], "max": [100, 100, 100]}}]}


class Connection:
    """A persistent HTTP connection, as health checks may use."""

    def __init__(self, port):
        self._connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)

    def get(self, path):
        self._connection.request("GET", path)
        answer = self._connection.getresponse()
        return answer.status, answer.read().decode()


def taken_port():
    """Returns a listening socket and its port."""
    taken = socket.create_server(("127.0.0.1", 0))
    return taken, taken.getsockname()[1]


class Program(FolderTestCase):
    def slow_scene(self):
        return self.write("slow.json", json.dumps(SLOW))

    def refused(self, listen, code, pattern, *options):
        # The server checks the port before the scene: otherwise it would report that the scene does not exist.
        done = call("serve", self.at("none.json"), "--device", "cpu", "--listen", listen, *options)
        self.assertEqual(done.returncode, code)
        self.assertRegex(done.stderr, pattern)
        self.assertEqual(done.stdout, "")

    def end_by_a_second_signal(self, pid, port):
        with HeldThread(pid, "simulation", lambda: answers(port)) as held:
            os.kill(pid, signal.SIGTERM)
            time.sleep(0.5)
            self.assertNotEqual(_state(pid), "Z", "the first signal ended it")
            os.kill(pid, signal.SIGTERM)
            held.wait_for_the_end(5)


class Start(Program):
    def test_a_port_that_is_taken_is_noticed_before_the_scene_is_made(self):
        taken, port = taken_port()
        with taken:
            self.refused(f"127.0.0.1:{port}", 4, rf"^spherule: 127.0.0.1:{port}: cannot be listened on: Address already in use; "
                                                 r"end what listens there, or choose another port \(0: any free one\)\n$")

    def test_so_is_an_address_that_is_not_ours(self):
        self.refused("192.0.2.1:8080", 4, r"192.0.2.1:8080: cannot be listened on: Cannot assign requested address; choose an "
                                          r"address of this machine \(0.0.0.0: all of them\)\n$", "--open")
        self.refused("no..such.host:8080", 2, "no..such.host:8080: cannot be listened on: Host not found")

    @contextmanager
    def starting(self):
        """Starts a server that is building its scene; yields it and its port."""
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = free.getsockname()[1]
        with subprocess.Popen([BINARY, "serve", self.slow_scene(), "--device", "cpu", "--listen", f"127.0.0.1:{port}"],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as server:
            try:
                end = time.monotonic() + 30
                while time.monotonic() < end:
                    with socket.socket() as probe:
                        if probe.connect_ex(("127.0.0.1", port)) == 0:
                            break
                    time.sleep(0.01)
                yield server, port
            finally:
                server.kill()

    def test_while_the_scene_is_made_it_is_alive_but_not_ready(self):
        with self.starting() as (server, port):
            connection = Connection(port)
            self.assertEqual(connection.get("/healthz"), (200, "alive\n"))
            status, ready = connection.get("/readyz")
            self.assertEqual((status, json.loads(ready)["state"]), (503, "starting"))
            self.assertEqual(connection.get("/")[0], 200)
            self.assertEqual(Viewer(port).status, 503)
            end = time.monotonic() + 120
            while connection.get("/readyz")[0] != 200 and time.monotonic() < end:
                time.sleep(0.1)
            self.assertEqual(Viewer(port).status, 101)
            server.terminate()
            self.assertEqual(server.wait(timeout=30), 0)

    def test_it_can_be_stopped_meanwhile(self):
        with self.starting() as (server, _):
            before = _computed(server.pid)
            server.terminate()
            _, status, usage = os.wait4(server.pid, 0)
            self.assertEqual(os.waitstatus_to_exitcode(status), 0)
            self.assertLess(usage.ru_utime + usage.ru_stime - before, 1)


class Stop(Program):
    def serve(self, *options):
        server = Server(BINARY, "serve", "box-4k", "--device", "cpu", *options)
        server.__enter__()
        self.addCleanup(server.end, kill=True)
        return server

    def test_it_is_unready_then_closed_then_tells_then_ends_its_step_and_its_recording_then_closes_with_1012(self):
        recording = self.at("run.sph")
        server = self.serve("--record", recording)
        viewer = Viewer(server.port).wait(lambda one: len(one.of("frame")) > 20)
        health = Connection(server.port)
        self.assertEqual(health.get("/readyz")[0], 200)
        with HeldThread(server.pid, "simulation", lambda: answers(server.port)):  # like a step that takes long
            os.kill(server.pid, signal.SIGTERM)
            viewer.wait(lambda one: one.of("event"))
            status, ready = health.get("/readyz")
            self.assertEqual((status, json.loads(ready)["state"]), (503, "draining"))
            self.assertEqual(health.get("/healthz")[0], 200)
            with self.assertRaises(ConnectionRefusedError):
                Connection(server.port).get("/readyz")
            time.sleep(1)
            self.assertIsNone(viewer.closed, "the step has not ended")
        self.assertEqual(viewer.ended(), (1012, "the server is stopping"))
        self.assertEqual([event["kind"] for event in viewer.of("event")], ["DRAINING"])
        self.assertEqual(viewer.of("event")[0]["text"], "The server is stopping.")
        self.assertEqual(server.wait(), 0)
        self.assertRegex(server.said, "recorded [0-9.]+ s in ")
        done = call("export", recording, "--format", "csv", "--out", self.at("run.csv"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("is exported up to", done.stderr)

    def test_a_viewer_that_does_not_read_delays_it_by_10_s_at_most(self):
        server = self.serve()
        viewer = Viewer(server.port).wait(lambda one: one.of("frame"))
        viewer.stall()
        time.sleep(2)  # until all buffers of the connection are full
        begun = time.monotonic()
        self.assertEqual(server.end(), 0)
        self.assertLess(time.monotonic() - begun, 13)

    def test_a_second_signal_ends_it_at_once(self):
        """The server exits with code 143 by itself, because the signal's default does not end the first process of a
        container."""
        server = self.serve()
        Viewer(server.port).wait(lambda one: one.of("frame")).stall()
        self.end_by_a_second_signal(server.pid, server.port)
        self.assertEqual(server.wait(), 143)


class FirstProcess(Program):
    """The server as the first process of a PID namespace, as in a container. Creating a namespace needs privileges."""

    def test_a_second_signal_ends_it_at_once(self):
        with Server("unshare", "--pid", "--fork", "--kill-child", BINARY, "serve", "box-4k", "--device", "cpu") as server:
            with open(f"/proc/{server.pid}/task/{server.pid}/children", encoding="utf-8") as children:
                first = int(children.read())
            with open(f"/proc/{first}/status", encoding="utf-8") as status:
                self.assertRegex(status.read(), r"(?m)^NSpid:.*\t1$")
            self.end_by_a_second_signal(first, server.port)
            self.assertEqual(server.wait(), 143)


def _computed(pid):
    """Returns the processor time of a process since its start (s)."""
    with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
        user, system = file.read().rsplit(")", 1)[1].split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


def _state(pid):
    with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
        return file.read().rsplit(")", 1)[1].split()[0]


if __name__ == "__main__":
    unittest.main()
