"""Tests `spherule serve --watch`: watch_test.py BINARY"""
import json
import os
import sys
import time
import unittest

from program import FolderTestCase, runner
from serving import Server
from viewer import Viewer

BINARY = sys.argv.pop()
call = runner(BINARY)


def scene(name, **more):
    return {"name": name, "bounds": {"min": [-1, -1, -1], "max": [1, 1, 1]},
            "groups": [{"list": {"spheres": [{"position": [0, 0, 0]}]}, "radius": {"constant": 0.1}}], **more}


class Watch(FolderTestCase):
    def serve(self, text):
        self.path = self.write("scene.json", text)
        return Server(BINARY, "serve", "--watch", self.path, "--device", "cpu:1")

    def names(self, viewer):
        return [one["name"] for one in viewer.of("scene")]

    def replace(self, name, text):
        """Saves as many editors do: a new file takes the place of the old one."""
        os.replace(self.write(name + ".new", text), self.at(name))

    def test_a_saved_scene_is_loaded(self):
        with self.serve(json.dumps(scene("first"))) as server:
            viewer = Viewer(server.port).wait(lambda one: one.of("frame"))
            self.write("scene.json", json.dumps(scene("second")))
            viewer.wait(lambda one: self.names(one)[-1] == "second")
            self.replace("scene.json", json.dumps(scene("third")))
            viewer.wait(lambda one: self.names(one)[-1] == "third")
            viewer.wait(lambda one: one.of("frame")[-1]["epoch"] == one.of("scene")[-1]["epoch"])
            # Saved without a change of the text.
            epoch = viewer.of("scene")[-1]["epoch"]
            os.utime(self.path)
            viewer.wait(lambda one: one.of("scene")[-1]["epoch"] != epoch)
            self.assertEqual(self.names(viewer)[-1], "third")

    def test_mistakes_leave_the_world_as_it_is(self):
        with self.serve(json.dumps(scene("first"))) as server:
            viewer = Viewer(server.port).wait(lambda one: one.of("frame"))
            self.write("scene.json", '{\n  "name": "second",\n  "bounds": {"min": [0, 0, 0]},\n  "stepp": 1\n}\n')
            viewer.wait(lambda one: one.of("event"))
            event = viewer.of("event")[-1]
            self.assertEqual(event["kind"], "WARNING")
            self.assertIn("is not loaded, the world stays as it is", event["text"])
            self.assertIn(f"{self.path}:4:3: stepp", event["text"])
            self.assertIn(f"{self.path}:3:", event["text"])
            frames = len(viewer.of("frame"))
            viewer.wait(lambda one: len(one.of("frame")) > frames + 3)
            self.assertEqual(self.names(viewer), ["first"])
            # A value out of its range.
            self.write("scene.json", json.dumps(scene("second", step=9), indent=1))
            viewer.wait(lambda one: len(one.of("event")) == 2)
            self.assertRegex(viewer.of("event")[-1]["text"], r"scene\.json:\d+:\d+: step: is 9, must be")
            # No file at all for a while.
            os.remove(self.path)
            viewer.wait(lambda one: len(one.of("event")) == 3)
            self.assertEqual(viewer.of("event")[-1]["text"],
                             "scene.json is gone. The world goes on as it is. Save the file again to load it.")
            self.write("scene.json", json.dumps(scene("second")))
            viewer.wait(lambda one: self.names(one)[-1] == "second")
            server.end()
            self.assertIn(f"{self.path}:4:3: stepp", server.said)

    def test_files_that_the_scene_names_are_watched(self):
        self.write("spheres.csv", "x,y,z,radius\n0,0,0,0.1\n")
        named = scene("csv", groups=[{"csv": {"file": "spheres.csv"}}])
        with self.serve(json.dumps(scene("first"))) as server:
            viewer = Viewer(server.port).wait(lambda one: one.of("frame"))
            self.write("scene.json", json.dumps(named))
            viewer.wait(lambda one: self.names(one)[-1] == "csv")
            self.replace("spheres.csv", "x,y,z,radius\n0,0,0,0.1\n0.5,0,0,0.1\n")
            viewer.wait(lambda one: one.of("scene")[-1].get("count") == 2)
            self.replace("spheres.csv", "x,y,z,radius\n0,0,zero,0.1\n")
            viewer.wait(lambda one: one.of("event"))
            text = viewer.of("event")[-1]["text"]
            self.assertIn("spheres.csv was saved but scene.json is not loaded, the world stays as it is.", text)
            self.assertIn("spheres.csv:2", text)
            os.remove(self.at("spheres.csv"))
            viewer.wait(lambda one: len(one.of("event")) == 2)
            self.assertIn("spheres.csv, which scene.json names, is gone.", viewer.of("event")[-1]["text"])
            self.assertEqual(viewer.of("scene")[-1].get("count"), 2)

    def test_a_burst_of_writes_is_loaded_once(self):
        with self.serve(json.dumps(scene("first"))) as server:
            viewer = Viewer(server.port).wait(lambda one: one.of("frame"))
            text = json.dumps(scene("second"))
            for k in range(30):  # also incomplete texts
                self.write("scene.json", text[:len(text) * (k + 1) // 30])
                time.sleep(0.05)
            viewer.wait(lambda one: self.names(one)[-1] == "second")
            self.assertEqual(viewer.of("event"), [])
            self.assertEqual(self.names(viewer), ["first", "second"])

    def test_a_scene_of_the_program_cannot_be_watched(self):
        done = call("serve", "--watch", "cradle", "--device", "cpu:1", "--listen", "127.0.0.1:0")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--watch: needs the file of a scene", done.stderr)


if __name__ == "__main__":
    unittest.main()
