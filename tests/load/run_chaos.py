#!/usr/bin/env python3
"""Disturbs a simulating server in every way that we know, and measures what its clients see of it.

    tests/load/run_chaos.py [--build build/release] [--minutes 30] [--viewers 20] [--scene box-4k]

Prints Markdown tables; the exit code is 1 on a fault. The server simulates with tokens, checkpoints, a command log and a
recording. Healthy viewers watch, and a healthy controller sends five commands a second. Attackers come in four phases, each
with quiet and attacked stretches in turn. Then the disk is full, the graphics device is lost, the wall clock jumps, and the
process is stopped and killed. A supervisor starts the server again with --resume. At the end all command logs are replayed
and all recordings exported, after the given time.
"""
import argparse
import datetime
import os
import random
import statistics
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../support/py"))
from attackers import Commander, Garbage, Guesser, Nonsense, Oversize, Slow, Stalled, Storm, Stranger  # noqa: E402
from chaos import STEPS_PER_SECOND, World  # noqa: E402
import watched  # noqa: E402

ATTACKS = {"stalled readers, slow requests": (Stalled, Slow), "reconnect storms, floods of commands": (Storm, Commander),
           "garbage": (Garbage, Nonsense, Oversize), "token guesses, strangers": (Guesser, Stranger)}
ATTACKED = 0.6  # share of the time that is for attackers
JOIN = 5  # s of a stretch until the viewers have joined
LOWEST = 0.9  # of the rates of quiet stretches


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--viewers", type=int, default=20)
    parser.add_argument("--rate", type=int, default=20)
    parser.add_argument("--scene", default="box-4k", help="a scene that this machine simulates in real time with one thread")
    args = parser.parse_args()
    if args.minutes < 5:
        parser.error("--minutes is at least 5: a stalled reader is dropped after more than 10 s; chaos_test.py is shorter")
    return args


def report(text):
    print(f"{time.strftime('%H:%M:%S')} load {os.getloadavg()[0]:.1f}: {text}", file=sys.stderr, flush=True)


def attacks(world, seconds):
    """All phases with attackers, in `seconds`. Prints tables of rates, causes and resources."""
    phase = seconds / len(ATTACKS)
    pairs = max(1, round(phase / 70))
    length = int(phase / pairs / 2 - JOIN)
    rows, causes, attackers, used = [], [], [], []
    for name, kinds in ATTACKS.items():
        report(name)
        quiet, attacked, counted = world.attack(kinds, length, pairs)
        row = [name]
        for what in ("frames", "steps"):
            calm, busy = (statistics.median(each[what] for each in stretches) for stretches in (quiet, attacked))
            ratios = [b[what] / a[what] for a, b in zip(quiet, attacked)]
            row += [f"{calm:.1f}", f"{busy:.1f}", f"{busy / calm:.3f}", f"{min(ratios):.2f} to {max(ratios):.2f}"]
            world.check(busy >= LOWEST * calm, f"{name}: {what} per second fell from {calm:.1f} to {busy:.1f}")
        rows.append(row)
        causes.append([name, *(", ".join(f"`{cause}` {count}" for cause, count in sorted(counted[family].items()))
                               for family in ("rejected", "closed"))])
        attackers += [one for stretch in attacked for one in stretch["attackers"]]
        used += [sample for stretch in quiet for sample in stretch["used"]]  # all have the same clients
    watched.table([f"medians of {pairs} pairs of {length} s", "frames/s of a viewer, quiet", "attacked", "ratio", "pairs",
                   "steps/s, quiet", "attacked", "ratio", "pairs"], rows)
    watched.attempts(attackers)
    watched.table(["counted by cause", "turned away", "sessions ended"], causes)
    world.faults += watched.growth(used)


def disturbances(world, seconds):
    """All other phases, in about `seconds`. Prints a table."""
    rows = []

    def phase(name, disturbance):
        report(name)
        try:
            rows.append([name, disturbance()])
        except (AssertionError, OSError) as error:
            world.faults.append(f"{name}: {error!r}")

    phase("full disk", lambda: world.full_disk(seconds / 10))
    phase("lost context", world.lost_device)
    phase("clock jumps", lambda: world.clock_jumps(seconds / 50))
    phase("SIGSTOP and SIGCONT", lambda: world.stopped_process(10))
    report("SIGKILL")
    chance, end, kills = random.Random(1), time.monotonic() + seconds / 2, 0
    while time.monotonic() < end:
        world.killed(chance.uniform(0, 3 * world.every))
        kills += 1
    lost = world.end()
    world.check(lost <= (world.every + 2) * STEPS_PER_SECOND, f"a life lost {lost:.0f} steps")
    rows.append(["SIGKILL", f"{kills} times; the server went on each time, and lost at most {lost:.0f} steps"])
    watched.table(["disturbance", "outcome"], rows)


def main():
    args = options()
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f} at the beginning, "
          f"{datetime.date.today():%d %B %Y}, {args.viewers} viewers at {args.rate} Hz, {args.scene}, {args.minutes:g} min\n",
          flush=True)
    with tempfile.TemporaryDirectory() as folder:
        world = World(args.build, folder, args.scene, args.viewers, args.rate)
        try:
            attacks(world, 60 * args.minutes * ATTACKED)
            disturbances(world, 60 * args.minutes * (1 - ATTACKED))
        finally:
            world.close()
        report("replays and exports")
        rows = [[f"command log {number}", line] for number, line in enumerate(world.replays(), 1)]
        rows += [["recordings with frames, all readable", world.exports()], ["commands of the controller", world.steering.sent],
                 ["their answers", ", ".join(f"{answer}: {n}" for answer, n in sorted(world.steering.answers.items()))]]
        watched.table(["at the end", ""], rows)
    for fault in world.faults:
        print(f"- GAVE WAY: {fault}")
    print(f"Load at the end: {os.getloadavg()[0]:.1f}." + ("" if world.faults else " It held."))
    return 1 if world.faults else 0


if __name__ == "__main__":
    sys.exit(main())
