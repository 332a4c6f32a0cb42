"""Tests commands for obstacles with real clients, obstacles in exports, and files of meshes that cannot be read."""
import glob
import json
import struct
import sys
import unittest

from program import FolderTestCase, runner
from serving import Server
from viewer import Viewer

BINARY = sys.argv.pop(1)
call = runner(BINARY)

BED = {"name": "bed", "bounds": {"min": [-1, -1, -1], "max": [1, 1, 1]},
       "groups": [{"name": "bed", "radius": {"constant": 0.05},
                   "lattice": {"min": [-1, -1, -1], "max": [1, 1, -0.7], "spacing": 0.107}}]}
PADDLE = {"box": {"min": [-0.5, -0.02, 0.2], "max": [0.5, 0.02, 0.4]}, "motion": {"spin": [0, 0, 2]}}
PISTON = {"box": {"min": [-0.9, -0.9, -0.5], "max": [0.9, 0.9, -0.4]},
          "motion": {"drive": {"along": [0, 0, 1], "mass": 50, "mostSpeed": 2}}}


def stl(triangles, count=None, header=b""):
    """Returns a binary STL file. `count`: the number of triangles that it claims."""
    data = header.ljust(80, b" ") + struct.pack("<I", len(triangles) if count is None else count)
    for corners in triangles:
        data += struct.pack("<12fH", 0, 0, 0, *[x for corner in corners for x in corner], 0)
    return data


TETRAHEDRON = [((0, 0, 0), (0, 1, 0), (1, 0, 0)), ((0, 0, 0), (1, 0, 0), (0, 0, 1)),
               ((0, 0, 0), (0, 0, 1), (0, 1, 0)), ((1, 0, 0), (0, 1, 0), (0, 0, 1))]


