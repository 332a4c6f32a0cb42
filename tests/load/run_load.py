#!/usr/bin/env python3
"""Measures the frames that many viewers get, and their cost for the simulation. Prints Markdown tables.

    tests/load/run_load.py [--build build/release] [--viewers 200] [--seconds 20] [--stretches 3]
                           [--part crowd|cost|play] [--recording FILE]

crowd: a bed that comes to rest, with many viewers; 1/10 of them stall, 1/10 are slow and 1/20 reconnect. Reports the
counters of /metrics. cost: a bed that stays awake, alternately with one viewer and with all. Reports the time per substep
and its ratio. play: the viewers of `crowd` watch a recording (`spherule play --loop`); without --recording, it records
20 s of box-50k first.
"""
import argparse
import datetime
import os
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../support/py"))
from serving import Server  # noqa: E402

# All viewers connect at once from one address.
UNLIMITED = ["--max-sessions", "0", "--max-sessions-per-address", "0", "--connections-per-second", "0"]
OF_INTEREST = ["spherule_frames_sent_total", "spherule_bytes_sent_total", "spherule_states_produced_total",
               "spherule_chains_lost_total", "spherule_sessions_accepted_total"]


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--viewers", type=int, default=200)
    parser.add_argument("--rate", type=int, default=20)
    parser.add_argument("--seconds", type=int, default=20, help="duration of crowd, and of each interval of cost")
    parser.add_argument("--stretches", type=int, default=3, help="intervals of cost, each with one viewer and with all")
    parser.add_argument("--settle", type=int, default=15, help="simulated time before the measurement (s)")
    parser.add_argument("--scene", default="box-10k")
    parser.add_argument("--device", default="cpu:1")
    parser.add_argument("--part", choices=["crowd", "cost", "play"], help="run only this part")
    parser.add_argument("--recording", help="recording for play")
    return parser.parse_args()


def report(text):
    print(text, file=sys.stderr, flush=True)


def wait_until(what, condition, seconds=300):
    report(what)
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise SystemExit(f"waited {seconds} s in vain: {what}")
        time.sleep(0.2)


def settle(server, seconds):
    wait_until(f"{seconds} s are simulated",
               lambda: server.metrics().get(("spherule_simulated_seconds", ""), 0) >= seconds)


def client(args, server, viewers, seconds, *more):
    return [os.path.join(args.build, "spherule_load"), server.stream, "--viewers", str(viewers), "--rate", str(args.rate),
            "--seconds", str(seconds), *more]


def program(args):
    return os.path.join(args.build, "spherule")


