"""Hostile clients of a server's port, each kind from its own address, with the causes under which the server counts them.

An attacker repeats `attempt` until it is stopped. It counts its attempts in `tried` and their outcomes in `answers`. Wire
formats are written out, because our clients cannot send them.
"""
import asyncio
import contextlib
import os
import random
import struct

UPGRADE = ("GET /ws HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Protocol: spherule.v1\r\n{more}\r\n")


def frame(payload, first=0x82):
    """A masked WebSocket frame (RFC 6455, 5.2); the mask is zero."""
    size = len(payload)
    if size < 126:
        head = struct.pack("!BB", first, 0x80 | size)
    elif size < 65536:
        head = struct.pack("!BBH", first, 0x80 | 126, size)
    else:
        head = struct.pack("!BBQ", first, 0x80 | 127, size)
    return head + bytes(4) + payload


def field(number, value):
    """A length-delimited field of protobuf, of fewer than 128 bytes."""
    return bytes([number << 3 | 2, len(value)]) + value


def hello(token):
    return frame(field(1, field(1, b"an attacker") + field(3, token.encode())))


class Attacker:
    """`address`: its source address. `hands`: number of tasks. `pause`: time between two attempts of a task (s).

    `rejected` and `closed`: causes of /metrics that count it in any case. `may`: causes that count it at times."""
    hands, pause = 4, 0.1
    rejected, closed, may = (), (), ()

    def __init__(self, port, address, tokens):
        self._port, self._address, self.tokens = port, address, tokens
        self.tried, self.answers = 0, {}

    async def run(self):
        await asyncio.gather(*(self._hand() for _ in range(self.hands)))

    async def _hand(self):
        while True:
            self.tried += 1
            answer = "not let in"
            try:
                reader, writer = await asyncio.wait_for(
                    asyncio.open_connection("127.0.0.1", self._port, local_addr=(self._address, 0)), 10)
                try:
                    answer = await asyncio.wait_for(self.attempt(reader, writer), 60)
                finally:
                    writer.transport.abort()
            except (OSError, asyncio.TimeoutError, asyncio.IncompleteReadError):
                pass
            self.answers[answer] = self.answers.get(answer, 0) + 1
            await asyncio.sleep(self.pause)

    async def upgrade(self, reader, writer, host="localhost", more=""):
        """Sends an upgrade request and returns the status of the answer."""
        writer.write(UPGRADE.format(host=host, more=more).encode())
        return await self.status(reader)

    @staticmethod
    async def status(reader):
        head = await reader.readuntil(b"\r\n\r\n")
        return head.split(b" ", 2)[1].decode()

    @staticmethod
    async def close_code(reader):
        """Reads up to the close frame and returns its code."""
        while True:
            first, size = await reader.readexactly(2)
            if size == 126:
                size = int.from_bytes(await reader.readexactly(2), "big")
            elif size == 127:
                size = int.from_bytes(await reader.readexactly(8), "big")
            payload = await reader.readexactly(size)
            if first & 15 == 8:
                return str(int.from_bytes(payload[:2], "big"))

    async def attempt(self, reader, writer):
        raise NotImplementedError


class Stalled(Attacker):
    """Is admitted as a viewer, and then reads nothing."""
    hands = 10
    closed = ("stalled",)

    async def attempt(self, reader, writer):
        if await self.upgrade(reader, writer) != "101":
            return "refused"
        writer.write(hello(self.tokens["viewer"]))
        writer.write(frame(field(3, b"\x08\x3c\x10\x01\x18\x01\x20\x01")))  # 60 fine frames a second, with speeds
        await asyncio.sleep(1)  # lets the server send something
        writer.transport.pause_reading()
        while not writer.transport.is_closing():
            writer.write(frame(b"", 0x89))  # the write fails once the server has dropped the connection
            await asyncio.sleep(1)
        return "dropped"


class Storm(Attacker):
    """Connects 300 times a second, sends hello and disconnects."""
    hands, pause = 30, 0.1
    rejected, may = ("connection_rate",), ("connections", "sessions_per_address")

    async def attempt(self, reader, writer):
        status = await self.upgrade(reader, writer)
        writer.write(hello(self.tokens["viewer"]))
        return status