class Obstacles(FolderTestCase):
    def serve(self, scene, *options):
        return Server(BINARY, "serve", self.write("scene.json", json.dumps(scene)), "--device", "cpu:1", *options)

    def write_bytes(self, name, data):
        with open(self.at(name), "wb") as file:
            file.write(data)

    def ctl(self, server, *words):
        return call("ctl", server.stream, *words)

    def test_viewers_see_obstacles_that_are_added_moved_and_removed(self):
        with self.serve(BED) as server:
            viewer = Viewer(server.port).wait(lambda one: one.of("frame"))
            self.assertEqual(viewer.of("scene")[-1].get("obstacles", []), [])
            added = self.ctl(server, "add_obstacle", json.dumps(PADDLE))
            self.assertEqual(added.returncode, 0, added.stderr)
            viewer.wait(lambda one: len(one.of("scene")[-1].get("obstacles", [])) == 1)
            viewer.wait(lambda one: one.of("frame")[-1].get("poses"))
            first = viewer.of("frame")[-1]["poses"][0]["rotation"]
            viewer.wait(lambda one: one.of("frame")[-1]["poses"][0]["rotation"] != first)
            self.assertEqual(self.ctl(server, "move_obstacle", "0", "0", "0", "0.3").returncode, 0)
            viewer.wait(lambda one: not one.of("frame")[-1].get("poses"))
            self.assertEqual(self.ctl(server, "remove_obstacle", "0").returncode, 0)
            viewer.wait(lambda one: not one.of("scene")[-1].get("obstacles"))

    def test_refusals_say_what_is_wrong_and_change_nothing(self):
        with self.serve(BED) as server:
            for words, text in ((["remove_obstacle", "0"], "the scene has no obstacles"),
                                (["add_obstacle", '{"sphere":{"centre":[0,0,-0.9],"radius":0.3}}'], "spheres are"),
                                (["add_obstacle", '{"sphere":{"centre":[0,0,0.5],"radius":-1}}'], "radius"),
                                (["add_obstacle", '{"mesh":{"file":"/etc/passwd"}}'], "file")):
                done = self.ctl(server, *words)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(text, done.stderr + done.stdout)
            facts = Viewer(server.port).wait(lambda one: one.of("frame")).of("scene")[-1]
            self.assertEqual(facts.get("obstacles", []), [])

    def test_a_piston_falls_onto_the_bed_and_fast_is_refused(self):
        with self.serve(dict(BED, obstacles=[PISTON])) as server:
            viewer = Viewer(server.port).wait(lambda one: one.of("frame"))
            viewer.wait(lambda one: one.of("frame")[-1]["poses"][0]["translation"][2] < -0.1)
            done = self.ctl(server, "set", "model", "fast")
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("needs the model balanced or accurate", done.stderr)
            # A saved scene begins where the piston is.
            saved = json.loads(server.get("/scene.json"))
            self.assertLess(saved["obstacles"][0]["motion"]["drive"]["place"], -0.1)

    def test_a_recording_exports_meshes_and_poses(self):
        data = stl(TETRAHEDRON)
        self.write_bytes("body.stl", data)
        obstacle = {"mesh": {"file": "body.stl", "scale": 0.2, "solid": True}, "translation": [0, 0, 0.2],
                    "motion": {"velocity": [0, 0, 0.5]}}
        scene = self.write("scene.json", json.dumps(dict(BED, obstacles=[obstacle])))
        recording = self.at("run.sph")
        done = call("run", scene, "--device", "cpu:1", "--for", "0.2s", "--record", recording)
        self.assertEqual(done.returncode, 0, done.stderr)
        done = call("export", recording, "--format", "vtk", "--out", self.at("out.pvd"))
        self.assertEqual(done.returncode, 0, done.stderr)
        moving = sorted(glob.glob(self.at("out/*-moving.vtp")))
        self.assertGreater(len(moving), 3)
        with open(moving[-1], "rb") as file:
            self.assertIn(b'NumberOfPolys="4"', file.read())

    def test_files_that_are_no_mesh_are_refused_in_one_sentence(self):
        nan = float("nan")
        files = {
            "empty.stl": (b"", "has no triangles"),
            "claims.stl": (stl(TETRAHEDRON, count=1_000_000_000), "1000000000"),
            "cut.stl": (stl(TETRAHEDRON)[:-7], "must have 284 bytes"),
            "nan.stl": (stl([((nan, 0, 0), (1, 0, 0), (0, 1, 0))]), "is nan"),
            "open.stl": (stl(TETRAHEDRON[:3]), "closed"),
            "inverted.stl": (stl([corners[::-1] for corners in TETRAHEDRON]), "inward"),
            "millimetres.stl": (stl([[[1000 * x for x in corner] for corner in each] for each in TETRAHEDRON]), "scale"),
            "word.obj": (b"v 0 0 0\nv 1 0 zero\n", "line 2"),
            "number.obj": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "line 4"),
            "noise.stl": (bytes(range(256)) * 3, ""),
        }
        for name, (data, text) in files.items():
            self.write_bytes(name, data)
            obstacle = {"mesh": {"file": name, "solid": True}}
            scene = self.write("scene.json", json.dumps(dict(BED, obstacles=[obstacle])))
            done = call("run", scene, "--device", "cpu:1", "--for", "0.1s")
            self.assertEqual(done.returncode, 2, name + ": " + done.stderr)
            message = [line for line in done.stderr.splitlines() if line.startswith("spherule: ")]
            self.assertEqual(len(message), 1, done.stderr)
            self.assertIn("obstacles[0].mesh", message[0])
            self.assertIn(text, message[0], name)
        # "solid" at the begin of a binary file, as some programs write it.
        self.write_bytes("solid.stl", stl(TETRAHEDRON, header=b"solid body"))
        scene = self.write("scene.json", json.dumps(
            dict(BED, obstacles=[{"mesh": {"file": "solid.stl", "scale": 0.2, "solid": True}}])))
        done = call("run", scene, "--device", "cpu:1", "--for", "0.1s")
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
