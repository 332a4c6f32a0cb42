#!/usr/bin/env python3
"""Tests commands of the program: command_line_test.py BINARY DEVICE, with the device `software` or `cpu`."""
import csv
import fcntl
import json
import os
import signal
import subprocess
import sys
import tempfile
import termios
import time
import unittest

from program import FolderTestCase, json_runner, runner, wait_for
from serving import Server

DEVICE = sys.argv.pop()
BINARY = sys.argv.pop()
KEYS = """scene device renderer quality spheres born removed emitters sinks steps substepsPerStep simSeconds intervalSeconds wallSeconds realTimeFactor
deviceSeconds passSeconds rebuilds launches longestChain kineticEnergy rotationalEnergy elasticEnergy potentialEnergy pushWork momentum angularMomentum contacts
overlapMean overlapMax wallOverlapMax speedMax speedRms meanHeight sleeping outside nonFinite impacts restitution
restitutionAsked collisions dissipatedEnergy kineticStress contactStress surfaceForces stateHash""".split()


call = runner(BINARY)
run_json = json_runner(call, DEVICE)


def scene_in(folder, name, radius, *positions):
    """Writes a scene of spheres in a unit cube; returns its path."""
    path = os.path.join(folder, name)
    spheres = [{"position": position} for position in positions]
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]},
                   "groups": [{"radius": {"constant": radius}, "list": {"spheres": spheres}}]}, file)
    return path


