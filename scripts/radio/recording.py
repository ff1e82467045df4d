# SPDX-License-Identifier: BSD-3-Clause
"""A folder of one camera as two robots: which entry each robot shows at which instant."""

import pathlib

import yaml


class Recording:
    """A folder with camera.yaml and associations.txt (rprr_sensor/tum_folder.hpp)."""

    def __init__(self, folder):
        folder = pathlib.Path(folder)
        self.camera = yaml.safe_load((folder / "camera.yaml").read_text(encoding="utf-8"))
        lines = (folder / "associations.txt").read_text(encoding="utf-8").splitlines()
        rows = [line.split() for line in lines if line.strip() and not line.startswith("#")]
        self.colour = [str(folder / row[1]) for row in rows]
        self.depth = [str(folder / row[3]) for row in rows]

    def entries(self, step):
        """Entries that a plays in a round, to the end and back: neighbours in time are near."""
        there = list(range(len(self.colour) - step))
        if not there:
            raise ValueError(f"no two entries are {step} apart: the recording has "
                             f"{len(self.colour)}")
        return there + there[-2:0:-1]

    def entry(self, k, step, is_b):
        """Entry of the k-th pair."""
        round_of_a = self.entries(step)
        return round_of_a[k % len(round_of_a)] + (step if is_b else 0)


def number_of(stamp_ns, start_ns, rate):
    """The pair that has this stamp, or None."""
    period = round(1e9 / rate)
    k, rest = divmod(stamp_ns - start_ns, period)
    return k if rest == 0 and k >= 0 else None
