"""Runs `spherule serve` or `spherule play` on a free port within a with statement."""
import http.client
import re
import subprocess
import threading
import urllib.request


class Server:
    def __init__(self, binary, command, *options, token=None, port=0, **more):
        """`token`: for /metrics, if the server requires one. `port`: 0 for a free one."""
        self._token = token
        self._command = [binary, command, *options, "--listen", f"127.0.0.1:{port}"]
        self._more = more
        self.said = ""  # its output, after it has ended

    def __enter__(self):
        self._process = subprocess.Popen(self._command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                         **self._more)
        self.greeting = []
        for line in self._process.stdout:
            self.greeting.append(line)
            found = re.search(r"https?://(127\.0\.0\.1:\d+)", line)
            if found:
                self._address = found.group(1)
                self._reading = threading.Thread(target=self._read, daemon=True)
                self._reading.start()
                return self
        raise RuntimeError("".join(self.greeting))

    def _read(self):
        """Empties the pipe of its output, because the server drops lines that find no room in it."""
        with self._process.stdout as lines:
            self._lines = list(lines)

    def __exit__(self, *_):
        self.end()

    def end(self, kill=False):
        """Stops the server and returns its exit code; its output is in `said`."""
        if self._process.returncode is None:
            (self._process.kill if kill else self._process.terminate)()
        return self.wait()

    def wait(self):
        """Waits until the server ends by itself and returns its exit code."""
        self._process.wait(timeout=120)
        self._reading.join()
        self.said = "".join(self._lines)
        return self._process.returncode

    @property
    def output(self):
        """All its output, after it has ended."""
        return "".join(self.greeting) + self.said

    def went_on_from(self):
        """The step of the checkpoint from which it went on; None if it began with a scene. Call after its end."""
        found = re.search(r"goes on from \S+ with the scene .*, at step (\d+)", self.output)
        return int(found.group(1)) if found else None

    def last_checkpoint(self):
        """The step of the last checkpoint that it has reported to be on the disk; None without one. Call after its end."""
        steps = re.findall(r"checkpoint \S+ of step (\d+): ", self.output)
        return int(steps[-1]) if steps else self.went_on_from()

    @property
    def pid(self):
        return self._process.pid

    @property
    def port(self):
        return int(self._address.rsplit(":")[1])

    @property
    def stream(self):
        return f"ws://{self._address}/ws"

    def get(self, path):
        headers = {"Authorization": f"Bearer {self._token}"} if self._token else {}
        request = urllib.request.Request(f"http://{self._address}{path}", headers=headers)
        with urllib.request.urlopen(request, timeout=120) as answer:
            return answer.read().decode()

    def fetch(self, path, tls):
        """Like get(), but with TLS. `tls`: an ssl.SSLContext."""
        with urllib.request.urlopen(f"https://{self._address}{path}", timeout=120, context=tls) as answer:
            return answer.read().decode()

    def status(self, path, **headers):
        connection = http.client.HTTPConnection(self._address, timeout=120)
        connection.putrequest("GET", path, skip_host="Host" in headers)
        for name, value in headers.items():
            connection.putheader(name, value)
        connection.endheaders()
        status = connection.getresponse().status
        connection.close()
        return status

    def metrics(self):
        """Returns the samples of /metrics: {(name, value of the first label or ""): value}."""
        text = self.get("/metrics")
        samples = {}
        for name, label, value in re.findall(r'^(\w+)(?:\{\w+="([^"]*)"[^}]*\})? (\S+)', text, re.MULTILINE):
            samples[name, label] = float(value)
        return samples