class Run(unittest.TestCase):
    def test_json_has_every_key(self):
        report = run_json("two-spheres", "--for", "0.1s")
        self.assertEqual(list(report), KEYS)
        self.assertEqual((report["steps"], report["spheres"], report["device"]), (6, 2, DEVICE))
        self.assertEqual((len(report["momentum"]), len(report["angularMomentum"])), (3, 3))
        self.assertRegex(report["stateHash"], "^[0-9a-f]{16}$")

    def test_impacts_are_those_of_each_stretch(self):
        done = call("run", "cradle", "--for", "2s", "--every", "1s", "--device", DEVICE, "--json")
        first, second = (json.loads(line) for line in done.stdout.splitlines())
        self.assertGreater(first["impacts"], 0)
        self.assertAlmostEqual(first["restitution"], 1, places=4)
        self.assertEqual(first["restitutionAsked"], 1)
        self.assertEqual((second["impacts"], second["restitution"], second["restitutionAsked"]), (0, None, None))

    def test_contact_sums_are_there_if_asked_for(self):
        plain = run_json("box-4k", "--for", "0.6s", "--no-sleep")
        names = "collisions", "dissipatedEnergy", "kineticStress", "contactStress", "surfaceForces"
        self.assertEqual([plain[name] for name in names], [None] * 5)
        done = call("run", "box-4k", "--for", "0.6s", "--every", "0.3s", "--contact-sums", "--no-sleep", "--device", DEVICE,
                    "--json")
        first, second = (json.loads(line) for line in done.stdout.splitlines())
        self.assertEqual(second["stateHash"], plain["stateHash"])
        self.assertGreater(second["collisions"], first["collisions"])
        lost = sum(first[name] - second[name] for name in ("kineticEnergy", "rotationalEnergy", "potentialEnergy"))
        self.assertAlmostEqual((second["dissipatedEnergy"] - first["dissipatedEnergy"]) / lost, 1, delta=0.1)
        self.assertEqual((len(second["kineticStress"]), len(second["contactStress"])), (6, 6))
        self.assertGreater(second["contactStress"][2], first["contactStress"][2])  # more spheres lie on others

    def test_surface_forces_are_written_at_the_times_of_reports(self):
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/forces.csv"
            more = ("--every", "0.5s", "--surface-forces", path, "--device", DEVICE, "--json")
            done = call("run", "bounce", "--for", "1.5s", *more)
            self.assertEqual(done.returncode, 0, done.stderr)
            reports = [json.loads(line) for line in done.stdout.splitlines()]
            with open(path, encoding="utf-8", newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual(list(rows[0]), "time surface fx fy fz tx ty tz".split())
            per_report = len(rows) // len(reports)
            self.assertEqual(len(rows), per_report * len(reports))
            for report, first in zip(reports, range(0, len(rows), per_report)):
                for row, force in zip(rows[first:first + per_report], report["surfaceForces"], strict=True):
                    self.assertAlmostEqual(float(row["time"]), report["simSeconds"], places=6)
                    self.assertEqual(row["surface"], force["surface"])
                    for name, value in zip("fx fy fz tx ty tz".split(), force["force"] + force["torque"], strict=True):
                        self.assertAlmostEqual(float(row[name]), value, delta=1e-6 * (1 + abs(value)))
            floor = next(row for row in rows[-per_report:] if row["surface"] == "Z_MIN")
            self.assertLess(float(floor["fz"]), -1)
            self.assertIn(path, call("run", "bounce", "--for", "0.1s", *more).stderr)
            self.assertEqual(call("run", "bounce", "--for", "0.1s", *more, "--force").returncode, 0)

    def test_same_scene_and_seed_give_the_same_hash_and_another_seed_another(self):
        def hash_of(*more):
            return run_json("box-4k", "--for", "0.1s", *more)["stateHash"]
        self.assertEqual(hash_of(), hash_of())
        self.assertNotEqual(hash_of(), hash_of("--seed", "7"))

    def test_contacts_are_counted_before_the_first_step(self):
        with tempfile.TemporaryDirectory() as folder:
            report = run_json(scene_in(folder, "pair.json", 0.1, [0.4, 0.5, 0.5], [0.58, 0.5, 0.5]), "--for", "0s")
        self.assertEqual((report["steps"], report["contacts"]), (0, 1))
        self.assertAlmostEqual(report["overlapMax"], 0.2, places=5)

    def test_spheres_deep_in_each_other_are_moved_apart_and_it_is_said(self):
        with tempfile.TemporaryDirectory() as folder:
            path = scene_in(folder, "pair.json", 0.1, [0.4, 0.5, 0.5], [0.45, 0.5, 0.5])
            done = call("run", path, "--for", "0s", "--device", DEVICE, "--json")
            self.assertLess(json.loads(done.stdout)["overlapMax"], 0.25)
            self.assertIn("pushing them apart first", done.stderr)
            self.assertAlmostEqual(run_json(path, "--for", "0s", "--quality", "fast")["overlapMax"], 1.5, places=5)

    def test_substeps_and_sleep_follow_the_options(self):
        self.assertEqual(run_json("bounce", "--for", "0.05s", "--substeps", "3")["substepsPerStep"], 3)

    def test_the_model_follows_the_option_and_brings_its_substeps(self):
        def model_of(*more):
            report = run_json("bounce", "--for", "0s", *more)
            return report["quality"], report["substepsPerStep"]
        self.assertEqual(model_of(), ("balanced", 8))
        self.assertEqual(model_of("--quality", "fast"), ("fast", 2))
        self.assertEqual(model_of("--quality", "fast", "--substeps", "5"), ("fast", 5))
        model, substeps = model_of("--quality", "accurate")
        self.assertEqual(model, "accurate")
        self.assertGreater(substeps, 8)

    def test_every_reports_each_stretch(self):
        done = call("run", "two-spheres", "--for", "0.25s", "--every", "0.1s", "--device", DEVICE, "--json")
        reports = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual([round(report["intervalSeconds"], 3) for report in reports], [0.1, 0.1, 0.05])
        self.assertAlmostEqual(sum(reports[0]["passSeconds"].values()), reports[0]["deviceSeconds"])
        self.assertGreater(reports[0]["passSeconds"]["contacts"], 0)
        rows = call("run", "two-spheres", "--for", "0.25s", "--every", "0.1s", "--device", DEVICE).stdout.splitlines()
        self.assertEqual([row.split()[0] for row in rows], ["time,", "0.1", "0.2", "0.25"])

    def test_a_dump_replaces_nothing_unless_told_and_a_refused_start_leaves_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            path, recording = os.path.join(folder, "states.csv"), os.path.join(folder, "run.sph")
            with open(path, "w", encoding="utf-8") as file:
                file.write("precious")
            run = ("run", "two-spheres", "--for", "0.1s", "--device", DEVICE, "--dump", path, "--record", recording)
            done = call(*run)
            self.assertEqual((done.returncode, done.stderr.splitlines()[-1]),
                             (2, f"spherule: {path}: is there already; give --force to replace it, or another name"))
            self.assertEqual(os.listdir(folder), ["states.csv"])
            with open(path, encoding="utf-8") as file:
                self.assertEqual(file.read(), "precious")
            self.assertEqual(call(*run, "--force").returncode, 0)
            with open(path, encoding="utf-8") as file:
                self.assertEqual(len(file.readlines()), 1 + 2 * 2)
            os.rename(path, recording)
            self.assertEqual(call(*run).returncode, 2)
            self.assertEqual(os.listdir(folder), ["run.sph"])

    def test_exit_codes(self):
        self.assertEqual(call("run", "box-4k").returncode, 2)
        self.assertEqual(call("run", "no-such-scene", "--for", "1s", "--device", DEVICE).returncode, 2)
        self.assertEqual(call("run", "bounce", "--for", "soon", "--device", DEVICE).returncode, 2)
        self.assertEqual(call("run", "bounce", "--for", "1e300s", "--device", DEVICE).returncode, 2)
        self.assertEqual(call("run", "bounce", "--for", "1s", "--quality", "best", "--device", DEVICE).returncode, 2)
        self.assertEqual(call("serve", "bounce", "--quality", "best", "--device", DEVICE).returncode, 2)
        self.assertEqual(call("run", "bounce", "--for", "1s", "--every", "0", "--dump", "/dev/null").returncode, 2)
        self.assertEqual(call("run", "bounce", "--for", "1s", "--device", "gpu:99").returncode, 3)
        self.assertRegex(call("run", "--help").stdout, r"\n  75 +device lost or hanging; start again\n")

    def test_a_wrong_scene_is_refused_with_file_path_value_and_reason(self):
        with tempfile.TemporaryDirectory() as folder:
            path = scene_in(folder, "wrong.json", -0.1, [0.5, 0.5, 0.5])
            done = call("run", path, "--for", "1s", "--device", DEVICE)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"wrong\.json:\d+:\d+: groups\[0\]\.radius\.constant: is -0\.1, must be 1e-06 to 1000000 m")


