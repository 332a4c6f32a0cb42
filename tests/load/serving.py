"""A `spherule serve` on a free port, for as long as a with statement."""
import re
import subprocess
import urllib.request


class Server:
    def __init__(self, binary, scene, *options):
        self._command = [binary, "serve", scene, "--listen", "127.0.0.1:0", *options]

    def __enter__(self):
        self._process = subprocess.Popen(self._command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        said = []
        for line in self._process.stdout:
            said.append(line)
            found = re.search(r"http://(127\.0\.0\.1:\d+)", line)
            if found:
                self._address = found.group(1)
                return self
        raise RuntimeError("".join(said))

    def __exit__(self, *_):
        self._process.terminate()
        self._process.communicate(timeout=30)

    @property
    def pid(self):
        return self._process.pid

    @property
    def stream(self):
        return f"ws://{self._address}/ws"

    def metrics(self):
        """The samples of /metrics: {(name, first label's value or ""): value}."""
        with urllib.request.urlopen(f"http://{self._address}/metrics", timeout=30) as answer:
            text = answer.read().decode()
        samples = {}
        for name, label, value in re.findall(r'^(\w+)(?:\{\w+="([^"]*)"[^}]*\})? (\S+)', text, re.MULTILINE):
            samples[name, label] = float(value)
        return samples
