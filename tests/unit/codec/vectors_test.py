#!/usr/bin/env python3
"""A decoder written after docs/codec.md alone, which is compared with the test vectors of that document:
vectors_test.py Vectors FOLDER, with the repository's folder. It is also compared with our decoder, on random chains of
valid and garbled frames: vectors_test.py Chains CODEC_CHAINS, with the program of codec_chains.cpp. It is simple and
slow."""
import re
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SUBJECT = Path(sys.argv.pop())
BLOCK, GROUP, CHUNK = 64, 2048, 16384  # spheres
WIDTHS = [*range(13), 14, 18, 32]
PLAIN, MASK, RUNS, RUNS_WITH_BASE = range(4)
PREVIOUS, LINEAR, HALF, NONE = range(4)


class Refused(Exception):
    """The frame is damaged, or does not follow."""


def signed(value, bits=32):
    value &= (1 << bits) - 1
    return value - (1 << bits) if value >> (bits - 1) else value


class Bits:
    """The bits of a chunk, least significant first."""

    def __init__(self, data):
        self._all = int.from_bytes(data, "little")
        self._size = 8 * len(data)
        self.at = 0

    def take(self, width):
        if self.at + width > self._size:
            raise Refused("ends too early")
        value = (self._all >> self.at) & ((1 << width) - 1)
        self.at += width
        return value

    def align(self, width):
        self.at += -self.at % width
        if self.at > self._size:
            raise Refused("ends too early")

    def whole(self):
        return self.at == self._size


def nearest(value, turns):
    """The number that differs by a multiple of the turns and is nearest to 0."""
    half = turns // 2
    return (value + half) % turns - half if turns else value


