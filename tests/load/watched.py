"""Healthy viewers of a server that is attacked: their frames, the resources of the server, and tables of both."""
import asyncio
import collections
import os
import re
import subprocess

FLAT = 1.1


def usage(pid):
    """Resident memory (MiB) and number of open descriptors."""
    with open(f"/proc/{pid}/statm", encoding="ascii") as file:
        pages = int(file.read().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2 ** 20, len(os.listdir(f"/proc/{pid}/fd"))


async def viewers(args, server, token, seconds):
    """Returns the load client's report, its exit code, and the resources of the server, sampled each second."""
    client = await asyncio.create_subprocess_exec(
        os.path.join(args.build, "spherule_load"), server.stream, "--viewers", str(args.viewers), "--rate", str(args.rate),
        "--seconds", str(seconds), "--decode", "2", "--markdown", stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        env={**os.environ, "SPHERULE_TOKEN": token})
    used = []
    reading = asyncio.ensure_future(client.stdout.read())
    while not reading.done():
        await asyncio.wait({reading}, timeout=1)
        used.append(usage(server.pid))
    return (await reading).decode(), await client.wait(), used


def rate_of(report):
    return float(re.search(r"^\| healthy \| \d+ \| ([\d.]+)", report, re.MULTILINE).group(1))


def difference(after, before, family):
    """How much each label of a family of counters has grown, without those that have not."""
    return {label: value - before.get((name, label), 0) for (name, label), value in after.items()
            if name == family and value > before.get((name, label), 0)}


def table(head, rows):
    print("| " + " | ".join(head) + " |\n|---" + "|--:" * (len(head) - 1) + "|")
    for row in rows:
        print("| " + " | ".join(str(cell) for cell in row) + " |")
    print(flush=True)


def attempts(attackers):
    """A table of all attackers, summed up by kind."""
    tried, answers = collections.Counter(), collections.defaultdict(collections.Counter)
    for one in attackers:
        tried[type(one).__name__] += one.tried
        answers[type(one).__name__].update(one.answers)
    table(["attacker", "attempts", "what came of them"],
          [[kind, number, ", ".join(f"{answer}: {n}" for answer, n in sorted(answers[kind].items()))]
           for kind, number in tried.items()])


def growth(used):
    """Prints a table of the resources that viewers() has sampled. Returns the faults: those that grow."""
    # The first quarter is skipped: buffers still grow.
    early, late = (used[len(used) * a // 4:len(used) * b // 4] for a, b in ((1, 2), (3, 4)))
    peaks = [[max(each[k] for each in part) for part in (early, late)] for k in (0, 1)]
    table(["server", "largest in the second quarter", "in the last"],
          [["resident, MiB", *(f"{value:.1f}" for value in peaks[0])], ["descriptors", *peaks[1]]])
    return [f"{what} grew from {early} to {late}" for what, (early, late) in zip(("memory", "descriptors"), peaks)
            if late > FLAT * early + 2]
