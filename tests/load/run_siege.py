#!/usr/bin/env python3
"""Measures healthy viewers of a recording while others attack the server. Prints Markdown tables; exit code 1 on a fault.

    tests/load/run_siege.py [--build build/release] [--viewers 40] [--seconds 600] [--quiet 60] [--recording FILE]

First the viewers alone (--quiet), then with all kinds of tests/load/attackers.py (--seconds). It gave way if the viewers'
rate fell by more than a tenth, if one of them had a fault or was dropped, if memory or descriptors grew, or if something that
was turned away was counted under no cause. Without --recording, 20 s of box-50k are recorded first.
"""
import argparse
import asyncio
import datetime
import os
import subprocess
import sys
import tempfile

import attackers
import watched
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../support/py"))
from serving import Server  # noqa: E402

TOKENS = {"viewer": "the-viewers-token-of-a-siege", "controller": "the-controllers-token-of-a-siege"}


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--viewers", type=int, default=40)
    parser.add_argument("--rate", type=int, default=20)
    parser.add_argument("--seconds", type=int, default=600)
    parser.add_argument("--quiet", type=int, default=60, help="time without attackers at the start (s)")
    parser.add_argument("--recording")
    return parser.parse_args()


async def siege(args, server):
    async with attackers.at_work(server.port, TOKENS) as besiegers:
        return await watched.viewers(args, server, TOKENS["viewer"], args.seconds), besiegers


def run(args, recording):
    program = os.path.join(args.build, "spherule")
    environment = {**os.environ, "SPHERULE_VIEWER_TOKEN": TOKENS["viewer"], "SPHERULE_CONTROLLER_TOKEN": TOKENS["controller"]}
    with Server(program, "play", recording, "--loop", token=TOKENS["viewer"], env=environment) as server:
        calm, calm_code, _ = asyncio.run(watched.viewers(args, server, TOKENS["viewer"], args.quiet))
        before = server.metrics()
        (busy, busy_code, used), besiegers = asyncio.run(siege(args, server))
        after = server.metrics()
        ended = server.end()
    rejected = watched.difference(after, before, "spherule_rejected_total")
    closed = watched.difference(after, before, "spherule_sessions_closed_total")
    calm_rate, busy_rate = watched.rate_of(calm), watched.rate_of(busy)
    watched.table(["healthy viewers", "alone", "besieged"], [["frames/s each", calm_rate, busy_rate]])
    print(busy)
    watched.attempts(besiegers)
    watched.table(["turned away, by cause", ""], sorted((cause, f"{n:.0f}") for cause, n in rejected.items()))
    watched.table(["sessions ended, by cause", ""], sorted((cause, f"{n:.0f}") for cause, n in closed.items()))

    faults = [f"no {cause} was counted" for one in besiegers for cause in one.rejected if cause not in rejected]
    faults += [f"no session ended as {cause}" for one in besiegers for cause in one.closed if cause not in closed]
    faults += watched.growth(used)
    if busy_rate < 0.9 * calm_rate:
        faults.append(f"the viewers' rate fell from {calm_rate} to {busy_rate}")
    if calm_code or busy_code:
        faults.append("the load client found faults")
    if ended:
        faults.append(f"the server ended with {ended}")
    for fault in faults:
        print(f"- GAVE WAY: {fault}")
    print("It held." if not faults else "")
    return 1 if faults else 0


def main():
    args = options()
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f} at the beginning, "
          f"{datetime.date.today():%d %B %Y}, {args.viewers} viewers at {args.rate} Hz, {args.seconds} s\n", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        recording = args.recording or os.path.join(folder, "box-50k.sph")
        if not args.recording:
            subprocess.run([os.path.join(args.build, "spherule"), "run", "box-50k", "--for", "20s", "--device", "cpu",
                            "--record", recording, "--record-rate", str(args.rate)], stdout=subprocess.DEVNULL, check=True)
        return run(args, recording)


if __name__ == "__main__":
    sys.exit(main())
