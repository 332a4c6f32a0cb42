#!/usr/bin/env python3
"""Compares Spherule and LAMMPS on the same bed:
peers.py [--sizes 10000,50000] [--rounds 3] [--friction 0.3] [--only PATTERN] [--rest SECONDS] [--markdown FILE]

N spheres (r = 5 cm, 1000 kg/m3, e = 0.5) fall from a jittered lattice of 1.25 d into an open box of the width
d sqrt(N / 20). Each round runs every contestant from the same positions, one after the other. Needs Debian's `lammps` and
`openmpi-bin`, and build/release/spherule. The times are those of the fall, 0 to 1 s, and of the settled bed, 5 to 6 s.
Overlaps of both are measured by Spherule, from the positions at the end. Speeds are ratios to LAMMPS at its usual
stiffness in the same round; above 1, a contestant is faster. With --only, the others take part only if their names match
the regular expression.

With --rest, the beds fall for 10 s instead and are then watched for so long: how far they sink, and how they move.
"""
import argparse
import csv
import json
import math
import os
import random
import re
import statistics
import subprocess
import sys
import tempfile

RADIUS = 0.05
DENSITY = 1000
SPACING = 1.25 * 2 * RADIUS
JITTER = 0.12 * 2 * RADIUS
RESTITUTION = 0.5
GRAVITY = 9.81
THREADS = os.cpu_count()
BINARY = os.environ.get("SPHERULE", "build/release/spherule")
WINDOWS = {"fall": (0, 1), "settled": (5, 6)}  # s
INTERVAL = 0.5  # s, of the reports of Spherule

SETTLED_AFTER = 10  # s, before a bed at rest is watched

OURS = {
    f"Spherule, {THREADS} threads, 1/480 s": ["--device", f"cpu:{THREADS}", "--no-sleep"],
    "Spherule, 1 thread, 1/480 s": ["--device", "cpu:1", "--no-sleep"],
    f"Spherule, {THREADS} threads, 1/1200 s": ["--device", f"cpu:{THREADS}", "--no-sleep", "--substeps", "20"],
    f"Spherule, {THREADS} threads, 1/480 s, with sleep": ["--device", f"cpu:{THREADS}"],
}
LAMMPS = {
    f"LAMMPS, {THREADS} ranks, k = 5e5 N/m, 1e-4 s": (5e5, 1e-4),
    f"LAMMPS, {THREADS} ranks, k = 5e4 N/m, 3e-4 s": (5e4, 3e-4),
}

USUAL = next(iter(LAMMPS))


