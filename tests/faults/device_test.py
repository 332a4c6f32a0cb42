#!/usr/bin/env python3
"""Tests the program with a device that is lost, hangs or has no memory: device_test.py BINARY DRIVER. DRIVER is the
library of faulty_driver.c."""
import http.client
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from faults import FaultyDriver, HeldThread
from program import FolderTestCase, runner
from serving import Server
from viewer import Viewer, answers

DRIVER = sys.argv.pop()
BINARY = sys.argv.pop()
call = runner(BINARY)


def setUpModule():
    """Compiles all kernels into a cache that the tests share. Otherwise Mesa compiles a kernel at its first launch. On a
    busy machine, this takes longer than the watchdogs of these tests allow."""
    cache = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(cache.cleanup)
    os.environ["MESA_SHADER_CACHE_DIR"] = cache.name
    subprocess.run([BINARY, "run", "box-4k", "--device", "software", "--for", "0.1s", "--record",
                    os.path.join(cache.name, "run.sph")], check=True, timeout=120, stdout=subprocess.DEVNULL)


class Faults(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.recording = self.at("run.sph")

    def serve(self, *options, scene="box-4k", device="software", driver=None):
        server = Server(BINARY, "serve", scene, "--device", device, *options, env=driver and driver.environment)
        server.__enter__()
        self.addCleanup(server.end, kill=True)
        return server

    def driver(self, fault):
        return FaultyDriver(self.folder, DRIVER, fault)

    def recorded(self, *, whole):
        done = call("export", self.recording, "--format", "csv", "--out", self.at("run.csv"))
        self.assertEqual(done.returncode, 0, done.stderr)
        if whole:
            self.assertNotIn("is exported up to", done.stderr)
        with open(self.at("run.csv"), encoding="utf-8") as file:
            positions = [line.split(",")[2:5] for line in file][1:]
        self.assertGreater(len(positions), 10)
        self.assertLess(max(abs(float(value)) for position in positions for value in position), 100)

    def told(self, viewer, pattern):
        self.assertEqual(viewer.ended()[0], 1012)
        events = [event for event in viewer.of("event") if event["kind"] == "DEVICE_LOST"]
        self.assertEqual(len(events), 1, viewer.of("event"))
        self.assertRegex(events[0]["text"], pattern)
        self.assertTrue(events[0]["text"].endswith("this page goes on by itself once the server has been started again."))


class Lost(Faults):
    cause = r"the device was reset: a kernel of this program hung or crashed it"

    def test_viewers_are_told_the_recording_plays_and_the_program_ends_with_75(self):
        driver = self.driver("reset")
        server = self.serve("--record", self.recording, driver=driver)
        viewer = Viewer(server.port)
        viewer.wait(lambda one: len(one.of("frame")) > 20)
        begun = time.monotonic()
        driver.strike()
        self.told(viewer, self.cause)
        self.assertEqual(server.wait(), 75)
        self.assertLess(time.monotonic() - begun, 20)  # although the driver blocks when objects are destroyed
        self.assertRegex(server.said, rf"(?m)^spherule: llvmpipe.*: {self.cause}; start it again$")
        self.recorded(whole=True)

    def test_it_is_noticed_while_nothing_is_simulated(self):
        driver = self.driver("reset")
        server = self.serve(driver=driver)
        self.assertEqual(call("ctl", server.stream, "pause").returncode, 0)
        begun = time.monotonic()
        driver.strike()
        self.assertEqual(server.wait(), 75)
        self.assertLess(time.monotonic() - begun, 20)

    def test_run_keeps_its_recording_and_ends_though_the_driver_hangs_as_it_goes(self):
        driver = self.driver("reset")
        with subprocess.Popen([BINARY, "run", "box-4k", "--device", "software", "--for", "1000s", "--record", self.recording,
                               "--watchdog", "3s"], env=driver.environment, stderr=subprocess.PIPE, text=True) as running:
            self.addCleanup(running.kill)
            while not os.path.exists(self.recording) or os.path.getsize(self.recording) < 100_000:
                time.sleep(0.1)
            driver.strike()
            said = running.communicate(timeout=30)[1]
        self.assertEqual(running.returncode, 75, said)
        self.recorded(whole=True)


class Hangs(Faults):
    cause = r"nothing has progressed for 3 s \([a-z_. ]+\): the device or its driver hangs, or needs a longer --watchdog"

    def unhealthy_then_ended(self, server, viewer, wait):
        """Checks that /healthz reports the hang, and that the server then ends with the right exit code, in time."""
        begun = time.monotonic()
        unhealthy = None
        while unhealthy is None and time.monotonic() < begun + 10:
            connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=10)
            try:
                connection.request("GET", "/healthz")
                answer = connection.getresponse()
                if answer.status == 503:
                    unhealthy = answer.read().decode()
            except OSError:
                break
            finally:
                connection.close()
            time.sleep(0.05)
        self.assertRegex(unhealthy or "", r"^stuck: nothing has progressed for [123]\.\d s; after 3 s the watchdog ends it\n$")
        self.told(viewer, self.cause)
        wait()
        self.assertEqual(server.wait(), 75)
        self.assertLess(time.monotonic() - begun, 25)
        self.assertRegex(server.said, rf"(?m)^spherule: watchdog: {self.cause}; start it again$")

    def test_a_device_that_computes_no_more_is_noticed(self):
        driver = self.driver("hang")
        server = self.serve("--watchdog", "3s", "--record", self.recording, driver=driver)
        viewer = Viewer(server.port).wait(lambda one: len(one.of("frame")) > 20)
        driver.strike()
        self.unhealthy_then_ended(server, viewer, lambda: None)
        self.recorded(whole=False)

    def test_so_is_a_thread_that_stands_still_on_the_cpu(self):
        server = self.serve("--watchdog", "3s", device="cpu:1")
        viewer = Viewer(server.port).wait(lambda one: len(one.of("frame")) > 3)
        with HeldThread(server.pid, "simulation", lambda: answers(server.port)) as held:
            self.unhealthy_then_ended(server, viewer, lambda: held.wait_for_the_end(15))

    def test_a_program_that_was_stopped_as_a_whole_goes_on(self):
        server = self.serve("--watchdog", "4s", device="cpu:1")
        # The simulation thread is stopped in the middle of its work, and is not the first thread to resume.
        with HeldThread(server.pid, "simulation", lambda: answers(server.port)):
            time.sleep(1)
            os.kill(server.pid, signal.SIGSTOP)
            time.sleep(5)
            os.kill(server.pid, signal.SIGCONT)
            time.sleep(0.5)
        viewer = Viewer(server.port).wait(lambda one: len(one.of("frame")) > 3)
        self.assertEqual(server.get("/healthz"), "alive\n")
        self.assertIsNone(viewer.closed)
        self.assertEqual(server.end(), 0, server.said)

    def test_a_stop_does_not_wait_for_a_step_that_never_ends(self):
        driver = self.driver("hang")
        server = self.serve(driver=driver)  # the default watchdog waits longer
        viewer = Viewer(server.port).wait(lambda one: len(one.of("frame")) > 3)
        driver.strike()
        begun = time.monotonic()
        os.kill(server.pid, signal.SIGTERM)
        self.assertEqual(server.wait(), 75)
        self.assertLess(time.monotonic() - begun, 25)
        self.assertEqual(viewer.ended()[0], 1012)
        self.assertRegex(server.said, r"(?m)^spherule: step: the one under way did not end in time; start it again$")


