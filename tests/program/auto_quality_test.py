#!/usr/bin/env python3
"""Tests goals of automatic quality, warnings, and the table of the dial: auto_quality_test.py BINARY."""
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request

from program import runner, wait_for

BINARY = sys.argv.pop()
PATIENCE = 60  # s; only a failing test waits that long


call = runner(BINARY)


class Served(unittest.TestCase):
    """Tests with a server and its log."""

    def serve(self, *arguments):
        self.log = tempfile.NamedTemporaryFile(mode="r", suffix=".log")
        self.addCleanup(self.log.close)
        with open(self.log.name, "w", encoding="utf-8") as log:
            server = subprocess.Popen([BINARY, "serve", *arguments, "--device", "cpu", "--listen", "127.0.0.1:0"],
                                      stdout=subprocess.PIPE, stderr=log, text=True)
        self.addCleanup(server.wait)
        self.addCleanup(server.kill)
        self.addCleanup(server.stdout.close)
        for line in server.stdout:
            if found := re.search(r"open http://(\S+)/", line):
                self.address = found.group(1)
                return
        self.fail("the server ended")

    def metric(self, name):
        with urllib.request.urlopen(f"http://{self.address}/metrics", timeout=30) as answer:
            found = re.search(rf"^{name} (\S+)$", answer.read().decode(), re.MULTILINE)
        return float(found.group(1)) if found else None

    def ctl(self, *words):
        done = call("ctl", f"ws://{self.address}/ws", *words)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def eventually(self, condition, what):
        self.assertTrue(wait_for(condition, PATIENCE), what)

    def logged(self):
        with open(self.log.name, encoding="utf-8") as log:
            return log.read()


class Budget(Served):
    def test_substeps_fall_to_hold_a_short_time_and_rise_again_for_a_long_one(self):
        self.serve("box-4k", "--substeps", "32", "--auto", "0.05ms")
        self.eventually(lambda: self.metric("spherule_substeps") == 4, "substeps fall to half of the model's own")
        self.eventually(lambda: re.search(r"\d+ substeps per step in place of 32: a step takes \S+ ms, and may take 0.05",
                                          self.logged()), "it is said")
        self.eventually(lambda: "out of reach even with 4 substeps" in self.logged(), "it is said that no more can be done")
        self.assertEqual(self.logged().count("out of reach"), 1)
        self.ctl("set", "auto", "10000ms")
        self.eventually(lambda: self.metric("spherule_substeps") == 64, "substeps rise to eight times the model's own")
        self.assertGreater(self.metric("spherule_step_seconds"), 0)

    def test_substeps_that_are_set_stay(self):
        self.serve("cradle", "--auto", "10000ms")
        self.ctl("set", "substeps", "5")
        self.eventually(lambda: self.metric("spherule_substeps") == 5, "what was set holds")
        time.sleep(3)
        self.assertEqual(self.metric("spherule_substeps"), 5)


class Metrics(Served):
    def test_figures_of_the_world_are_there_for_who_asks(self):
        self.serve("cradle")
        self.metric("spherule_contacts")  # the first request starts the statistics
        self.eventually(lambda: self.metric("spherule_speed_max_metres_per_second"), "spheres move")
        self.assertEqual(self.metric("spherule_energy_rises"), 0)
        self.assertGreater(self.metric('spherule_energy_joules{kind="kinetic"}'), 0)