class Garbage(Attacker):
    """Random bytes instead of HTTP, and instead of WebSocket frames."""
    rejected, closed = ("malformed",), ("protocol",)

    async def attempt(self, reader, writer):
        garbage = os.urandom(random.randrange(1, 2000))
        if random.random() < 0.5:
            writer.write(b"\x00" + garbage + b"\r\n\r\n")
            return await self.status(reader)
        await self.upgrade(reader, writer)
        writer.write(b"\xf0" + garbage + bytes(200))
        return await self.close_code(reader)


class Nonsense(Attacker):
    """Messages in valid WebSocket frames that are not protobuf: as the first message, or from a viewer."""
    closed = ("undecodable",)

    async def attempt(self, reader, writer):
        if await self.upgrade(reader, writer) != "101":
            return "refused"
        if random.random() < 0.5:
            writer.write(hello(self.tokens["viewer"]))
        writer.write(frame(b"\x0a\xff" + os.urandom(random.randrange(100))))  # a field that is longer than the message
        return await self.close_code(reader)


class Oversize(Attacker):
    """Headers, bodies and messages that are too long."""
    rejected, closed = ("long_header", "long_body"), ("too_big",)

    async def attempt(self, reader, writer):
        kind = random.randrange(3)
        if kind == 0:
            writer.write(b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"x" * 20_000 + b"\r\n\r\n")
            return await self.status(reader)
        if kind == 1:
            writer.write(b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 20000\r\n\r\n" + bytes(20_000))
            return await self.status(reader)
        await self.upgrade(reader, writer)
        writer.write(frame(bytes(10_000)))
        return await self.close_code(reader)


class Slow(Attacker):
    """Sends one byte of a request per second and never completes it."""
    hands = 20
    rejected, may = ("slow_request",), ("malformed",)  # at the end it leaves in the middle of a request

    async def attempt(self, reader, writer):
        answer = asyncio.ensure_future(reader.read(1))
        for byte in UPGRADE.format(host="localhost", more=""):
            writer.write(byte.encode())
            await asyncio.wait({answer}, timeout=1)
            if answer.done():
                return "closed" if not answer.result() else "answered"
        return "answered"


class Guesser(Attacker):
    """Tries tokens, at the stream and at /metrics."""
    hands, pause = 20, 0
    rejected, closed = ("wrong_token",), ("no_token",)

    async def attempt(self, reader, writer):
        token = os.urandom(16).hex()
        if random.random() < 0.5:
            writer.write(f"GET /metrics HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {token}\r\n\r\n".encode())
            return await self.status(reader)
        if await self.upgrade(reader, writer) != "101":
            return "refused"
        writer.write(hello(token))
        return await self.close_code(reader)


class Stranger(Attacker):
    """Uses a foreign origin, a foreign host name, no token, or a command before the hello."""
    rejected, closed = ("host", "origin", "no_token"), ("no_token", "no_hello")

    async def attempt(self, reader, writer):
        kind = random.randrange(4)
        if kind == 0:
            return await self.upgrade(reader, writer, more="Origin: https://evil.example\r\n")
        if kind == 1:
            return await self.upgrade(reader, writer, host="evil.example")
        await self.upgrade(reader, writer)
        writer.write(hello("") if kind == 2 else frame(field(2, field(2, b""))))
        return await self.close_code(reader)


class Commander(Attacker):
    """A viewer that sends hundreds of commands a second."""
    hands, pause = 2, 1
    rejected, may = ("viewers_command", "command_rate"), ("overflow",)

    async def attempt(self, reader, writer):
        if await self.upgrade(reader, writer) != "101":
            return "refused"
        writer.write(hello(self.tokens["viewer"]))
        writer.write(frame(field(3, b"\x08\x00")))  # no frames
        writer.write(300 * frame(field(2, b"\x08\x07" + field(2, b""))))
        await asyncio.sleep(1)
        return "talked" if not reader.at_eof() else "dropped"


ALL = (Stalled, Storm, Garbage, Nonsense, Oversize, Slow, Guesser, Stranger, Commander)


@contextlib.asynccontextmanager
async def at_work(port, tokens, kinds=ALL):
    """Yields an attacker of each kind, which attack the port until the end of the block."""
    attackers = [kind(port, f"127.0.1.{1 + ALL.index(kind)}", tokens) for kind in kinds]
    tasks = [asyncio.ensure_future(attacker.run()) for attacker in attackers]
    try:
        yield attackers
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
