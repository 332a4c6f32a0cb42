#!/usr/bin/env python3
"""Tests command logs, `spherule replay` and `spherule compare`: command_log_test.py BINARY"""
import json
import os
import random
import sys
import time
import unittest

from program import FolderTestCase, json_runner, runner, wait_for
from serving import Server
from viewer import Controller

BINARY = sys.argv.pop()
call = runner(BINARY)
run_json = json_runner(call, "cpu")

SPAWN = '{"list": {"spheres": [{"position": [0, 0.2, 0.4], "radius": 0.05}]}}'


class Random(Controller):
    """Sends commands at random, of all kinds that change the world."""

    def __init__(self, port, seed):
        super().__init__(port, rate=20)
        self.chance = random.Random(seed)

    def command(self):
        chance, sphere = self.chance, self.chance.randrange(700)
        commands = [
            {"push": {"sphere": sphere, "impulse": [chance.uniform(-2, 2), 0, chance.uniform(0, 3)]}},
            {"pull": {"sphere": sphere, "point": [chance.uniform(-1, 1), 0, 1]}},
            {"release": {}},
            {"remove": {"spheres": [sphere]}},
            {"set": {"gravity": [chance.uniform(-2, 2), 0, -9.81]}},
            {"set": {"friction": chance.uniform(0, 0.8)}},
            {"set": {"model": chance.choice(["FAST", "BALANCED"]), "auto": {"budgetMs": chance.uniform(1, 30)}}},
            {"addField": {"field": {"drag": {"density": chance.uniform(0, 3)}}}},
            {"removeField": {"number": 0}},
            {"addObstacle": {"obstacle": {"sphere": {"centre": [chance.uniform(-5, 5), 0, 9], "radius": 0.1}}}},
            {"removeObstacle": {"obstacle": chance.randrange(9)}},
            {"reset": {}} if chance.random() < 0.05 else {"release": {}},
        ]
        self.send(chance.choice(commands))

    def decisions(self):
        """Returns how often the goal for quality has moved the substeps."""
        return sum("substeps per step in place of" in event["text"] for event in self.of("event"))


