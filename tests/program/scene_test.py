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

# Mistakes of structure and of content. "@" is before the place of each mistake, which follows with path and message.
MIXED = [
    ('{"bounds": {"min": [0, 0, 0], "max": [1, 1, 1], "material": @"stel"},',
     ("bounds.material", 'is "stel", which is no material of the scene; it has "stone", "steel", "stone"; did you mean '
                         '"steel"?')),
    ('"gravity": [0, 0, 0], @"setp": 0.01, "quality": {"model": @"balanced"},',
     ("setp", 'is not a field of Scene; did you mean "step"?'),
     ("quality.model", 'is "balanced", must be one of FAST, BALANCED, ACCURATE; did you mean "BALANCED"?')),
    ('"materials": [{"name": "stone", "restitution": @1.5}, {"name": "steel"}, {"name": @"stone"}],',
     ("materials[0].restitution", "is 1.5, must be 0 to 1"),
     ("materials[2].name", 'is "stone", the name of another material')),
    ('"pairs": [{"a": "stone", "b": @"granite"}, {"a": "stone", "b": "steel"}, @{"a": "steel", "b": "stone"}],',
     ("pairs[0].b", 'is "granite", which is no material of the scene; it has "stone", "steel", "stone"'),
     ("pairs[2]", 'is of "steel" and "stone", as an earlier one is')),
    ('"fields": [{"buoyancy": @{}},',
     ("fields[0].buoyancy", "needs gravity, which is zero; give the scene a gravity or remove the buoyancy")),
    ('{"drag": {"velocity": @[0, 0, 2e5]}, "inBox": {"min": [0, 0, 0], "max": [1, @0, 1]}}],',
     ("fields[1].drag.velocity", "is 200000 m/s long, at most 100000 is allowed"),
     ("fields[1].inBox.max[1]", "is 0, must be above min, which is 0")),
    ('"obstacles": [{"mesh": {"file": @"none.stl"}, "material": @"ston"},',
     ("obstacles[0].mesh.file", "FOLDER/none.stl: there is no such file"),
     ("obstacles[0].material", 'is "ston", which is no material of the scene; it has "stone", "steel", "stone"; did '
                               'you mean "stone"?')),
    ('{"sphere": {"centre": [0.5, 0.5, 0.05], "radius": 0.04}, "motion": {"keyframes": [{"time": 2}, {"time": @1}]}},',
     ("obstacles[1].motion.keyframes[1].time", "is 1 s, must be above 2 s, the time before")),
    ('{"plane": {"point": [0, 0, 0], "normal": [0, @"up", 1]}, "motion": {"velocity": [0, 0, @2e9]}},',
     ("obstacles[2].plane.normal[1]", 'is "up", must be a number'),
     ("obstacles[2].motion.velocity[2]", "is 2000000000, must be -1000000000 to 1000000000 m/s")),
    ('{"disc": {"centre": [0.5, 0.5, 0.5], "normal": @[0, 0, 0], "radius": 0.1}},',
     ("obstacles[3].disc.normal", "is zero, must have a direction")),
    ('{"box": {"min": [0.9, 0.9, 0], "max": [1, 1, 0.1]}}],',),
    ('"groups": [{"radius": {"uniform": {"min": 0.02, "max": @0.01}}, "list": {}, "material": @"steal"},',
     ("groups[0].radius.uniform.max", "is 0.01, must be above min, 0.02"),
     ("groups[0].material", 'is "steal", which is no material of the scene; it has "stone", "steel", "stone"; did you '
                            'mean "steel"?')),
    ('{"radius": {"constant": 0.01}, "list": {"spheres": [{"position": [0.5, 0.5, 0.9]}, @{"position": [2, 0.5, 0.5]},',
     ("groups[1].list.spheres[1]", "is at (2, 0.5, 0.5) with radius 0.01 and reaches x = 2.01, outside the bounds, "
                                   "which are 0 to 1")),
    ('{"position": [0.5, @"a", 0.5]}, @{"position": [0.95, 0.95, 0.05]}]}},',
     ("groups[1].list.spheres[2].position[1]", 'is "a", must be a number'),
     ("groups[1].list.spheres[3]", "is at (0.95, 0.95, 0.05) with radius 0.01 and reaches into obstacles[4]")),
    ('{"radius": {"table": {"radii": [0.01, 0.02], "shares": [@0.5, 1]}}, "list": {}},',
     ("groups[2].radius.table.shares[0]", "is 0.5, must be 0: no sphere is smaller than the first radius; begin with "
                                          "the smallest radius")),
    ('{"csv": {"file": @"none.csv"}, "radius": {"constant": 0.01}, @"friction": 0.3},',
     ("groups[3].csv.file", "FOLDER/none.csv: there is no such file"),
     ("groups[3].friction", "is not a field of Group; Material and MaterialPair have one of this name")),
    ('{"fill": @{"min": [0, 0, 0], "max": [1, 1, 2], "count": 3}, "radius": {"constant": 0.01}},',
     ("groups[4].fill", "reaches z = 2, outside the bounds, which are 0 to 1; make the region smaller, or the bounds "
                        "larger")),
    ('{"fill": {"min": [0, 0, 0], "max": [1, 1, 1], "count": 3}, "radius": {@"constnat": 0.01}}],',
     ("groups[5].radius.constnat", 'is not a field of Radius; did you mean "constant"?')),
    ('"camera": {"eye": [1, 1, 1], "target": @[1, 1, 1]}, "light": {"direction": @[0, 0, 0]},',
     ("camera.target", "is where the eye is; move one of them"),
     ("light.direction", "has no length")),
    ('"sinks": [{"region": {"min": [0, 0, 0], "max": [@-1, 1, 1]}}],',
     ("sinks[0].region.max[0]", "is -1, must be above min, which is 0")),
    ('"emitters": [{"disc": {"centre": [0.5, 0.5, 0.8], "normal": [0, 0, 1], "radius": 0.1}, "rate": 9,',),
    ('"material": @"ste",',
     ("emitters[0].material", 'is "ste", which is no material of the scene; it has "stone", "steel", "stone"; did you '
                              'mean "stone"?')),
    ('"radius": {"constant": 0.01}, "schedule": [{"from": 1, "to": 2}, {"from": @1.5, "to": 3}]}]}',
     ("emitters[0].schedule[1].from", "is 1.5 s, but the time before it ends at 2 s; give them in order")),
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

    def test_mistakes_of_structure_and_of_content_are_found_at_once(self):
        expected = []
        for number, (line, *mistakes) in enumerate(MIXED, 1):
            parts = line.split("@")
            self.assertEqual(len(parts), 1 + len(mistakes), line)
            for k, (path, message) in enumerate(mistakes):
                column = 1 + len("".join(parts[:k + 1]))
                expected.append(f":{number}:{column}: {path}: {message.replace('FOLDER', self.folder)}")
        self.assertEqual(self.checked("\n".join(line.replace("@", "") for line, *_ in MIXED)), expected)

    def test_at_most_ten_spheres_of_a_list_are_named(self):
        spheres = ",\n".join('{"position": [2, 0, 0]}' if k % 2 else '{"position": [0.5, 0.5, 0.5], "radius": -1}'
                             for k in range(30))
        group = '{"list": {"spheres": [\n' + spheres + ']}, "radius": {"constant": 0.1}}'
        other = group.replace('"radius": -1', '"spin": [1, 0, 0]')
        found = self.checked(BEGIN + '"groups": [' + group + "," + other + "]}")
        structural = [line for line in found if line.endswith("radius: is -1, must be 1e-06 to 1000000 m")]
        self.assertEqual(len(structural), 15)
        content = [line.split(":")[3] for line in found if line not in structural]
        self.assertEqual(content, [f" groups[{n}].list.spheres[{k}]" for n in range(2) for k in range(1, 20, 2)])

    def test_nothing_that_follows_from_a_mistake_is_reported(self):
        group = '"groups": [{"list": {"spheres": [{"position": [5, 0, 0]}]}, "radius": {"constant": 0.1}, '
        for members, paths in {
                # The name of a material may be the one that is named.
                '"materials": [{"name": "a"}, {"nam": "b"}],' + group + '"material": "b"}]': ["nam", "spheres[0]"],
                '"materials": {"name": "b"},' + group + '"material": "b"}]': ["materials", "spheres[0]"],
                # A moved obstacle, or one without a shape, may be anywhere.
                '"obstacles": [{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}, "translation": [9, 9]}],'
                '"groups": [{"list": {"spheres": [{"position": [0.5, 0.5, 0.5], "radius": 0.1}]}}]': ["translation"],
                group.replace("[5, 0, 0]}]", '[5, 0, 0]}], "saved": 1') + '"metal": 0}]': ["saved"],
                '"step": 5, "emitters": [{"box": {"min": [0, 0, 0.5], "max": [1, 1, 1]}, "rate": 999999,'
                ' "radius": {"constant": 0.01}}]': ["step"],
        }.items():
            found = self.checked(BEGIN + members + "}")
            self.assertEqual(len(found), len(paths), found)
            for line, path in zip(found, paths):
                self.assertIn(f"{path}: ", line)
        for bounds in ('"min": [0, 0], "max": [1, 1, 1]', '"min": [1, 1, 1], "max": [0, 0, 0]'):
            found = self.checked('{"bounds": {' + bounds + "},\n" + group + '"material": "b"}]}')
            self.assertEqual(len(found), 2, "without bounds, no sphere has a wrong place")
            self.assertIn("bounds.m", found[0])
            self.assertIn("groups[0].material", found[1])

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
