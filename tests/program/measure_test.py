#!/usr/bin/env python3
"""Tests `spherule measure`, and that measured errors keep within bounds: measure_test.py BINARY."""
import csv
import json
import math
import os
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

from program import runner

BINARY = sys.argv.pop()
LONGEST = 250  # s; it should take 50 s on two free processors
MODELS = {"fast", "balanced", "accurate"}
ONLY_ACCURATE = ("Chung & Ooi 1, glass", "Chung & Ooi 1, limestone", "Chung & Ooi 2, aluminium",
                 "Chung & Ooi 2, magnesium")
CASES = {"projectile", "bounce", "head-on", "oblique", "Chung & Ooi 3", "Chung & Ooi 4", "slip to roll", "incline",
         "rolling resistance", "cradle, gaps of 1 %", "cradle, touching", "elastic gas", "stack of five", "bed"}

# (case, beginning of the figure, model or "" for all): the largest error, with the substeps that the model chooses. It
# is two to three times the measured error, or a requirement.
BOUNDS = {
    ("projectile", "distance", "fast"): 1e-5,
    ("projectile", "distance", "balanced"): 2e-5,
    ("projectile", "distance", "accurate"): 5e-4,
    ("bounce", "apex", "fast"): 1e-4,
    ("bounce", "apex", "balanced"): 1e-4,
    ("bounce", "apex", "accurate"): 0.03,
    ("bounce", "time", "fast"): 0.02,
    ("bounce", "time", "balanced"): 0.004,
    ("bounce", "time", "accurate"): 0.01,
    ("head-on", "restitution", ""): 0.001,
    ("oblique", "restitution", "fast"): 0.001,
    ("oblique", "restitution", "balanced"): 0.001,
    # Soft spheres rotate around each other while they touch, for a long time at restitution 0.
    ("oblique", "restitution 0.", "accurate"): 0.012,
    ("oblique", "restitution 1", "accurate"): 0.005,
    ("head-on", "momentum", ""): 1e-5,
    ("oblique", "momentum", ""): 1e-5,
    ("Chung & Ooi 1, glass", "", "accurate"): 0.01,
    ("Chung & Ooi 1, limestone", "", "accurate"): 0.01,
    ("Chung & Ooi 2, aluminium", "", "accurate"): 0.01,
    ("Chung & Ooi 2, magnesium", "", "accurate"): 0.01,
    ("Chung & Ooi 3", "restitution", "fast"): 1e-5,
    ("Chung & Ooi 3", "restitution", "balanced"): 1e-5,
    ("Chung & Ooi 3", "restitution", "accurate"): 0.001,
    ("Chung & Ooi 4", "tangential", ""): 0.016,
    ("Chung & Ooi 4", "spin", ""): 0.022,
    ("Chung & Ooi 4", "rebound", ""): 0.025,
    ("slip to roll", "", "fast"): 0.1,
    ("slip to roll", "", "balanced"): 0.03,
    ("slip to roll", "", "accurate"): 0.003,
    ("incline", "acceleration", ""): 0.003,
    ("rolling resistance", "slowing", ""): 0.005,
    ("cradle, gaps of 1 %", "speed of the last", ""): 0.01,
    ("elastic gas", "momentum", ""): 1e-6,
    ("elastic gas", "energy", ""): 0.001,
    ("stack of five", "force", "balanced"): 0.01,
    ("stack of five", "force", "accurate"): 0.01,
    ("stack of five", "sinking", "balanced"): 0.02,
    ("stack of five", "sinking", "accurate"): 0.03,
    ("bed", "overlap, mean", "fast"): 0.5,
    ("bed", "overlap, mean", "balanced"): 0.01,
    ("bed", "overlap, mean", "accurate"): 0.005,
    ("bed", "force", ""): 0.02,
}


call = runner(BINARY, "measure", timeout=LONGEST)


