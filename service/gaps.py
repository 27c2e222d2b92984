"""How often the machine itself stands still: on a shared one, other guests take its cores.

What a loaded service misses has to be seen beside this: a tick that falls into a gap is late,
whatever the service does.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

_SCRIPT = """
import gc, json, sys, time
gc.disable()
seconds, least = map(float, sys.argv[1:])
gaps, clock = [], time.perf_counter
begin = last = clock()
while last - begin < seconds:
    now = clock()
    if now - last >= least:
        gaps.append(now - last)
    last = now
json.dump(gaps, sys.stdout)
"""


def gaps_seen(seconds: float, *, least: float, cores: int) -> list[float]:
    """Return the gaps [s] in which processes that only read the clock did not run, on any core.

    Args:
        seconds: How long to look; nothing else should run meanwhile.
        least: Gaps from which on [s] count.
        cores: How many processes look at a time, one for each core.

    Raises:
        OSError: If a process cannot be started, or ends by itself.
    """
    command = [sys.executable, "-c", _SCRIPT, str(seconds), str(least)]
    looking = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(cores)]
    answers = [process.communicate()[0] for process in looking]
    if any(process.returncode for process in looking):
        raise OSError("a process that looked for gaps ended by itself")
    return sorted(gap for answer in answers for gap in json.loads(answer))


def stolen_seconds(stat: Path = Path("/proc/stat")) -> float | None:
    """Return how long other guests have had this machine's cores when it wanted them [s].

    Since it was started, of all cores together; None where the system does not say. Only Linux does
    (man 5 proc_stat: the eighth number of the first line, in clock ticks).
    """
    try:
        name, *ticks = stat.read_text().splitlines()[0].split()
        return int(ticks[7]) / os.sysconf("SC_CLK_TCK") if name == "cpu" else None
    except (OSError, ValueError, IndexError):
        return None
