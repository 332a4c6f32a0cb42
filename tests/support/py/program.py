"""Runs the program under test to its end, and gives each test a folder for its files."""
import json
import os
import subprocess
import tempfile
import time
import unittest


def runner(binary, *first, timeout=120):
    """Returns a function that runs the program with the arguments `first` and its own, for at most `timeout` s."""
    def call(*arguments, preexec_fn=None, **variables):
        """`variables`: further variables of the environment, in capitals. Returns the result of subprocess.run()."""
        if wrong := [name for name in variables if not name.isupper() and name not in os.environ]:
            raise TypeError(f"no variables of the environment: {wrong}")
        return subprocess.run([binary, *first, *arguments], capture_output=True, text=True, timeout=timeout,
                              check=False, env={**os.environ, **variables}, preexec_fn=preexec_fn)
    return call


def json_runner(call, device):
    """Returns a function that runs `spherule run` with its arguments on the device, and returns the last report."""
    def run_json(*arguments):
        done = call("run", *arguments, "--device", device, "--json")
        assert done.returncode == 0, done.stderr
        assert done.stdout.count("\n") == 1, done.stdout
        return json.loads(done.stdout)
    return run_json


def wait_for(condition, seconds=60):
    """Waits until `condition()` is true, for at most `seconds`. Returns its last result."""
    end = time.monotonic() + seconds
    while not (result := condition()) and time.monotonic() < end:
        time.sleep(0.05)
    return result


class FolderTestCase(unittest.TestCase):
    """Each test has an empty folder, which is removed after it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def at(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        """Writes a file of the folder; returns its path."""
        with open(self.at(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.at(name)
