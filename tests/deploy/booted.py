"""A Debian root in which systemd runs as the first process, in namespaces of its own. Needs root."""
import json
import subprocess
import sys
from pathlib import Path

from program import wait_for

BOOT = Path(__file__).with_name("boot.sh")
FETCH = """
import json, sys, urllib.error, urllib.request
request = urllib.request.Request("http://127.0.0.1:8080" + sys.argv[1])
try:
    with urllib.request.urlopen(request, timeout=10) as answer:
        print(json.dumps([answer.status, answer.read().decode()]))
except urllib.error.HTTPError as error:
    print(json.dumps([error.code, error.read().decode()]))
except OSError as error:
    print(json.dumps([0, str(error)]))
"""


class Booted:
    """The root, booted within a with statement. Its network has only the loopback address."""

    def __init__(self, root):
        self._root = root

    def __enter__(self):
        self._process = subprocess.Popen(
            ["unshare", "--pid", "--fork", "--kill-child", "--mount", "--uts", "--ipc", "--net", "--cgroup", BOOT,
             self._root.path], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if not wait_for(lambda: self.state() in ("running", "degraded"), 60):
            self.__exit__()
            raise RuntimeError("systemd has not started in its namespaces")
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()

    def _first(self):
        path = f"/proc/{self._process.pid}/task/{self._process.pid}/children"
        return Path(path).read_text(encoding="ascii").split()[0]

    def call(self, *command):
        """Runs the command in the root, beside systemd."""
        return subprocess.run(
            ["nsenter", "--target", self._first(), "--pid", "--mount", "--uts", "--ipc", "--net", "--cgroup", "--root",
             "--wd=/", "env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND=noninteractive", *command],
            stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120, check=False)

    def state(self):
        try:
            return self.call("systemctl", "is-system-running").stdout.strip()
        except (OSError, IndexError):
            return ""

    def get(self, path):
        """Returns status and body of a request to port 8080 in the network of the root; status 0: no connection."""
        done = subprocess.run(["nsenter", "--target", self._first(), "--net", sys.executable, "-c", FETCH, path],
                              capture_output=True, text=True, timeout=60, check=True)
        return tuple(json.loads(done.stdout))

    def show(self, unit, name):
        return self.call("systemctl", "show", "--property", name, "--value", unit).stdout.strip()

    def log(self, unit):
        return self.call("journalctl", "--no-pager", "--unit", unit).stdout
