# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/soak runs: disturbs a pair at random, and looks how it does."""

import argparse
import json
import pathlib
import random
import signal
import statistics
import sys
import threading
import time

from bench import Bench, make_recording
from processes import A, B, wait_for

PATIENCE = 10.0  # seconds until service must be back; AIM is what we want
AIM = 3.0
SETTLED = 30.0  # seconds after its start from which a process's memory counts
MORE_MEMORY_KB = 24 << 10
MORE_DESCRIPTORS = 16


def parse():
    parser = argparse.ArgumentParser()
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--seed", type=float, default=1)
    parser.add_argument("--rate", type=float, default=5.0)
    parser.add_argument("--no-faults", action="store_true")
    parser.add_argument("--json", type=pathlib.Path)
    return parser.parse_args()


class Life:
    """A process from one start to its end: memory and descriptors, first and last."""

    def __init__(self, process):
        self.name, self.pid, self.begun = process.name, process.child.pid, time.monotonic()
        self.first = self.last = None  # kB, descriptors

    def sample(self, process):
        now = process.resident_kb(), process.descriptors()
        if None in now:
            return
        self.last = now
        if self.first is None and time.monotonic() - self.begun > SETTLED:
            self.first = now

    def grown(self):
        """kB and descriptors, or None if it did not live long enough."""
        return self.first and tuple(b - a for a, b in zip(self.first, self.last))


class Watch:
    """The lives of all processes, from a thread of its own."""

    def __init__(self, processes):
        self.processes, self.lives, self.current = processes, [], {}
        self.expected_dead, self.crashed = set(), []
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def stop(self):
        self._stop.set()
        self._thread.join()

    def _run(self):
        while not self._stop.wait(0.5):
            for process in self.processes.all():
                self._look(process)

    def _look(self, process):
        child = process.child
        if child.poll() is not None:
            if child.pid not in self.expected_dead and child.poll() != -signal.SIGKILL:
                self.expected_dead.add(child.pid)
                self.crashed.append(f"{process.name} ended with {child.returncode}")
            return
        life = self.current.get(process)
        if life is None or life.pid != child.pid:
            life = self.current[process] = Life(process)
            self.lives.append(life)
        life.sample(process)