class Decoder:
    """q1 and q2 are lists of x y z for sphere after sphere, with the copies that fill the last block."""

    def __init__(self, spheres):
        self.spheres = spheres
        self.blocks = -(-spheres // BLOCK)
        self.number = None
        self.turns = (0, 0, 0)
        self.q1 = [0] * (self.blocks * BLOCK * 3)
        self.q2 = None  # none behind a keyframe
        self.modes, self.predictors, self.codes = set(), set(), set()  # that have come

    def newest(self):
        return self.q1[:3 * self.spheres]

    def apply(self, frame):
        number, self.number = self.number, None  # what is refused ends the chain
        self.number = self._apply(frame, number)

    def _apply(self, frame, before):
        """The frame's number."""
        if len(frame) < 16 or len(frame) % 4:
            raise Refused("size")
        words = struct.unpack(f"<{len(frame) // 4}I", frame)
        magic, flags = frame[:3], frame[3]
        if magic != b"\x53\x50\x01" or flags & ~7 or words[1] != self.spheres:
            raise Refused("head")
        keyframe, hashed = flags & 1, flags & 2
        number = words[2]
        if not keyframe and (before is None or number != (before + 1) & 0xFFFFFFFF):
            raise Refused("does not follow")
        turns = (0, 0, 0)
        if flags & 4:
            turns = words[4:7]
            if len(turns) < 3 or not any(turns) or any(each == 1 or each > 1 << 30 for each in turns):
                raise Refused("turns")
        if not keyframe and turns != self.turns:
            raise Refused("other turns")
        self._turns = turns
        chunks = -(-self.spheres // CHUNK)
        head = 7 if flags & 4 else 4
        begin = 4 * (head + chunks)
        if len(frame) < begin:
            raise Refused("table")
        ends = [begin + 4 * end for end in words[head:head + chunks]]
        if ends[-1] != len(frame) or any(a >= b for a, b in zip([begin, *ends], ends)):
            raise Refused("table")
        self._next = list(self.q1)
        for chunk, (first, last) in enumerate(zip([begin, *ends], ends)):
            self._chunk(chunk, frame[first:last], keyframe)
        if hashed and self._hash() != words[3]:
            raise Refused("hash")
        self.turns = turns
        self.q2 = None if keyframe else self.q1
        self.q1 = self._next
        return number

    def _chunk(self, chunk, data, keyframe):
        bits = Bits(data)
        for group in range(chunk * CHUNK, min((chunk + 1) * CHUNK, self.blocks * BLOCK), GROUP):
            there = bits.take(32)
            blocks = range(group // BLOCK, min(group // BLOCK + 32, self.blocks))
            if there >> len(blocks):
                raise Refused("blocks that do not exist")
            if keyframe and there != (1 << len(blocks)) - 1:
                raise Refused("blocks missing in a keyframe")
            for k, block in enumerate(blocks):
                if there >> k & 1:
                    self._block(block, bits, keyframe)
            bits.align(32)
        if not bits.whole():
            raise Refused("bytes behind a chunk")

    def _block(self, block, bits, keyframe):
        mode, predictor = bits.take(2), bits.take(2)
        codes = [bits.take(4) for _ in range(3)]
        self.modes.add(mode)
        self.predictors.add(predictor)
        self.codes.update(codes)
        if (predictor == NONE) != bool(keyframe):
            raise Refused("predictor of a keyframe")
        if predictor == NONE and mode != RUNS_WITH_BASE:
            raise Refused("mode of a keyframe")
        if predictor in (LINEAR, HALF) and self.q2 is None:
            raise Refused("predictor behind a keyframe")
        base = [0, 0, 0]
        if mode == MASK:
            values = self._masked(bits, codes)
        else:
            selectors = [0] * 24
            if mode in (RUNS, RUNS_WITH_BASE):
                selectors = [bits.take(2) for _ in range(24)]
            if mode == RUNS_WITH_BASE:
                base = self._base(bits, predictor)
            values = [[bits.take(WIDTHS[max(codes[axis] - selectors[8 * axis + k // 8], 0)]) for k in range(BLOCK)]
                      for axis in range(3)]
        bits.align(16)
        for k in range(BLOCK):
            for axis in range(3):
                value = values[axis][k]
                residual = base[axis] + ((value >> 1) ^ -(value & 1))
                at = 3 * (BLOCK * block + k) + axis
                self._next[at] = nearest(signed(self._predicted(predictor, at) + residual), self._turns[axis])

    def _predicted(self, predictor, at):
        if predictor == NONE:
            return 0
        if predictor == PREVIOUS:
            return self.q1[at]
        change = nearest(signed(self.q1[at] - self.q2[at]), self._turns[at % 3])
        return self.q1[at] + (change if predictor == LINEAR else change >> 1)

    @staticmethod
    def _masked(bits, codes):
        runs = [bits.take(1) for _ in range(24)]
        masks = [bits.take(8) if run else 0 for run in runs]
        return [[bits.take(WIDTHS[codes[axis]]) + 1 if masks[8 * axis + k // 8] >> k % 8 & 1 else 0 for k in range(BLOCK)]
                for axis in range(3)]

    @staticmethod
    def _base(bits, predictor):
        if predictor == NONE:
            return [bits.take(32) for _ in range(3)]
        fields = [signed(bits.take(10), 10) for _ in range(3)]
        scale = 4 ** bits.take(2)
        return [field * scale for field in fields]

    def _hash(self):
        total = 0
        for k in range(self.spheres):
            x, y, z = self._next[3 * k:3 * k + 3]
            h = ((x + k * 0x9E3779B1) * 0x85EBCA77) & 0xFFFFFFFF
            h ^= h >> 15
            h = ((h + y) * 0xC2B2AE3D) & 0xFFFFFFFF
            h ^= h >> 13
            h = ((h + z) * 0x27D4EB2F) & 0xFFFFFFFF
            total += h ^ h >> 16
        return total & 0xFFFFFFFF


def words(text):
    return b"".join(struct.pack("<I", int(word, 16)) for word in text.split())


def vector(name):
    return (SUBJECT / "tests/golden/codec" / name).read_bytes()


def frames(decoder, numbers):
    for number in numbers:
        decoder.apply(vector(f"frame-{number}.spb"))
    return decoder


class Vectors(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.positions = struct.unpack("<1749i", vector("positions.i32"))

    def test_the_frames_give_the_positions(self):
        decoder = frames(Decoder(583), range(8))
        self.assertEqual(tuple(decoder.newest()), self.positions)
        self.assertEqual((decoder.modes, decoder.predictors), ({0, 1, 2, 3}, {0, 1, 2, 3}))

    def test_who_joins_at_the_second_keyframe_gets_the_same(self):
        self.assertEqual(tuple(frames(Decoder(583), range(5, 8)).newest()), self.positions)

    def test_a_frame_that_is_missing_is_noticed(self):
        decoder = frames(Decoder(583), range(2))
        with self.assertRaises(Refused):
            frames(decoder, [3])
        with self.assertRaises(Refused):
            frames(decoder, [2])
        self.assertEqual(tuple(frames(decoder, range(5, 8)).newest()), self.positions)

    def test_several_chunks(self):
        decoder = Decoder(18433)
        for n in range(4):
            decoder.apply(vector(f"chunks-{n}.spb"))
            expected = []
            for k in range(18433):
                b = k // 64
                m = (6 * n + b % 16) // 16
                expected += [100 * b + k % 2 * 2 ** (b % 13), m * (5 + b % 7) - b, 7 - k % 3 * (m % 2)]
            self.assertEqual(decoder.newest(), expected)
        self.assertLessEqual(set(range(14)), decoder.codes)

    def test_the_frames_that_the_document_writes_out(self):
        section = (SUBJECT / "docs/codec.md").read_text(encoding="utf-8").split("## Test vectors")[1].split("\n## ")[0]
        keyframe, delta, turning, turned = (words(block) for block in re.findall(r"((?:^    (?:[0-9a-f]{8} *)+\n)+)", section, re.MULTILINE))
        decoder = Decoder(64)
        decoder.apply(keyframe)
        self.assertEqual(decoder.newest(), 64 * [5, 6, -7])
        decoder.apply(delta)
        expected = 64 * [5, 6, -7]
        expected[3:6] = [4, 6, -7]
        expected[120:123] = [6, 5, -9]
        self.assertEqual(decoder.newest(), expected)
        decoder.apply(turning)
        self.assertEqual(decoder.newest(), 64 * [49, 6, -7])
        decoder.apply(turned)
        expected = 64 * [49, 6, -7]
        expected[3:6] = [48, 6, -7]
        expected[120:123] = [-50, 5, -9]
        self.assertEqual(decoder.newest(), expected)


class Chains(unittest.TestCase):
    def test_both_decoders_take_and_refuse_the_same(self):
        for seed in range(2):
            with self.subTest(seed=seed), tempfile.NamedTemporaryFile() as file:
                subprocess.run([SUBJECT, str(seed), file.name], check=True)
                self.compare(file)

    def compare(self, file):
        def number():
            return struct.unpack("<I", file.read(4))[0]
        file.seek(0, 2)
        size = file.tell()
        file.seek(0)
        refused = 0
        while file.tell() < size:
            spheres, count = number(), number()
            decoder = Decoder(spheres)
            for _ in range(count):
                frame, taken, reason = file.read(number()), number(), file.read(number())
                newest = struct.unpack(f"<{3 * spheres}i", file.read(12 * spheres))
                if number():
                    file.read(12 * spheres)
                if taken:
                    decoder.apply(frame)
                    self.assertEqual(tuple(decoder.newest()), newest)
                    continue
                refused += 1
                with self.assertRaises(Refused, msg=reason):
                    decoder.apply(frame)
        self.assertGreater(refused, 100)


if __name__ == "__main__":
    unittest.main()
