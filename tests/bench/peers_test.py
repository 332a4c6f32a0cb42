#!/usr/bin/env python3
"""Tests of peers.py: its ratios, its windows and its choice of contestants."""
import pathlib
import sys
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import peers  # noqa: E402


def row(fall, settled):
    return {"fall": fall, "settled": settled, "overlapMean": 0.001, "overlapMax": 0.01, "speedRms": 0, "sleeping": 0}


class Peers(unittest.TestCase):
    def test_speeds_are_taken_round_by_round(self):
        # The machine is ten times as slow in the last round, which changes no ratio.
        ours, usual = [row(1, 2), row(1, 2), row(10, 20)], [row(4, 6), row(4, 6), row(40, 60)]
        self.assertEqual(peers.speed(ours, usual, "fall"), 4)
        self.assertEqual(peers.speed(ours, usual, "settled"), 3)

    def test_the_table_has_the_speed_beside_lammps(self):
        text = peers.table(10_000, {"Spherule": [row(0.5, 0.25)], peers.USUAL: [row(2, 5)]})
        self.assertIn("| Spherule | 0.5 | 0.25 | 2 | 4 | 4 | 20 | 0.1 | 1 |", text)
        self.assertIn(f"| {peers.USUAL} | 2 | 5 | 0.5 | 0.2 | 1 | 1 |", text)

    def test_windows_hold_the_stretches_of_their_time(self):
        state = {"overlapMean": 0, "overlapMax": 0, "speedRms": 0, "sleeping": 0}
        stretches = [{"simSeconds": k / 2, "wallSeconds": k, "intervalSeconds": 0.5, **state} for k in range(1, 13)]
        with mock.patch.object(peers, "reports", return_value=stretches):
            row_of_ours = peers.race_ours("bed.json", [])
        self.assertEqual(row_of_ours["fall"], 1 + 2)
        self.assertEqual(row_of_ours["settled"], 11 + 12)

    def test_the_usual_contestant_always_takes_part(self):
        self.assertEqual([name for name, _ in peers.chosen(peers.LAMMPS, "1 thread")], [peers.USUAL])
        self.assertEqual([name for name, _ in peers.chosen(peers.OURS, "1 thread,")], ["Spherule, 1 thread, 1/480 s"])
        self.assertEqual(len(peers.chosen(peers.OURS, "")), len(peers.OURS))


if __name__ == "__main__":
    unittest.main()