class Soak:
    def __init__(self, arguments):
        self.arguments = arguments
        self.random = random.Random(arguments.seed)
        recording = make_recording(arguments.output / "room", frames=30)
        self.bench = Bench(arguments.output / "nodes", recording, arguments.rate,
                           int(arguments.seed))
        self.watch = None
        self.recoveries = []  # (what, seconds or None)
        self.rows = []
        self.quiet_seconds, self.quiet_views = 0.0, 0  # without faults, once service was back

    # Each does its harm and undoes it.

    def node_restarts(self):
        process = self.random.choice(list(self.bench.processes.nodes.values()))
        process.kill()
        time.sleep(self.random.uniform(0.1, 3.0))
        process.start()
        return f"{process.name} was killed"

    def host_restarts(self):
        host = self.random.choice([A, B, "station"])
        for process in self.bench.processes.of(host):
            process.kill()
        time.sleep(self.random.uniform(0.5, 5.0))
        for process in self.bench.processes.of(host):
            process.start()
        return f"all of {host} was killed"

    def radio_is_down(self):
        self.bench.radio(down=True)
        time.sleep(self.random.uniform(1.0, 10.0))
        self.bench.radio()
        return "the radio was down"

    def radio_is_bad(self):
        faults = {kind: self.random.uniform(0.02, 0.3) for kind in
                  self.random.sample(["lose", "duplicate", "reorder", "corrupt"],
                                     self.random.randint(1, 4))}
        self.bench.radio(**faults, delay=self.random.uniform(0.0, 0.1))
        time.sleep(self.random.uniform(2.0, 8.0))
        self.bench.radio()
        return "the radio was bad: " + ", ".join(sorted(faults))

    def disturb(self):
        what = self.random.choice([self.node_restarts, self.node_restarts, self.host_restarts,
                                   self.radio_is_down, self.radio_is_bad, self.radio_is_bad])()
        # What takes a node to start and to be heard is not RPRR's.
        wait_for(lambda: self.bench.cameras.heard() and self.bench.judge.connected(), 30)
        since = time.monotonic()
        seconds = self.bench.seconds_until_rebuilt(since, PATIENCE)
        self.recoveries.append((what, seconds))
        if seconds is None or seconds > AIM:
            took = "no" if seconds is None else f"{seconds:.1f} s until"
            print(f"  {took} service after: {what}", flush=True)

    def run(self):
        if not self.bench.await_service(60):
            print("the pair never worked; logs are in", self.arguments.output)
            return False
        self.watch = Watch(self.bench.processes)
        print("of b's views: rebuilt from a's, whole, wrong, PSNR in dB and latency in ms; back: "
              "the\nlongest until service was back so far; MB and files: of all processes together")
        print(f"{'minute':>6} {'faults':>6} {'back s':>7} {'rebuilt':>8} {'whole':>6} {'wrong':>6} "
              f"{'PSNR':>5} {'least':>5} {'ms':>6} {'95%':>6} {'MB':>6} {'files':>6}", flush=True)
        start = time.monotonic()
        end = start + 60.0 * self.arguments.minutes
        row = start
        while time.monotonic() < end:
            quiet = time.monotonic()
            pause = self.random.uniform(2.0, 8.0)
            while time.monotonic() < min(end, quiet + pause):
                time.sleep(0.2)
                if time.monotonic() - row >= 60.0:
                    self.report(row)
                    row += 60.0
            self.quiet_views += sum(1 for view in list(self.bench.judge.views)
                                    if view.robot == B and view.sparse and view.came >= quiet)
            self.quiet_seconds += time.monotonic() - quiet
            if not self.arguments.no_faults and time.monotonic() < end:
                self.disturb()
        if time.monotonic() - row > 5.0:
            self.report(row)
        return self.verdict()

    def report(self, since):
        views = [view for view in list(self.bench.judge.views)
                 if view.robot == B and since <= view.came < since + 60.0]
        rebuilt = [view for view in views if view.sparse]
        latency = sorted(message.latency_ms for came, message in list(self.bench.statistics)
                         if came >= since)
        backs = [seconds for _, seconds in self.recoveries if seconds is not None]
        alive = [life.last for life in self.watch.current.values() if life.last]
        decibels = [view.psnr for view in rebuilt]
        row = {"minute": len(self.rows) + 1, "faults": len(self.recoveries),
               "longest_back_s": max(backs, default=0.0), "rebuilt": len(rebuilt),
               "whole": len(views) - len(rebuilt),
               "wrong": sum(1 for view in views if view.wrong),
               "psnr": statistics.median(decibels) if decibels else 0.0,
               "psnr_least": min(decibels, default=0.0),
               "latency_ms": latency[len(latency) // 2] if latency else 0.0,
               "latency_ms_95": latency[len(latency) * 95 // 100] if latency else 0.0,
               "megabytes": sum(last[0] for last in alive) / 1024.0,
               "descriptors": sum(last[1] for last in alive)}
        self.rows.append(row)
        print("{minute:6d} {faults:6d} {longest_back_s:7.2f} {rebuilt:8d} {whole:6d} {wrong:6d} "
              "{psnr:5.1f} {psnr_least:5.1f} {latency_ms:6.1f} {latency_ms_95:6.1f} "
              "{megabytes:6.1f} {descriptors:6d}".format(**row), flush=True)

    def verdict(self):
        self.watch.stop()
        problems = [f"a wrong view: {view.robot} {view.stamp} {view.wrong}"
                    for view in self.bench.judge.wrong]
        problems += [f"no service within {PATIENCE:.0f} s after: {what}"
                     for what, seconds in self.recoveries if seconds is None]
        problems += self.watch.crashed
        problems += self.bench.processes.left_behind()
        for life in self.watch.lives:
            grown = life.grown()
            if grown and grown[0] > MORE_MEMORY_KB:
                problems.append(f"{life.name} grew by {grown[0]} kB")
            if grown and grown[1] > MORE_DESCRIPTORS:
                problems.append(f"{life.name} has {grown[1]} descriptors more than at first")
        if not any(view.sparse for view in self.bench.judge.views):
            problems.append("nothing was rebuilt")
        self.print_lives()
        rate = self.quiet_views / self.quiet_seconds
        print(f"between faults {rate:.2f} views of b a second were rebuilt")
        for problem in problems[:30]:
            print("wrong:", problem)
        slow = sum(1 for _, seconds in self.recoveries if seconds is None or seconds > AIM)
        print(f"{len(self.recoveries)} faults, {slow} of them took over {AIM:.0f} s; "
              + ("all was well" if not problems else f"{len(problems)} problems"))
        self.write_json(problems, rate)
        return not problems

    def print_lives(self):
        print(f"{'process, of its longest life':40} {'MB first':>9} {'last':>7} "
              f"{'files first':>12} {'last':>5} {'lives':>6}")
        for name in sorted({life.name for life in self.watch.lives}):
            lives = [life for life in self.watch.lives if life.name == name]
            longest = max((life for life in lives if life.first), default=None,
                          key=lambda life: life.last is not None and self.length(life, lives))
            if longest is None:
                print(f"{name:40} {'none lived long enough':>36} {len(lives):6d}")
                continue
            print(f"{name:40} {longest.first[0] / 1024:9.1f} {longest.last[0] / 1024:7.1f} "
                  f"{longest.first[1]:12d} {longest.last[1]:5d} {len(lives):6d}")

    @staticmethod
    def length(life, lives):
        later = [other.begun for other in lives if other.begun > life.begun]
        return min(later, default=time.monotonic()) - life.begun

    def write_json(self, problems, rate):
        if not self.arguments.json:
            return
        lives = [{"name": life.name, "first": life.first, "last": life.last}
                 for life in self.watch.lives]
        self.arguments.json.write_text(json.dumps(
            {"minutes": self.arguments.minutes, "seed": self.arguments.seed, "rows": self.rows,
             "recoveries": self.recoveries, "problems": problems,
             "rebuilt_per_second_between_faults": rate, "processes": lives}, indent=1) + "\n",
            encoding="utf-8")


def end_on_signal(*_):
    raise KeyboardInterrupt


def main():
    signal.signal(signal.SIGTERM, end_on_signal)
    soak, well = None, False
    try:
        soak = Soak(parse())
        well = soak.run()
    except KeyboardInterrupt:
        print("interrupted")
    finally:
        if soak is not None:
            soak.bench.stop()
    sys.exit(0 if well else 1)


if __name__ == "__main__":
    main()