class Energy(Served):
    def test_a_column_that_swings_gets_some_from_the_model_and_that_is_told(self):
        # With one substep per step, the load of a column needs longer to its foot than the column to fall.
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "column.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump({"bounds": {"min": [-1, -1, 0], "max": [1, 1, 4]}, "sleep": {"enabled": False},
                           "quality": {"model": "BALANCED", "substeps": 1},
                           "groups": [{"radius": {"constant": 0.05}, "list": {"spheres": [
                               {"position": [0, 0, 0.05 + 0.1 * k]} for k in range(20)]}}]}, file)
            self.serve(path)
        self.metric("spherule_contacts")
        self.ctl("reset")
        self.eventually(lambda: self.metric("spherule_energy_rises") == 1, "the rise is seen")
        self.eventually(lambda: re.search(r"mechanical energy has risen by \S+ J to \S+ J, though nothing gave any",
                                          self.logged()), "it is said")
        self.ctl("reset")
        self.ctl("set", "model", "fast")
        time.sleep(3)
        self.eventually(lambda: self.metric("spherule_energy_rises") == 0, "it is quiet again")

    def test_an_impact_through_balls_that_touch_is_no_rise(self):
        self.serve("cradle-touching", "--quality", "balanced")
        self.metric("spherule_contacts")
        self.ctl("reset")
        self.eventually(lambda: self.metric("spherule_simulated_seconds") > 1, "time goes on")
        self.assertEqual(self.metric("spherule_energy_rises"), 0)

    def test_spheres_deep_in_each_other_are_no_rise(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "deep.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump({"gravity": [0, 0, 0], "bounds": {"min": [-1, -1, -1], "max": [1, 1, 1]},
                           "quality": {"model": "ACCURATE"},
                           "groups": [{"radius": {"constant": 0.1}, "list": {"spheres": [
                               {"position": [-0.07, 0, 0]}, {"position": [0.07, 0, 0]}]}}]}, file)
            self.serve(path)
        self.eventually(lambda: "spheres are in each other by up to 0.6 radii; pushing them apart first" in self.logged(),
                        "it is said")
        self.metric("spherule_contacts")
        self.eventually(lambda: self.metric("spherule_simulated_seconds") > 0.5, "time goes on")
        self.assertLess(self.metric("spherule_speed_max_metres_per_second"), 0.2)
        self.assertEqual(self.metric("spherule_energy_rises"), 0)


class Overlap(unittest.TestCase):
    def bed(self, *more):
        done = call("run", "box-4k", "--for", "4s", "--device", "cpu", "--json", "--no-sleep", *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout), done.stderr

    def test_run_holds_an_overlap_and_gives_the_same_bits_again(self):
        fixed, _ = self.bed("--substeps", "2")
        held, log = self.bed("--substeps", "2", "--auto", "0.5%")
        self.assertGreater(fixed["overlapMean"], 0.01)
        self.assertLess(held["overlapMean"], 0.0075)
        self.assertGreater(held["substepsPerStep"], 2)
        self.assertIn("the mean overlap is", log)
        self.assertEqual(held["stateHash"], self.bed("--substeps", "2", "--auto", "0.5%")[0]["stateHash"])

    def test_run_refuses_a_time_to_hold(self):
        done = call("run", "bounce", "--for", "1s", "--device", "cpu", "--auto", "16ms")
        self.assertEqual(done.returncode, 2)
        self.assertIn("quality.auto: holds a time per step", done.stderr)
        for wrong in ("16", "ms", "0ms", "-1%", "60%", "nan%", "fast"):
            self.assertEqual(call("run", "bounce", "--for", "1s", "--auto", wrong).returncode, 2, wrong)


class Table(unittest.TestCase):
    def refusal(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "table.json")
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            done = call("serve", "bounce", "--device", "cpu", "--listen", "127.0.0.1:0", "--quality-table", path)
        self.assertEqual(done.returncode, 2, done.stderr)
        return done.stderr

    def test_a_table_that_is_wrong_is_refused_with_file_place_and_what_to_do(self):
        self.assertRegex(self.refusal("{"), r"table\.json:1:2: is not JSON; `spherule measure .+` writes ")
        self.assertRegex(self.refusal('{"device": "cpu"}'), r"table\.json: renderer: is missing; `spherule measure ")
        missing = call("serve", "bounce", "--device", "cpu", "--quality-table", "/no/such.json")
        self.assertEqual(missing.returncode, 2)
        self.assertIn("/no/such.json: there is no such file", missing.stderr)


if __name__ == "__main__":
    unittest.main()
