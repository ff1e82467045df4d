#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What crossed the radio in one run of radio_test or several, as tables and as JSON.

Usage: report.py [--json FILE] FOLDER...

A FOLDER is one run: settings.json, phases.json, meter.json, counters_*.json, statistics.jsonl,
images.jsonl. Exits with 1 if no frame was rebuilt, or if meter and interface counters disagree.
"""

import argparse
import collections
import json
import pathlib
import sys

HOST_OF = {"10.77.0.1": "station", "10.77.0.2": "a", "10.77.0.3": "b"}
OUR_NODES = ("/play_", "/watch_station", "/await_topics")
LAST_ACKNOWLEDGEMENTS = 0.5  # s
AGREE = 0.01  # share that meter and counters may differ by
Line = collections.namedtuple("Line", "kind name way")  # kind: rprr, ros, test
Sums = collections.namedtuple("Sums", "wire payload messages message_bytes")
NOTHING = Sums(0, 0, 0, 0)


def read_json(path):
    return json.loads(path.read_text(encoding="utf-8"))


def read_lines(path):
    if not path.exists():
        return []
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def quantile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))] if ordered else None


def line_of(connection, master_port):
    """Where a connection stands in the table."""
    client, server = HOST_OF[connection["client"]], HOST_OF[connection["server"]]
    ours = connection["caller"].startswith(OUR_NODES)
    if connection["kind"] == "topic":
        rprr = "/rprr/" in connection["name"] or connection["name"] == "/station/receipts"
        kind = "test" if ours else "rprr" if rprr else "ros"
        return Line(kind, connection["name"], f"{server} > {client}")
    kind = "test" if ours else "ros"
    if connection["kind"] == "xmlrpc":
        to = "the master" if connection["port"] == master_port else "nodes"
        return Line(kind, f"XMLRPC to {to}", f"{client} - {server}")
    name = "service " + connection["name"] if connection["kind"] == "service" else "other TCP"
    return Line(kind, name, f"{client} - {server}")


class Run:
    def __init__(self, folder):
        self.folder = folder
        self.settings = read_json(folder / "settings.json")
        self.phases = read_json(folder / "phases.json")
        self.meter = read_json(folder / "meter.json")
        self.counters = {name: read_json(folder / f"counters_{name}.json")
                         for name in ("begin", "ready", "end")}
        start = self.phases["go"]
        self.statistics = [each for each in read_lines(folder / "statistics.jsonl")
                           if each["stamp"] * 1e-9 >= start - 1e-3]
        self.images = read_lines(folder / "images.jsonl")
        self.lines = [line_of(each, self.settings["master_port"])
                      for each in self.meter["connections"]]
        self.span = max(self.settings["seconds"], self.last_message() - start)

    def last_message(self):
        times = [packet[0] for packet in self.meter["packets"]
                 if packet[1] >= 0 and self.lines[packet[1]].kind == "rprr" and packet[5] > 0]
        return max(times, default=self.phases["go"])

    def sums(self, begin, end):
        """What every line took between two instants."""
        table = collections.defaultdict(lambda: NOTHING)
        for time, number, _, size, payload, messages, message_bytes in self.meter["packets"]:
            if not begin <= time < end:
                continue
            line = self.lines[number] if number >= 0 else Line("ros", "no TCP", "")
            add = Sums(size, payload, messages, message_bytes)
            table[line] = Sums(*(x + y for x, y in zip(table[line], add)))
        return table

    def counted(self, first, last, direction):
        """Bytes by the interfaces' counters between two readings, by host."""
        def read(when, host):
            return self.counters[when][host][direction][0]["stats64"][direction]["bytes"]
        return {host: read(last, host) - read(first, host) for host in self.counters[first]}

    def result(self):
        """Everything, as one dictionary."""
        begin, end = self.phases["ready"], self.phases["end"]
        start = self.phases["go"]
        # What goes on for ever, goes on while one waits for the radio to be quiet.
        table = self.sums(start, start + self.span + LAST_ACKNOWLEDGEMENTS)
        starting = self.sums(self.phases["begin"], begin)
        rprr = [sums for line, sums in table.items() if line.kind == "rprr"]
        robots = [sums for line, sums in table.items()
                  if line.kind == "rprr" and line.name != "/station/receipts"]
        received = self.counted("ready", "end", "rx")
        sent = self.counted("ready", "end", "tx")
        metered = sum(sums.wire for sums in self.sums(begin, end).values())
        return {
            "settings": self.settings,
            "seconds": self.span,
            "lines": [{**line._asdict(), **sums._asdict()} for line, sums in sorted(table.items())],
            "frames": self.frames(),
            "quality": self.quality(),
            "bytes": {
                "accounted": sum(self.accounted(each) for each in self.statistics),
                "messages": sum(sums.message_bytes for sums in robots),
                "rprr_wire": sum(sums.wire for sums in rprr),
                "ros_wire": sum(s.wire for line, s in table.items() if line.kind == "ros"),
                "test_wire": sum(s.wire for line, s in table.items() if line.kind == "test"),
                "wire": sum(sums.wire for sums in table.values()),
                "metered": metered,
                "counters_received": received,
                "counters_sent": sent,
                "lost_in_queue": sum(sent.values()) - sum(received.values()),
            },
            "start": {
                "seconds": begin - self.phases["begin"],
                "wire": sum(s.wire for s in starting.values()),
                "lines": [{**line._asdict(), **sums._asdict()}
                          for line, sums in sorted(starting.items())],
            },
            "after_silence": self.after_silence(),
            "missed_packets": self.meter["missed"],
            "agree": abs(metered - sum(received.values())) <= AGREE * sum(received.values()),
        }

    def accounted(self, frame):
        """Robots without a peer account for previews, but nobody is there to send them to."""
        alone = self.settings["mode"] == "independent"
        return frame["bytes_total"] - (frame["bytes_pose"] if alone else 0)

    def frames(self):
        def of(robot):
            frames = [each for each in self.statistics if each["robot"] == robot]
            sparse = [each for each in frames if each["reference"]]
            late = [each["latency_ms"] for each in frames]
            return {"rebuilt": len(frames), "sparse": len(sparse),
                    "per_second": len(frames) / self.span,
                    "bytes_median": quantile([each["bytes_total"] for each in frames], 0.5),
                    "latency_ms": {"median": quantile(late, 0.5), "90%": quantile(late, 0.9),
                                   "worst": max(late, default=None)}}
        return {"a": of(self.settings["a"]), "b": of(self.settings["b"]),
                "played": int(self.settings["seconds"] * self.settings["fps"])}

    def after_silence(self):
        """Seconds from the radio's return until frames that were made after it came."""
        back = self.phases["back"]
        if back is None:
            return None

        def first(robot, sparse):
            times = [each["time"] - back for each in self.statistics
                     if each["robot"] == self.settings[robot] and each["stamp"] * 1e-9 >= back
                     and (each["reference"] or not sparse)]
            return min(times, default=None)
        anything = [each["time"] - back for each in self.statistics if each["time"] >= back]
        return {"any frame": min(anything, default=None), "new frame of a": first("a", False),
                "new frame of b": first("b", False), "new exchange": first("b", True)}

    def quality(self):
        return {"views": len(self.images),
                **{name: quantile([each[name] for each in self.images], 0.5)
                   for name in ("psnr", "ssim")}}


