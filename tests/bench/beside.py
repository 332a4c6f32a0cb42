#!/usr/bin/env python3
"""Compares the speed of an older commit with this one:
beside.py COMMIT [--scenes settled-10k,falling-10k] [--devices cpu:1,cpu:2] [--blocks N] [--json FILE]

The commit is checked out and built under build/beside. Both sides run the same beds (r = 5 cm, e = 0.5, friction
0.3, 480 substeps per second, no sleep) in one process each, and take turns in short blocks. The ratios are those of
two blocks that follow each other, so a change of the machine's load affects both. Above 1, this commit is faster.

A scene is settled-N or falling-N; N may end with k or m. A settled bed has come to rest for 5 s under the law of
its own side. One of more than 50,000 spheres is composed of tiles of 50,000. A falling bed is timed from 0.2 to 0.5
s after its release, in six blocks.

A device is a device of spherule. All threads of cpu:1 and of software run on one processor, which changes after
each pair of blocks. With cpu:1 and cpu:N the gain from N threads is reported."""
import argparse
import array
import dataclasses
import hashlib
import itertools
import json
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
STEPPER_CMAKE = ROOT / "tests/bench/stepper.cmake"
WORK = pathlib.Path(os.environ.get("SPHERULE_BESIDE", ROOT / "build/beside"))
SIDES = ("old", "new")

RADIUS = 0.05
LAYERS = 20
HEIGHT = 4  # m, of the box
STEP_RATE = 60
SUBSTEPS = 8  # per step
RATE = STEP_RATE * SUBSTEPS
SETTLE = 5 * RATE  # substeps
# Substeps after a state was loaded, in which contacts regain their memory: of a single bed, and of tiles.
WARM = RATE // 2
WARM_TILES = RATE // 4
FALL_BEGIN, FALL_END = RATE // 5, RATE // 2  # substeps after the release
BLOCKS_OF_FALL = 6
TILE = 50_000
ON_ONE_PROCESSOR = ("cpu:1", "software")
COLUMNS = 3  # of a state: positions, velocities, spins; four floats each


@dataclasses.dataclass(frozen=True)
class Bed:
    name: str
    falling: bool
    spheres: int
    tiles: tuple  # along x and y; (1, 1): one bed

    @property
    def block(self):
        """The substeps of a block."""
        if self.falling:
            return (FALL_END - FALL_BEGIN) // BLOCKS_OF_FALL
        return 128 if self.spheres <= 20_000 else 64 if self.spheres <= 100_000 else 32

    def rounded(self, blocks):
        """The number of blocks, rounded up to whole falls."""
        return math.ceil(blocks / BLOCKS_OF_FALL) * BLOCKS_OF_FALL if self.falling else blocks


