#!/usr/bin/env python3
"""Tests of beside.py: its arithmetic, its beds, and a race of a program with itself: beside_test.py STEPPER."""
import array
import json
import pathlib
import subprocess
import sys
import unittest

from program import FolderTestCase, runner

STEPPER = pathlib.Path(sys.argv.pop())
SCRIPT = pathlib.Path(__file__).with_name("beside.py")
sys.path.insert(0, str(SCRIPT.parent))
import beside  # noqa: E402


def blocks(*seconds, simulated=0.5, substeps=240):
    return [{"wall": value, "processor": 2 * value, "simulated": simulated, "substeps": substeps} for value in seconds]


class Arithmetic(unittest.TestCase):
    def test_ratios_are_taken_pair_by_pair(self):
        # The machine is three times as slow in the last pair, which changes no ratio.
        both = {"old": blocks(2, 4, 12), "new": blocks(1, 2, 6)}
        self.assertEqual(beside.compared(both, "wall"), {"median": 2, "low": 2, "high": 2})
        self.assertEqual(beside.compared({"old": blocks(1, 2, 3, 4, 5), "new": blocks(1, 1, 1, 1, 1)}, "wall"),
                         {"median": 3, "low": 2, "high": 4})

    def test_ratios_are_above_one_where_the_new_side_is_faster(self):
        self.assertEqual(beside.compared({"old": blocks(3), "new": blocks(2)}, "processor")["median"], 1.5)

    def test_a_side_with_more_substeps_is_compared_by_simulated_time(self):
        both = {"old": blocks(1, simulated=0.5), "new": blocks(1, simulated=0.25)}
        self.assertEqual(beside.compared(both, "wall")["median"], 0.5)

    def test_sides_with_unequal_numbers_of_blocks_are_refused(self):
        with self.assertRaises(ValueError):
            beside.compared({"old": blocks(1, 2), "new": blocks(1)}, "wall")

    def test_gains_compare_threads_and_then_sides(self):
        gains = beside.gains({"old": blocks(4, 8), "new": blocks(3, 6)}, {"old": blocks(2, 4), "new": blocks(2, 4)})
        self.assertEqual(gains["old"]["median"], 2)
        self.assertEqual(gains["new"]["median"], 1.5)
        self.assertEqual(gains["new over old"]["median"], 0.75)

    def test_times_per_substep_are_medians_in_milliseconds(self):
        self.assertEqual(beside.milliseconds(blocks(0.12, 0.24, 9), "wall"), 1)
        self.assertEqual(beside.milliseconds(blocks(0.12, 0.24, 9), "processor"), 2)


class Beds(unittest.TestCase):
    def test_names_give_beds(self):
        self.assertEqual(beside.bed_of("settled-10k"), beside.Bed("settled-10k", False, 10_000, (1, 1)))
        self.assertEqual(beside.bed_of("falling-1m"), beside.Bed("falling-1m", True, 1_000_000, (1, 1)))
        self.assertEqual(beside.bed_of("settled-1m").tiles, (5, 4))
        self.assertEqual(beside.bed_of("settled-350k").tiles, (7, 1))
        for name in ("settled", "sliding-10k", "settled-10x", "settled-60k"):
            with self.assertRaises(ValueError, msg=name):
                beside.bed_of(name)

    def test_blocks_of_a_fall_divide_it(self):
        bed = beside.bed_of("falling-10k")
        self.assertEqual(bed.block * beside.BLOCKS_OF_FALL, beside.FALL_END - beside.FALL_BEGIN)
        self.assertEqual([bed.rounded(count) for count in (1, 6, 7)], [6, 6, 12])
        self.assertEqual(beside.bed_of("settled-10k").rounded(7), 7)
        for name in ("settled-10k", "settled-50k", "settled-1m", "falling-10k"):
            self.assertEqual(beside.bed_of(name).block % beside.SUBSTEPS, 0, name)

    def test_tiles_fill_the_box_side_by_side(self):
        columns = [-0.5, -0.5, 3, 0.05, 0.5, 0.5, 3, 0.05, *range(8), *range(8, 16)]  # two spheres in a tile of 1 m
        whole = array.array("f")
        whole.frombytes(beside.tiled(array.array("f", columns).tobytes(), (2, 1), 1))
        self.assertEqual(len(whole), 2 * len(columns))
        self.assertEqual(whole[0:16:4].tolist(), [-1, 0, 0, 1])
        self.assertEqual(whole[1:16:4].tolist(), [-0.5, 0.5, -0.5, 0.5])
        self.assertEqual(whole[2:16:4].tolist(), [3, 3, 3, 3])
        self.assertEqual(whole[16:32].tolist(), [*range(8), *range(8)])
        self.assertEqual(whole[32:].tolist(), [*range(8, 16), *range(8, 16)])

    def test_a_scene_of_tiles_is_as_wide_as_its_tiles(self):
        width = beside.scene_of(beside.bed_of("settled-50k"))["bounds"]["max"][0]
        self.assertEqual(beside.scene_of(beside.bed_of("settled-1m"))["bounds"]["max"],
                         [5 * width, 4 * width, beside.HEIGHT])


class Race(FolderTestCase):
    def test_a_program_beside_itself_has_equal_states_on_all_devices(self):
        call = runner(sys.executable, SCRIPT, "HEAD", "--old", STEPPER, "--new", STEPPER)
        done = call("--scenes", "settled-1k,falling-1k", "--devices", "cpu:1,cpu:2", "--blocks", "5", "--json",
                    self.at("figures.json"), SPHERULE_BESIDE=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("Gain of cpu:2 over cpu:1", done.stdout)
        figures = json.loads(pathlib.Path(self.at("figures.json")).read_text(encoding="utf-8"))
        for scene in figures["scenes"]:
            states = [state for row in scene["devices"].values() for state in row["state"].values()]
            self.assertEqual(len(states), 4)
            self.assertEqual(len({state["hash"] for state in states}), 1)
            for row in scene["devices"].values():
                self.assertGreater(row["processor"]["median"], 0)
            count = {"settled-1k": 5, "falling-1k": 6}[scene["scene"]]
            for blocks_by_side in (result["blocks"] for result in scene["results"].values()):
                self.assertEqual([len(blocks_by_side[side]) for side in beside.SIDES], [count, count])

    def test_a_state_of_other_spheres_is_refused(self):
        scene = self.write("bed.json", json.dumps(beside.scene_of(beside.bed_of("settled-1k"))))
        self.write("short.state", "12 bytes....")
        done = subprocess.run([STEPPER, scene, "cpu:1"], input=f"load {self.at('short.state')}\n", capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("is not a state of 1000 spheres", done.stderr)


if __name__ == "__main__":
    unittest.main()
