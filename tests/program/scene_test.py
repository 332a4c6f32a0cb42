#!/usr/bin/env python3
"""Tests `spherule scene`: scene_test.py BINARY."""
import json
import os
import pathlib
import subprocess
import sys
import unittest

from program import FolderTestCase, runner

BINARY = os.path.abspath(sys.argv.pop())
call = runner(BINARY, timeout=120)
ROOT = pathlib.Path(__file__).resolve().parents[2]

# A line of a scene with a mistake, its column, its path and its message. The first mistake is in line 3.
MISTAKES = [
    ('"gravty": [0, 0, -9.81],', 1, "gravty", 'is not a field of Scene; did you mean "gravity"?'),
    ('"step": 2,', 9, "step", "is 2, must be 1e-06 to 1 s"),
    ('"gravity": [0, -9.81],', 12, "gravity", "has 2 numbers, must have three: x, y, z"),
    ('"sphereContacts": "no",', 19, "sphereContacts", 'is "no", must be true or false'),
    ('"description": 7,', 16, "description", "is 7, must be a text"),
    ('"quality": {"model": "BALANCD",', 22, "quality.model",
     'is "BALANCD", must be one of FAST, BALANCED, ACCURATE; did you mean "BALANCED"?'),
    ('"substeps": 0.5,', 13, "quality.substeps", "is 0.5, must be a whole number, not negative"),
    ('"auto": {"budgetMs": 16, "overlap": 0.01}},', 26, "quality.auto.overlap",
     "is beside `budgetMs`; Auto has only one of budgetMs, overlap"),
    ('"materials": [{"name": "a", "restitution": 1.2},', 44, "materials[0].restitution", "is 1.2, must be 0 to 1"),
    ('{"name": "b", "frictoin": 0.2}],', 15, "materials[1].frictoin",
     'is not a field of Material; did you mean "friction"?'),
    ('"pairs": {"a": "a", "b": "b"},', 10, "pairs", "is an object, must be a list"),
    ('"fields": [{"attraction": {"centre": [0, 0, 0], "softening": 0}},', 62, "fields[0].attraction.softening",
     "is 0, must be 1e-06 to 1000000000 m"),
    ('{}],', 1, "fields[1]", "has none of drag, attraction, buoyancy, spring; give one of them"),
    ('"obstacles": [{"sphere": {"centre": [0, 0, 0]}},', 26, "obstacles[0].sphere.radius",
     "is missing; it must be a number"),
    ('{"plane": {"point": [0, 0, 0], "normal": [0, "up", 1]}},', 46, "obstacles[1].plane.normal[1]",
     'is "up", must be a number'),
    ('{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}, "colour": "#12345"}],', 57, "obstacles[2].colour",
     'is "#12345", must be #rrggbb in hexadecimal'),
    ('"groups": [{"list": {}, "radius": {"constnat": 0.1}},', 36, "groups[0].radius.constnat",
     'is not a field of Radius; did you mean "constant"?'),
    ('{"fill": {"min": [0, 0, 0], "max": [1, 1, 1], "count": -5}, "radius": 0.1},', 56, "groups[1].fill.count",
     "is -5, must be at least 1"),
    ('{"csv": null}],', 9, "groups[2].csv", "is null, must be an object"),
    ('"camera": {"fieldOfView": 0},', 27, "camera.fieldOfView", "is 0, must be 1 to 150 °"),
    ('"camera": {}', 1, "camera", "is given twice"),
]
BEGIN = '{\n"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]},\n'