def bed_of(name):
    found = re.fullmatch(r"(settled|falling)-(\d+)([km]?)", name)
    if not found:
        raise ValueError(f"{name}: a scene is settled-N or falling-N, where N may end with k or m")
    spheres = int(found[2]) * {"": 1, "k": 1000, "m": 1_000_000}[found[3]]
    falling = found[1] == "falling"
    if falling or spheres <= TILE:
        return Bed(name, falling, spheres, (1, 1))
    if spheres % TILE:
        raise ValueError(f"{name}: a settled bed of more than {TILE} spheres is a multiple of {TILE}")
    count = spheres // TILE
    across = next(k for k in range(math.isqrt(count), 0, -1) if count % k == 0)
    return Bed(name, falling, spheres, (count // across, across))


def width_of(spheres):
    """The width (m) of a single bed that is about 20 spheres deep."""
    return 2 * RADIUS * math.sqrt(spheres / LAYERS)


def scene_of(bed):
    width = width_of(bed.spheres // math.prod(bed.tiles))
    far = [bed.tiles[0] * width, bed.tiles[1] * width, HEIGHT]
    lattice = {"min": [0, 0, 0], "max": far, "spacing": 2.2 * RADIUS, "jitter": 0.1 * RADIUS, "count": bed.spheres,
               "seed": 1}
    return {"name": bed.name, "bounds": {"min": [0, 0, 0], "max": far, "open": ["Z_MAX"]},
            "materials": [{"restitution": 0.5, "friction": 0.3}], "quality": {"substeps": SUBSTEPS},
            "groups": [{"radius": {"constant": RADIUS}, "lattice": lattice}]}


def tiled(state, tiles, width):
    """Repeats a state along x and y. Positions are relative to the centre of the bounds. `width`: of one tile (m)."""
    columns = array.array("f")
    columns.frombytes(state)
    length = len(columns) // COLUMNS
    places = list(itertools.product(*(range(count) for count in tiles)))
    whole = array.array("f")
    for place in places:
        shifted = columns[:length]
        for axis in range(2):
            shift = (place[axis] - (tiles[axis] - 1) / 2) * width
            shifted[axis::4] = array.array("f", (value + shift for value in shifted[axis::4]))
        whole.extend(shifted)
    for column in range(1, COLUMNS):
        whole.extend(columns[column * length:(column + 1) * length] * len(places))
    return whole.tobytes()


def summary(values):
    """The median of ratios, and the quartiles as their spread."""
    if len(values) == 1:
        return {"median": values[0], "low": values[0], "high": values[0]}
    low, middle, high = statistics.quantiles(values, n=4, method="inclusive")
    return {"median": middle, "low": low, "high": high}


def cost(block, clock):
    """The time of a block per simulated second: a side may choose other substeps than the other."""
    return block[clock] / block["simulated"]


def compared(blocks, clock):
    """blocks: by side, the reports of the blocks in order. Returns the summary of old over new, pair by pair."""
    return summary([cost(old, clock) / cost(new, clock) for old, new in zip(blocks["old"], blocks["new"], strict=True)])


def gains(one, several):
    """The speed of several threads over one thread, block by block, for each side; and the new gain over the old gain.
    Arguments: blocks by side, on one thread and on several."""
    gain = {side: [cost(a, "wall") / cost(b, "wall") for a, b in zip(one[side], several[side], strict=True)]
            for side in SIDES}
    return {**{side: summary(gain[side]) for side in SIDES},
            "new over old": summary([new / old for old, new in zip(gain["old"], gain["new"], strict=True)])}


def milliseconds(blocks, clock):
    """The median time per substep."""
    return statistics.median(1e3 * block[clock] / block["substeps"] for block in blocks)


class Stepper:
    """A running program spherule_stepper."""

    def __init__(self, program, scene, device, environment):
        self.name = f"{program} {scene} {device}"
        self.process = subprocess.Popen([program, scene, device], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True, env=os.environ | environment)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()

    def move_to(self, processor):
        """Binds all threads to a processor."""
        for thread in pathlib.Path(f"/proc/{self.process.pid}/task").iterdir():
            os.sched_setaffinity(int(thread.name), {processor})

    def ask(self, *words):
        print(*words, file=self.process.stdin, flush=True)
        answer = self.process.stdout.readline()
        if not answer:
            sys.exit(f"{self.name} ended at: {' '.join(map(str, words))}")
        return json.loads(answer)


def run_quietly(*command, **options):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}:\n{done.stdout[-4000:]}")
    return done.stdout.strip()


def built(commit, flags, jobs):
    """Checks the commit out and builds spherule_stepper against its libraries, with further compiler flags. Returns the
    path of the program."""
    revision = run_quietly("git", "rev-parse", "--verify", f"{commit}^{{commit}}", cwd=ROOT)[:12]
    folder = WORK / (revision + ("-" + hashlib.sha256(flags.encode()).hexdigest()[:6] if flags else ""))
    if not (folder / "CMakeLists.txt").exists():
        run_quietly("git", "worktree", "prune", cwd=ROOT)
        run_quietly("git", "worktree", "add", "--detach", folder, revision, cwd=ROOT)
    print(f"building {revision} in {folder}", file=sys.stderr)
    run_quietly("cmake", "--preset", "release", "-D", "SPHERULE_TESTS=OFF", "-D", f"CMAKE_CXX_FLAGS={flags}",
                "-D", f"CMAKE_PROJECT_spherule_INCLUDE={STEPPER_CMAKE}", cwd=folder)
    run_quietly("cmake", "--build", "build/release", "-j", str(jobs), "--target", "spherule_stepper", cwd=folder)
    return folder / "build/release/spherule_stepper"


def settled_state(program, bed, environment):
    """Returns the file with the settled state of a side. It is kept for later calls of the same program."""
    single = bed_of(f"settled-{bed.spheres // math.prod(bed.tiles)}")
    key = hashlib.sha256(program.read_bytes()).hexdigest()[:16]
    states = WORK / "states"
    states.mkdir(parents=True, exist_ok=True)
    kept = states / f"{key}-{single.spheres}.state"
    if not kept.exists():
        print(f"settling {single.spheres} spheres of {program}", file=sys.stderr)
        with tempfile.TemporaryDirectory(dir=states) as folder:
            scene = pathlib.Path(folder) / "bed.json"
            scene.write_text(json.dumps(scene_of(single)), encoding="utf-8")
            with Stepper(program, scene, "cpu", environment) as stepper:
                stepper.ask("run", SETTLE)
                stepper.ask("save", pathlib.Path(folder) / "state")
            (pathlib.Path(folder) / "state").rename(kept)
    return kept


def raced(programs, bed, devices, blocks, environment):
    """Returns, by device: blocks by side, and the last state by side."""
    processors = sorted(os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        scene = folder / "bed.json"
        scene.write_text(json.dumps(scene_of(bed)), encoding="utf-8")
        start = dict.fromkeys(SIDES)
        if not bed.falling:
            for side in SIDES:
                start[side] = settled_state(programs[side], bed, environment)
                if math.prod(bed.tiles) > 1:
                    state = tiled(start[side].read_bytes(), bed.tiles, width_of(TILE))
                    start[side] = folder / side
                    start[side].write_bytes(state)
        steppers = {(device, side): Stepper(programs[side], scene, device, environment)
                    for device in devices for side in SIDES}
        results = {device: {"blocks": {side: [] for side in SIDES}, "state": {}} for device in devices}
        if not bed.falling:
            for (_, side), stepper in steppers.items():
                stepper.ask("load", start[side])
                stepper.ask("run", WARM if bed.tiles == (1, 1) else WARM_TILES)
        for number in range(bed.rounded(blocks)):
            if bed.falling and number % BLOCKS_OF_FALL == 0:
                for stepper in steppers.values():
                    stepper.ask("start")
                    stepper.ask("run", FALL_BEGIN)
            for device in devices:
                for side in SIDES if number % 2 == 0 else reversed(SIDES):
                    if device in ON_ONE_PROCESSOR:  # processors may differ in speed, so both sides use each of them
                        steppers[device, side].move_to(processors[number % len(processors)])
                    results[device]["blocks"][side].append(steppers[device, side].ask("run", bed.block))
        for (device, side), stepper in steppers.items():
            results[device]["state"][side] = stepper.ask("state")
            stepper.__exit__()
    return results


def working_tree():
    """The commit of this checkout; unknown outside a repository."""
    try:
        done = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True, check=True,
                              cwd=ROOT)
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return done.stdout.strip()


def processor():
    facts = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    names = re.findall(r"^model name\s*: (.*)$", facts, re.MULTILINE)
    return f"{names[0] if names else 'unknown processor'}, {os.cpu_count()} processors"


def report(bed, results):
    """Returns the result of a scene as figures."""
    rows = {}
    for device, result in results.items():
        blocks = result["blocks"]
        rows[device] = {
            "processor": compared(blocks, "processor"), "wall": compared(blocks, "wall"),
            "processorMs": {side: milliseconds(blocks[side], "processor") for side in SIDES},
            "wallMs": {side: milliseconds(blocks[side], "wall") for side in SIDES},
            "realTime": {side: 1 / statistics.median(cost(block, "wall") for block in blocks[side]) for side in SIDES},
            "state": result["state"]}
    several = [device for device in results if re.fullmatch(r"cpu:\d+", device) and device != "cpu:1"]
    threads = {device: gains(results["cpu:1"]["blocks"], results[device]["blocks"])
               for device in several if "cpu:1" in results}
    hashes = {side: {result["state"][side]["hash"] for result in results.values()} for side in SIDES}
    count = len(next(iter(results.values()))["blocks"]["old"])
    return {"scene": bed.name, "spheres": bed.spheres, "block": bed.block, "blocks": count,
            "devices": rows, "threads": threads, "equalHashes": {side: len(hashes[side]) == 1 for side in SIDES}}


def text_of(figures):
    def spread(figure):
        return f"{figure['median']:.3g} ({figure['low']:.3g} to {figure['high']:.3g})"

    lines = [f"### {figures['scene']}, {figures['blocks']} blocks of {figures['block']} substeps", "",
             "| device | processor ms per substep: old | new | old / new | wall ms per substep: old | new | old / new "
             "| real-time factor: old | new |", "|---|--:|--:|--:|--:|--:|--:|--:|--:|"]
    for device, row in figures["devices"].items():
        lines.append(f"| {device} | {row['processorMs']['old']:.4g} | {row['processorMs']['new']:.4g} "
                     f"| {spread(row['processor'])} | {row['wallMs']['old']:.4g} | {row['wallMs']['new']:.4g} "
                     f"| {spread(row['wall'])} | {row['realTime']['old']:.3g} | {row['realTime']['new']:.3g} |")
    lines += ["", "| device, side | overlap, % of r: mean | max | rms speed, mm/s | mean height, m | hash |",
              "|---|--:|--:|--:|--:|---|"]
    for device, row in figures["devices"].items():
        for side, state in row["state"].items():
            lines.append(f"| {device}, {side} | {100 * state['overlapMean']:.3g} | {100 * state['overlapMax']:.3g} "
                         f"| {1e3 * state['speedRms']:.3g} | {state['meanHeight']:.4f} | {state['hash']} |")
    lines.append("")
    for device, gain in figures["threads"].items():
        lines.append(f"Gain of {device} over cpu:1, wall time: old {spread(gain['old'])}, new {spread(gain['new'])}, "
                     f"new over old {spread(gain['new over old'])}.")
    for side in SIDES:
        if not figures["equalHashes"][side]:
            lines.append(f"The hashes of the devices differ on the {side} side.")
    return "\n".join(lines) + "\n"


def options_from(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("commit", help="the older commit")
    parser.add_argument("--scenes", default="settled-10k,falling-10k,settled-50k,falling-50k")
    parser.add_argument("--devices", default="cpu:1")
    parser.add_argument("--blocks", type=int, default=12, help="of each side, scene and device (default: 12)")
    parser.add_argument("--json", metavar="FILE", help="file to write, with all blocks")
    parser.add_argument("--new", type=pathlib.Path, default=ROOT / "build/release/spherule_stepper",
                        help="spherule_stepper of this commit (default: %(default)s)")
    parser.add_argument("--old", type=pathlib.Path, help="spherule_stepper of the commit, if it is built already")
    parser.add_argument("--flags", default="", help="compiler flags for the older commit")
    parser.add_argument("--environment", action="append", default=[], metavar="NAME=VALUE",
                        help="variable for both sides")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="of the build")
    options = parser.parse_args(arguments)
    if options.blocks < 1:
        parser.error("--blocks: at least 1")
    try:
        options.beds = [bed_of(name) for name in options.scenes.split(",")]
    except ValueError as error:
        parser.error(str(error))
    return options


def main():
    options = options_from(sys.argv[1:])
    if not options.new.exists():
        sys.exit(f"{options.new} is missing: cmake --build build/release --target spherule_stepper")
    programs = {"old": options.old or built(options.commit, options.flags, options.jobs), "new": options.new}
    environment = dict(pair.split("=", 1) for pair in options.environment)
    heads = {"old": options.commit, "new": working_tree()}
    print(f"{processor()}. Old: {heads['old']}, new: {heads['new']}. Medians of blocks; brackets give the "
          "quartiles.\n")
    scenes = []
    for bed in options.beds:
        results = raced(programs, bed, options.devices.split(","), options.blocks, environment)
        scenes.append(report(bed, results) | {"results": results})
        print(text_of(scenes[-1]), flush=True)
    if options.json:
        content = {"processor": processor(), "commits": heads, "load": os.getloadavg(), "scenes": scenes}
        pathlib.Path(options.json).write_text(json.dumps(content, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
