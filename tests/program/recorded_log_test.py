#!/usr/bin/env python3
"""Tests recordings that carry a command log: recorded_log_test.py BINARY"""
import json
import os
import sys
import unittest

from program import FolderTestCase, json_runner, runner, wait_for
from serving import Server
from viewer import Controller

BINARY = sys.argv.pop()
call = runner(BINARY)
run_json = json_runner(call, "cpu")


class RecordedLog(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.recording = self.at("run.sph")
        self.script = self.write("commands.txt", "0.1 push 0 0.1 0 0\n0.5 set friction 0.3\n0.6 push 3 0.2 0 0\n")

    def replay(self, file):
        done = call("replay", file, "--device", "cpu", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def rows(self, recording):
        done = call("export", recording, "--format", "csv", "--out", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_a_run_can_be_repeated_from_its_recording(self):
        arguments = ("cradle", "--for", "1s", "--script", self.script, "--hash-every", "6", "--record")
        done = run_json(*arguments, self.recording, "--record-log")
        again = self.replay(self.recording)
        self.assertEqual((again["stateHash"], again["step"]), (done["stateHash"], 60))
        self.assertEqual((again["commands"], again["hashes"], again["same"], again["complete"]), (3, 12, True, True))
        plain = self.at("plain.sph")
        self.assertEqual(run_json(*arguments, plain)["stateHash"], done["stateHash"])
        self.assertEqual(self.rows(self.recording), self.rows(plain))
        refused = call("replay", plain, "--device", "cpu")
        self.assertEqual(refused.returncode, 2)
        self.assertIn(f"{plain}: carries no command log: it was recorded without --record-log", refused.stderr)

    def test_a_recording_can_be_compared_with_a_log(self):
        log = self.at("run.sphl")
        run_json("cradle", "--for", "1s", "--script", self.script, "--log", log, "--record", self.recording,
                 "--record-log")
        done = call("compare", self.recording, log, "--device", "cpu")
        self.assertEqual((done.returncode, done.stdout), (0, "the runs are equal\n"))

    def test_a_recording_that_is_cut_off_is_carried_out_up_to_the_cut(self):
        run_json("cradle", "--for", "1s", "--hash-every", "1", "--record", self.recording, "--record-log")
        with open(self.recording, "rb") as file:
            content = file.read()
        with open(self.recording, "wb") as file:
            file.write(content[:len(content) * 9 // 10])
        done = call("replay", self.recording, "--device", "cpu")
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertRegex(done.stderr, r"was carried out up to step \d\d: 0 commands, \d\d hashes are equal")
        self.assertRegex(done.stderr, r"run.sph: the record at byte \d+ is cut off")

    def test_a_part_of_a_run_of_a_server_can_be_repeated(self):
        folder = self.at("recordings")
        with Server(BINARY, "serve", "box-4k", "--device", "cpu", "--hash-every", "5", "--recordings", folder,
                    "--record-log") as server:
            controller = Controller(server.port, rate=20)

            def send(command):
                self.assertIn("applied", controller.result(controller.send(command)))

            def frames(count):
                seen = len(controller.of("frame"))
                controller.wait(lambda one: len(one.of("frame")) >= seen + count)

            send({"push": {"sphere": 4, "impulse": [0.1, 0, 0]}})
            for k in range(2):
                send({"startRecording": {}})
                for sphere in range(8):
                    send({"push": {"sphere": sphere, "impulse": [0.2, 0.1, 0.5]}})
                    frames(2)
                if k == 1:
                    send({"load": {"name": "cradle"}})
                    frames(5)
                send({"stopRecording": {}})
                controller.wait(lambda one, k=k: sum(not state.get("active") for state in one.of("recording")) > k)
            self.assertEqual(server.end(), 0, server.said)
        files = sorted(os.listdir(folder))
        self.assertEqual(len(files), 2)
        for name in files:
            again = self.replay(os.path.join(folder, name))
            self.assertTrue(again["same"] and again["complete"], again)
            self.assertGreaterEqual(again["commands"], 8)
            self.assertGreaterEqual(again["hashes"], 3)

    def test_a_server_that_records_from_its_start_has_the_log_of_its_whole_run(self):
        with Server(BINARY, "serve", "box-4k", "--device", "cpu", "--record", self.recording, "--record-log",
                    "--log", self.at("run.sphl")) as server:
            self.assertTrue(wait_for(lambda: server.metrics()["spherule_steps", ""] > 20))
            self.assertEqual(server.end(), 0, server.said)
        one, other = self.replay(self.recording), self.replay(self.at("run.sphl"))
        self.assertGreater(one["steps"], 10)
        self.assertTrue(one["complete"] and other["complete"])
        self.assertLessEqual(one["steps"], other["steps"])


if __name__ == "__main__":
    unittest.main()