class Interrupted(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.dump = self.at("states.csv")

    def start(self, *more):
        running = subprocess.Popen([BINARY, "run", "two-spheres", "--for", "1e9s", "--device", DEVICE, *more],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: (running.kill(), running.wait(), running.stdout.close(), running.stderr.close()))
        return running

    def test_the_first_signal_ends_it_with_a_summary_and_complete_files(self):
        for sign in signal.SIGINT, signal.SIGTERM:
            recording = f"{self.dump}-{sign}.sph"
            running = self.start("--json", "--every", "1s", "--dump", self.dump, "--record", recording, "--force")
            self.assertTrue(wait_for(lambda path=recording: os.path.exists(path) and os.path.getsize(path) > 1000))
            running.send_signal(sign)
            out, said = running.communicate(timeout=20)
            self.assertEqual(running.returncode, 0, said)
            report = json.loads(out)
            self.assertEqual(list(report), KEYS)
            self.assertIn(f"ended early by {sign.name}, at step {report['steps']}", said)
            with open(self.dump, encoding="utf-8", newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual(len(rows) % 2, 0)
            self.assertAlmostEqual(float(rows[-1]["time"]), report["simSeconds"], delta=1e-6 * report["simSeconds"])
            states = recording + ".csv"
            done = call("export", recording, "--format", "csv", "--out", states)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn("exported up to", done.stderr)
            with open(states, encoding="utf-8") as file:
                last = list(csv.DictReader(file))[-1]
            self.assertAlmostEqual(float(last["time"]), report["simSeconds"], delta=1e-6 * report["simSeconds"])

    def test_with_every_each_line_is_whole(self):
        running = self.start("--json", "--every", "0.5s")
        lines = [running.stdout.readline(), running.stdout.readline()]
        running.send_signal(signal.SIGINT)
        rest = running.stdout.read()  # communicate() would lose what readline() has read ahead
        running.communicate(timeout=20)
        self.assertEqual(running.returncode, 0)
        reports = [json.loads(line) for line in lines + rest.splitlines()]
        for before, after in zip(reports, reports[1:]):
            self.assertAlmostEqual(after["simSeconds"], before["simSeconds"] + after["intervalSeconds"], places=6)

    def test_the_second_signal_ends_it_at_once(self):
        os.mkfifo(self.dump)  # the pipe fills up, so that the program cannot finish
        reader = os.open(self.dump, os.O_RDWR | os.O_NONBLOCK)
        self.addCleanup(os.close, reader)

        def is_full(wait=0.3):
            before = fcntl.ioctl(reader, termios.FIONREAD, b"1234")
            time.sleep(wait)
            return before == fcntl.ioctl(reader, termios.FIONREAD, b"1234") != bytes(4)
        for first, second in (signal.SIGINT, signal.SIGTERM), (signal.SIGTERM, signal.SIGINT):
            running = self.start("--every", "0.02s", "--dump", self.dump, "--force")
            self.assertTrue(wait_for(is_full))
            running.send_signal(first)
            time.sleep(0.2)
            self.assertIsNone(running.poll())
            running.send_signal(second)
            self.assertEqual(running.wait(timeout=20), 128 + second)
            while True:
                try:
                    os.read(reader, 1 << 20)
                except BlockingIOError:
                    break

    def test_a_signal_that_was_ignored_stays_so(self):
        running = subprocess.Popen(["sh", "-c", 'trap "" HUP; exec "$@"', "sh", BINARY, "run", "two-spheres", "--for", "1e9s",
                                    "--device", DEVICE, "--dump", self.dump], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        self.addCleanup(lambda: (running.kill(), running.wait()))
        self.assertTrue(wait_for(lambda: os.path.exists(self.dump) and os.path.getsize(self.dump) > 0))
        running.send_signal(signal.SIGHUP)
        time.sleep(0.2)
        self.assertIsNone(running.poll())


class Others(unittest.TestCase):
    def test_no_limit_is_switched_off_by_a_number_that_is_none(self):
        for option in ("--connections-per-second", "--commands-per-second"):
            for value in ("nan", "inf", "-1", "many"):
                done = call("serve", "bounce", option, value, "--listen", "127.0.0.1:0", "--device", DEVICE)
                self.assertEqual(done.returncode, 2, (option, value))
                self.assertIn(option, done.stderr)
        for value in ("nan", "inf", "1e308min"):
            self.assertEqual(call("run", "bounce", "--for", "1s", "--watchdog", value).returncode, 2, value)

    def test_plan_says_what_a_scene_requires(self):
        plan = json.loads(call("plan", "box-50k", "--json").stdout)
        self.assertEqual((plan["spheres"], plan["bytes"]), (50000, sum(array["bytes"] for array in plan["arrays"])))
        words = call("plan", "box-50k").stdout.split()  # the last line has the bytes read and written by all kernels
        self.assertIn("solve_contacts.comp", words)
        self.assertAlmostEqual(int(words[-2]), sum(row["read"] for row in plan["traffic"]), delta=0.5)
        self.assertEqual([call("plan", "bounce", "--quality", name).returncode for name in ("accurate", "best")], [0, 2])

    def test_probe_names_the_renderer(self):
        chosen = json.loads(call("probe", "--device", DEVICE, "--json").stdout)["chosen"]
        self.assertIn({"software": "llvmpipe", "cpu": "thread"}[DEVICE], chosen["renderer"])


class ServeWithContactSums(unittest.TestCase):
    def test_queries_and_metrics_have_them(self):
        with Server(BINARY, "serve", "cradle", "--contact-sums", "--device", DEVICE) as server:
            answer = wait_for(lambda: (figures := json.loads(call("ctl", server.stream, "query").stdout))["simTime"] > 1
                              and figures)
            self.assertGreater(int(answer["collisions"]), 0)
            self.assertGreater(answer["contactStress"][0], 0)
            metrics = wait_for(lambda: (all_of := server.metrics()).get(("spherule_collisions", ""), 0) > 0 and all_of)
        self.assertGreater(metrics["spherule_contact_stress_pascals", "xx"], 0)
        self.assertGreaterEqual(metrics["spherule_kinetic_stress_pascals", "xx"], 0)
        self.assertIn(("spherule_dissipated_joules", ""), metrics)

    def test_queries_and_metrics_have_forces_on_walls(self):
        with Server(BINARY, "serve", "bounce", "--contact-sums", "--device", DEVICE) as server:
            answer = wait_for(lambda: (figures := json.loads(call("ctl", server.stream, "query").stdout))["simTime"] > 1
                              and figures)
            walls = {on["surface"]: on["force"] for on in answer["surfaceForces"]}
            self.assertEqual(list(walls), "X_MIN X_MAX Y_MIN Y_MAX Z_MIN".split())
            self.assertLess(walls["Z_MIN"][2], -1)
            force = 'spherule_surface_force_newtons{axis="z",surface="Z_MIN"} -'
            self.assertTrue(wait_for(lambda: force in server.get("/metrics")))
            self.assertIn('spherule_surface_torque_newton_metres{axis="x",surface="Z_MIN"} ', server.get("/metrics"))
            self.assertEqual(call("ctl", server.stream, "load", "cradle").returncode, 0)
            self.assertTrue(wait_for(lambda: "Z_MIN" not in server.get("/metrics")), "of a scene that is gone")


class Serve(unittest.TestCase):
    def setUp(self):
        self.server = self.enterContext(Server(BINARY, "serve", "cradle", "--device", DEVICE))
        self.get = self.server.get

    def ctl(self, *words):
        return call("ctl", self.server.stream, *words)

    def test_commands_are_answered_with_their_step_or_refused_with_the_reason(self):
        done = self.ctl("set", "gravity", "0", "0", "-1.6")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"^applied at step \d+")
        for words, reason in {("set", "restitution", "1.5"): "set.restitution: is 1.5",
                              ("set", "friction", "-1"): "set.friction: is -1",
                              ("set", "substeps", "0"): "set.substeps: is 0",
                              ("load", "nothing"): 'load.name: is "nothing"; known are',
                              ('{"load":{"scene":{}}}',): "load.scene.bounds: are missing",
                              ("spawn", "{}"): "spawn.group: has no spheres",
                              ("push", "99", "0", "0", "1"): "push.sphere: is 99",
                              ("step", "0"): "step.count: is 0"}.items():
            refused = self.ctl(*words)
            self.assertEqual((refused.returncode, refused.stdout), (4, ""), words)
            self.assertTrue(refused.stderr.startswith("refused: " + reason), refused.stderr)
        self.assertEqual(self.ctl("dance").returncode, 2)

    def test_a_query_is_answered_with_json_alone(self):
        done = self.ctl("query")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["spheres"], 5)
        self.assertNotIn("stateHash", json.loads(done.stdout))

    def test_a_query_for_the_hash_has_that_of_a_run(self):
        for words in ("pause",), ("reset",), ("step", "20"):
            self.assertEqual(self.ctl(*words).returncode, 0)
        answer = json.loads(self.ctl("query", "hash").stdout)
        self.assertEqual(answer["stateHash"], run_json("cradle", "--for", "0.33333s")["stateHash"])
        self.assertEqual(answer["step"], "20")
        self.assertEqual(json.loads(self.ctl("query", "hash").stdout), answer)
        self.ctl("step")
        self.assertNotEqual(json.loads(self.ctl("query", "hash").stdout)["stateHash"], answer["stateHash"])
        self.assertEqual(self.ctl("resume").returncode, 0)
        for _ in range(5):  # the world goes on
            self.assertRegex(json.loads(self.ctl("query", "hash").stdout)["stateHash"], "^[0-9a-f]{16}$")

    def test_a_scene_file_that_cannot_be_loaded_is_answered_with_what_can(self):
        done = self.ctl("load", "nope.json")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        for words in ("nope.json: there is no such file", "path of a scene file on this machine", "box-50k"):
            self.assertIn(words, done.stderr)
        with tempfile.TemporaryDirectory() as folder:
            os.mkfifo(os.path.join(folder, "pipe.json"))
            self.assertIn("is not a file", self.ctl("load", os.path.join(folder, "pipe.json")).stderr)
            path = os.path.join(folder, "wrong.json")
            with open(path, "w", encoding="utf-8") as file:
                file.write('{"bounds": }')
            self.assertIn("wrong.json:1:12: is not JSON", self.ctl("load", path).stderr)

    def test_friction_and_the_model_can_be_set(self):
        for words in (("set", "friction", "0.3"), ("set", "model", "fast"), ("set", "model", "accurate"),
                      ("set", "model", "balanced")):
            self.assertEqual(self.ctl(*words).returncode, 0, words)
        self.assertEqual(self.ctl("set", "model", "slow").returncode, 2)

    def test_a_refused_set_changes_nothing(self):
        self.assertEqual(self.ctl('{"set":{"speed":2,"restitution":5}}').returncode, 4)
        self.assertEqual(self.ctl('{"set":{"speed":-2,"gravity":[0,0,0]}}').returncode, 4)

    def test_a_file_name_that_is_no_utf8_does_not_end_the_server(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = scene_in(folder, "plain.json", 0.1, [0.5, 0.5, 0.5])
            path = os.path.join(os.fsencode(folder), b"caf\xe9.json")
            os.rename(scene, path)
            with Server(BINARY, "serve", path, "--device", DEVICE, errors="replace") as other:
                self.assertEqual(json.loads(other.get("/readyz"))["scene"], "caf\ufffd")
                self.assertEqual(other.end(), 0)

    def test_health_readiness_and_metrics(self):
        self.assertEqual(self.get("/healthz"), "alive\n")
        ready = json.loads(self.get("/readyz"))
        self.assertEqual((ready["device"], ready["scene"], ready["spheres"]), (DEVICE, "cradle", 5))
        self.assertIn(ready["state"], ("running", "paused"))
        self.assertIn("spherule_spheres 5", self.get("/metrics"))
        for _ in range(100):  # figures appear after the first request
            metrics = self.get("/metrics")
            if "spherule_momentum" in metrics:
                break
            time.sleep(0.1)
        for name in ("momentum_newton_seconds", "angular_momentum_newton_metre_seconds"):
            for axis in "xyz":
                self.assertIn(f'spherule_{name}{{axis="{axis}"}}', metrics)
        self.assertIn("spherule_push_work_joules 0", metrics)
        self.assertIn("<!doctype html>", self.get("/").lower())

    def test_sigterm_drains_and_exits_0(self):
        self.assertEqual(self.server.end(), 0)


if __name__ == "__main__":
    unittest.main()
