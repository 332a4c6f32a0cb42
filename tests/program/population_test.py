"""Tests `remove`, sinks and `spawn` with clients that follow the population and clients that do not."""
import base64
import json
import sys
import unittest

from program import FolderTestCase, runner, wait_for
from serving import Server
from viewer import Viewer

BINARY = sys.argv.pop(1)
call = runner(BINARY)

BED = {"name": "bed", "bounds": {"min": [-1, -1, -1], "max": [1, 1, 1]},
       "materials": [{"friction": 0.4, "restitution": 0}],
       "groups": [{"name": "bed", "radius": {"constant": 0.05},
                   "lattice": {"min": [-1, -1, -1], "max": [1, 1, -0.7], "spacing": 0.107}}]}
TEN = {"name": "ten", "radius": {"constant": 0.05}, "colour": "#ff0000",
       "lattice": {"min": [-0.3, -0.3, 0], "max": [0.3, 0.3, 0.3], "spacing": 0.2, "count": 10}}


class Follower(Viewer):
    """Follows Population messages: keeps the id of each place."""

    def __init__(self, port, **more):
        super().__init__(port, population=True, **more)

    def table(self):
        facts = self.of("scene")[-1]
        table = {}
        for run in facts.get("places", []):
            self.add(table, run)
        number = facts.get("population", 0)
        for change in self.of("population"):
            if change["epoch"] != facts["epoch"] or change["number"] <= number:
                continue
            assert change["number"] == number + 1, "no change is left out"
            number = change["number"]
            for run in change.get("removed", []):
                for k in range(run["count"]):
                    del table[run.get("first", 0) + k]
            for run in change.get("added", []):
                self.add(table, run)
        return table

    @staticmethod
    def add(table, run):
        for k in range(run.get("count", 0)):
            place = run.get("first", 0) + k
            assert place not in table, "the place is taken"
            table[place] = int(run.get("id", 0)) + k


def size(frame):
    """Returns the bytes of positions, values and spins."""
    return sum(len(base64.b64decode(frame.get(name, ""))) for name in ("spb", "values", "spins"))


