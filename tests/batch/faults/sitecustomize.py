"""Loaded by every Python with this folder on its path: in a process that plans, the name of a drawing says what fails.

It stands for what a drawing may do to a library in C: nothing that Python could catch.
"""

import sys

if "deltacam.batch.planning.worker" in sys.orig_argv:
    import os
    import re
    import signal
    import time
    from typing import Any

    from deltacam import pipeline

    plan = pipeline.plan

    def _hang() -> None:
        time.sleep(3600.0)

    def _hang_without_a_turn() -> None:
        """Holds Python's lock, so that no other thread has its turn."""
        re.match(r"(a+)+$", "a" * 64 + "b")

    def _exit() -> None:
        os._exit(3)

    def _say_and_exit() -> None:
        os.write(2, b"first\n\x1b[31mthe \xff last word\n\n")
        os._exit(4)

    def _break() -> None:
        os.kill(os.getpid(), signal.SIGSEGV)

    def _eat() -> None:
        held = []
        while True:
            held.append(bytearray(2**24))

    def _eat_in_c() -> None:
        os.write(2, b"terminate called after throwing an instance of 'std::bad_alloc'\n  what():  std::bad_alloc\n")
        os.abort()

    def _print() -> None:
        os.write(1, b"printed by a library\n" * 10_000)
        os.write(2, b"a warning of a part that passed\n")

    def _close() -> None:
        os.closerange(3, 1000)

    FAULTS = {
        "hang": _hang,
        "busy": _hang_without_a_turn,
        "exit": _exit,
        "words": _say_and_exit,
        "break": _break,
        "eat": _eat,
        "abort": _eat_in_c,
        "print": _print,
        "close": _close,
    }

    def planned(drawing: Any, **options: Any) -> Any:
        """What `pipeline.plan` makes of a drawing whose name begins with no fault."""
        FAULTS.get(str(drawing).split("-")[0].removesuffix(".dxf"), lambda: None)()
        return plan(drawing, **options)

    pipeline.plan = planned
