#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/radio/meter: streams that come in any order, frames in any pieces, what they belong to."""

import importlib.machinery
import importlib.util
import random
import struct
import unittest

import script_test


def load_meter():
    path = str(script_test.SCRIPTS / "radio" / "meter")
    loader = importlib.machinery.SourceFileLoader("meter", path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("meter", loader))
    loader.exec_module(module)
    return module


meter = load_meter()


def frame(body):
    return struct.pack("<I", len(body)) + body


def header(**fields):
    lines = (f"{key}={value}".encode() for key, value in fields.items())
    return frame(b"".join(frame(line) for line in lines))


def pieces(data, randomness):
    """The data in segments: start, bytes."""
    start = 0
    while start < len(data):
        length = randomness.randint(1, 40)
        yield start, data[start:start + length]
        start += length


def packet(source, destination, sequence, payload=b"", flags=0x10):
    """An Ethernet frame of TCP; source and destination are address and port."""
    tcp = struct.pack("!HHIIBBHHH", source[1], destination[1], sequence, 0, 5 << 4, flags, 0, 0, 0)
    length = 20 + len(tcp) + len(payload)
    ip = struct.pack("!BBHHHBBH", 0x45, 0, length, 0, 0, 64, 6, 0)
    for address, _ in (source, destination):
        ip += bytes(int(part) for part in address.split("."))
    return b"\0" * 12 + b"\x08\x00" + ip + tcp + payload


class MeterTest(unittest.TestCase):
    def test_a_stream_is_whole_in_any_order_and_with_repeats(self):
        for seed in range(50):
            randomness = random.Random(seed)
            data = randomness.randbytes(500)
            begin = randomness.choice((0, 1000, 2**32 - 100))  # numbers wrap
            segments = list(pieces(data, randomness))
            segments += [(at, data[at:at + 70]) for at in range(0, 500, 130)]
            first, rest = segments[0], segments[1:]
            randomness.shuffle(rest)
            stream = meter.Stream()
            got = b""
            for start, payload in [first] + rest:
                got += stream.take((begin + start) % 2**32, payload)
            self.assertEqual(got, data, f"seed {seed}")

    def test_frames_are_counted_in_any_pieces(self):
        bodies = [b"x" * size for size in (0, 1, 3, 1000, 70)]
        data = header(topic="/t", callerid="/n") + b"".join(map(frame, bodies))
        for seed in range(20):
            frames, count, size = meter.Frames(), 0, 0
            for _, piece in pieces(data, random.Random(seed)):
                more, larger = frames.take(piece)
                count, size = count + more, size + larger
            self.assertEqual((count, size), (len(bodies), sum(map(len, bodies))), f"seed {seed}")
            self.assertEqual(frames.first, {"topic": "/t", "callerid": "/n"})

    def test_messages_of_a_topic_are_told_from_its_headers(self):
        whole = meter.Meter()
        subscriber, publisher = ("10.0.0.1", 40000), ("10.0.0.2", 50000)
        asked, answered = header(topic="/t", callerid="/s"), header(callerid="/p")
        whole.take(0.0, packet(subscriber, publisher, 9, flags=0x02), 54)
        whole.take(0.1, packet(subscriber, publisher, 10, asked), 100)
        whole.take(0.2, packet(publisher, subscriber, 70, answered + frame(b"12345")), 100)
        connection, = (each.summary() for each in whole.connections)
        self.assertEqual((connection["kind"], connection["name"], connection["caller"]),
                         ("topic", "/t", "/s"))
        self.assertEqual(whole.packets[-1][5:], [1, 5])
        self.assertEqual(sum(each[5] for each in whole.packets), 1)

    def test_calls_are_counted_once_and_know_their_caller(self):
        whole = meter.Meter()
        node, master = ("10.0.0.1", 40000), ("10.0.0.2", 11311)
        call = (b"POST /RPC2 HTTP/1.1\r\n\r\n<methodCall><methodName>getParam</methodName><params>"
                b"<param><value>/robot</value></param></params></methodCall>")
        sequence = 1
        for _ in range(3):
            for part in (call[:60], call[60:]):
                whole.take(0.0, packet(node, master, sequence, part), 100)
                sequence += len(part)
        connection = whole.connections[0].summary()
        self.assertEqual((connection["kind"], connection["caller"], dict(connection["calls"])),
                         ("xmlrpc", "/robot", {"getParam": 3}))

    def test_what_is_no_tcp_is_counted_too(self):
        whole = meter.Meter()
        for junk in (b"", b"\0" * 20, b"\xff" * 60):
            whole.take(0.0, junk, len(junk))
        self.assertEqual([each[1] for each in whole.packets], [-1, -1, -1])
        self.assertEqual(sum(each[3] for each in whole.packets), 80)


if __name__ == "__main__":
    script_test.main(MeterTest)
