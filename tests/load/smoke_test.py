#!/usr/bin/env python3
"""Runs the load client with a server and without one: smoke_test.py SERVER CLIENT."""
import sys
import unittest

from program import runner
from serving import Server

CLIENT = sys.argv.pop()
SERVER = sys.argv.pop()


load = runner(CLIENT, timeout=60)


class Smoke(unittest.TestCase):
    def test_five_viewers_of_which_one_stalls_find_no_fault(self):
        with Server(SERVER, "serve", "cradle", "--device", "cpu:1") as server:
            done = load(server.stream, "--viewers", "5", "--stalled", "1", "--decode", "2", "--warm-up", "2",
                        "--seconds", "3", "--server-pid", str(server.pid), "--markdown")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("| healthy | 4 |", done.stdout)
        self.assertIn("| stalled | 1 |", done.stdout)
        self.assertIn("| resident, MiB |", done.stdout)
        self.assertIn("3 of 3 s", done.stderr)

    def test_what_cannot_be_is_refused(self):
        for arguments, said in ((["http://localhost/ws"], "ws://"),
                                (["ws://127.0.0.1:1/ws"], "cannot be reached"),
                                (["ws://127.0.0.1:1/ws", "--viewers", "2", "--stalled", "3"], "3 are stalled"),
                                (["ws://127.0.0.1:1/ws", "--decode", "2"], "1 healthy"),
                                (["ws://127.0.0.1:1/ws", "--tier", "best"], "--tier"),
                                ([], "url")):
            done = load(*arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn(said, done.stderr, arguments)


if __name__ == "__main__":
    unittest.main()