def crowd(args, *show):
    tenth = args.viewers // 10
    with Server(program(args), *show, *UNLIMITED) as server:
        if show[0] == "serve":
            settle(server, args.settle)
        before = server.metrics()
        done = subprocess.run(client(args, server, args.viewers, args.seconds, "--stalled", str(tenth), "--slow", str(tenth),
                                     "--reconnecting", str(tenth // 2), "--decode", "4", "--server-pid",
                                     str(server.pid), "--markdown"), stdout=subprocess.PIPE, text=True, check=False)
        after = server.metrics()
    print(done.stdout)
    print("| /metrics, from before to after | |\n|---|--:|")
    for key in sorted(after):
        closed = key[0] == "spherule_sessions_closed_total" and after[key] > before.get(key, 0)
        if key[0] in OF_INTEREST or closed:
            print(f"| {key[0]}{' ' + key[1] if key[1] else ''} | {after[key] - before.get(key, 0):.0f} |")
    if show[0] == "serve":
        print(f"| spherule_sleeping_spheres, of {after['spherule_spheres', '']:.0f} | "
              f"{after['spherule_sleeping_spheres', '']:.0f} |\n")
    return done.returncode


def play(args):
    with tempfile.TemporaryDirectory() as folder:
        recording = args.recording or os.path.join(folder, "box-50k.sph")
        if not args.recording:
            report("recording 20 s of box-50k")
            subprocess.run([program(args), "run", "box-50k", "--for", "20s", "--device", "cpu", "--record", recording,
                            "--record-rate", str(args.rate)], stdout=subprocess.DEVNULL, check=True)
        return crowd(args, "play", recording, "--loop")


def thread_seconds(pid):
    """CPU time of each thread of the process since its start (s)."""
    seconds = {}
    for thread in os.listdir(f"/proc/{pid}/task"):
        with open(f"/proc/{pid}/task/{thread}/stat", encoding="utf-8") as file:
            fields = file.read().rpartition(")")[2].split()
        seconds[thread] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return seconds


def sample(server):
    metrics = server.metrics()
    passes = {name: value for (family, name), value in metrics.items() if family == "spherule_pass_seconds_total"}
    return {"time": time.monotonic(), "substeps": metrics["spherule_steps", ""] * metrics["spherule_substeps", ""],
            "pack": passes.pop("pack", 0), "passes": sum(passes.values()), "threads": thread_seconds(server.pid),
            "frames": metrics["spherule_frames_sent_total", ""], "lost": metrics["spherule_chains_lost_total", ""]}


def stretch(args, server, viewers):
    """Time per substep (ms) and other figures with this number of viewers."""
    with subprocess.Popen(client(args, server, viewers, args.seconds + 30), stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as crowd_process:
        try:
            wait_until(f"{viewers} watch", lambda: server.metrics()["spherule_sessions", ""] >= viewers, 60)
            time.sleep(3)
            first = sample(server)
            time.sleep(args.seconds)
            last = sample(server)
        finally:
            crowd_process.kill()
    wait_until("all have left", lambda: server.metrics()["spherule_sessions", ""] == 0, 60)
    substeps = last["substeps"] - first["substeps"]
    cpu = {thread: last["threads"][thread] - before for thread, before in first["threads"].items()
           if thread in last["threads"]}
    simulation = max(cpu.values())  # the busiest thread, with one thread on the CPU device
    wall = last["time"] - first["time"]
    return {"passes, wall ms per substep": 1e3 * (last["passes"] - first["passes"]) / substeps,
            "simulation thread, CPU ms per substep": 1e3 * simulation / substeps,
            "encoding of frames, wall ms per substep": 1e3 * (last["pack"] - first["pack"]) / substeps,
            "all other threads, CPU ms per second": 1e3 * (sum(cpu.values()) - simulation) / wall,
            "substeps per second": substeps / wall,
            "frames sent per second": (last["frames"] - first["frames"]) / wall,
            "chains lost": last["lost"] - first["lost"]}


def cost(args):
    alone, crowded = [], []
    with Server(program(args), "serve", args.scene, "--no-sleep", "--device", args.device, *UNLIMITED) as server:
        settle(server, args.settle)
        for number in range(args.stretches):
            report(f"interval {number + 1} of {args.stretches}")
            alone.append(stretch(args, server, 1))
            crowded.append(stretch(args, server, args.viewers))
    print(f"| {args.scene} --no-sleep, medians of {args.stretches} intervals | 1 viewer | {args.viewers} viewers | ratio | "
          "ratios of pairs |\n|---|--:|--:|--:|--:|")
    for name in alone[0]:
        one, many = (statistics.median(each[name] for each in stretches) for stretches in (alone, crowded))
        ratios = sorted(b[name] / a[name] for a, b in zip(alone, crowded) if a[name] > 0)
        spread = f"{ratios[0]:.2f} to {ratios[-1]:.2f}" if ratios else "-"
        print(f"| {name} | {one:.4g} | {many:.4g} | {f'{many / one:.3f}' if one > 0 else '-'} | {spread} |")


def main():
    args = options()
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f} at the beginning, "
          f"{datetime.date.today():%d %B %Y}, {args.viewers} viewers at {args.rate} Hz, --device {args.device}\n", flush=True)
    if args.part == "play":
        return play(args)
    failed = crowd(args, "serve", args.scene, "--device", args.device) if args.part != "cost" else 0
    if args.part != "crowd":
        cost(args)
    return failed


if __name__ == "__main__":
    sys.exit(main())
