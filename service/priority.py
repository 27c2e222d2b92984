"""Which threads come first: live faces before work in the background, the event loop at once.

Linux gives each thread its own priority and slice; elsewhere these threads are like any others.
"""

from __future__ import annotations

import ctypes
import os
import platform
import struct
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

BEHIND = 10
"""Steps of niceness behind live faces: a thread then gets about a tenth of a core that they want,
and all of it while they do not."""
AWAITED = 5
"""The same for what somebody waits for before a face can be seen: about a quarter of a core."""
_NICEST = 19
_SHORT_SLICE_NANOSECONDS = 100_000
"""The shortest that Linux takes. Whoever asks for less at a time is let in before the slice of
another thread, 1.4 to 3 ms, is over."""
_SCHED_SETATTR = {"x86_64": 314, "aarch64": 274, "riscv64": 274}
"""Number of the system call, which the C library has no function for."""
_ATTRIBUTES = struct.Struct("<IIQiIQQQ")
"""Size, policy (0: the usual one), flags, niceness, priority, slice [ns], deadline, period."""
_DROP_FROM_BOUNDS = 24
"""Of `prctl`: a capability that no program which is started from here has (PR_CAPBSET_DROP)."""
_RAISES_PRIORITIES = 23
"""The capability to take a higher priority (CAP_SYS_NICE)."""
_NOT_FOR_CHILDREN = 1
"""Flag: threads that this one starts have the usual slice."""


def stand_back(steps: int = BEHIND) -> None:
    """Lower the priority of this thread by `steps` of niceness, for good."""
    with suppress(OSError, AttributeError):
        thread = threading.get_native_id()
        nice = os.getpriority(os.PRIO_PROCESS, thread)
        os.setpriority(os.PRIO_PROCESS, thread, min(_NICEST, nice + steps))


def stand_back_wholly(steps: int = BEHIND) -> None:
    """Lower the priority of every thread of this process: libraries start some as they load."""
    with suppress(OSError, AttributeError):
        threads = [int(task) for task in os.listdir("/proc/self/task")]
        for thread in threads:
            with suppress(OSError):  # It has ended since.
                nice = os.getpriority(os.PRIO_PROCESS, thread)
                os.setpriority(os.PRIO_PROCESS, thread, min(_NICEST, nice + steps))
        return
    stand_back(steps)


def stay_back() -> None:
    """Have what this thread starts not come before it again, for good.

    Chromium gives its processes a priority above all others where it may, and it may as root; what
    it draws by then comes before live faces. Without that capability it keeps what it inherits.
    """
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(_DROP_FROM_BOUNDS, _RAISES_PRIORITIES, 0, 0, 0)


def background_pool(threads: int, name: str, *, steps: int = BEHIND) -> ThreadPoolExecutor:
    """Return a pool whose threads stand back.

    Args:
        threads: Most at a time.
        name: Prefix of their names.
        steps: How far back, in steps of niceness.
    """
    return ThreadPoolExecutor(
        threads, thread_name_prefix=name, initializer=stand_back, initargs=(steps,)
    )


def take_short_turns() -> bool:
    """Have this thread run soon after it wakes, also while every core is busy.

    It gets no larger share of a core: it is let in sooner, for less at a time. For the event loop,
    which wakes often and does little.

    Returns:
        Whether the system does so; Linux does from 6.12 on.
    """
    number = _SCHED_SETATTR.get(platform.machine())
    if sys.platform != "linux" or number is None:
        return False
    nice = os.getpriority(os.PRIO_PROCESS, threading.get_native_id())
    if nice < 0:
        return False  # The flag would take that privilege from the threads of live faces.
    size, slice_ = _ATTRIBUTES.size, _SHORT_SLICE_NANOSECONDS
    attributes = _ATTRIBUTES.pack(size, 0, _NOT_FOR_CHILDREN, nice, 0, slice_, 0, 0)
    try:
        return bool(ctypes.CDLL(None).syscall(number, 0, attributes, 0) == 0)
    except (OSError, AttributeError):
        return False
