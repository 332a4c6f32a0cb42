#!/usr/bin/env python3
"""A short round of each disturbance of run_chaos.py, checked by counts: chaos_test.py BUILD [CLASS.TEST...]"""
import asyncio
import random
import sys
import unittest

import attackers
from chaos import World
from program import FolderTestCase

BUILD = sys.argv.pop(1)


class ChaosTestCase(FolderTestCase):
    scene = "box-4k"

    def setUp(self):
        super().setUp()
        self.world = World(BUILD, self.folder, self.scene, viewers=3, every=1)
        self.addCleanup(self.world.close)

    def tearDown(self):
        self.world.end()
        self.world.replays()
        self.world.exports()
        self.assertEqual(self.world.faults, [])


class Chaos(ChaosTestCase):
    def test_attackers_are_counted_under_their_causes(self):
        kinds = [kind for kind in attackers.ALL if kind is not attackers.Stalled]  # which takes longer
        before = self.world.server.metrics()
        for _ in range(5):  # a slow request is ended after 10 s
            asyncio.run(self.world.stretch(8, kinds))
            if self.world.has_counted(before, kinds):
                break
        self.world.counted(before, kinds)

    def test_a_full_disk_ends_the_log_and_checkpoints_are_written_again(self):
        self.world.full_disk(2)

    def test_clock_jumps_and_a_stopped_process(self):
        self.world.clock_jumps(0, (3600, -7200, 0))
        self.world.stopped_process(2)

    def test_kills(self):
        for _ in range(3):
            self.world.killed(random.uniform(0, 2))


class LostDevice(ChaosTestCase):
    scene = "cradle"  # has few kernels to compile

    def test_a_lost_device_and_a_restart(self):
        self.world.lost_device()


if __name__ == "__main__":
    unittest.main()
