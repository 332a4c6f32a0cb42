#!/usr/bin/env python3
"""Kills a server at random moments while it is under load, and lets it go on: run_kill_rounds.py BINARY [ROUNDS [SEED]]

In each round viewers watch, a controller sends commands at random, and a recording is made. After the last round,
`spherule replay` carries out the command log of all rounds without any disturbance. Its hashes are those of the server
only if each round went on with the right bits.
"""
import json
import os
import random
import re
import sys
import tempfile
import time

from program import runner
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


def one_round(number, folder, chance):
    """Returns how many steps the server had done, the step from which it went on, and its recording."""
    recording = os.path.join(folder, f"round-{number}.sph")
    with serve(folder, "--record", recording) as server:
        controller = Controller(server.port)
        viewers = [Viewer(server.port, rate=rate) for rate in (60, 5)]
        end = time.monotonic() + chance.uniform(0.3, 3)
        while time.monotonic() < end:
            controller.command(chance)
            time.sleep(0.03)
        steps = server.metrics()["spherule_steps", ""]
        server.end(kill=True)
        del viewers
    said = "".join(server.greeting) + server.said
    found = re.search(r"goes on from (\S+) with the scene .*, at step (\d+)", said)
    if number > 0 and not found:
        raise AssertionError(f"round {number} did not go on:\n{said}")
    if "passed over" in said:
        raise AssertionError(f"round {number} passed over a checkpoint:\n{said}")
    return steps, int(found.group(2)) if found else 0, recording


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
        readable = 0
        for number in range(ROUNDS):
            steps, began, recording = one_round(number, folder, chance)
            readable += check_recording(recording) > 0
            if number % 10 == 9:
                print(f"{number + 1} rounds: from step {began} to about {steps:.0f}; {readable} recordings have frames",
                      flush=True)
        with serve(folder) as server:  # ends in order, and so does its log
            if server.end() != 0:
                raise AssertionError(server.said)
        done = call("replay", folder + "/commands.sphl", "--device", "cpu", "--json")
        if done.returncode != 0:
            raise AssertionError(f"the replay differs: {done.stdout}{done.stderr}")
        report = json.loads(done.stdout)
        size = os.path.getsize(folder + "/commands.sphl")
    print(f"{ROUNDS} rounds of SIGKILL: each went on; replay of {report['steps']} steps with {report['commands']} "
          f"commands and {report['decisions']} decisions: {report['hashes']} hashes are equal; "
          f"{readable} recordings have frames, none is unreadable; the log has {size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
