#!/usr/bin/env python3
"""Tests checkpoints, with which runs and servers go on: checkpoint_test.py BINARY"""
import glob
import json
import os
import re
import signal
import subprocess
import sys
import time
import unittest

from program import FolderTestCase, json_runner, runner, wait_for
from serving import Server
from viewer import Controller

BINARY = sys.argv.pop()
call = runner(BINARY)
run_json = json_runner(call, "cpu")

BOX = ("box-4k", "--auto", "0.5%")


class Kept(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.kept = self.at("kept")

    def checkpoints(self):
        return sorted(glob.glob(self.kept + "/checkpoint-*.sphc"))

    def killed_run(self, *arguments, after):
        """Runs until `after()` is true, and kills the program."""
        with subprocess.Popen([BINARY, "run", *arguments, "--device", "cpu"], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True) as process:
            self.assertTrue(wait_for(after), "the run does not go on")
            process.send_signal(signal.SIGKILL)
            said = process.communicate()[1]
        self.assertEqual(process.returncode, -signal.SIGKILL, said)


class Run(Kept):
    def test_a_killed_run_goes_on_with_the_bits_of_an_undisturbed_one(self):
        script = self.write("commands.txt", "0.3 push 7 0.2 0 0.1\n0.6 set gravity 0 0 -3\n1.2 set friction 0.1\n")
        arguments = (*BOX, "--for", "1.5s", "--script", script)
        undisturbed = run_json(*arguments)
        keeping = (*arguments, "--checkpoints", self.kept, "--checkpoint-every", "0.1s", "--resume")
        for count in (2, 4):
            self.killed_run(*keeping, after=lambda: self.last() >= count)
        done = run_json(*keeping)
        self.assertEqual(done["stateHash"], undisturbed["stateHash"])
        self.assertEqual(len(self.checkpoints()), 3)
        again = run_json(*keeping)  # nothing is left to do
        self.assertEqual(again["stateHash"], undisturbed["stateHash"])

    def last(self):
        names = self.checkpoints()
        return int(re.search(r"(\d+)\.sphc", names[-1]).group(1)) if names else 0

    def test_a_longer_run_goes_on_after_the_end_of_a_shorter_one(self):
        run_json("cradle", "--for", "0.5s", "--checkpoints", self.kept)
        done = run_json("cradle", "--for", "1s", "--checkpoints", self.kept, "--resume")
        self.assertEqual(done["stateHash"], run_json("cradle", "--for", "1s")["stateHash"])

    def test_damaged_checkpoints_are_named_and_passed_over(self):
        arguments = ("cradle", "--for", "1s", "--checkpoints", self.kept)
        for seconds in ("0.2s", "0.4s", "0.6s"):
            run_json("cradle", "--for", seconds, "--checkpoints", self.kept, "--resume")
        names = self.checkpoints()
        with open(names[2], "r+b") as file:
            file.truncate(os.path.getsize(names[2]) // 2)
        with open(names[1], "r+b") as file:
            file.seek(os.path.getsize(names[1]) // 2)
            byte = file.read(1)
            file.seek(-1, os.SEEK_CUR)
            file.write(bytes([byte[0] ^ 16]))
        done = call("run", *arguments, "--resume", "--device", "cpu", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, rf"a checkpoint is passed over: {names[2]}: the record at byte \d+ is cut off")
        self.assertRegex(done.stderr, rf"a checkpoint is passed over: {names[1]}: the record at byte \d+ is damaged")
        self.assertRegex(done.stderr, rf"goes on from {names[0]} with the scene cradle, at step 12, 0.2 s simulated")
        self.assertEqual(json.loads(done.stdout)["stateHash"], run_json("cradle", "--for", "1s")["stateHash"])
        for _ in range(4):
            run_json(*arguments, "--resume")
        self.assertTrue(os.path.exists(names[1] + ".bad") and os.path.exists(names[2] + ".bad"), "nothing removes them")

    def test_another_scene_than_that_of_the_checkpoint_is_warned_of(self):
        named = self.write("cradle.json", '{"name": "other", "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}')
        unnamed = self.write("mine.json", '{"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}')
        self.write("cradle-too.json", "no scene any more")
        run_json("cradle", "--for", "0.1s", "--checkpoints", self.kept)
        for scene, name in (("bounce", "bounce"), (named, "other"), (unnamed, "mine"), (self.at("gone/cradle.json"), None),
                            (self.at("cradle-too.json"), "cradle-too"), ("cradle", None)):
            done = call("run", scene, "--for", "0.1s", "--checkpoints", self.kept, "--resume", "--device", "cpu")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("the scene of the command line and its options are not used", done.stderr)
            self.assertEqual(done.stderr.count(" warning "), 0 if name is None else 1, done.stderr)
            if name:
                self.assertIn(f"the checkpoint has the scene cradle, the command line names the scene {name}, which is "
                              "not used; to begin with it, leave out --resume or give --checkpoints another folder",
                              done.stderr)

    def test_a_signal_in_the_midst_of_a_step_ends_the_log_there(self):
        log = self.at("log.sphl")
        keeping = ("box-4k", "--substeps", "6000", "--checkpoints", self.kept, "--checkpoint-every", "0.1s", "--log", log)
        with subprocess.Popen([BINARY, "run", *keeping, "--for", "100s", "--device", "cpu"], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True) as process:
            self.assertTrue(wait_for(self.checkpoints))
            time.sleep(0.2)  # the next step is under way; it takes seconds
            process.send_signal(signal.SIGTERM)
            said = process.communicate(timeout=100)[1]
        self.assertEqual(process.returncode, 0, said)
        self.assertRegex(said, r"ended early by SIGTERM, at step \d+")
        again = call("replay", log, "--device", "cpu", "--json")
        self.assertEqual(again.returncode, 0, again.stderr)
        report = json.loads(again.stdout)
        self.assertTrue(report["same"] and report["complete"])
        self.assertGreater(report["time"] * 60 % 1, 0.001, "it ends within a step")

    def test_without_a_good_checkpoint_it_begins_with_the_scene(self):
        os.mkdir(self.kept)
        with open(self.kept + "/checkpoint-00000004.sphc", "w", encoding="utf-8") as file:
            file.write("nothing")
        done = call("run", "cradle", "--for", "0.1s", "--checkpoints", self.kept, "--resume", "--device", "cpu")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("checkpoint-00000004.sphc: is no checkpoint: it has only 7 bytes", done.stderr)
        self.assertEqual(sorted(os.listdir(self.kept)), ["checkpoint-00000004.sphc.bad", "checkpoint-00000005.sphc", "lock"])

    def test_a_start_without_resume_warns_of_what_it_replaces(self):
        run_json("cradle", "--for", "0.1s", "--checkpoints", self.kept)
        done = call("run", "cradle", "--for", "0.1s", "--checkpoints", self.kept, "--device", "cpu")
        self.assertIn(f"{self.kept} holds 1 checkpoints of an earlier run, which new ones replace", done.stderr)

    def test_double_precision_is_refused(self):
        done = call("run", "cradle", "--for", "0.1s", "--log", self.at("log"), "--device", "cpu-double")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("the state of cpu-double cannot be saved", done.stderr)

    def test_what_cannot_be_is_refused(self):
        file = self.write("file", "")
        for arguments, reason in {
                ("--checkpoints", file): f"{file}: cannot be the folder of checkpoints",
                ("--resume",): "--resume: needs the folder of the checkpoints",
                ("--resume", "--checkpoints", ""): "--resume: needs the folder of the checkpoints",
                ("--checkpoints", self.kept, "--checkpoint-every", "0s"): "--checkpoint-every: is 0s, must be 0.1s to",
                ("--checkpoints", self.kept, "--keep-checkpoints", "0"): "--keep-checkpoints",
                ("--log", file): f"{file}: is there already; give --force to replace it"}.items():
            done = call("run", "cradle", "--for", "0.1s", *arguments, "--device", "cpu")
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(reason, done.stderr)

    def test_a_script_must_have_the_commands_that_were_carried_out(self):
        script = self.write("commands.txt", "0.1 push 0 0.1 0 0\n0.2 push 1 0.1 0 0\n")
        run_json("cradle", "--for", "0.5s", "--script", script, "--checkpoints", self.kept)
        done = call("run", "cradle", "--for", "1s", "--checkpoints", self.kept, "--resume", "--device", "cpu")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("--script: has 0 commands, but 2 had been carried out before the checkpoint", done.stderr)

    def test_a_run_goes_on_when_its_folder_is_deleted(self):
        with subprocess.Popen([BINARY, "run", "box-4k", "--for", "2s", "--checkpoints", self.kept, "--checkpoint-every",
                               "0.1s", "--device", "cpu"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            self.assertTrue(wait_for(self.checkpoints))
            subprocess.run(["rm", "-r", self.kept], check=True)
            said = process.communicate(timeout=100)[1]
        self.assertEqual(process.returncode, 0, said)
        self.assertRegex(said, rf"no checkpoint could be written: {self.kept}/checkpoint-\d+.sphc: cannot be written: "
                               "No such file or directory")


class Serve(Kept):
    def serve(self, *more, scene="box-4k"):
        return Server(BINARY, "serve", scene, "--device", "cpu", "--checkpoints", self.kept, "--resume",
                      "--recordings", "", *more)

    def ctl(self, server, *words):
        done = call("ctl", server.stream, *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def query(self, server):
        return json.loads(self.ctl(server, "query", "hash"))

    def checkpoint(self, server):
        """Returns the step and the name."""
        found = re.fullmatch(r"applied at step (\d+), checkpoint (\S+)\n", self.ctl(server, "checkpoint"))
        return int(found.group(1)), found.group(2)

    def test_a_killed_server_goes_on(self):
        log = self.at("log.sphl")
        with self.serve("--checkpoint-every", "0.2s", "--log", log) as server:
            self.assertTrue(wait_for(lambda: server.metrics()["spherule_steps", ""] > 20))
            self.ctl(server, "push", "7", "0.5", "0", "1")
            self.ctl(server, "set", "speed", "2")
            saved, _ = self.checkpoint(server)
            self.assertTrue(wait_for(lambda: len(self.checkpoints()) == 3))
            server.end(kill=True)
        begun = time.monotonic()
        with self.serve("--checkpoint-every", "1000s", "--log", log) as server:
            self.assertGreaterEqual(int(self.query(server)["step"]), saved)
            self.ctl(server, "pause")
            state = self.query(server)
            metrics = server.metrics()
            self.assertLess(metrics["spherule_checkpoint_age_seconds", ""], time.monotonic() - begun)
            self.assertEqual(server.end(), 0, server.said)
        again = call("replay", log, "--device", "cpu", "--json")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(json.loads(again.stdout)["stateHash"], state["stateHash"])
        with self.serve() as server:
            self.assertEqual(self.query(server)["stateHash"], state["stateHash"], "it is still paused")

    def test_a_run_that_goes_on_from_a_server_ends_the_pulls_of_sessions(self):
        log = self.at("log.sphl")
        with self.serve("--checkpoint-every", "1000s", "--log", log, scene="cradle") as server:
            self.ctl(server, "pause")
            controller = Controller(server.port, rate=0)
            pull = controller.send({"pull": {"sphere": 0, "point": [0, 0, 1]}})
            self.assertIn("applied", controller.result(pull))
            step, _ = self.checkpoint(server)
            server.end(kill=True)
        done = run_json("cradle", "--for", f"{step / 60 + 1}s", "--checkpoints", self.kept, "--resume", "--log", log)
        again = call("replay", log, "--device", "cpu", "--json")
        self.assertEqual(again.returncode, 0, again.stderr)
        report = json.loads(again.stdout)
        self.assertEqual((report["commands"], report["stateHash"]), (2, done["stateHash"]))

    def test_a_signal_in_the_midst_of_a_step_waits_for_its_end(self):
        log = self.at("log.sphl")
        arguments = ("--checkpoint-every", "1000s", "--log", log, "--hash-every", "1", "--substeps", "1000")
        with self.serve(*arguments) as server:
            self.assertTrue(wait_for(lambda: server.metrics()["spherule_steps", ""] > 1))
            self.assertEqual(server.end(), 0, server.said)
        saved = int(re.search(r"checkpoint \S+ of step (\d+): ", server.said).group(1))
        again = call("replay", log, "--device", "cpu", "--json")
        self.assertEqual(again.returncode, 0, again.stderr)
        report = json.loads(again.stdout)
        self.assertEqual((report["same"], report["complete"], report["step"]), (True, True, saved))
        with self.serve("--checkpoint-every", "1000s") as server:
            server.end()
        self.assertRegex(server.output, rf"goes on from \S+ with the scene box-4k, at step {saved},")

    def test_a_checkpoint_by_command_is_safe_when_it_is_answered(self):
        with self.serve("--checkpoint-every", "1000s", scene="cradle") as server:
            self.ctl(server, "pause")
            state = self.query(server)
            _, name = self.checkpoint(server)
            self.assertEqual(self.checkpoints(), [self.kept + "/" + name])
            metrics = server.metrics()
            self.assertEqual(metrics["spherule_checkpoints_total", ""], 1)
            self.assertEqual(metrics["spherule_checkpoint_bytes", ""], os.path.getsize(self.kept + "/" + name))
            server.end(kill=True)
        with self.serve(scene="cradle") as server:
            self.assertEqual(self.query(server)["stateHash"], state["stateHash"])

    def test_a_checkpoint_ends_a_step_in_which_the_world_is_paused(self):
        with self.serve("--checkpoint-every", "1000s", "--substeps", "3000", scene="box-10k") as server:
            self.ctl(server, "pause")
            self.checkpoint(server)
            self.assertEqual(len(self.checkpoints()), 1)

    def test_entries_are_on_the_disk_a_second_after_they_were_made(self):
        log = self.at("log.sphl")
        with Server(BINARY, "serve", "cradle", "--device", "cpu", "--log", log, "--hash-every", "0", "--recordings",
                    "") as server:
            self.ctl(server, "pause")
            self.assertTrue(wait_for(lambda: os.path.getsize(log) > 100))  # the state at the beginning
            size = os.path.getsize(log)
            self.ctl(server, "push", "0", "0.1", "0", "0")
            self.assertTrue(wait_for(lambda: os.path.getsize(log) > size))
            server.end(kill=True)
        done = call("replay", log, "--device", "cpu", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["commands"], 1)

    def test_a_paused_server_writes_nothing_anew(self):
        with self.serve("--checkpoint-every", "0.1s", scene="cradle") as server:
            self.ctl(server, "pause")
            self.checkpoint(server)
            written = server.metrics()["spherule_checkpoints_total", ""]
            time.sleep(0.5)
            self.assertEqual(server.metrics()["spherule_checkpoints_total", ""], written)

    def test_the_script_of_a_run_goes_on_after_a_server(self):
        early = self.write("early.txt", "0.1 push 0 0.1 0 0\n")
        script = self.write("commands.txt", "0.1 push 0 0.1 0 0\n0.7 push 1 0.1 0 0\n")
        log = self.at("log.sphl")
        run_json("cradle", "--for", "0.5s", "--script", early, "--checkpoints", self.kept)
        with self.serve("--checkpoint-every", "1000s", scene="cradle") as server:
            self.assertTrue(wait_for(lambda: server.metrics()["spherule_steps", ""] > 31))
            self.assertEqual(server.end(), 0, server.said)
        step = server.last_checkpoint()
        self.assertGreater(step, server.went_on_from())
        run_json("cradle", "--for", f"{step / 60 + 1}s", "--script", script, "--checkpoints", self.kept, "--resume", "--log",
                 log)
        again = call("replay", log, "--device", "cpu", "--json")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(json.loads(again.stdout)["commands"], 1)

    def test_a_new_world_replaces_the_checkpoints_at_once(self):
        with self.serve("--checkpoint-every", "1000s", scene="cradle") as server:
            self.assertEqual(server.end(), 0, server.said)
        with Server(BINARY, "serve", "bounce", "--device", "cpu", "--checkpoints", self.kept, "--checkpoint-every", "1000s",
                    "--recordings", "") as server:
            self.assertTrue(wait_for(lambda: server.metrics()["spherule_checkpoints_total", ""] == 1))
            server.end(kill=True)
        with self.serve(scene="bounce") as server:
            server.end()
        self.assertRegex(server.output, r"goes on from \S+ with the scene bounce,")

    def test_the_end_writes_a_checkpoint(self):
        with self.serve("--checkpoint-every", "1000s", scene="cradle") as server:
            self.assertEqual(server.end(), 0, server.said)
        self.assertEqual(len(self.checkpoints()), 1)

    def test_the_folder_is_for_one_server(self):
        with self.serve(scene="cradle"):
            done = call("serve", "cradle", "--device", "cpu", "--listen", "127.0.0.1:0", "--checkpoints", self.kept)
        self.assertEqual(done.returncode, 2)
        self.assertIn(f"{self.kept}: is used by another program", done.stderr)

    def test_failures_are_counted_and_told(self):
        with self.serve("--checkpoint-every", "0.2s") as server:
            self.assertTrue(wait_for(self.checkpoints))
            subprocess.run(["rm", "-r", self.kept], check=True)
            self.assertTrue(wait_for(lambda: server.metrics()["spherule_checkpoint_failures_total", ""] > 0))
            done = call("ctl", server.stream, "checkpoint")
            self.assertEqual(done.returncode, 4, done.stdout)
            self.assertIn("cannot be written: No such file or directory", done.stderr)
            os.mkdir(self.kept)
            self.ctl(server, "checkpoint")
        self.assertTrue(self.checkpoints())

    def test_without_a_folder_it_is_refused(self):
        with Server(BINARY, "serve", "cradle", "--device", "cpu", "--recordings", "") as server:
            done = call("ctl", server.stream, "checkpoint")
            self.assertEqual(done.returncode, 4)
            self.assertIn("this server writes no checkpoints: start it with --checkpoints FOLDER", done.stderr)


if __name__ == "__main__":
    unittest.main()
