#!/usr/bin/env python3
"""A decoder written from docs/codec.md alone, held against the test vectors in tests/golden/codec, so that the document
is enough for a client in another language: codec_vectors.py FOLDER, or codec_vectors.py --chains FILE for what codec_chains
has written."""
import struct
import sys
import unittest
from pathlib import Path

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
    """Of a chunk, least significant first."""

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


class Decoder:
    """q1 and q2 are lists of x y z for sphere after sphere, with the copies that fill the last block."""

    def __init__(self, spheres):
        self.spheres = spheres
        self.blocks = -(-spheres // BLOCK)
        self.number = None
        self.q1 = [0] * (self.blocks * BLOCK * 3)
        self.q2 = None  # none behind a keyframe
        self.seen = set()  # (mode, predictor, width code) of what came

    def newest(self):
        return self.q1[:3 * self.spheres]

    def apply(self, frame):
        if len(frame) < 16 or len(frame) % 4:
            raise Refused("size")
        words = struct.unpack(f"<{len(frame) // 4}I", frame)
        magic, flags = frame[:3], frame[3]
        if magic != b"\x53\x50\x01" or flags & ~3 or words[1] != self.spheres:
            raise Refused("head")
        keyframe, hashed = flags & 1, flags & 2
        number = words[2]
        if not keyframe and (self.number is None or number != (self.number + 1) & 0xFFFFFFFF):
            raise Refused("does not follow")
        chunks = -(-self.spheres // CHUNK)
        begin = 4 * (4 + chunks)
        if len(frame) < begin:
            raise Refused("table")
        ends = [begin + 4 * end for end in words[4:4 + chunks]]
        if ends[-1] != len(frame) or any(a >= b for a, b in zip([begin, *ends], ends)):
            raise Refused("table")
        self._next = list(self.q1)
        for chunk, (first, last) in enumerate(zip([begin, *ends], ends)):
            self._chunk(chunk, frame[first:last], keyframe)
        if hashed and self._hash() != words[3]:
            raise Refused("hash")
        self.q2 = None if keyframe else self.q1
        self.q1 = self._next
        self.number = number

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
        self.seen.add((mode, predictor, *codes))
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
                self._next[at] = signed(self._predicted(predictor, at) + residual)

    def _predicted(self, predictor, at):
        if predictor == NONE:
            return 0
        if predictor == PREVIOUS:
            return self.q1[at]
        change = signed(self.q1[at] - self.q2[at])
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
        return [field * 4 ** bits_e for field, bits_e in zip(fields, [bits.take(2)] * 3)]

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
