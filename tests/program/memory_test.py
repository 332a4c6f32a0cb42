#!/usr/bin/env python3
"""Tests that scenes and commands that need too much memory are refused with need and limit: memory_test.py BINARY"""
import json
import os
import subprocess
import sys
import unittest

from program import FolderTestCase, runner
from serving import Server

BINARY = sys.argv.pop()
call = runner(BINARY)


def lattice(spheres, **more):
    spacing = 0.11
    side = spacing * (int(round(spheres ** (1 / 3))) + 2)
    box = {"min": [0, 0, 0], "max": [side, side, side]}
    return {"bounds": box, "quality": {"model": "BALANCED", "substeps": 1}, **more,
            "groups": [{"radius": {"constant": 0.05}, "lattice": {**box, "spacing": spacing, "count": spheres}}]}


class Memory(FolderTestCase):
    def scene(self, spheres, **more):
        return self.write(f"{spheres}.json", json.dumps(lattice(spheres, **more)))

    def refused(self, done, *parts):
        said = done.stdout + done.stderr
        self.assertEqual(done.returncode, 4, said)
        for part in (" more of memory are needed for ", *parts):
            self.assertIn(part, said)

    def test_run_is_refused_before_the_memory_is_taken(self):
        for spheres, what in ((16_000_000, "groups[0].lattice.count: 854 MiB"), (1_000_000, "a scene of 1000000 spheres")):
            command = [BINARY, "run", self.scene(spheres), "--for", "1s", "--device", "cpu:1", "--memory-limit", "300MiB"]
            with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as run:
                said = run.stderr.read()
                _, status, used = os.wait4(run.pid, 0)
                run.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(run.returncode, 4, said)
            for part in (what, " more of memory are needed for ", "--memory-limit allows 300 MiB"):
                self.assertIn(part, said)
            self.assertLess(used.ru_maxrss, 150 << 10, f"KiB: at most the spheres of the smaller; {said}")

    def test_plan_says_it_beforehand(self):
        path = self.scene(200_000)
        plan = json.loads(call("plan", path, "--json").stdout)
        memory = {part["name"]: part["bytes"] for part in plan["memory"]}
        self.assertEqual(memory["device: arrays"], plan["bytes"])
        self.assertEqual(memory["host: scene"], 56 * 200_000)
        together = memory["all, where device and host are one"]
        room = 40 << 20  # memory of the program itself, and a margin
        for limit, code in ((together + 2 * room, 0), (together - room, 4)):
            done = call("run", path, "--for", "0.02s", "--device", "cpu:1", "--memory-limit", str(limit))
            self.assertEqual(done.returncode, code, f"{limit}: {done.stderr}")

    def test_a_load_beside_the_world_that_runs_is_refused_and_that_goes_on(self):
        with Server(BINARY, "serve", self.scene(200_000), "--device", "cpu:1", "--memory-limit", "350MiB") as server:
            done = call("ctl", server.stream, "load", self.scene(270_000))
            self.refused(done, "a scene of 270000 spheres", "--memory-limit allows 350 MiB", "what runs here holds ")
            self.assertEqual(call("ctl", server.stream, "load", "two-spheres").returncode, 0)
            done = call("ctl", server.stream, "load", self.scene(270_000))
            self.assertEqual(done.returncode, 0, f"alone it has room: {done.stderr}")
            self.assertEqual(server.end(), 0)

    def test_a_recording_without_room_is_refused(self):
        folder = os.path.join(self.folder, "recordings")
        with Server(BINARY, "serve", self.scene(300_000), "--device", "cpu:1", "--memory-limit", "350MiB",
                    "--recordings", folder) as server:
            self.refused(call("ctl", server.stream, "record"), "--memory-limit allows 350 MiB")
            self.assertEqual(os.listdir(folder) if os.path.exists(folder) else [], [], "no empty file is left")
            self.assertEqual(server.end(), 0)


if __name__ == "__main__":
    unittest.main()
