#!/usr/bin/env python3
"""Reads files with spheres that other programs have written: sphere_files_test.py BINARY LMP. LMP is LAMMPS
(tests/unpack_lammps.sh). Runs with Debian's Python, with ASE (tests/unpack_ase.sh)."""
import csv
import json
import random
import subprocess
import sys
import unittest

import numpy
from ase import Atoms
from ase.io import write

from program import FolderTestCase, runner

LMP = sys.argv.pop()
BINARY = sys.argv.pop()
call = runner(BINARY)


class SphereFiles(FolderTestCase):
    """Random spheres are written by another program, and read by this one."""

    def setUp(self):
        super().setUp()
        rng = random.Random(7)
        places = rng.sample([(x, y, z) for x in range(5) for y in range(5) for z in range(5)], 40)
        self.positions = numpy.array([[0.2 * side + rng.uniform(0.08, 0.12) for side in place] for place in places])
        self.radii = numpy.array([rng.uniform(0.01, 0.07) for _ in places])
        self.velocities = numpy.array([[rng.uniform(-2, 2) for _ in range(3)] for _ in places])
        self.spins = numpy.array([[rng.uniform(-9, 9) for _ in range(3)] for _ in places])

    def read(self, source, file, group=None, **options):
        """Returns the spheres at the beginning of a run: rows of x y z vx vy vz radius wx wy wz."""
        scene = {"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}, "materials": [{"friction": 0.5}],
                 "groups": [{source: {"file": file, **options}, **(group or {})}]}
        states = self.at("states.csv")
        done = call("run", self.write("scene.json", json.dumps(scene)), "--device", "cpu", "--for", "0.02s", "--dump",
                    states, "--force")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(states, encoding="utf-8") as rows:
            first = [row for row in csv.DictReader(rows) if float(row["time"]) == 0]
        return numpy.array([[float(row[name]) for name in "x y z vx vy vz radius wx wy wz".split()] for row in first])

    def expect(self, rows, velocities=None, spins=None, radii=None):
        velocities = self.velocities if velocities is None else velocities
        spins = self.spins if spins is None else spins
        radii = self.radii if radii is None else radii
        numpy.testing.assert_allclose(rows[:, 0:3], self.positions, atol=1e-6)
        numpy.testing.assert_allclose(rows[:, 3:6], velocities, rtol=1e-6, atol=1e-6)
        numpy.testing.assert_allclose(rows[:, 6], radii, rtol=1e-6)
        numpy.testing.assert_allclose(rows[:, 7:10], spins, rtol=1e-6, atol=1e-6)

    def test_ase_writes_extended_xyz(self):
        for names in (("radius", "velo", "omega"), ("radius", "vel", "omega"),
                      ("radii", "velocities", "angular_velocity")):
            atoms = Atoms(f"X{len(self.radii)}", positions=self.positions, cell=[1, 1, 1], pbc=[True, False, False])
            atoms.info["note"] = "made for a \"test\""
            atoms.new_array("tags2", numpy.arange(len(self.radii)))
            for name, values in zip(names, (self.radii, self.velocities, self.spins)):
                atoms.new_array(name, values)
            write(self.at("ase.xyz"), [atoms[:3], atoms], format="extxyz")
            self.expect(self.read("xyz", "ase.xyz", frame=1))

    def test_ase_writes_plain_xyz(self):
        write(self.at("plain.xyz"), Atoms(f"O{len(self.radii)}", positions=1000 * self.positions), format="xyz")
        rows = self.read("xyz", "plain.xyz", {"radius": {"constant": 0.05}, "velocity": [1, 2, 3]}, scale=0.001)
        self.expect(rows, velocities=[[1, 2, 3]] * len(rows), spins=numpy.zeros((len(rows), 3)),
                    radii=[0.05] * len(rows))

    def test_exports_are_read(self):
        spheres = [{"position": list(position), "radius": radius}
                   for position, radius in zip(self.positions, self.radii)]
        scene = {"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}, "groups": [{"list": {"spheres": spheres}}]}
        file, recording, export = self.write("listed.json", json.dumps(scene)), self.at("run.sph"), self.at("out.xyz")
        for command in (["run", file, "--device", "cpu", "--for", "0.02s", "--record", recording],
                        ["export", recording, "--format", "xyz", "--out", export]):
            done = call(*command)
            self.assertEqual(done.returncode, 0, done.stderr)
        rows = self.read("xyz", "out.xyz")
        numpy.testing.assert_allclose(rows[:, 0:3], self.positions, atol=1e-4)  # exports have the recording's precision
        numpy.testing.assert_allclose(rows[:, 6], self.radii, rtol=1e-6)

    def lammps(self, style, *commands):
        """Makes the spheres in LAMMPS, and carries out the commands there."""
        script = ["units si", f"atom_style {style}", "boundary f f f", "atom_modify sort 1 0.2",
                  "region box block 0 1 0 1 0 1", "create_box 1 box", "mass 1 1" if style == "atomic" else ""]
        # LAMMPS numbers its atoms in the order of their making.
        for number, (position, velocity) in enumerate(zip(self.positions, self.velocities), 1):
            script += [f"create_atoms 1 single {' '.join(map(repr, map(float, position)))} units box",
                       f"group one id {number}", f"velocity one set {' '.join(map(repr, map(float, velocity)))}"]
            if style == "sphere":
                script += [f"set atom {number} diameter {2 * self.radii[number - 1]!r}", f"set atom {number} omega "
                           + " ".join(map(repr, map(float, self.spins[number - 1])))]
            script += ["group one delete"]
        path = self.write("in.lammps", "\n".join(script + list(commands)) + "\n")
        done = subprocess.run([LMP, "-in", path, "-log", "none"], cwd=self.folder, capture_output=True, text=True,
                              timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_lammps_writes_data_files(self):
        self.lammps("sphere", "write_data sphere.data")
        self.expect(self.read("lammps", "sphere.data"))
        self.lammps("atomic", "write_data atomic.data")
        rows = self.read("lammps", "atomic.data", {"radius": {"constant": 0.05}})
        self.expect(rows, spins=numpy.zeros((len(rows), 3)), radii=[0.05] * len(rows))

    def test_lammps_writes_dump_files(self):
        columns = "vx vy vz omegax omegay omegaz id type"
        exact = "modify format float %.15g"
        self.lammps("sphere", "dump 1 all custom 1 two.dump id type xs ys zs radius",
                    "dump_modify 1 format float %.15g", "timestep 1e-9", "run 1",
                    f"write_dump all custom plain.dump {columns} x y z radius {exact}",
                    f"write_dump all custom scaled.dump {columns} xs ys zs diameter {exact}",
                    f"write_dump all custom unwrapped.dump {columns} xu yu zu radius {exact}")
        for file in "plain.dump", "scaled.dump", "unwrapped.dump":
            self.expect(self.read("lammps", file))
        none = numpy.zeros((len(self.radii), 3))
        for frame in 0, 1:
            self.expect(self.read("lammps", "two.dump", frame=frame), velocities=none, spins=none)


if __name__ == "__main__":
    unittest.main()
