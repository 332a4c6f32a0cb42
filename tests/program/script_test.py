#!/usr/bin/env python3
"""Tests `spherule run --script`: script_test.py BINARY"""
import csv
import json
import sys
import unittest

from program import FolderTestCase, json_runner, runner
from serving import Server

BINARY = sys.argv.pop()
call = runner(BINARY)
run_json = json_runner(call, "cpu")


def commands_file(test, *lines):
    return test.write("commands.txt", "".join(line + "\n" for line in lines))


SPAWN = '{"list": {"spheres": [{"position": [0, 0.2, 0.4], "radius": 0.05}]}}'


class Script(FolderTestCase):
    def run_with(self, scene, duration, *lines, more=()):
        return run_json(scene, "--for", duration, "--script", commands_file(self, *lines), *more)

    def refusal(self, *lines, scene="cradle", duration="1s"):
        done = call("run", scene, "--for", duration, "--script", commands_file(self, *lines), "--device", "cpu")
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        return done.stderr.split("commands.txt", 1)[1]

    def test_the_bits_are_those_of_the_same_commands_of_ctl(self):
        done = self.run_with("cradle", "1s", "# the same as by ctl", "0 set restitution 0.9", "",
                             "0.5s push 4 0.1 0 0.2", '500ms {"set": {"gravity": [0, 0, -1.6]}}', "0.7 spawn " + SPAWN,
                             "0.8 set model fast")
        self.assertEqual((done["steps"], done["spheres"], done["quality"]), (60, 6, "fast"))
        with Server(BINARY, "serve", "cradle", "--device", "cpu") as server:
            for words in (("pause",), ("reset",), ("set", "restitution", "0.9"), ("step", "30"),
                          ("push", "4", "0.1", "0", "0.2"), ("set", "gravity", "0", "0", "-1.6"), ("step", "12"),
                          ("spawn", SPAWN), ("step", "6"), ("set", "model", "fast"), ("step", "12")):
                answer = call("ctl", server.stream, *words)
                self.assertEqual(answer.returncode, 0, answer.stderr)
            query = json.loads(call("ctl", server.stream, "query", "hash").stdout)
        self.assertEqual((query["step"], query["stateHash"]), ("60", done["stateHash"]))

    def test_a_command_comes_before_the_first_step_at_its_time_or_after_it(self):
        def hash_at(time_text):
            return self.run_with("cradle", "0.5s", time_text + " push 4 0.5 0 0")["stateHash"]
        self.assertEqual(hash_at("0.1s"), hash_at("0.09s"))  # 6 steps of 1/60 s
        self.assertNotEqual(hash_at("0.1s"), hash_at("0.101s"))

    def test_recordings_have_the_added_spheres(self):
        recording, states = self.at("run.sph"), self.at("states.csv")
        self.run_with("cradle", "1s", "0.5 spawn " + SPAWN, more=("--record", recording))
        self.assertEqual(call("export", recording, "--format", "csv", "--out", states).returncode, 0)
        with open(states, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        times = sorted({float(row["time"]) for row in rows})
        self.assertEqual(len(times), 32)  # 30 in a second, the beginning, and the first step with the new sphere
        for time_now in times:
            self.assertEqual(sum(float(row["time"]) == time_now for row in rows), 5 if time_now < 0.51 else 6, time_now)
        self.assertEqual({row["group"] for row in rows if row["id"] == "5"}, {"2"})

    def test_a_wrong_line_is_refused_before_the_run_with_its_place(self):
        for line, reason in {"set gravity 0 0 0": "must have a time and a command, such as: 1.5s set gravity",
                             "1.5s": "must have a time and a command",
                             "0.1 dance": "'dance' is no command; accepted are",
                             "0.1 set colour red": "'colour' cannot be set",
                             "0.1 set restitution 1.5": "set.restitution: is 1.5, must be within 0 and 1",
                             "0.1 set substeps 0": "set.substeps: is 0, must be",
                             "0.1 set speed 2": "'set speed' has no effect: a run goes as fast as it can",
                             "0.1 set auto 5ms": "'set auto' with a time per step makes the result depend",
                             "0.1 push 5 0 0 1": "pushes sphere 5, but the scene has 5 spheres by then",
                             "0.1 push ray 0 0 0 0 0 1 nan 0 0": "'nan' is no number",
                             '0.1 spawn {"radius": {"constant": 0.1}}': "spawn.group: has no spheres",
                             "0.1 spawn {": "is not JSON",
                             "0.1 pause": "'pause' has no place in a script; it takes set, spawn, remove, push and changes of obstacles",
                             "0.1 reset": "'reset' has no place in a script",
                             "1s push 0 0 0 1": "comes at 1 s, when no step follows; --for ends the run at 1 s"}.items():
            said = self.refusal("# the first line is a comment", line)
            self.assertTrue(said.startswith(":2: "), said)
            self.assertIn(reason, said)
        said = self.refusal("0.2 push 0 0 0 1", "0.1 push 0 0 0 1")
        self.assertTrue(said.startswith(":2: comes at 0.1 s, before the line above, at 0.2 s; put the lines in"), said)
        done = call("run", "cradle", "--for", "1s", "--script", self.at("missing"), "--device", "cpu")
        self.assertIn("missing: cannot be read: give a file with a line for each command to --script", done.stderr)

    def test_lines_are_checked_against_the_scene_of_their_time(self):
        cork = SPAWN.replace('{"list"', '{"material": "cork", "list"')
        lines = ('0.1 add_material {"name": "cork", "density": 240}', "0.2 spawn " + cork,
                 '0.3 change_group 2 {"name": "corks", "material": "cork"}')
        self.assertEqual(self.run_with("cradle", "1s", *lines)["spheres"], 6)
        for line, reason in {"0.2 spawn " + cork: ":1: spawn.group.material: is \"cork\", which is no material",
                             '0.2 add_field {"drag": {"density": -1}}': ":1: add_field.field.drag.density: is -1",
                             '0.2 change_group 3 {"name": "none"}': ":1: change_group.number: is 3, must be 0 to",
                             "0.2 remove_group 3": ":1: remove_group.number: is 3, must be 0 to"}.items():
            said = self.refusal(line, *lines[2:])
            self.assertTrue(said.startswith(reason), said)

    def test_obstacles_have_changed_by_then(self):
        block = '{"box": {"min": [-0.2, 0.1, 0.3], "max": [0.2, 0.3, 0.5]}}'
        lines = ("0.1 add_obstacle " + block, "0.2 remove_obstacle 0", "0.3 spawn " + SPAWN)
        self.assertEqual(self.run_with("cradle", "1s", *lines)["spheres"], 6)
        self.assertTrue(self.refusal(lines[0], lines[2]).startswith(":2: spawn.group"), self.refusal(lines[0], lines[2]))

    def test_spheres_of_emitters_may_be_pushed_and_removed(self):
        drip = ('{"name": "drip", "box": {"min": [-0.1, 0.2, 0.4], "max": [0.1, 0.3, 0.5]}, "rate": 50,'
                ' "radius": {"constant": 0.01}}')
        lines = ("0.1 add_emitter " + drip, "0.5 push 6 0 0 1e-6", "0.5 remove 5")
        self.assertGreater(self.run_with("cradle", "1s", *lines)["spheres"], 6)
        self.assertIn("is 1000, the scene has", self.refusal(*lines[:1], "0.5 push 1000 0 0 1"))

    def test_a_command_that_is_refused_on_the_way_ends_the_run_with_its_place(self):
        self.assertTrue(self.refusal("0.1 push ray 0 0 -5 0 0 -1 0 0 1").startswith(":1: push.ray: meets no sphere"))


if __name__ == "__main__":
    unittest.main()
