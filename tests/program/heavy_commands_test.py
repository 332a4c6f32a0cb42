"""Tests commands and scenes that take long: meanwhile the server answers other commands, and can be stopped."""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
import unittest

from serving import Server
from viewer import Viewer

BINARY = sys.argv.pop(1)


class Controller(Viewer):
    """Sends commands as JSON, and keeps the order of the answers."""

    def __init__(self, port, rate=0):
        super().__init__(port, rate)
        self._last = 0

    def give(self, command):
        self._last += 1
        self._send(0x1, json.dumps({"command": {"id": self._last, **command}}).encode())
        return self._last

    def answers(self):
        return [result["id"] for result in self.of("result")]

    def answer(self, number):
        self.wait(lambda viewer: str(number) in viewer.answers())
        return next(result for result in self.of("result") if result["id"] == str(number))

    def ask(self, command):
        """Returns the answer and its delay (s)."""
        began = time.monotonic()
        answer = self.answer(self.give(command))
        return answer, time.monotonic() - began


def scene(groups, bounds=1.0, **more):
    return {"load": {"scene": {"name": "heavy", "bounds": {"min": [-bounds] * 3, "max": [bounds] * 3}, "groups": groups,
                               **more}}}


CROWD = scene([{"radius": {"constant": 0.01},
                "lattice": {"min": [-0.1] * 3, "max": [0.1] * 3, "spacing": 1e-7, "count": 100000}}])
PACKED = scene([{"radius": {"constant": 0.005}, "fill": {"min": [-1] * 3, "max": [1] * 3, "count": 5650000}}])
BOXES = scene([{"radius": {"constant": 0.004},
                "lattice": {"min": [-1, -1, -0.5], "max": [1, 1, 1], "spacing": 0.012, "count": 30000}}],
              obstacles=[{"box": {"min": [-1 + 0.002 * k, -1, -1], "max": [-0.999 + 0.002 * k, 1, -0.9]}}
                         for k in range(1000)])
# Each case is sent to a running simulation of 4,000 spheres.
CASES = {
    "the most substeps": [{"set": {"substeps": "most"}}],
    "the largest push": [{"push": {"sphere": 0, "impulse": ["most", 0, 0]}}],
    "the largest push in accurate": [{"set": {"model": "ACCURATE"}}, {"push": {"sphere": 0, "impulse": ["most", 0, 0]}}],
    "30,000 spheres and 1,000 boxes": [BOXES],
    "100,000 spheres in one point": [CROWD],
    "a fill of 0.37 of the volume": [PACKED],
}


def largest(controller, command):
    """Returns the command with the largest accepted value, which the refusal of a larger one gives."""
    kind = next(iter(command))
    tried = json.loads(json.dumps(command).replace('"most"', "1e9" if kind == "push" else "1000000"))
    answer, _ = controller.ask(tried)
    words = answer["refused"]["reason"]
    value = words.split("at most ")[-1].split()[0] if kind == "push" else words.split("1 to ")[1].split()[0]
    number = 0.999 * float(value) if kind == "push" else int(value)
    return json.loads(json.dumps(command).replace('"most"', repr(number)))


class HeavyCommands(unittest.TestCase):
    def test_others_are_answered_meanwhile_and_the_server_ends(self):
        for name, commands in CASES.items():
            with self.subTest(name), Server(BINARY, "serve", "box-4k", "--device", "cpu:1") as server:
                viewer = Viewer(server.port, 20)
                controller = Controller(server.port)
                heavy = None
                for command in commands:
                    if heavy is not None:
                        self.assertIn("applied", controller.answer(heavy))
                    if "most" in json.dumps(command)[:200]:
                        command = largest(controller, command)
                    heavy = controller.give(command)
                times = []
                for _ in range(5):
                    for light in ({"pause": {}}, {"resume": {}}, {"query": {}}):
                        answer, took = controller.ask(light)
                        self.assertIn("applied", answer, answer)
                        times.append(took)
                health = server.get("/healthz")
                self.assertTrue(health.startswith("alive"), health)
                # The cancel ends a pending command. A command that was done before it is not refused.
                cancelled, took = controller.ask({"cancel": {}})
                times.append(took)
                outcome = controller.answer(heavy)
                if "applied" in cancelled:
                    self.assertEqual(outcome["refused"]["reason"], "cancelled")
                else:
                    self.assertIn("applied", outcome)
                answer, took = controller.ask({"load": {"name": "cradle"}})
                times.append(took)
                self.assertIn("applied", answer, answer)
                viewer.wait(lambda one: any(facts["name"] == "cradle" for facts in one.of("scene")))
                if "load" in commands[-1]:
                    controller.give(commands[-1])
                began = time.monotonic()
                self.assertEqual(server.end(), 0, server.said)
                print(f"{name}: median {statistics.median(times):.3f} s, longest {max(times):.3f} s; "
                      f"SIGTERM {time.monotonic() - began:.2f} s", file=sys.stderr)

    def test_ctl_waits_for_a_load_as_long_as_that_progresses(self):
        with Server(BINARY, "serve", "box-4k", "--device", "cpu:1") as server, tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "packed.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(PACKED["load"]["scene"], file)
            controller = Controller(server.port)
            ctl = subprocess.Popen([BINARY, "ctl", "--timeout", "4", server.stream, "load", path], stderr=subprocess.PIPE,
                                   text=True)
            # Progress is sent five times a second, so 24 different shares take longer than the timeout of ctl.
            controller.wait(lambda one: len({change.get("share") for change in one.of("change")}) > 24)
            self.assertIsNone(ctl.poll())
            controller.ask({"cancel": {}})
            self.assertEqual(ctl.communicate(timeout=30)[1], "refused: cancelled\n")
            self.assertEqual(ctl.returncode, 4)

    def test_what_a_world_cannot_bear_is_refused_with_the_most_that_it_can(self):
        with Server(BINARY, "serve", "box-4k", "--device", "cpu:1") as server:
            controller = Controller(server.port)
            for command in ({"set": {"substeps": "most"}}, {"push": {"sphere": 0, "impulse": ["most", 0, 0]}}):
                answer, _ = controller.ask(largest(controller, command))
                self.assertIn("applied", answer, answer)
            obstacles = [{"box": {"min": [-1, -1, -1], "max": [1, 1, -0.9]}}] * 1000
            many = scene([{"radius": {"constant": 0.001}, "lattice": {"min": [-1, -1, -0.8], "max": [1, 1, 1], "spacing": 0.01,
                                                                      "count": 1000000}}], obstacles=obstacles)
            answer, _ = controller.ask(many)
            self.assertIn("obstacles", answer["refused"]["reason"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
