#!/usr/bin/env python3
"""Tests the columns of `spherule run --dump` against independent calculations: dump_test.py BINARY"""
import csv
import json
import math
import sys
import unittest

from program import FolderTestCase, json_runner, runner

BINARY = sys.argv.pop()
call = runner(BINARY)
run_json = json_runner(call, "cpu")


class Dump(FolderTestCase):
    def dumped(self, scene, *more):
        """Runs the scene; returns the rows of its dump by column."""
        path = self.at("states.csv")
        run_json(self.write("scene.json", json.dumps(scene)), "--dump", path, "--force", *more)
        with open(path, encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_it_has_its_header_and_a_row_per_sphere_and_state(self):
        path = self.at("states.csv")
        run_json("two-spheres", "--for", "0.2s", "--every", "0.1", "--dump", path)
        with open(path, encoding="utf-8") as file:
            rows = list(csv.reader(file))
        self.assertEqual(rows[0], "time id x y z vx vy vz radius wx wy wz material group asleep contacts".split())
        self.assertEqual(len(rows), 1 + 3 * 2)

    def test_it_has_spin_material_group_and_sleep(self):
        spheres = [{"position": [0, 0, 0.1]}, {"position": [0.5, 0, 0.9], "spin": [1, -2, 3]}]
        scene = {"bounds": {"min": [-1, -1, 0], "max": [1, 1, 1]},
                 "materials": [{"name": "a", "friction": 0.5}, {"name": "b"}],
                 "groups": [{"list": {"spheres": spheres[:1]}, "radius": {"constant": 0.1}},
                            {"list": {}, "radius": {"constant": 0.1}},
                            {"list": {"spheres": spheres[1:]}, "material": "b", "radius": {"constant": 0.1}}]}
        rows = self.dumped(scene, "--for", "2s", "--every", "1s")
        self.assertEqual([[row[name] for name in ("id", "wx", "wy", "wz", "material", "group", "asleep")]
                          for row in rows[:2]],
                         [["0", "0", "0", "0", "0", "0", "0"], ["1", "1", "-2", "3", "1", "2", "0"]])
        self.assertEqual([row["asleep"] for row in rows if row["id"] == "0"], ["0", "1", "1"])
        self.assertEqual([row["contacts"] for row in rows if row["id"] == "0"], ["1", "1", "1"])

    def test_it_has_the_flight_of_a_sphere(self):
        place, velocity, spin, radius = [0.1, -0.2, 0.5], [0.3, 0.2, 1.5], [4, -5, 6], 0.07
        scene = {"bounds": {"min": [-1, -1, 0], "max": [1, 1, 2]}, "gravity": [0.5, 0, -9.81],
                 "materials": [{"friction": 0.5}],
                 "groups": [{"list": {"spheres": [{"position": place, "velocity": velocity, "spin": spin}]},
                             "radius": {"constant": radius}}]}
        for model in "fast", "balanced", "accurate":
            rows = [{name: float(value) for name, value in row.items()}
                    for row in self.dumped(scene, "--for", "0.2s", "--every", "0.1s", "--quality", model)]
            self.assertEqual(len(rows), 3)
            for k, row in enumerate(rows):
                time_now = 0.1 * k
                self.assertAlmostEqual(row["time"], time_now, places=9)
                for axis, name in enumerate("xyz"):
                    pull = scene["gravity"][axis]
                    self.assertAlmostEqual(row["v" + name], velocity[axis] + pull * time_now, delta=5e-5)
                    self.assertAlmostEqual(row[name], place[axis] + velocity[axis] * time_now + pull * time_now ** 2 / 2,
                                           places=5)
                    self.assertAlmostEqual(row["w" + name], spin[axis], places=5)
                self.assertAlmostEqual(row["radius"], radius, places=7)
                self.assertEqual((row["contacts"], row["asleep"]), (0, 0))

    def test_it_has_the_contacts_of_its_own_positions(self):
        scene = {"bounds": {"min": [0, 0, 0], "max": [1, 1, 1], "open": ["Z_MAX"]},
                 "obstacles": [{"plane": {"point": [0, 0, 0.2], "normal": [0.6, 0, 0.8]}}],
                 "groups": [{"fill": {"min": [0.3, 0.1, 0.3], "max": [0.9, 0.9, 0.9], "count": 150},
                             "radius": {"uniform": {"min": 0.03, "max": 0.06}}}]}
        rows = [row for row in self.dumped(scene, "--for", "1s") if float(row["time"]) > 0.5]
        self.assertEqual(len(rows), 150)
        spheres = [[float(row[name]) for name in ("x", "y", "z", "radius")] for row in rows]
        touching = 0
        for a, row in zip(spheres, rows):
            x, y, z, r = a
            # The gaps beyond those up to which bodies count as touching.
            gaps = [gap - 2e-4 * r for gap in (x - r, 1 - x - r, y - r, 1 - y - r, z - r, 0.6 * x + 0.8 * (z - 0.2) - r)]
            gaps += [math.dist(a[:3], b[:3]) - 1.0001 * (r + b[3]) for b in spheres if b is not a]
            if min(map(abs, gaps)) > 1e-6:  # otherwise rounding decides
                self.assertEqual(int(row["contacts"]), sum(gap < 0 for gap in gaps))
                touching += int(row["contacts"])
        self.assertGreater(touching, 150)


if __name__ == "__main__":
    unittest.main()