class Full(Faults):
    need = r"the device has no room for [0-9.]+ MiB \(out of memory\); use fewer spheres or a device with more memory \(the " \
           r"scene needs [0-9.]+ MiB in all\)"

    def test_a_driver_that_allows_a_kernel_too_few_buffers_is_refused_at_the_start(self):
        driver = self.driver("buffers")
        driver.strike()
        done = call("run", "two-spheres", "--device", "software", "--for", "0.1s", **driver.environment)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("allows a kernel 8 storage buffers; 16 are needed", done.stderr)

    def test_a_scene_that_has_no_room_is_refused_with_what_it_needs(self):
        driver = self.driver("memory")
        driver.strike()
        for command in (["serve", "box-50k", "--listen", "127.0.0.1:0"], ["run", "box-50k", "--for", "1s"]):
            done = call(*command, "--device", "software", **driver.environment)
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertRegex(done.stderr.splitlines()[-1], rf"^spherule: [a-z ]+: {self.need}$")

    def test_a_scene_that_is_loaded_is_refused_and_the_old_one_goes_on(self):
        driver = self.driver("memory")
        server = self.serve(scene="cradle", driver=driver)
        driver.strike()
        done = call("ctl", server.stream, "load", "box-50k")
        self.assertEqual(done.returncode, 4)
        self.assertRegex(done.stderr, rf"refused: [a-z ]+: {self.need}")
        viewer = Viewer(server.port).wait(lambda one: len(one.of("frame")) > 3)
        self.assertEqual(viewer.of("scene")[-1]["name"], "cradle")
        self.assertEqual(json.loads(server.get("/readyz"))["spheres"], 5)
        self.assertEqual(server.end(), 0)

    def test_so_is_one_that_has_no_room_in_the_memory_of_the_program(self):
        box = {"min": [0, 0, 0], "max": [160, 160, 160]}
        scene = self.write("large.json", json.dumps({"bounds": box, "groups": [
            {"radius": {"constant": 0.1}, "lattice": {"count": 4_000_000, "spacing": 0.3, **box}}]}))
        limited = runner("bash", "-c", 'ulimit -v 1500000; exec "$@"', "bash", BINARY)
        for command in (["serve", scene, "--listen", "127.0.0.1:0"], ["run", scene, "--for", "1s"]):
            done = limited(*command, "--device", "cpu:1")
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertRegex(done.stderr.splitlines()[-1], r"use fewer spheres")


if __name__ == "__main__":
    unittest.main()