class Check(FolderTestCase):
    def checked(self, text, code=2):
        path = self.write("wrong.json", text)
        done = call("scene", "check", path)
        self.assertEqual((done.returncode, done.stderr), (code, ""), done.stdout)
        return [line.removeprefix(path) for line in done.stdout.splitlines()]

    def test_all_mistakes_are_found_at_once_with_their_places(self):
        found = self.checked(BEGIN + "".join(line + "\n" for line, *_ in MISTAKES) + "}\n")
        expected = [f":{number}:{column}: {path}: {message}"
                    for number, (_, column, path, message) in enumerate(MISTAKES, 3)]
        also = [line for line in found if line not in expected]
        self.assertEqual([line for line in expected if line not in found], [], "\n".join(found))
        self.assertEqual([line.split(": ", 1)[1] for line in also], ["groups[1].radius: is 0.1, must be an object"])

    def test_the_first_mistake_of_the_reader_has_its_place(self):
        for members, place in {
                '"groups": [{"list": {"spheres": [{"position": [0.5, 0.5, 0.5]},\n {"position": [2, 0, 0]}]},\n'
                ' "radius": {"constant": 0.1}}]': ":4:2: groups[0].list.spheres[1]: is at (2, 0, 0)",
                '"groups": [{"list": {},\n "material": "steel"}]': ':4:14: groups[0].material: is "steel", which is no',
                '"bounds2": 1': ":3:1: bounds2: is not a field of Scene; did you mean",
        }.items():
            found = self.checked(BEGIN + members + "}")
            self.assertEqual(len(found), 1, found)
            self.assertTrue(found[0].startswith(place), found)

    def test_syntax_errors_have_their_place(self):
        self.assertEqual(self.checked(BEGIN + '"step": 0.01\n"name": "a"}'),
                         [":4:1: is not JSON: unexpected string literal; expected '}'"])

    def test_scenes_of_the_program_have_no_mistakes(self):
        files = sorted(str(path) for path in (ROOT / "server/scenes").glob("*.json") if not path.stem.endswith("-1m"))
        done = call("scene", "check", *files)
        self.assertEqual((done.returncode, done.stdout), (0, "".join(f"{file}: no mistakes\n" for file in files)))

    def test_each_file_is_checked(self):
        right = self.write("right.json", BEGIN + '"name": "a"}')
        done = call("scene", "check", "/none.json", right)
        self.assertEqual((done.returncode, done.stdout),
                         (2, f"/none.json: there is no such file\n{right}: no mistakes\n"))

    def test_other_commands_name_the_first_mistake(self):
        path = self.write("wrong.json", BEGIN + '"step": 3,\n"nam": "a"}')
        for command in (("run", path, "--for", "1s", "--device", "cpu"), ("serve", path, "--device", "cpu"),
                        ("plan", path)):
            done = call(*command)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(done.stderr.splitlines()[-1], f"spherule: {path}:3:9: step: is 3, must be 1e-06 to 1 s "
                                                           "(1 more: see `spherule scene check`)")

    def test_the_key_of_a_schema_is_accepted(self):
        self.assertEqual(self.checked(BEGIN + '"$schema": "scene.schema.json"}', code=0), [": no mistakes"])


class New(FolderTestCase):
    def test_templates_are_listed(self):
        done = call("scene", "new")
        self.assertEqual(done.returncode, 0)
        self.assertEqual([line.split()[0] for line in done.stdout.splitlines()], ["box", "drum", "empty", "hopper"])

    def test_each_template_has_no_mistakes_and_runs(self):
        for name in ("box", "drum", "empty", "hopper"):
            path = self.at(f"{name}.json")
            self.assertEqual(call("scene", "new", name, path).returncode, 0)
            text = pathlib.Path(path).read_text(encoding="utf-8")
            self.assertEqual(json.loads(text)["$schema"], "scene.schema.json")
            self.assertEqual(call("scene", "check", path).stdout, f"{path}: no mistakes\n")
            done = call("run", path, "--for", "0.2s", "--device", "cpu", "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(json.loads(done.stdout)["outside"], 0, name)

    def test_no_file_is_replaced(self):
        path = self.write("mine.json", "mine")
        done = call("scene", "new", "box", path)
        self.assertEqual((done.returncode, done.stderr), (2, f"spherule: {path}: is there already; give another name\n"))
        self.assertEqual(pathlib.Path(path).read_text(encoding="utf-8"), "mine")

    def test_the_name_of_the_file_follows_from_the_template(self):
        done = subprocess.run([BINARY, "scene", "new", "empty"], cwd=self.folder, check=False, capture_output=True)
        self.assertEqual(done.returncode, 0)
        self.assertEqual(os.listdir(self.folder), ["empty.json"])

    def test_unknown_templates_are_refused(self):
        done = call("scene", "new", "bix", self.at("a.json"))
        self.assertEqual((done.returncode, done.stderr),
                         (2, 'spherule: "bix": is no template (did you mean box?); there are box, drum, empty, hopper\n'))


class Fields(unittest.TestCase):
    def test_a_part_of_a_scene_is_described(self):
        done = call("scene", "fields", "here=Sleep")
        self.assertIn("| `here.speed` | m/s | 0.02 | above 0, up to 1,000 |", done.stdout)
        self.assertEqual(call("scene", "fields", "Sleap").stderr.split(";")[0],
                         'spherule: "Sleap": is no message of a scene (did you mean Sleep?)')
        self.assertIn("## Attraction\n", call("scene", "fields").stdout)

    def test_the_page_on_scenes_is_up_to_date(self):
        done = subprocess.run([sys.executable, "-B", ROOT / "docs/scene_tables.py", BINARY, "--check"],
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_parts_of_the_command_are_suggested(self):
        done = call("scene", "chek", "a.json")
        self.assertEqual((done.returncode, done.stderr),
                         (2, 'spherule: "chek" is no command (did you mean check?); there are check, new, schema, fields; '
                             "see `spherule scene --help`\n"))


if __name__ == "__main__":
    unittest.main()
