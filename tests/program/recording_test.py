#!/usr/bin/env python3
"""Tests recordings, and exports as other programs read them: recording_test.py BINARY. Runs with Debian's Python, with
ASE (tests/unpack_ase.sh) and VTK."""
import csv
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest
import xml.etree.ElementTree as xml

import numpy
from ase.io import read
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from program import FolderTestCase, runner

BINARY = sys.argv.pop()
COLUMNS = ["id", "x", "y", "z", "radius", "group", "material"]
NUMBERS = ["id", "group", "material"]
FLOAT = 1e-6  # m; rounding of float32 and of nine digits, some metres from the origin
MIXED = {"bounds": {"min": [0, 0, 0], "max": [1, 2, 1.5]}, "materials": [{}, {"name": "heavy", "density": 4000}],
         "groups": [{"name": "small", "radius": {"constant": 0.03},
                     "fill": {"count": 150, "min": [0, 0, 0], "max": [1, 2, 1.5]}},
                    {"name": "mixed", "material": "heavy", "radius": {"uniform": {"min": 0.04, "max": 0.09}},
                     "fill": {"count": 60, "min": [0, 0, 0], "max": [1, 2, 1.5]}}]}


call = runner(BINARY)


def frames_of(path):
    """Reads a CSV file of `run --dump` or `export`; returns [(time, rows of COLUMNS in id order)]."""
    frames = {}
    with open(path, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            frames.setdefault(float(row["time"]), []).append([float(row[column]) for column in COLUMNS])
    return [(when, numpy.array(rows)) for when, rows in frames.items()]


class RecordingTestCase(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.recording = self.at("run.sph")

    def run_done(self, scene, *more, device="cpu"):
        done = call("run", scene, "--device", device, "--record", self.recording, *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def export(self, file_format, name, *more):
        done = call("export", self.recording, "--format", file_format, "--out", self.at(name), *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.at(name)

    def refused(self, *arguments, code=2):
        done = call(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr.splitlines()[-1]


class Formats(RecordingTestCase):
    """Each export has the states of the same run's dump, within the documented error."""

    def record(self, scene, smallest, *more):
        dump = self.at("states.csv")
        self.run_done(scene, "--for", "2.5s", "--dump", dump, "--every", "0.0333333s", *more)
        self.bound = smallest / 500 + FLOAT
        self.dumped = frames_of(dump)
        self.assertEqual(len(self.dumped), 76)

    def mixed(self):
        path = self.at("mixed.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(MIXED, file)
        return path

    def same(self, when, positions, radii, numbers, dumped):
        """`numbers`: columns of ids, groups and materials."""
        self.assertAlmostEqual(when, dumped[0], delta=1e-8)
        numpy.testing.assert_array_equal(numpy.column_stack(numbers), dumped[1][:, [0, 5, 6]])
        self.assertLessEqual(numpy.abs(positions - dumped[1][:, 1:4]).max(), self.bound)
        numpy.testing.assert_allclose(radii, dumped[1][:, 4], rtol=1e-7)

    def check_all(self):
        exported = frames_of(self.export("csv", "run.csv"))
        self.assertEqual(len(exported), len(self.dumped))
        for (when, rows), dumped in zip(exported, self.dumped):
            self.same(when, rows[:, 1:4], rows[:, 4], rows[:, [0, 5, 6]].T, dumped)

        exported = read(self.export("xyz", "run.xyz"), index=":", format="extxyz")
        self.assertEqual(len(exported), len(self.dumped))
        for atoms, dumped in zip(exported, self.dumped):
            self.same(atoms.info["Time"], atoms.positions, atoms.arrays["radius"],
                      [atoms.arrays[name] for name in NUMBERS], dumped)

        listed = xml.parse(self.export("vtk", "run.pvd")).getroot().findall("Collection/DataSet")
        self.assertEqual(len(listed), len(self.dumped))
        for entry, dumped in zip(listed, self.dumped):
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(self.at(entry.get("file")))
            reader.Update()
            data = reader.GetOutput()
            self.assertEqual(data.GetNumberOfVerts(), len(dumped[1]))
            arrays = data.GetPointData()
            self.same(float(entry.get("timestep")), vtk_to_numpy(data.GetPoints().GetData()),
                      vtk_to_numpy(arrays.GetArray("radius")),
                      [vtk_to_numpy(arrays.GetArray(name)) for name in NUMBERS], dumped)
        return exported

    def test_two_spheres(self):
        self.record("two-spheres", 0.05)
        atoms = self.check_all()[0]
        numpy.testing.assert_allclose(atoms.cell.lengths(), [4, 1, 1])
        numpy.testing.assert_allclose(atoms.info["Origin"], [-2, -0.5, -0.5])

    def test_a_box_of_mixed_radii(self):
        self.record(self.mixed(), 0.03)
        self.check_all()

    def test_tiers_state_what_they_are_off_by(self):
        for tier, part in ("normal", 50), ("eco", 16):
            self.record(self.mixed(), 0.03, "--record-tier", tier, "--force")
            self.bound = 0.03 / part + FLOAT
            exported = frames_of(self.export("csv", f"{tier}.csv"))
            self.assertEqual(len(exported), len(self.dumped))
            for (when, rows), dumped in zip(exported, self.dumped):
                self.same(when, rows[:, 1:4], rows[:, 4], rows[:, [0, 5, 6]].T, dumped)


class Record(RecordingTestCase):
    def bytes_of(self, *more, duration="0.5s", device="cpu"):
        self.run_done("box-4k", "--for", duration, "--force", *more, device=device)
        with open(self.recording, "rb") as file:
            return file.read()

    def test_the_same_run_gives_the_same_bytes(self):
        once = self.bytes_of()
        self.assertEqual(self.bytes_of(), once)
        self.assertEqual(self.bytes_of(device="cpu:1"), once)
        self.assertNotEqual(self.bytes_of("--seed", "7"), once)

    def test_runs_that_differ_have_other_ids(self):
        script = self.write("push.txt", "0.3s set gravity 0 0 -1.6\n")
        runs = ((), ("--seed", "7"), ("--script", script), ("--record-tier", "eco"), ("--record-rate", "20"),
                ("--quality", "fast"))
        ids = {self.bytes_of(*more)[12:16] for more in runs} | {self.bytes_of(duration="0.4s")[12:16]}
        self.assertEqual(len(ids), len(runs) + 1)
        self.assertEqual(self.bytes_of("--contact-sums"), self.bytes_of())

    def test_the_folder_of_a_scene_changes_nothing(self):
        corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
        scene = {"bounds": {"min": [-2, -2, -2], "max": [2, 2, 2]}, "obstacles": [{"mesh": {"file": "wedge.obj"}}],
                 "groups": [{"radius": {"constant": 0.1}, "list": {"spheres": [{"position": [0.2, 0.2, 1.5]}]}}]}
        recorded = []
        for folder in "here", "there":
            os.mkdir(self.at(folder))
            with open(self.at(f"{folder}/wedge.obj"), "w", encoding="utf-8") as file:
                file.writelines(["# " + 97 * " " + "\n"] * 11_000)  # a file of more than 1 MiB stays a file
                file.writelines(f"v {x} {y} {z}\n" for x, y, z in corners)
                file.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces)
            with open(self.at(f"{folder}/scene.json"), "w", encoding="utf-8") as file:
                json.dump(scene, file)
            self.run_done(self.at(f"{folder}/scene.json"), "--for", "0.5s", "--force")
            with open(self.recording, "rb") as file:
                recorded.append(file.read())
        self.assertEqual(*recorded)

    def test_a_group_that_changes_in_the_run_has_its_new_name(self):
        script = self.write("rename.txt", '0.1s change_group 0 {"name": "renamed", "colour": "#ff0000"}\n')
        self.run_done("cradle", "--for", "0.3s", "--script", script)
        with open(self.recording, "rb") as file:
            recorded = file.read()
        self.assertEqual(recorded.count(b"renamed"), 1)
        self.assertEqual(len(frames_of(self.export("csv", "renamed.csv"))), 10)

    def test_recording_changes_nothing(self):
        plain = call("run", "box-4k", "--for", "0.5s", "--device", "cpu", "--json")
        recorded = self.run_done("box-4k", "--for", "0.5s", "--json")
        self.assertEqual(json.loads(plain.stdout)["stateHash"], json.loads(recorded.stdout)["stateHash"])

    def test_frames_are_as_often_as_asked_and_the_last_state_is_there(self):
        for rate, times in ("10", [0, 0.1, 0.2, 0.25]), ("1000", [k / 60 for k in range(16)]):
            self.run_done("two-spheres", "--for", "0.25s", "--record-rate", rate, "--force")
            recorded = [when for when, _ in frames_of(self.export("csv", f"{rate}.csv"))]
            numpy.testing.assert_allclose(recorded, times, atol=1e-8)

    def test_a_file_that_is_there_is_kept_unless_told(self):
        self.run_done("two-spheres", "--for", "0.1s")
        arguments = ["run", "two-spheres", "--for", "0.1s", "--device", "cpu", "--record", self.recording]
        self.assertEqual(self.refused(*arguments), f"spherule: {self.recording}: is there already; give --force to "
                                                   "replace it, or another name")
        self.assertEqual(call(*arguments, "--force").returncode, 0)

    def test_where_there_is_no_room_the_recording_so_far_stays(self):
        def little_room():
            resource.setrlimit(resource.RLIMIT_FSIZE, (1_500_000, 1_500_000))
        done = call("run", "box-10k", "--for", "10s", "--device", "cpu", "--record", self.recording,
                    "--record-rate", "60", preexec_fn=little_room)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertRegex(done.stderr.splitlines()[-1],
                         r"run.sph: writing failed after 1500000 bytes: File too large; raise the limit \(ulimit "
                         r"-f\) or write less; what has been written stays as it is$")
        done = call("export", self.recording, "--format", "vtk", "--out", self.at("run"), "--every", "0.5s")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"run.sph is exported up to [0-9.]+ s: the record at byte [0-9]+ is cut off")
        self.assertGreater(len(os.listdir(self.at("run"))), 1)

    def test_a_recording_that_is_deleted_while_it_is_written_ends_the_run(self):
        folder = self.at("films")
        os.mkdir(folder)
        recording = os.path.join(folder, "run.sph")
        with subprocess.Popen([BINARY, "run", "two-spheres", "--for", "1e9s", "--device", "cpu", "--record", recording],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as running:
            try:
                while running.poll() is None and not (os.path.exists(recording) and os.path.getsize(recording) > 1000):
                    time.sleep(0.01)
                shutil.rmtree(folder)
                _, said = running.communicate(timeout=20)
            finally:
                running.kill()
        self.assertEqual(running.returncode, 4, said)
        self.assertEqual(said.splitlines()[-1], f"spherule: {recording}: was deleted while it was written, or its folder "
                                                "was; nothing of it is kept")

    def test_a_run_that_is_killed_leaves_what_it_had_about_a_second_before(self):
        arguments = [BINARY, "run", "box-10k", "--for", "1000s", "--device", "cpu", "--record", self.recording]
        with subprocess.Popen(arguments, stderr=subprocess.DEVNULL) as running:
            try:
                deadline = time.monotonic() + 60
                while time.monotonic() < deadline:
                    time.sleep(0.1)
                    if os.path.exists(self.recording) and os.path.getsize(self.recording) > 100_000:
                        break
            finally:
                running.kill()
        self.export("vtk", "run", "--every", "1s")
        self.assertGreater(len(os.listdir(self.at("run"))), 0)


PERIODIC = {"bounds": {"min": [0, 0, 0], "max": [2, 1, 3], "periodic": ["X", "Z"]}, "gravity": [0, 0, 0],
            "materials": [{"restitution": 1}],
            "groups": [{"radius": {"constant": 0.05}, "velocity": [3.1, 0, -1.7], "list": {"spheres": [
                {"position": [0.1, 0.2, 2.95]}, {"position": [1.99, 0.5, 1]}]}}]}


class Periodic(RecordingTestCase):
    """Two spheres that fly across seams without meeting anything."""

    def setUp(self):
        super().setUp()
        path = self.at("periodic.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(PERIODIC, file)
        self.run_done(path, "--for", "4s")

    def places(self, name, *more):
        frames = frames_of(self.export("csv", name, *more))
        return numpy.array([when for when, _ in frames]), numpy.array([rows[:, 1:4] for _, rows in frames])

    def test_positions_are_inside_and_formats_know_the_axes(self):
        _, places = self.places("a.csv")
        self.assertTrue((places >= 0).all() and (places <= [2, 1, 3]).all())
        self.assertGreater(numpy.abs(numpy.diff(places[:, :, 0], axis=0)).max(), 1.8)
        atoms = read(self.export("xyz", "a.xyz"), index="0", format="extxyz")
        self.assertEqual(list(atoms.pbc), [True, False, True])
        reader = vtkXMLPolyDataReader()
        self.export("vtk", "a.pvd", "--every", "1s")
        reader.SetFileName(self.at("a/" + sorted(os.listdir(self.at("a")))[0]))
        reader.Update()
        periods = vtk_to_numpy(reader.GetOutput().GetFieldData().GetArray("Periods"))
        numpy.testing.assert_array_equal(periods.ravel(), [2, 0, 3])

    def test_unwrapped_paths_have_no_jump(self):
        starts = numpy.array([sphere["position"] for sphere in PERIODIC["groups"][0]["list"]["spheres"]])
        for more in (), ("--every", "0.7s"):
            times, places = self.places("b.csv", "--unwrap", "--force", *more)
            expected = starts + times[:, None, None] * numpy.array(PERIODIC["groups"][0]["velocity"])
            numpy.testing.assert_allclose(places, expected, atol=0.05 / 500 + 1e-5)
        times, places = self.places("c.csv", "--unwrap", "--from", "2s")
        self.assertTrue((places[0] >= 0).all() and (places[0] <= [2, 1, 3]).all())
        self.assertLess(numpy.abs(numpy.diff(places, axis=0)).max(), 0.2)

    def test_what_knows_no_turns_refuses_the_file(self):
        with open(self.recording, "rb") as file:
            self.assertIn(b"SP\x01\x07", file.read())


class Export(RecordingTestCase):
    def setUp(self):
        super().setUp()
        self.run_done("two-spheres", "--for", "5s")

    def times(self, name, *more):
        return [when for when, _ in frames_of(self.export("csv", name, *more))]

    def test_every_from_and_to_choose_frames(self):
        numpy.testing.assert_allclose(self.times("a.csv", "--every", "1s"), [0, 1, 2, 3, 4, 5], atol=1e-8)
        numpy.testing.assert_allclose(self.times("b.csv", "--from", "2.4s", "--to", "2.5s"), [2.4, 2.43333333,
                                      2.46666667, 2.5], atol=1e-7)
        numpy.testing.assert_allclose(self.times("c.csv", "--from", "4.45s", "--every", "250ms"),
                                      [4.46666667, 4.73333333, 4.96666667], atol=1e-7)
        self.assertEqual(len(self.times("d.csv", "--every", "1ms")), 151)

    def test_what_cannot_be_is_refused(self):
        out = self.at("out.csv")
        export = ["export", self.recording, "--format", "csv", "--out"]
        self.assertEqual(self.refused(*export, out, "--from", "6s"),
                         f"spherule: {self.recording}: has nothing of that time: it goes from 0 s to 5 s")
        self.assertEqual(self.refused(*export, out, "--from", "2s", "--to", "1s"), "spherule: --to: is before --from; see `spherule export --help`")
        self.assertFalse(os.path.exists(out))
        missing = self.at("no/out.csv")
        self.assertEqual(self.refused(*export, missing),
                         f"spherule: {missing}: cannot be written: No such file or directory; make its folder first")
        with open(self.at("there.csv"), "w", encoding="utf-8"):
            pass
        self.assertEqual(self.refused(*export, self.at("there.csv")), f"spherule: {self.at('there.csv')}: is there "
                                                                      "already; give --force to replace it, or another name")
        self.assertEqual(self.refused(*export, self.recording, "--force"),
                         f"spherule: {self.recording}: is the exported file itself; choose another name")
        self.assertIn("is no recording", self.refused("export", __file__, "--format", "csv", "--out", out))
        self.assertIn("No space left on device", self.refused(*export, "/dev/full", "--force", code=4))

    def interrupted(self, sign, *arguments):
        """Sends the signal after the first file exists and before the end; returns exit code and output."""
        for _ in range(50):
            with subprocess.Popen([BINARY, "export", self.recording, "--force", *arguments], stderr=subprocess.PIPE,
                                  text=True) as running:
                while running.poll() is None and not any(".part" in name for name in os.listdir(self.folder)):
                    time.sleep(0.001)
                running.send_signal(sign)
                said = running.stderr.read()
            if running.returncode != 0:  # otherwise it ended before the signal
                return running.returncode, said
            for name in os.listdir(self.folder):
                if name.startswith("out"):
                    path = self.at(name)
                    shutil.rmtree(path) if os.path.isdir(path) else os.remove(path)
        self.fail("it cannot be interrupted")

    def test_interrupted_it_leaves_nothing_under_the_name(self):
        self.run_done("box-4k", "--for", "3s", "--record-rate", "60", "--force")
        for file_format, sign in ("csv", signal.SIGINT), ("xyz", signal.SIGTERM), ("vtk", signal.SIGINT), ("csv", signal.SIGKILL):
            code, said = self.interrupted(sign, "--format", file_format, "--out", self.at(f"out.{file_format}"))
            self.assertEqual(code, -9 if sign == signal.SIGKILL else 128 + sign, said)
            left = [name for name in os.listdir(self.folder) if name.startswith("out")]
            self.assertFalse([name for name in left if ".part" not in name])
            if sign != signal.SIGKILL:
                self.assertEqual(left, [])
                self.assertRegex(said, f"ended by {sign.name} after [0-9]+ frames: .* was not written")

    def test_standard_output_gets_the_same_text(self):
        for file_format in "csv", "xyz":
            with open(self.export(file_format, f"out.{file_format}"), encoding="utf-8") as file:
                self.assertEqual(call("export", self.recording, "--format", file_format, "--out", "-").stdout, file.read())
        said = self.refused("export", self.recording, "--format", "vtk", "--out", "-")
        self.assertEqual(said, "spherule: --out: cannot be standard output: vtk is many files; give a name, or --format "
                               "xyz; see `spherule export --help`")

    def test_a_damaged_frame_ends_it_and_it_goes_on_behind(self):
        with open(self.recording, "rb") as file:
            content = file.read()
        for byte in 0, 40:  # in different parts of a record
            self.goes_on_behind(content, len(content) // 2 + byte)

    def goes_on_behind(self, content, byte):
        with open(self.recording, "wb") as file:
            file.write(content[:byte] + bytes([content[byte] ^ 1]) + content[byte + 1:])
        said = self.refused("export", self.recording, "--format", "csv", "--out", self.at("a.csv"), "--force")
        self.assertRegex(said, r"the record at byte [0-9]+ is damaged: its checksum differs; [0-9]+ frames before it "
                               "were exported; --from exports the part after it$")
        before = frames_of(self.at("a.csv"))
        self.assertGreater(len(before), 10)
        # Starts at a keyframe, and in the damaged part before it.
        for begin in "4s", f"{before[-1][0] + 0.1}s":
            after = self.times("b.csv", "--from", begin, "--force")
            numpy.testing.assert_allclose((after[0], after[-1]), (4, 5), atol=1e-8)


if __name__ == "__main__":
    unittest.main()