def number(value, digits=0):
    return "-" if value is None else f"{value:.{digits}f}"


def print_settings(settings):
    print(f"\n{settings['mode']}: {settings['rate_kbit']} kbit/s shared by three hosts, "
          f"{settings['folder']}, step {settings['step']}, {settings['fps']:g} frames per second "
          f"offered for {settings['seconds']} s")
    special = {"profile": settings["profile"], "arguments": settings["launch_args"],
               "parameters": " ".join(settings["params"]), "master at": settings["master"]}
    print(", ".join(f"{name} {value}" for name, value in special.items() if value) + "\n")


def print_lines(result):
    seconds = result["seconds"]
    print(f"{'what crosses the radio':<40}{'way':<18}{'msg/s':>7}{'message B/s':>13}"
          f"{'wire B/s':>10}{'overhead':>10}")
    titles = {"rprr": "RPRR", "ros": "ROS itself", "test": "the test's own nodes"}
    for kind, title in titles.items():
        lines = [each for each in result["lines"] if each["kind"] == kind]
        for each in lines:
            messages = each["message_bytes"]
            over = f"{100 * (each['wire'] / messages - 1):.1f}%" if messages else "-"
            print(f"{each['name']:<40}{each['way']:<18}{each['messages'] / seconds:>7.2f}"
                  f"{messages / seconds:>13.0f}{each['wire'] / seconds:>10.0f}{over:>10}")
        total = sum(each["wire"] for each in lines)
        print(f"{'  ' + title + ', total':<78}{total / seconds:>10.0f}")


