"""Facts with which the files of deploy/ must agree: the Dockerfile, the version, and constants of the server."""
import json
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]


def read(path):
    return (ROOT / path).read_text(encoding="utf-8")


def found(path, pattern):
    """Returns the first group of the pattern, which must match in the file."""
    match = re.search(pattern, read(path))
    if not match:
        raise AssertionError(f"{path} has no {pattern}")
    return match.group(1)


def milliseconds(path, name):
    return int(found(path, rf"{name}{{([\d']+)}}").replace("'", ""))


VERSION = found("CMakeLists.txt", r"project\(spherule VERSION (\S+)")
DRAIN_MS = milliseconds("server/net/server.h", "drainTimeout")
LAST_CHECKPOINT_S = int(found("server/host/host.cpp", r"longestWaitForCheckpoint = (\d+)s"))
END_S = int(found("server/host/host.cpp", r"longestWaitForEnd = (\d+)s"))
STOP_S = DRAIN_MS / 1000 + END_S + LAST_CHECKPOINT_S  # the longest time that a server with checkpoints takes to end
IDLE_MS = milliseconds("server/net/server.h", "idleTimeout")


class Dockerfile:
    """The last stage of the Dockerfile, which makes the image."""

    def __init__(self):
        text = re.sub(r"\\\n", " ", re.sub(r"^#.*\n", "", read("deploy/Dockerfile"), flags=re.MULTILINE))
        stage = re.split(r"^FROM ", text, flags=re.MULTILINE)[-1]
        self.instructions = [line.split(None, 1) for line in stage.splitlines()[1:] if line.strip()]
        self.user, self.group = self.only("USER").split(":")
        self.volume = self.only("VOLUME")
        self.port = int(self.only("EXPOSE"))
        self.entrypoint = json.loads(self.only("ENTRYPOINT"))
        self.healthcheck = json.loads(self.only("HEALTHCHECK").split("CMD", 1)[1])
        self.environment = dict(pair.split("=", 1) for line in self.all("ENV") for pair in line.split())

    def all(self, name):
        return [rest for instruction, rest in self.instructions if instruction == name]

    def only(self, name):
        (value,) = self.all(name)
        return value

