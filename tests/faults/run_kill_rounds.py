#!/usr/bin/env python3
"""Kills a server at random moments while it is under load, and lets it go on: run_kill_rounds.py BINARY [ROUNDS [SEED]]

In each round viewers watch, a controller sends commands at random, and a recording is made. After the last round,
`spherule replay` carries out the command log of all rounds without any disturbance. Its hashes are those of the server
only if each round went on with the right bits.
"""
import glob
import json
import os
import random
import shutil
import sys
import tempfile
import time

from program import runner, wait_for
from serving import Server
from viewer import Controller, Viewer

BINARY = sys.argv[1]
ROUNDS = int(sys.argv[2]) if len(sys.argv) > 2 else 100
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else 1
EVERY = 0.3  # s between checkpoints
call = runner(BINARY, timeout=600)


def serve(folder, *more):
    return Server(BINARY, "serve", "rapids-3k", "--device", "cpu", "--checkpoints", folder + "/kept", "--checkpoint-every",
                  f"{EVERY}s", "--resume", "--log", folder + "/commands.sphl", "--hash-every", "5", "--auto", "30ms", *more)


def one_round(number, folder, chance, safe):
    """Returns how many steps the server had done, the step of its last checkpoint on the disk, and its recording. `safe`:
    the step of the last checkpoint of the round before."""
    recording = os.path.join(folder, f"round-{number}.sph")
    with serve(folder, "--record", recording) as server:
        controller = Controller(server.port)
        viewers = [Viewer(server.port, rate=rate) for rate in (60, 5)]
        if number == 0:  # there is a checkpoint from which the next round can go on
            wait_for(lambda: server.metrics()["spherule_checkpoints_total", ""] > 0)
        end = time.monotonic() + chance.uniform(0.3, 3)
        while time.monotonic() < end:
            controller.command(chance)
            time.sleep(0.03)
        steps = server.metrics()["spherule_steps", ""]
        server.end(kill=True)
        del viewers
    began = server.went_on_from()
    if number > 0 and (began is None or began < safe):
        raise AssertionError(f"round {number} went on from step {began}, but step {safe} was on the disk:\n{server.output}")
    if "passed over" in server.output:
        raise AssertionError(f"round {number} passed over a checkpoint:\n{server.output}")
    return steps, server.last_checkpoint(), recording


def check_recording(path):
    """Returns the number of frames that can be exported; 0 if the server was killed before the first one."""
    if not os.path.exists(path):
        return 0
    out = path + ".csv"
    done = call("export", path, "--format", "csv", "--out", out, "--every", "0.2s")
    if done.returncode == 2 and "has no frames" in done.stderr:
        return 0
    if done.returncode != 0:
        raise AssertionError(f"{path} cannot be read: {done.stderr}")
    with open(out, encoding="utf-8") as file:
        times = {line.split(",", 1)[0] for line in file} - {"time"}
    os.remove(out)
    os.remove(path)
    return len(times)


def main():
    chance = random.Random(SEED)
    with tempfile.TemporaryDirectory() as folder:
        readable = safe = 0
        for number in range(ROUNDS):
            steps, safe, recording = one_round(number, folder, chance, safe)
            readable += check_recording(recording) > 0
            if number % 10 == 9:
                print(f"{number + 1} rounds: about {steps:.0f} steps, {safe} of them in a checkpoint; {readable} recordings "
                      "have frames", flush=True)
        with serve(folder) as server:  # ends in order, and so does its log
            if server.end() != 0:
                raise AssertionError(server.said)
        done = call("replay", folder + "/commands.sphl", "--device", "cpu", "--json")
        if done.returncode != 0:
            kept = shutil.copy(folder + "/commands.sphl", os.path.join(tempfile.gettempdir(), f"kill-rounds-{SEED}.sphl"))
            raise AssertionError(f"the replay of {kept} differs: {done.stdout}{done.stderr}")
        report = json.loads(done.stdout)
        if not (report["complete"] and report["same"] and report["hashes"] > ROUNDS and report["step"] >= safe):
            raise AssertionError(f"the log is not that of all rounds: {report}")
        if glob.glob(folder + "/commands-*.sphl"):
            raise AssertionError("a round did not go on with the log")
        if readable == 0:
            raise AssertionError("no recording has frames")
        size = os.path.getsize(folder + "/commands.sphl")
    print(f"{ROUNDS} rounds of SIGKILL: each went on; replay of {report['steps']} steps with {report['commands']} "
          f"commands and {report['decisions']} decisions: {report['hashes']} hashes are equal; "
          f"{readable} recordings have frames, none is unreadable; the log has {size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
