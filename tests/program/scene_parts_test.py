"""Tests commands for fields, emitters, materials and groups with real clients, and scripts with them."""
import json
import sys
import time
import unittest

from program import FolderTestCase, json_runner, runner
from serving import Server
from viewer import Viewer

BINARY = sys.argv.pop(1)
call = runner(BINARY)
run_json = json_runner(call, "cpu")

WIND = {"drag": {"density": 5, "velocity": [4, 0, 0]}}
RAIN = {"name": "rain", "box": {"min": [-0.8, -0.8, 0.7], "max": [0.8, 0.8, 0.8]}, "rate": 100,
        "radius": {"constant": 0.05}}
BED = {"name": "bed", "bounds": {"min": [-1, -1, -1], "max": [1, 1, 1]},
       "materials": [{"name": "steel", "friction": 0.1}, {"name": "rubber", "friction": 0.8}],
       "groups": [{"name": "bed", "radius": {"constant": 0.05},
                   "lattice": {"min": [-1, -1, -1], "max": [1, 1, -0.7], "spacing": 0.107}}]}


class SceneParts(FolderTestCase):
    def serve(self, scene, *options):
        return Server(BINARY, "serve", self.write("scene.json", json.dumps(scene)), "--device", "cpu:1", *options)

    def ctl(self, server, *words):
        words = [json.dumps(word) if isinstance(word, dict) else str(word) for word in words]
        return call("ctl", server.stream, *words)

    def done(self, server, *words):
        answer = self.ctl(server, *words)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        return answer.stdout

    def saved(self, server):
        time.sleep(1.1)  # one scene a second
        return json.loads(server.get("/scene.json"))

    def test_viewers_see_parts_and_saved_scenes_have_them(self):
        with self.serve(BED) as server:
            viewer = Viewer(server.port).wait(lambda one: one.of("frame"))
            self.assertNotIn("fields", viewer.of("parts")[-1])
            self.assertIn("number 0", self.done(server, "add_field", WIND))
            viewer.wait(lambda one: len(one.of("parts")[-1].get("fields", [])) == 1)
            self.done(server, "change_field", 0, {"drag": {"density": 2, "velocity": [0, 3, 0]}})
            viewer.wait(lambda one: one.of("parts")[-1]["fields"][0]["drag"]["velocity"] == [0, 3, 0])
            self.assertIn("number 0", self.done(server, "add_emitter", RAIN))
            viewer.wait(lambda one: [group["name"] for group in one.of("scene")[-1]["groups"]] == ["bed", "rain"])
            viewer.wait(lambda one: one.of("scene")[-1]["groups"][1].get("count", 0) > 3)
            self.assertIn("number 2", self.done(server, "add_material", {"name": "cork", "density": 240}))
            self.done(server, "set_pair", {"a": "steel", "b": "cork", "friction": 0.7})
            self.done(server, "change_group", 0, {"name": "floor", "material": "cork", "colour": "#ff0000"})
            viewer.wait(lambda one: one.of("scene")[-1]["groups"][0].get("colour") == "#ff0000")
            self.assertEqual(viewer.of("scene")[-1]["materials"], ["steel", "rubber", "cork"])
            self.assertEqual(viewer.of("parts")[-1]["pairs"], [{"a": "steel", "b": "cork", "friction": 0.7}])
            saved = self.saved(server)
            self.assertEqual(saved["fields"][0]["drag"]["velocity"], [0, 3, 0])
            self.assertEqual([one["name"] for one in saved["emitters"]], ["rain"])
            self.assertEqual([one["name"] for one in saved["materials"]], ["steel", "rubber", "cork"])
            self.assertEqual(saved["groups"][0]["material"], "cork")
            again = self.write("saved.json", json.dumps(saved))
            self.assertEqual(call("scene", "check", again).returncode, 0)
            self.done(server, "remove_emitter", 0)
            self.done(server, "remove_group", 0)
            viewer.wait(lambda one: [group["name"] for group in one.of("scene")[-1]["groups"]] == ["rain"])
            self.done(server, "remove_field", 0)
            viewer.wait(lambda one: "fields" not in one.of("parts")[-1])
            # A reset undoes them all.
            self.done(server, "reset")
            viewer.wait(lambda one: one.of("scene")[-1]["materials"] == ["steel", "rubber"])
            self.assertEqual([group["name"] for group in viewer.of("scene")[-1]["groups"]], ["bed"])
            viewer.wait(lambda one: len(one.of("parts")[-1]["materials"]) == 2)

    def test_other_clients_are_told_who_has_changed_the_scene(self):
        with self.serve(BED) as server:
            viewer = Viewer(server.port).wait(lambda one: one.of("frame"))
            self.done(server, "add_emitter", RAIN)
            viewer.wait(lambda one: one.of("event"))
            event = viewer.of("event")[-1]
            self.assertEqual((event["kind"], event["text"]), ("COMMANDED", "add_emitter"))
            self.assertEqual(event["command"], {"addEmitter": {"emitter": {"name": "rain"}}})

    def test_refusals_say_what_is_wrong_and_change_nothing(self):
        with self.serve(BED) as server:
            self.done(server, "pause")
            before = json.loads(self.done(server, "query", "hash"))["stateHash"]
            viewer = Viewer(server.port).wait(lambda one: one.of("parts"))
            parts = viewer.of("parts")[-1]
            for words, text in (
                    (["remove_field", 0], "number: is not there: the scene has no fields"),
                    (["add_field", {}], "has no kind"),
                    (["add_field", {"drag": {"density": -1}}], "addField.field.drag.density: is -1, must be 0 to"),
                    (["change_field", 1, WIND], "the scene has no fields"),
                    (["add_emitter", dict(RAIN, rate=3e5, radius={"constant": 0.001})],
                     "brings the emitters to 5000 spheres in a step, at most 4096 are allowed"),
                    (["add_emitter", dict(RAIN, material="wood")], 'is "wood", which is no material of the scene'),
                    (["remove_material", 0], 'is of the material "steel", of which are the walls, groups[0]'),
                    (["add_material", {"name": "m" * 201}], "is 201 bytes long, must be at most 200"),
                    (["set_pair", {"a": "steel"}], "is missing"),
                    (["change_group", 0, {"colour": "red"}], "colour"),
                    (["remove_group", 7], "is 7, must be 0 to 0")):
                done = self.ctl(server, *words)
                self.assertNotEqual(done.returncode, 0, words)
                self.assertIn(text, done.stderr + done.stdout)
            self.assertEqual(json.loads(self.done(server, "query", "hash"))["stateHash"], before)
            self.assertEqual(viewer.of("parts"), [parts])

    def test_a_script_has_the_bits_of_ctl(self):
        lines = ("0.1s add_field " + json.dumps(WIND), "0.1s add_emitter " + json.dumps(RAIN),
                 "0.2s change_material 1 " + json.dumps({"name": "rubber", "friction": 0.4}),
                 "0.2s change_group 0 " + json.dumps({"material": "rubber"}), "0.3s remove_field 0",
                 "0.3s remove_emitter 0")
        script = self.write("commands.txt", "".join(line + "\n" for line in lines))
        scene = self.write("scene.json", json.dumps(BED))
        done = run_json(scene, "--for", "0.5s", "--script", script)
        self.assertGreater(done["spheres"], 648 + 5)  # of the bed, and some of the emitter
        with Server(BINARY, "serve", scene, "--device", "cpu") as server:
            for words in (("pause",), ("reset",), ("step", 6), ("add_field", WIND), ("add_emitter", RAIN), ("step", 6),
                          ("change_material", 1, {"name": "rubber", "friction": 0.4}),
                          ("change_group", 0, {"material": "rubber"}), ("step", 6), ("remove_field", 0),
                          ("remove_emitter", 0), ("step", 12)):
                self.done(server, *words)
            query = json.loads(self.done(server, "query", "hash"))
        self.assertEqual((query["step"], query["stateHash"]), ("30", done["stateHash"]))

    def test_many_changes_leave_the_stream_alive(self):
        with self.serve(BED) as server:
            viewer = Viewer(server.port).wait(lambda one: one.of("frame"))
            epochs = len(viewer.of("scene"))
            begin = time.monotonic()
            for k in range(40):
                self.done(server, "change_group", 0, {"colour": f"#0000{k:02x}"})
            seconds = time.monotonic() - begin
            viewer.wait(lambda one: one.of("scene")[-1]["groups"][0].get("colour") == "#000027")
            self.assertLessEqual(len(viewer.of("scene")) - epochs, 10 * seconds + 2)
            frames = len(viewer.of("frame"))
            viewer.wait(lambda one: len(one.of("frame")) > frames + 5)
            self.assertIsNone(viewer.closed)


if __name__ == "__main__":
    unittest.main()