def bed(count):
    """Returns positions and the width of the box (m)."""
    width = 2 * RADIUS * math.sqrt(count / 20)
    across = int(width / SPACING)
    margin = (width - (across - 1) * SPACING) / 2
    rng = random.Random(1)
    spheres = []
    while len(spheres) < count:
        layer, place = divmod(len(spheres), across * across)
        corner = (margin + place % across * SPACING, margin + place // across * SPACING, (layer + 0.5) * SPACING)
        spheres.append([axis + rng.uniform(-JITTER, JITTER) for axis in corner])
    return spheres, width


def scene_of(folder, name, spheres, width, friction):
    """Writes a scene with these positions; returns its path."""
    with open(os.path.join(folder, name + ".csv"), "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow("xyz")
        writer.writerows(spheres)
    scene = {"bounds": {"min": [0, 0, 0], "max": [width, width, 8], "open": ["Z_MAX"]},
             "gravity": [0, 0, -GRAVITY], "materials": [{"density": DENSITY, "restitution": RESTITUTION, "friction": friction}],
             "groups": [{"radius": {"constant": RADIUS}, "csv": {"file": name + ".csv"}}]}
    path = os.path.join(folder, name + ".json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene, file)
    return path


def reports(path, *options):
    command = [BINARY, "run", path, "--json", *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stderr}")
    return [json.loads(line) for line in done.stdout.splitlines()]


def race_ours(path, options):
    stretches = reports(path, "--for", f"{WINDOWS['settled'][1]}s", "--every", f"{INTERVAL}s", *options)
    row = {}
    for window, (begin, end) in WINDOWS.items():
        inside = [s for s in stretches if begin < s["simSeconds"] - INTERVAL / 2 < end]
        row[window] = sum(s["wallSeconds"] for s in inside) / sum(s["intervalSeconds"] for s in inside)
    last = stretches[-1]
    return row | {key: last[key] for key in ("overlapMean", "overlapMax", "speedRms", "sleeping")}


def lammps_input(count, width, stiffness, step, friction, phases):
    mass = DENSITY * 4 / 3 * math.pi * RADIUS ** 3
    decay = -math.log(RESTITUTION)
    ratio = decay / math.hypot(math.pi, decay)  # damping ratio of a linear spring with this restitution
    pair, wall = (2 * ratio * math.sqrt(stiffness / m) for m in (mass / 2, mass))
    style = "hooke/history" if friction else "hooke"

    def law(damping):
        return f"{stiffness} {stiffness * 2 / 7} {damping} " + (f"NULL {friction} 1" if friction else "0 0 0")
    faces = "\n".join(f"fix {axis} all wall/gran {style} {law(wall)} {axis}plane 0 {far}"
                      for axis, far in (("x", width), ("y", width), ("z", "NULL")))
    runs = "\n".join(f"run {round(seconds / step)}\nwrite_dump all custom {number}.dump id x y z vx vy vz "
                     "modify sort id format float %.9g" for number, seconds in enumerate(phases))
    return f"""units si
atom_style sphere
boundary f f f
newton off
comm_modify vel yes
processors {THREADS} 1 1
read_data bed{count}.data
neighbor 0.02 bin
neigh_modify delay 0 every 1 check yes
pair_style gran/{style} {law(pair)}
pair_coeff * *
{faces}
fix gravity all gravity {GRAVITY} vector 0 0 -1
fix move all nve/sphere
timestep {step}
thermo_modify lost warn norm no
{runs}
"""


def run_lammps(folder, spheres, width, friction, stiffness, step, phases):
    """Runs phases of these simulated times (s). Returns for each its wall time (s) and the state at its end:
    [id, x, y, z, vx, vy, vz] per sphere."""
    count = len(spheres)
    with open(os.path.join(folder, f"bed{count}.data"), "w", encoding="utf-8") as file:
        top = spheres[-1][2] + 1
        file.write(f"bed\n\n{count} atoms\n1 atom types\n\n0 {width} xlo xhi\n0 {width} ylo yhi\n-0.2 {top} zlo zhi\n\nAtoms\n\n")
        for number, (x, y, z) in enumerate(spheres, 1):
            file.write(f"{number} 1 {2 * RADIUS} {DENSITY} {x} {y} {z}\n")
    with open(os.path.join(folder, "bed.in"), "w", encoding="utf-8") as file:
        file.write(lammps_input(count, width, stiffness, step, friction, phases))
    command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", str(THREADS), "lmp", "-in", "bed.in", "-log", "none"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False,
                          env=os.environ | {"OMPI_MCA_mpi_yield_when_idle": "1", "OMP_NUM_THREADS": "1"})
    loops = [float(seconds) for seconds in re.findall(r"Loop time of (\S+) on", done.stdout)]
    if done.returncode != 0 or len(loops) != len(phases):
        sys.exit(f"{' '.join(command)} in {folder}: {done.stdout[-2000:]}{done.stderr}")
    ends = []
    for number in range(len(phases)):
        with open(os.path.join(folder, f"{number}.dump"), encoding="utf-8") as file:
            lines = file.read().split("vz")[-1].strip().splitlines()
        ends.append([[float(value) for value in line.split()] for line in lines])
    return loops, ends


def rms_of(rows):
    return math.sqrt(sum(v * v for row in rows for v in row[4:7]) / len(rows))


def race_lammps(folder, spheres, width, friction, stiffness, step):
    (_, fall), (begin, end) = WINDOWS["fall"], WINDOWS["settled"]
    loops, ends = run_lammps(folder, spheres, width, friction, stiffness, step, (fall, begin - fall, end - begin))
    # Soft spheres may overlap walls, but a scene must not, so its bounds are larger and the positions are shifted.
    raised = [[axis + 1 for axis in row[1:4]] for row in ends[-1]]
    overlaps = reports(scene_of(folder, "lammps_end", raised, width + 2, friction), "--device", "cpu", "--quality", "fast", "--for", "0s")[0]
    return {"fall": loops[0] / fall, "settled": loops[2] / (end - begin), "speedRms": rms_of(ends[-1]), "sleeping": 0,
            "overlapMean": overlaps["overlapMean"], "overlapMax": overlaps["overlapMax"]}


def rest_ours(path, options, seconds):
    stretches = reports(path, "--for", f"{SETTLED_AFTER + seconds}s", "--every", f"{SETTLED_AFTER}s", *options)
    return {"height": stretches[0]["meanHeight"], "sinking": stretches[0]["meanHeight"] - stretches[-1]["meanHeight"],
            "speedRms": stretches[-1]["speedRms"], "speedMax": stretches[-1]["speedMax"]}


def rest_lammps(folder, spheres, width, friction, stiffness, step, seconds):
    _, ends = run_lammps(folder, spheres, width, friction, stiffness, step, (SETTLED_AFTER, seconds))
    heights = [statistics.fmean(row[3] for row in rows) for rows in ends]
    return {"height": heights[0], "sinking": heights[0] - heights[1], "speedRms": rms_of(ends[1]),
            "speedMax": max(math.hypot(*row[4:7]) for row in ends[1])}


def rest_table(count, seconds, results):
    lines = [f"### {count:,} spheres at rest for {seconds} s", "",
             f"| | mean height after {SETTLED_AFTER} s, m | sinking in {seconds} s, mm | then: rms speed, mm/s | fastest, mm/s |",
             "|---|--:|--:|--:|--:|"]
    for name, row in results.items():
        lines.append(f"| {name} | {row['height']:.4f} | {1e3 * row['sinking']:.3g} | {1e3 * row['speedRms']:.3g} "
                     f"| {1e3 * row['speedMax']:.3g} |")
    return "\n".join(lines) + "\n"


def chosen(contestants, pattern):
    return [(name, how) for name, how in contestants.items() if name == USUAL or re.search(pattern, name)]


def race(folder, path, spheres, width, options):
    results = {}
    for number in range(options.rounds):
        for name, more in chosen(OURS, options.only):
            results.setdefault(name, []).append(race_ours(path, more))
            print(f"round {number + 1}: {name}", results[name][-1], file=sys.stderr)
        for name, (stiffness, step) in chosen(LAMMPS, options.only):
            results.setdefault(name, []).append(race_lammps(folder, spheres, width, options.friction, stiffness, step))
            print(f"round {number + 1}: {name}", results[name][-1], file=sys.stderr)
    return table(len(spheres), results)


def rest(folder, path, spheres, width, options):
    results = {}
    for name, more in chosen(OURS, options.only):
        results[name] = rest_ours(path, more, options.rest)
        print(name, results[name], file=sys.stderr)
    for name, (stiffness, step) in chosen(LAMMPS, options.only):
        results[name] = rest_lammps(folder, spheres, width, options.friction, stiffness, step, options.rest)
        print(name, results[name], file=sys.stderr)
    return rest_table(len(spheres), options.rest, results)


def speed(rows, usual, window):
    """The median of the speeds over those of the usual contestant, round by round."""
    return statistics.median(other[window] / row[window] for row, other in zip(rows, usual, strict=True))


def table(count, results):
    lines = [f"### {count:,} spheres", "",
             "| | wall s per simulated s: fall | settled | real-time factor: fall | settled | speed, LAMMPS = 1: fall | settled "
             "| overlap, % of r: mean | max | rms speed, m/s | asleep |",
             "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|"]
    for name, rows in results.items():
        m = {key: statistics.median(row[key] for row in rows) for key in rows[0]}
        fall, settled = (speed(rows, results[USUAL], window) for window in WINDOWS)
        lines.append(f"| {name} | {m['fall']:.3g} | {m['settled']:.3g} | {1 / m['fall']:.3g} | {1 / m['settled']:.3g} "
                     f"| {fall:.3g} | {settled:.3g} "
                     f"| {100 * m['overlapMean']:.3g} | {100 * m['overlapMax']:.3g} | {m['speedRms']:.3g} | {m['sleeping']:.0f} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", default="10000,50000")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--friction", type=float, default=0.3)
    parser.add_argument("--only", default="", metavar="PATTERN")
    parser.add_argument("--rest", type=int, metavar="SECONDS")
    parser.add_argument("--markdown")
    options = parser.parse_args()
    text = ""
    for count in map(int, options.sizes.split(",")):
        spheres, width = bed(count)
        with tempfile.TemporaryDirectory() as folder:
            path = scene_of(folder, "bed", spheres, width, options.friction)
            text += (rest if options.rest else race)(folder, path, spheres, width, options) + "\n"
    print(text)
    if options.markdown:
        with open(options.markdown, "w", encoding="utf-8") as file:
            file.write(text)


if __name__ == "__main__":
    main()