class Refusals(unittest.TestCase):
    def test_without_a_folder_it_says_so(self):
        done = call("--quick")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--out is required", done.stderr)

    def test_a_folder_that_cannot_be_written_is_refused_before_anything_runs(self):
        for folder, name in (("/proc/measured", "/proc/measured"), (f"{BINARY}/inside", "inside")):
            done = call("--quick", "--out", folder)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(name, done.stderr)
        self.assertEqual(call("--suite", "beauty", "--out", "/tmp").returncode, 2)


class Accuracy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            began = time.monotonic()
            cls.done = call("--quick", "--suite", "accuracy", "--device", "cpu", "--out", folder)
            cls.seconds = time.monotonic() - began
            cls.files = {}
            for name in os.listdir(folder):
                with open(os.path.join(folder, name), encoding="utf-8", newline="") as file:
                    cls.files[name] = file.read()
        cls.rows = list(csv.DictReader(cls.files["measure.csv"].splitlines()))

    def test_it_succeeds_in_time_and_tells_how_far_it_is(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        self.assertLess(self.seconds, LONGEST)
        self.assertIn("accuracy: bounce, balanced x1", self.done.stderr)

    def test_every_model_has_every_case(self):
        for model in MODELS:
            expected = CASES | set(ONLY_ACCURATE if model == "accurate" else ())
            self.assertEqual({row["case"] for row in self.rows if row["model"] == model}, expected, model)

    def test_everything_was_measured(self):
        self.assertEqual([row for row in self.rows if row["verdict"]], [])
        for row in self.rows:
            self.assertTrue(math.isfinite(float(row["value"])), row)

    def test_every_bound_holds(self):
        for (case, figure, model), most in BOUNDS.items():
            rows = [row for row in self.rows if row["case"] == case and row["figure"].startswith(figure)
                    and row["factor"] == "1" and model in ("", row["model"]) and row["error"]]
            with self.subTest(case=case, figure=figure, model=model):
                self.assertTrue(rows)
                worst = max(rows, key=lambda row: float(row["error"]))
                self.assertLessEqual(float(worst["error"]), most, f"{worst['figure']}, {worst['model']}")

    def overlap(self, model, factor):
        return next(float(row["error"]) for row in self.rows if row["case"] == "bed" and row["model"] == model
                    and row["figure"] == "overlap, mean" and row["factor"] == factor)

    def test_accurate_gets_better_with_more_substeps(self):
        self.assertGreater(self.overlap("accurate", "0.5"), 2 * self.overlap("accurate", "1"))
        self.assertGreater(self.overlap("accurate", "1"), 2 * self.overlap("accurate", "2"))

    def test_balanced_gets_better_with_more_substeps_down_to_its_slop(self):
        slop = 0.001  # the overlap that contacts keep, over the radius
        coarse, middle, fine = (self.overlap("balanced", factor) for factor in ("0.5", "1", "2"))
        self.assertGreater(coarse, 2 * middle)
        self.assertGreater(middle, fine)
        self.assertLess(middle, 2 * slop)
        self.assertLess(fine, slop)

    def test_every_file_can_be_read(self):
        plots = {"bed-overlap.svg", "bounce-apex.svg", "restitution.svg", "slip-to-roll.svg"}
        self.assertEqual(set(self.files), plots | {"measure.csv", "measure.md", "measure.json"})
        for plot in plots:
            root = xml.etree.ElementTree.fromstring(self.files[plot])
            lines = root.findall("{http://www.w3.org/2000/svg}path")
            self.assertEqual(len(lines), len(MODELS), plot)
        summary = json.loads(self.files["measure.json"])
        self.assertEqual(set(summary["models"]), MODELS)
        for model, rungs in summary["models"].items():
            self.assertEqual([rung["factor"] for rung in rungs], [0.5, 1, 2], model)
            for rung in rungs:
                self.assertEqual(len(rung["curves"]), len(plots))
        self.assertIn("spherule measure --suite accuracy --quick --device cpu", self.files["measure.md"])
        self.assertIn(self.rows[0]["renderer"], self.files["measure.md"])


if __name__ == "__main__":
    unittest.main()
