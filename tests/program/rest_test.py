#!/usr/bin/env python3
"""Tests that beds with friction come to rest and do not move again: rest_test.py BINARY."""
import json
import os
import random
import subprocess
import sys
import tempfile
import unittest

BINARY = sys.argv.pop()
RADIUS = 0.05  # m
PITCH = 2.5 * RADIUS
ACROSS = 6
LAYERS = 28
BEDS = 6


def write_bed(folder, seed):
    """Writes a scene with a jittered lattice in an open box; returns its path and its number of spheres."""
    rng = random.Random(seed)
    width = ACROSS * PITCH

    def place(index):
        return (index + 0.5) * PITCH + rng.uniform(-0.2, 0.2) * RADIUS
    spheres = [{"position": [place(i), place(j), place(k)]}
               for k in range(LAYERS) for j in range(ACROSS) for i in range(ACROSS)]
    scene = {"bounds": {"min": [0, 0, 0], "max": [width, width, 4], "open": ["Z_MAX"]},
             "gravity": [0, 0, -9.81],
             "materials": [{"restitution": 0.5, "friction": 0.3}],
             "groups": [{"radius": {"constant": RADIUS}, "list": {"spheres": spheres}}]}
    path = os.path.join(folder, "bed.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene, file)
    return path, len(spheres)


def reports_of(seed):
    """Returns the number of spheres and a report after each 10 s."""
    with tempfile.TemporaryDirectory() as folder:
        path, count = write_bed(folder, seed)
        done = subprocess.run([BINARY, "run", path, "--device", "cpu", "--for", "70s", "--every", "10s", "--json"],
                              capture_output=True, text=True, timeout=250, check=True)
    return count, [json.loads(line) for line in done.stdout.splitlines()]


class Rest(unittest.TestCase):
    def test_after_ten_seconds_all_sleep_and_a_minute_later_no_bit_has_changed(self):
        """Without spinning resistance, a loose sphere may spin on the floor for long, and roll about. One bed of six may
        have one: of 12 beds, one had it, at 2.1 mm/s."""
        still = 0
        for seed in range(1, BEDS + 1):
            with self.subTest(seed=seed):
                count, reports = reports_of(seed)
                self.assertEqual(len(reports), 7)
                self.assertLess(reports[0]["speedMax"], 5e-3)
                self.assertLess(reports[-1]["speedMax"], 1e-3)
                self.assertGreaterEqual(reports[0]["sleeping"], count - 1)
                self.assertLess(reports[0]["overlapMean"], 0.02)
                if reports[0]["sleeping"] == count:
                    self.assertEqual({report["stateHash"] for report in reports}, {reports[0]["stateHash"]})
                    still += 1
        self.assertGreaterEqual(still, BEDS - 1)


if __name__ == "__main__":
    unittest.main()
