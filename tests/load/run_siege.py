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
import re
import subprocess
import sys
import tempfile

import attackers
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../support/py"))
from serving import Server  # noqa: E402

TOKENS = {"viewer": "the-viewers-token-of-a-siege", "controller": "the-controllers-token-of-a-siege"}
# Rejections that must have been counted, because attackers cause them all the time.
CAUSES = ["connection_rate", "slow_request", "malformed", "long_header", "long_body", "host", "origin", "no_token",
          "wrong_token", "command_rate", "viewers_command"]
CLOSED = ["stalled", "protocol", "too_big", "no_token", "no_hello"]
FLAT = 1.1


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--viewers", type=int, default=40)
    parser.add_argument("--rate", type=int, default=20)
    parser.add_argument("--seconds", type=int, default=600)
    parser.add_argument("--quiet", type=int, default=60, help="time without attackers at the start (s)")
    parser.add_argument("--recording")
    return parser.parse_args()


def usage(pid):
    """Resident memory (MiB) and number of open descriptors."""
    with open(f"/proc/{pid}/statm", encoding="ascii") as file:
        pages = int(file.read().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2 ** 20, len(os.listdir(f"/proc/{pid}/fd"))


async def viewers(args, server, seconds):
    """Returns the load client's report and the resources of the server, sampled each second."""
    client = await asyncio.create_subprocess_exec(
        os.path.join(args.build, "spherule_load"), server.stream, "--viewers", str(args.viewers), "--rate", str(args.rate),
        "--seconds", str(seconds), "--decode", "2", "--markdown", stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        env={**os.environ, "SPHERULE_TOKEN": TOKENS["viewer"]})
    used = []
    reading = asyncio.ensure_future(client.stdout.read())
    while not reading.done():
        await asyncio.wait({reading}, timeout=1)
        used.append(usage(server.pid))
    return (await reading).decode(), await client.wait(), used


def rate_of(report):
    return float(re.search(r"^\| healthy \| \d+ \| ([\d.]+)", report, re.MULTILINE).group(1))


async def siege(args, server):
    port = int(server.stream.split(":")[2].split("/")[0])
    besiegers = [kind(port, f"127.0.1.{place}", TOKENS) for place, kind in enumerate(attackers.ALL, 1)]
    tasks = [asyncio.ensure_future(one.run()) for one in besiegers]
    result = await viewers(args, server, args.seconds)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
    return result, besiegers


def difference(after, before, family):
    return {label: value - before.get((name, label), 0) for (name, label), value in after.items()
            if name == family and value > before.get((name, label), 0)}


def table(head, rows):
    print("| " + " | ".join(head) + " |\n|---" + "|--:" * (len(head) - 1) + "|")
    for row in rows:
        print("| " + " | ".join(str(cell) for cell in row) + " |")
    print()


def run(args, recording):
    program = os.path.join(args.build, "spherule")
    environment = {**os.environ, "SPHERULE_VIEWER_TOKEN": TOKENS["viewer"], "SPHERULE_CONTROLLER_TOKEN": TOKENS["controller"]}
    with Server(program, "play", recording, "--loop", token=TOKENS["viewer"], env=environment) as server:
        calm, calm_code, _ = asyncio.run(viewers(args, server, args.quiet))
        before = server.metrics()
        (busy, busy_code, used), besiegers = asyncio.run(siege(args, server))
        after = server.metrics()
        ended = server.end()
    rejected = difference(after, before, "spherule_rejected_total")
    closed = difference(after, before, "spherule_sessions_closed_total")
    calm_rate, busy_rate = rate_of(calm), rate_of(busy)
    table(["healthy viewers", "alone", "besieged"], [["frames/s each", calm_rate, busy_rate]])
    print(busy)
    table(["attacker", "attempts", "what came of them"],
          [[type(one).__name__, one.tried, ", ".join(f"{answer}: {n}" for answer, n in sorted(one.answers.items()))]
           for one in besiegers])
    table(["turned away, by cause", ""], sorted((cause, f"{n:.0f}") for cause, n in rejected.items()))
    table(["sessions ended, by cause", ""], sorted((cause, f"{n:.0f}") for cause, n in closed.items()))
    # The first quarter is skipped: buffers still grow.
    early, late = (used[len(used) * a // 4:len(used) * b // 4] for a, b in ((1, 2), (3, 4)))
    peaks = [[max(each[k] for each in part) for part in (early, late)] for k in (0, 1)]
    table(["server", "largest in the second quarter", "in the last"],
          [["resident, MiB", *(f"{value:.1f}" for value in peaks[0])], ["descriptors", *peaks[1]]])

    faults = [f"no {cause} was counted" for cause in CAUSES if cause not in rejected]
    faults += [f"no session ended as {cause}" for cause in CLOSED if cause not in closed]
    if busy_rate < 0.9 * calm_rate:
        faults.append(f"the viewers' rate fell from {calm_rate} to {busy_rate}")
    if calm_code or busy_code:
        faults.append("the load client found faults")
    faults += [f"{what} grew from {early} to {late}" for what, (early, late) in zip(("memory", "descriptors"), peaks)
               if late > FLAT * early + 2]
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
