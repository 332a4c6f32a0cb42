#!/usr/bin/env python3
"""Prints the largest packed fractions, for docs/accuracy.md: packing.py BINARY [--spheres N,...] [--seeds N] [--within F]

For each mixture, with walls and in a periodic cell, it halves the interval of fractions between one that is packed and
one that is refused. It prints the mean of the seeds, the time of the largest fraction that was packed,
and of a fraction 0.02 below, and the largest overlap of the loaded scene as a share of the radius. A periodic cell may
be too small to run: its overlap is nan."""
import argparse
import json
import math
import os
import statistics
import subprocess
import tempfile
import time

MIXTURES = {
    "equal": {"constant": 1},
    "1:2, equal masses": {"table": {"radii": [0.999, 1, 1.999, 2], "shares": [0, 0.5, 0.5, 1], "byMass": True}},
    "log-normal, deviation 0.3": {"logNormal": {"median": 1, "deviation": 0.3, "min": 0.4, "max": 2.5}},
}


def scaled(radius, by):
    (kind, value), = radius.items()
    if kind == "constant":
        return {kind: value * by}
    lengths = ("radii", "median", "min", "max")
    scale = lambda one: [x * by for x in one] if isinstance(one, list) else one * by
    return {kind: {name: scale(one) if name in lengths else one for name, one in value.items()}}


def mean_cube(radius):
    (kind, value), = radius.items()
    if kind == "constant":
        return value**3
    if kind == "table":
        return 1 / statistics.mean(r**-3 for r in (1, 2))  # equal masses of both
    return math.exp(4.5 * value["deviation"] ** 2)


def scene(radius, spheres, fraction, periodic, seed):
    side = (spheres * 4 / 3 * math.pi * mean_cube(radius) / 0.6) ** (1 / 3)
    by = 1 / side
    bounds = {"min": [0, 0, 0], "max": [1, 1, 1]}
    if periodic:
        bounds["periodic"] = ["X", "Y", "Z"]
    return {"bounds": bounds, "gravity": [0, 0, 0], "quality": {"model": "FAST"},
            "groups": [{"radius": scaled(radius, by),
                        "fill": {"min": [0, 0, 0], "max": [1, 1, 1], "fraction": fraction, "seed": seed}}]}


def packed(binary, folder, one):
    """Returns seconds and figures, or None if the fill was refused."""
    path = os.path.join(folder, "scene.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(one, file)
    begun = time.monotonic()
    done = subprocess.run([binary, "scene", "check", path], capture_output=True, text=True)
    seconds = time.monotonic() - begun
    if done.returncode != 0:
        if "jam" not in done.stderr + done.stdout:
            raise RuntimeError(done.stdout + done.stderr)
        return None
    return seconds


def largest(binary, folder, radius, spheres, periodic, seed, within):
    low, high = 0.48, 0.70
    while high - low > within:
        middle = (low + high) / 2
        if packed(binary, folder, scene(radius, spheres, middle, periodic, seed)):
            low = middle
        else:
            high = middle
    return low


def overlap(binary, folder, one):
    path = os.path.join(folder, "scene.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(one, file)
    done = subprocess.run([binary, "run", path, "--for", "0.001s", "--device", "cpu", "--json"], capture_output=True,
                          text=True)
    if done.returncode != 0:  # a periodic cell that is too small for the lists of pairs
        return math.nan, 0
    figures = json.loads(done.stdout.splitlines()[-1])
    return figures["overlapMax"], figures["spheres"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("binary")
    parser.add_argument("--spheres", default="1000,10000,100000")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--within", type=float, default=0.002, help="of the fraction")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for name, radius in MIXTURES.items():
            for spheres in map(int, options.spheres.split(",")):
                for periodic in (False, True):
                    reached = [largest(options.binary, folder, radius, spheres, periodic, seed, options.within)
                               for seed in range(1, options.seeds + 1)]
                    fraction = statistics.mean(reached)
                    limit = packed(options.binary, folder, scene(radius, spheres, reached[0], periodic, 1))
                    below = packed(options.binary, folder, scene(radius, spheres, reached[0] - 0.02, periodic, 1))
                    deepest, count = overlap(options.binary, folder, scene(radius, spheres, reached[0], periodic, 1))
                    print(f"| {name} | {count:,} | {'periodic' if periodic else 'walls'} | {fraction:.3f} | "
                          f"{limit:.1f} s | {below:.1f} s | {deepest:.1e} |", flush=True)


if __name__ == "__main__":
    main()
