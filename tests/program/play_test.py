#!/usr/bin/env python3
"""Tests playback, and recording by a server: play_test.py BINARY LOAD_CLIENT."""
import json
import os
import resource
import subprocess
import sys
import time
import unittest

from program import FolderTestCase, runner, wait_for
from serving import Server

CLIENT = sys.argv.pop()
BINARY = sys.argv.pop()


call = runner(BINARY)


def tell(server, *words):
    return call("ctl", server.stream, *words)


class RecordingTestCase(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.recording = self.at("a.sph")

    def length_of(self, recording):
        """Returns the first and the last time (s), and the message about the end of the recording."""
        done = call("export", recording, "--format", "csv", "--out", self.at("out.csv"), "--force")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.at("out.csv"), encoding="utf-8") as file:
            times = [float(line.split(",", 1)[0]) for line in file.readlines()[1:]]
        return times[0], times[-1], done.stderr

    def serve(self, *options, **more):
        return Server(BINARY, "serve", *options, "--device", "cpu:1", cwd=self.folder, **more)


class Play(RecordingTestCase):
    def setUp(self):
        super().setUp()
        done = call("run", "two-spheres", "--for", "4s", "--device", "cpu", "--record", self.recording)
        self.assertEqual(done.returncode, 0, done.stderr)

    def step_of(self, server):
        return json.loads(server.get("/readyz"))["steps"]

    def test_commands_say_where_it_is(self):
        with Server(BINARY, "play", self.recording, "--paused") as server:
            def at(step):
                return wait_for(lambda: self.step_of(server) == step)
            self.assertTrue(at(0))
            self.assertEqual(tell(server, "seek", "2").returncode, 0)
            self.assertTrue(at(120))
            self.assertEqual(tell(server, "step", "3").returncode, 0)
            self.assertTrue(at(126))
            self.assertEqual(tell(server, "reset").returncode, 0)
            self.assertTrue(at(0))
            self.assertEqual(tell(server, "set", "speed", "100").returncode, 0)
            self.assertEqual(tell(server, "resume").returncode, 0)
            self.assertTrue(at(240))
            self.assertTrue(wait_for(lambda: json.loads(server.get("/readyz"))["state"] == "paused"))
            for words, said in ((["set", "gravity", "0", "0", "1"], "only its speed can be set"),
                                (["load", "box"], "nothing in it can be changed"), (["record"], "nothing in it can be")):
                done = tell(server, *words)
                self.assertEqual(done.returncode, 4)
                self.assertIn(said, done.stdout + done.stderr)
            self.assertEqual(server.end(), 0)
            self.assertIn("spherule plays", "".join(server.greeting))

    def test_viewers_of_any_tier_and_rate_find_no_fault(self):
        with Server(BINARY, "play", self.recording, "--loop", "--speed", "3") as server:
            for tier, rate in ("fine", 60), ("normal", 20), ("eco", 5):
                done = subprocess.run([CLIENT, server.stream, "--viewers", "3", "--decode", "3", "--tier", tier,
                                       "--rate", str(rate), "--seconds", "2"], capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_what_cannot_be_played_is_said(self):
        for arguments, said in (([self.at("none.sph")], "there is no such file"),
                                ([__file__], "is no recording"),
                                ([self.recording, "--speed", "0"], "--speed: is 0, must be within"),
                                ([self.recording, "--listen", "nowhere"], "nowhere"), ([], "file is required")):
            done = call("play", *arguments)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(said, done.stderr)

    def test_a_cut_recording_plays_up_to_the_cut_and_says_so(self):
        with open(self.recording, "r+b") as file:
            file.truncate(os.path.getsize(self.recording) // 2)
        with Server(BINARY, "play", self.recording, "--speed", "100") as server:
            self.assertTrue(wait_for(lambda: json.loads(server.get("/readyz"))["state"] == "paused"))
            self.assertGreater(self.step_of(server), 50)
            server.end()
            self.assertRegex(server.said + "".join(server.greeting), r"a.sph is played up to [0-9.]+ s: the record at byte")


class Record(RecordingTestCase):
    def recorded(self, server):
        return server.metrics()["spherule_recording_bytes", ""]

    def test_serve_records_from_its_beginning_until_it_is_stopped(self):
        with self.serve("two-spheres", "--record", self.recording) as server:
            time.sleep(2)
            self.assertEqual(server.end(), 0)
            self.assertRegex(server.said, r"recorded [0-9.]+ s in \S*a\.sph, [0-9.]+ MB")
        begin, end, said = self.length_of(self.recording)
        self.assertLess(begin, 0.5)
        self.assertGreater(end, 1.2)
        self.assertNotIn("up to", said)

    def test_a_server_that_is_killed_leaves_what_it_had_about_a_second_before(self):
        with self.serve("two-spheres", "--record", self.recording) as server:
            self.assertTrue(wait_for(lambda: server.metrics()["spherule_simulated_seconds", ""] > 4))
            server.end(kill=True)
        begin, end, said = self.length_of(self.recording)
        self.assertGreater(end - begin, 1.5)
        self.assertRegex(said, "it was not finished|is cut off")

    def test_viewers_start_and_stop_recordings_and_nothing_moves_back_in_them(self):
        with self.serve("two-spheres") as server:
            self.assertIn("nothing is being recorded", tell(server, "record", "stop").stderr)
            self.assertEqual(tell(server, "record").returncode, 0)
            self.assertIn("already", tell(server, "record").stderr)
            time.sleep(1)
            self.assertEqual(tell(server, "reset").returncode, 0)
            time.sleep(1)
            self.assertEqual(tell(server, "load", "cradle").returncode, 0)
            time.sleep(1)
            self.assertEqual(tell(server, "record", "stop").returncode, 0)
            self.assertTrue(wait_for(lambda: server.metrics()["spherule_recording_active", ""] == 0))
            self.assertIn("no other time than now", tell(server, "seek", "1").stderr)
            server.end()
        made = os.listdir(self.at("recordings"))
        self.assertEqual(len(made), 1)
        self.assertRegex(made[0], r"^two-spheres-\d{8}-\d{6}\.sph$")
        begin, end, said = self.length_of(os.path.join(self.at("recordings"), made[0]))
        self.assertGreater(end - begin, 2)
        self.assertNotIn("up to", said)

    def test_a_full_disk_ends_the_recording_and_nothing_else(self):
        def little_room():
            resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, 300_000))
        with self.serve("box", "--record", self.recording, preexec_fn=little_room) as server:
            def has_ended():
                seen = server.metrics()
                return seen["spherule_recording_bytes", ""] > 0 and seen["spherule_recording_active", ""] == 0
            self.assertTrue(wait_for(has_ended, 60))
            steps = server.metrics()["spherule_steps", ""]
            self.assertTrue(wait_for(lambda: server.metrics()["spherule_steps", ""] > steps + 10))
            self.assertEqual(server.end(), 0)
            self.assertRegex(server.said, r"The recording \S*a\.sph has ended: writing failed after 300000 bytes: "
                                          r"File too large; raise the limit \(ulimit -f\) or write less; what has been "
                                          r"written stays as it is\.")
        self.assertIn("is cut off", self.length_of(self.recording)[2])

    def test_a_stop_before_the_first_frame_is_no_failure(self):
        scene = self.write("empty.json", '{"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}')
        with self.serve(scene, "--record", self.recording) as server:
            self.assertTrue(wait_for(lambda: server.metrics()["spherule_recording_active", ""] == 1))
            self.assertEqual(server.end(), 0, server.said)
            self.assertRegex(server.said, rf"warning {self.recording}: nothing was recorded: no frame has come")
        self.assertFalse(os.path.exists(self.recording))

    def test_where_it_cannot_be_begun_nothing_is_served(self):
        self.write("a.sph", "precious")
        done = call("serve", "two-spheres", "--device", "cpu:1", "--listen", "127.0.0.1:0", "--record", self.recording)
        self.assertEqual(done.returncode, 2)
        self.assertIn("is there already; give --force to replace it", done.stderr)
        other = self.at("b.sph")
        with self.serve("two-spheres", "--record", other) as server:
            self.assertTrue(wait_for(lambda: self.recorded(server) > 0))
            taken = server.stream.split("/")[2]
            done = call("serve", "two-spheres", "--device", "cpu:1", "--listen", taken, "--record", self.recording, "--force")
            self.assertEqual(done.returncode, 4, done.stderr)
        with open(self.recording, encoding="utf-8") as file:
            self.assertEqual(file.read(), "precious")
        done = call("serve", "two-spheres", "--record-rate", "25")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--record-rate", done.stderr)


if __name__ == "__main__":
    unittest.main()
