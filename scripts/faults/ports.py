# SPDX-License-Identifier: BSD-3-Clause
"""A port for a master of one's own."""

import random
import socket

# Below the ports that systems give to outgoing connections (Linux: from 32768): one of those could be
# taken by another program before the master listens.
FIRST, LAST = 20000, 32767


def free_port():
    while True:
        port = random.SystemRandom().randint(FIRST, LAST)
        with socket.socket() as probe:
            try:
                probe.bind(("", port))
            except OSError:
                continue
            return port