class Population(FolderTestCase):
    def serve(self, scene, *options):
        return Server(BINARY, "serve", self.write("scene.json", json.dumps(scene)), "--device", "cpu:1", *options)

    def ctl(self, server, *words):
        return call("ctl", server.stream, *words)

    def query(self, server):
        return json.loads(self.ctl(server, "query").stdout)

    def test_followers_get_changes_and_others_new_epochs(self):
        with self.serve(BED) as server:
            follower, other = Follower(server.port), Viewer(server.port)
            for viewer in (follower, other):
                viewer.wait(lambda one: one.of("frame"))
            before = other.of("scene")[-1]["count"]
            self.assertEqual(len(follower.table()), before)
            self.assertEqual(self.ctl(server, "spawn", json.dumps(TEN)).returncode, 0)
            self.assertEqual(self.ctl(server, "remove", "3", "4").returncode, 0)
            self.assertEqual(self.ctl(server, "remove", str(before + 1)).returncode, 0)
            follower.wait(lambda one: len(one.of("population")) >= 3)
            other.wait(lambda one: one.of("scene")[-1]["count"] == before + 7)
            self.assertEqual(len(follower.of("scene")), 1, "no new epoch")
            ids = sorted(follower.table().values())
            self.assertEqual(ids, sorted(set(range(before + 10)) - {3, 4, before + 1}))
            added = follower.of("population")[0]
            self.assertEqual([group["name"] for group in added["groups"]], ["ten"])
            self.assertEqual(sum(run["count"] for run in added["added"]), 10)
            self.assertLess(len(json.dumps(added)), 400, "bytes in proportion to the new spheres")
            # Frames of both go on.
            number = follower.of("population")[-1]["number"]
            follower.wait(lambda one: one.of("frame")[-1].get("population", 0) == number)
            epoch = other.of("scene")[-1]["epoch"]
            other.wait(lambda one: one.of("frame")[-1]["epoch"] == epoch)
            self.assertEqual(other.of("frame")[-1]["count"], before + 7)
            late = Follower(server.port).wait(lambda one: one.of("frame"))
            self.assertEqual(sorted(late.table().values()), ids)
            statistics = self.query(server)
            self.assertEqual(int(statistics["born"]), before + 10)
            self.assertEqual(int(statistics["removed"]), 3)
            self.assertEqual(server.metrics()["spherule_spheres_removed_total", ""], 3)

    def test_frames_grow_by_what_new_spheres_need(self):
        begin = 2  # s, when the bed sleeps
        pouring = dict(BED, emitters=[{"box": {"min": [-0.9, -0.9, 0.5], "max": [0.9, 0.9, 0.5]}, "rate": 60, "begin": begin,
                                       "radius": {"constant": 0.05}, "velocity": [0, 0, -1]}])
        with self.serve(pouring) as server:
            follower = Follower(server.port)
            follower.wait(lambda one: one.of("frame") and one.of("frame")[-1]["simTime"] > begin + 3)
            frames = follower.of("frame")
            asleep = [frame for frame in frames if begin - 0.5 < frame["simTime"] < begin]
            later = [frame for frame in frames if frame["simTime"] > begin]
            bed = sum(run["count"] for run in follower.of("scene")[0]["places"])
            self.assertEqual({frame["status"]["sleeping"] for frame in asleep}, {bed}, "the bed sleeps")
            self.assertLessEqual(len(follower.of("scene")), 2, "one epoch with more places")
            born = len(follower.table()) - bed
            self.assertGreater(born, 150)
            # Those that an earlier status tells: births come evenly.
            awake = sum(bed + born * k / len(later) - frame["status"].get("sleeping", 0) for k, frame in enumerate(later))
            at_rest = max(size(frame) for frame in asleep)
            moving = sum(size(frame) - at_rest for frame in later)
            told = sum(len(json.dumps(message)) for message in follower.of("population"))
            print(f"{born} births, {len(later)} frames with {awake:.0f} awake spheres in all: {moving} bytes besides "
                  f"{at_rest} bytes per frame, and {told} bytes of messages of births")
            self.assertLess(moving, 2 * awake + 64 * born)  # a keyframe for each birth would be more
            self.assertLess(told, 200 * born)

    def test_refusals_name_the_field_and_change_nothing(self):
        with self.serve(BED) as server:
            for words, text in ((["remove", "99999"], "remove.spheres[0]: is 99999, the scene has"),
                                (["remove", "region", "5", "5", "5", "6", "6", "6"], "has no sphere's centre in it"),
                                (["remove"], "needs ids of spheres, or a region"),
                                (['{"remove":{}}'], "are missing: give ids of spheres, or a region")):
                done = self.ctl(server, *words)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(text, done.stderr + done.stdout)
            self.assertEqual(self.ctl(server, "remove", "7").returncode, 0)
            self.assertIn("a sphere that was removed", self.ctl(server, "remove", "7").stderr)
            self.assertIn("a sphere that was removed", self.ctl(server, "push", "7", "0", "0", "1").stderr)
            self.assertEqual(int(self.query(server)["removed"]), 1)

    def test_a_slow_follower_gets_the_facts_again(self):
        rain = dict(BED, sinks=[{"region": {"min": [-1, -1, -1], "max": [0.3, 1, -0.9]}}])  # the others stay
        with self.serve(rain) as server:
            follower = Follower(server.port)
            follower.wait(lambda one: one.of("frame"))
            wait_for(lambda: int(self.query(server)["removed"]) > 300)
            left = int(self.query(server)["spheres"])
            follower.wait(lambda one: len(one.table()) == int(self.query(server)["spheres"]))
            self.assertLessEqual(len(follower.table()), left)
            late = Follower(server.port)
            late.wait(lambda one: one.of("scene") and len(one.table()) == int(self.query(server)["spheres"]))

    def test_an_empty_world_and_one_without_contacts_begin_an_epoch(self):
        for contacts, region, scenes in ((True, ["-1", "-1", "-1", "1", "1", "1"], 2),
                                         (False, ["-1", "-1", "-1", "0", "0", "1"], 2)):
            with self.serve(dict(BED, sphereContacts=contacts)) as server:
                follower = Follower(server.port)
                follower.wait(lambda one: one.of("frame"))
                self.assertEqual(self.ctl(server, "remove", "region", *region).returncode, 0)
                left = int(self.query(server)["spheres"])
                follower.wait(lambda one: len(one.of("scene")) == scenes and len(one.table()) == left)
                self.assertEqual(self.ctl(server, "spawn", json.dumps(TEN)).returncode, 0)
                follower.wait(lambda one: len(one.table()) == left + 10)
                epoch = follower.of("scene")[-1]["epoch"]
                follower.wait(lambda one: one.of("frame")[-1]["epoch"] == epoch)

    def test_a_script_removes_and_a_dump_keeps_ids(self):
        scene = self.write("scene.json", json.dumps(BED))
        script = self.write("script.txt", "0.05s remove 0 1\n0.1s remove region -1 -1 -1 0 0 0\n")
        dump = self.at("dump.csv")
        done = call("run", scene, "--device", "cpu:1", "--for", "0.3s", "--script", script, "--dump", dump, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads(done.stdout.splitlines()[-1])
        self.assertEqual(result["born"], result["spheres"] + result["removed"])
        self.assertGreater(result["removed"], 50)
        rows = [line.split(",") for line in open(dump, encoding="utf-8").read().splitlines()[1:]]
        last = [row for row in rows if row[0] == rows[-1][0]]
        self.assertEqual(len(last), result["spheres"])
        ids = [int(row[1]) for row in last]
        self.assertEqual(ids, sorted(ids))
        self.assertNotIn(0, ids)
        self.assertEqual(max(ids), result["born"] - 1)
        again = call("run", scene, "--device", "cpu:2", "--for", "0.3s", "--script", script, "--json")
        self.assertEqual(json.loads(again.stdout.splitlines()[-1])["stateHash"], result["stateHash"])
        wrong = self.write("wrong.txt", "0.1s remove 99999\n")
        done = call("run", scene, "--device", "cpu:1", "--for", "0.3s", "--script", wrong)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("removes sphere 99999, but the scene has", done.stderr)

    def test_a_recording_shows_the_present_spheres(self):
        scene = self.write("scene.json", json.dumps(dict(BED, sinks=[{"region": {"min": [-1, -1, -1],
                                                                                "max": [-0.5, 1, 1]}}])))
        film = self.at("film.sph")
        done = call("run", scene, "--device", "cpu:1", "--for", "0.5s", "--record", film, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        left = json.loads(done.stdout.splitlines()[-1])["spheres"]
        table = self.at("table.csv")
        done = call("export", film, "--format", "csv", "--out", table)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = open(table, encoding="utf-8").read().splitlines()[1:]
        time = rows[-1].split(",")[0]
        self.assertEqual(sum(row.startswith(time + ",") for row in rows), left)

    def test_sinks_are_checked(self):
        for sinks, text in (([{}], "sinks[0].region: is missing"),
                            ([{"region": {"min": [1, 0, 0], "max": [0, 1, 1]}}], "sinks[0].region"),
                            ([{"region": {"min": [0, 0, 0], "max": [1, 1, 1]}}] * 9, "sinks: has 9 entries")):
            scene = self.write("scene.json", json.dumps(dict(BED, sinks=sinks)))
            done = call("run", scene, "--device", "cpu:1", "--for", "0.1s")
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(text, done.stderr)


if __name__ == "__main__":
    unittest.main()