class Log(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.kept = self.at("kept")
        self.log = self.at("run.sphl")

    def replay(self, log, *more):
        done = call("replay", log, "--device", "cpu", "--json", *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_a_replay_gives_the_same_hashes(self):
        script = self.write("commands.txt", f"0.1 push 4 0.1 0 0.2\n0.2 spawn {SPAWN}\n0.3 set model fast\n"
                                            '0.4 add_field {"drag": {"density": 2}}\n0.5 remove 2\n')
        done = run_json("cradle", "--for", "1s", "--script", script, "--log", self.log, "--hash-every", "6")
        again = self.replay(self.log)
        self.assertEqual((again["stateHash"], again["step"]), (done["stateHash"], 60))
        self.assertEqual((again["commands"], again["hashes"], again["same"], again["complete"]), (5, 12, True, True))

    def test_a_replay_makes_the_decisions_of_the_goal_for_quality(self):
        done = run_json("box-4k", "--auto", "0.001%", "--for", "1s", "--log", self.log)
        again = self.replay(self.log)
        self.assertEqual(again["stateHash"], done["stateHash"])
        self.assertGreater(again["decisions"], 0)

    def test_a_replay_loads_another_scene(self):
        with Server(BINARY, "serve", "cradle", "--device", "cpu", "--log", self.log, "--hash-every", "5", "--recordings",
                    "") as server:
            for command in ("push 0 0.1 0 0", "load bounce", "push 0 0 0 0.001", "load two-spheres", "pause"):
                done = call("ctl", server.stream, *command.split())
                self.assertEqual(done.returncode, 0, done.stderr)
                steps = server.metrics()["spherule_steps", ""]
                if command != "pause":
                    self.assertTrue(wait_for(lambda: server.metrics()["spherule_steps", ""] > steps + 10))
            state = json.loads(call("ctl", server.stream, "query", "hash").stdout)
            self.assertEqual(server.end(), 0, server.said)
        again = self.replay(self.log)
        self.assertEqual((again["scene"], again["stateHash"], again["step"]),
                         ("two-spheres", state["stateHash"], int(state["step"])))
        self.assertEqual((again["commands"], again["same"], again["complete"]), (2, True, True))
        self.assertGreaterEqual(again["hashes"], 6)

    def test_the_log_goes_on_with_the_run(self):
        script = self.write("commands.txt", "0.1 push 0 0.1 0 0\n0.75 push 1 0.1 0 0\n")
        arguments = ("cradle", "--script", script, "--log", self.log, "--checkpoints", self.kept, "--resume")
        run_json("cradle", "--for", "1s", "--script", script, "--log", self.at("whole.sphl"))
        early = self.write("early.txt", "0.1 push 0 0.1 0 0\n")
        run_json("cradle", "--script", early, *arguments[3:], "--for", "0.7s")
        kept = os.listdir(self.kept)
        run_json(*arguments, "--for", "0.8s")
        for name in os.listdir(self.kept):
            if name not in kept:
                os.remove(os.path.join(self.kept, name))
        done = call("run", *arguments, "--for", "1s", "--device", "cpu")  # again from 0.7 s
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"1 commands and decisions of {self.log} are removed: they came after the checkpoint", done.stderr)
        self.assertEqual(self.replay(self.log)["commands"], 2)
        self.assertEqual(self.replay(self.log)["stateHash"], self.replay(self.at("whole.sphl"))["stateHash"])

    def test_a_new_log_begins_beside_one_that_cannot_go_on(self):
        run_json("cradle", "--for", "0.5s", "--log", self.log, "--checkpoints", self.kept)
        run_json("cradle", "--for", "0.5s", "--log", self.log, "--force")
        with open(self.log, "rb") as file:
            other = file.read()
        done = call("run", "cradle", "--for", "1s", "--log", self.log, "--checkpoints", self.kept, "--resume",
                    "--device", "cpu")
        self.assertEqual(done.returncode, 0, done.stderr)
        new = self.at("run-2.sphl")
        self.assertIn(f"{self.log} is not the log of this state; a new command log begins in {new}", done.stderr)
        self.assertEqual(self.replay(new)["steps"], 30)
        for seconds in ("1.5s", "2s"):  # the new log goes on
            run_json("cradle", "--for", seconds, "--log", self.log, "--checkpoints", self.kept, "--resume")
        self.assertEqual(self.replay(new)["steps"], 90)
        self.assertFalse(os.path.exists(self.at("run-3.sphl")))
        with open(self.log, "rb") as file:
            self.assertEqual(file.read(), other)

    def test_a_server_that_was_killed_before_its_first_checkpoint_starts_again(self):
        arguments = ("cradle", "--for", "0.5s", "--log", self.log, "--checkpoints", self.kept, "--resume")
        self.write("run.sphl", "of a program that was killed")
        done = call("run", *arguments, "--device", "cpu")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.replay(self.at("run-2.sphl"))["steps"], 30)

    def test_force_does_not_end_the_log_of_the_checkpoint(self):
        for seconds in ("0.5s", "1s"):
            run_json("cradle", "--for", seconds, "--log", self.log, "--checkpoints", self.kept, "--resume", "--dump",
                     self.at("states.csv"), "--force")
        self.assertEqual(self.replay(self.log)["steps"], 60)

    def test_a_run_that_fails_has_a_log_with_an_end(self):
        script = self.write("commands.txt", "0.5 remove 3\n0.6 remove 3\n")
        done = call("run", "cradle", "--for", "1s", "--script", script, "--log", self.log, "--device", "cpu")
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual((self.replay(self.log)["step"], self.replay(self.log)["complete"]), (36, True))

    def test_compare_names_the_first_step_at_which_runs_differ(self):
        def logged(name, *lines):
            script = self.write(name + ".txt", "".join(line + "\n" for line in lines))
            run_json("cradle", "--for", "1s", "--script", script, "--log", self.at(name))
            return self.at(name)
        one = logged("one", "0.5 push 1 0.1 0 0")
        for other, code, said in (
                (logged("same", "0.5 push 1 0.1 0 0"), 0, "the runs are equal"),
                (logged("more", "0.5 push 1 0.1 0 0", "0.9 push 2 0.1 0 0"), 6, "the states differ from step 55 on"),
                (logged("other", "0.5 push 1 0.2 0 0"), 6, "the states differ from step 31 on"),
                (logged("later", "0.7 push 1 0.1 0 0"), 6, "the states differ from step 31 on")):
            done = call("compare", one, other, "--device", "cpu")
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
            self.assertIn(said, done.stdout)
        run_json("cradle", "--for", "1s", "--substeps", "9", "--log", self.at("finer"))
        done = call("compare", one, self.at("finer"), "--device", "cpu")
        self.assertEqual(done.returncode, 6)
        self.assertRegex(done.stdout, r"have different states at the beginning\nthe states differ from step \d+ on")

    def test_compare_takes_runs_for_equal_whose_hashes_were_logged_at_other_steps(self):
        for name, every in (("one", "7"), ("other", "30"), ("none", "0")):
            run_json("cradle", "--for", "1s", "--log", self.at(name), "--hash-every", every)
        for other in ("other", "none"):
            done = call("compare", self.at("one"), self.at(other), "--device", "cpu")
            self.assertEqual((done.returncode, done.stdout), (0, "the runs are equal\n"))

    def test_a_changed_log_is_found(self):
        script = self.write("commands.txt", "0.1 push 4 0.1 0 0.2\n")
        run_json("cradle", "--for", "1s", "--log", self.log, "--script", script)
        with open(self.log, "rb") as file:
            content = file.read()
        for damaged, hashes in ((content[:-5], 3), (content[:-40] + bytes([content[-40] ^ 1]) + content[-39:], 2)):
            with open(self.log, "wb") as file:
                file.write(damaged)
            for report in ((), ("--json",)):
                done = call("replay", self.log, "--device", "cpu", *report)
                self.assertEqual(done.returncode, 2, done.stdout)
                self.assertRegex(done.stderr, r"the record at byte \d+ is (cut off|damaged)")
            report = json.loads(done.stdout)  # up to the flaw
            self.assertEqual((report["complete"], report["same"], report["commands"]), (False, True, 1))
            self.assertEqual((report["step"], report["hashes"]), (60, hashes))

    def test_a_replay_of_random_commands_has_the_same_hashes(self):
        with Server(BINARY, "serve", "rapids-3k", "--device", "cpu", "--log", self.log, "--hash-every", "5", "--substeps",
                    "16", "--auto", "0.05ms", "--recordings", "") as server:
            controller = Random(server.port, int(os.environ.get("SPHERULE_TEST_SEED", "1")))
            for goal, substeps in ((0.05, 16), (10000, 8), (0.05, 16), (10000, 8), (0.05, 16)):
                for _ in range(40):
                    controller.command()
                    time.sleep(0.02)
                # A command begins the readings anew. Without further ones, the goal moves the substeps.
                decisions = controller.decisions()
                controller.send({"set": {"substeps": substeps, "auto": {"budgetMs": goal}}})
                controller.wait(lambda one: one.decisions() > decisions)
            controller.wait(lambda one: len(one.of("result")) == one.sent)
            carried = sum("applied" in result for result in controller.of("result"))
            self.assertTrue(all("auto" in settings for settings in controller.of("settings")), "the goal is always on")
            self.assertEqual(server.end(), 0, server.said)
        again = self.replay(self.log)
        self.assertTrue(again["same"] and again["complete"])
        self.assertGreaterEqual(again["decisions"], 5)
        self.assertGreaterEqual(again["hashes"], 12, "ten of them between the begin and the end")
        self.assertGreater(carried, 60)
        self.assertGreaterEqual(again["commands"], carried)  # the end of the session releases its sphere


if __name__ == "__main__":
    unittest.main()
