"""A viewer that shares no code with the page or the server: a WebSocket (RFC 6455) of JSON messages."""
import base64
import json
import os
import socket
import struct
import threading
import time


def answers(port):
    """Returns whether a new viewer gets the settings within a second."""
    try:
        Viewer(port, rate=0, patience=1).wait(lambda one: one.of("settings"), 1)
    except (AssertionError, TimeoutError):
        return False
    return True


class Viewer:
    """Reads the server's messages on its own thread, until the server closes the connection."""

    def __init__(self, port, rate=30, patience=30, **hello):
        """`patience`: time without a byte (s) after which the connection counts as closed. `hello`: more fields of Hello."""
        self.messages = []
        self._stalled = False
        self.closed = None  # (code, reason); (None, "") if the connection ended without a close frame
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=patience)
        key = base64.b64encode(os.urandom(16)).decode()
        self._socket.sendall((f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                              f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
                              "Sec-WebSocket-Protocol: spherule.v1\r\n\r\n").encode())
        self._file = self._socket.makefile("rb")
        self.status = int(self._file.readline().split()[1])
        while self._file.readline().strip():
            pass
        if self.status != 101:
            self._socket.close()
            return
        self._send(0x1, json.dumps({"hello": {"client": "test", "view": {"rate": rate}, **hello}}).encode())
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _send(self, opcode, payload):
        mask = os.urandom(4)
        head = bytes([0x80 | opcode])
        if len(payload) < 126:
            head += bytes([0x80 | len(payload)])
        elif len(payload) < 1 << 16:
            head += struct.pack(">BH", 0x80 | 126, len(payload))
        else:
            head += struct.pack(">BQ", 0x80 | 127, len(payload))
        self._socket.sendall(head + mask + bytes(byte ^ mask[k % 4] for k, byte in enumerate(payload)))

    def _read(self):
        try:
            while self.closed is None and not self._stalled:
                self._take(*self._frame())
        except (OSError, ValueError, struct.error, IndexError):
            self.closed = self.closed or (None, "")
        if not self._stalled:
            self._file.close()
            self._socket.close()

    def _frame(self):
        head = self._file.read(2)
        length = head[1] & 0x7F
        if length == 126:
            length = struct.unpack(">H", self._file.read(2))[0]
        elif length == 127:
            length = struct.unpack(">Q", self._file.read(8))[0]
        return head[0] & 0xF, self._file.read(length)

    def _take(self, opcode, payload):
        if opcode == 0x8:
            self._send(0x8, payload[:2])
            self.closed = (struct.unpack(">H", payload[:2])[0], payload[2:].decode())
        elif opcode == 0x9:
            self._send(0xA, payload)
        elif opcode == 0x1:
            self.messages.append((time.monotonic(), json.loads(payload)))

    def stall(self):
        """Stops reading, and stays connected."""
        self._stalled = True
        self._thread.join()

    def of(self, kind):
        return [message[kind] for _, message in list(self.messages) if kind in message]

    def wait(self, condition, patience=90):
        """Waits until `condition(self)` is true. A failure lists the last messages."""
        end = time.monotonic() + patience
        while not condition(self):
            if time.monotonic() > end:
                kinds = [list(message)[0] for _, message in self.messages[-20:]]
                raise AssertionError(f"waited in vain; closed: {self.closed}; last messages: {kinds}; {self.of('event')}")
            time.sleep(0.02)
        return self

    def ended(self, patience=30):
        self.wait(lambda viewer: viewer.closed is not None, patience)
        return self.closed


class Controller(Viewer):
    """A viewer that sends commands at random, for the first 700 spheres of a scene."""

    def __init__(self, port, **more):
        super().__init__(port, **more)
        self.sent = 0

    def send(self, command):
        """Sends a command and returns its id."""
        self.sent += 1
        self._send(0x1, json.dumps({"command": {"id": str(self.sent), **command}}).encode())
        return str(self.sent)

    def command(self, chance, without=()):
        """`chance`: a random.Random. `without`: names of commands that are not sent."""
        sphere = chance.randrange(700)
        commands = {
            "push": {"push": {"sphere": sphere,
                              "impulse": [chance.uniform(-2, 2), chance.uniform(-2, 2), chance.uniform(0, 3)]}},
            "pull": {"pull": {"sphere": sphere, "point": [chance.uniform(-1, 1), 0, 1]}},
            "release": {"release": {}},
            "remove": {"remove": {"spheres": [sphere]}},
            "gravity": {"set": {"gravity": [chance.uniform(-2, 2), 0, -9.81]}},
            "friction": {"set": {"friction": chance.uniform(0, 0.8)}},
            "model": {"set": {"model": chance.choice(["FAST", "BALANCED"])}},
            "checkpoint": {"checkpoint": {}},
        }
        self.send(commands[chance.choice([name for name in commands if name not in without])])

    def result(self, command):
        """Waits for the result of the command with this id."""
        self.wait(lambda one: any(result["id"] == command for result in one.of("result")))
        return next(result for result in self.of("result") if result["id"] == command)