def starting(lines):
    """Where the bytes of the start went, in a few words."""
    sums = collections.Counter()
    for each in lines:
        ros = each["kind"] == "ros"
        sums[each["name"] if ros else "RPRR's topics" if each["kind"] == "rprr" else
             "the test's own"] += each["wire"]
    return sums.most_common()


def print_accounts(result):
    counts, seconds = result["bytes"], result["seconds"]
    received = sum(counts["counters_received"].values())
    print(f"\nbytes of the run, and per second of {seconds:.1f} s")
    rows = (("RPRR's own account (/station/statistics)", counts["accounted"]),
            ("messages of RPRR seen on the radio", counts["messages"]),
            ("the same with receipts, TCPROS, TCP, IP, Ethernet", counts["rprr_wire"]),
            ("ROS's own traffic", counts["ros_wire"]),
            ("the test's own nodes", counts["test_wire"]),
            ("all that the meter saw, until the radio was quiet", counts["metered"]),
            ("interface counters, received", received),
            ("interface counters, sent", sum(counts["counters_sent"].values())))
    for name, value in rows:
        print(f"  {name:<52}{value:>12}{value / seconds:>10.0f}")
    print(f"  lost in the radio's queue and sent again: {counts['lost_in_queue']} bytes; "
          f"packets that the meter missed: {result['missed_packets']}")
    for way in ("sent", "received"):
        print(f"  {way} by host, B/s: " + ", ".join(
            f"{host} {value / seconds:.0f}"
            for host, value in counts["counters_" + way].items()))
    if counts["messages"]:
        missing = counts["messages"] - counts["accounted"]
        print(f"  on the radio but in no account (frames that were not rebuilt): {missing} bytes, "
              f"{100 * missing / counts['messages']:.1f}% of the messages")
        print(f"  protocol overhead on RPRR's messages: "
              f"{100 * (counts['rprr_wire'] / counts['messages'] - 1):.1f}%")
    if result["after_silence"]:
        print("  seconds from the radio's return to the first: " + ", ".join(
            f"{name} {number(seconds, 1)}" for name, seconds in result["after_silence"].items()))
    start = result["start"]
    parts = ", ".join(f"{name} {wire}" for name, wire in starting(start["lines"]))
    print(f"  starting up: {start['wire']} bytes in {start['seconds']:.1f} s, of these {parts}")


def print_together(results):
    """The runs side by side."""
    def latency(frames):
        late = frames["latency_ms"]
        return " / ".join(number(late[key]) for key in ("median", "90%", "worst"))

    def rate(frames):
        return number(frames["per_second"], 2)

    rows = [
        ("frames of a at the station, per second", lambda r: rate(r["frames"]["a"])),
        ("frames of b at the station, per second", lambda r: rate(r["frames"]["b"])),
        ("  of these rebuilt from a's (exchanges), per second",
         lambda r: number(r["frames"]["b"]["sparse"] / r["seconds"], 2)),
        ("bytes of a's frame, median", lambda r: number(r["frames"]["a"]["bytes_median"])),
        ("bytes for b's frame, median", lambda r: number(r["frames"]["b"]["bytes_median"])),
        ("latency of a's frames, ms: median / 90% / worst", lambda r: latency(r["frames"]["a"])),
        ("latency of b's frames, ms: median / 90% / worst", lambda r: latency(r["frames"]["b"])),
        ("PSNR of b's views, dB, median", lambda r: number(r["quality"]["psnr"], 2)),
        ("SSIM of b's views, median", lambda r: number(r["quality"]["ssim"], 3)),
        ("wire, bytes per second", lambda r: number(r["bytes"]["wire"] / r["seconds"])),
        ("  of these ROS's own", lambda r: number(r["bytes"]["ros_wire"] / r["seconds"])),
    ]
    print(f"\n{'':<54}" + "".join(f"{r['settings']['mode']:>22}" for r in results))
    for name, value in rows:
        print(f"{name:<54}" + "".join(f"{value(r):>22}" for r in results))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    results = [Run(folder).result() for folder in arguments.folders]
    for result in results:
        print_settings(result["settings"])
        print_lines(result)
        print_accounts(result)
    print_together(results)
    if arguments.json:
        arguments.json.write_text(json.dumps({"runs": results}, indent=1) + "\n", encoding="utf-8")
    for result in results:
        if not result["agree"]:
            sys.exit("the meter and the interfaces' counters disagree: see the table")
        if result["frames"]["b"]["rebuilt"] == 0:
            sys.exit("no frame of b came to the station")


if __name__ == "__main__":
    main()
