# SPDX-License-Identifier: GPL-3.0-or-later
"""A computation beside Blender's window, which can be cancelled."""

import threading
import warnings


class Job(threading.Thread):
    """Runs ``work(progress)``, which touches nothing of Blender; ``progress`` takes the fraction done
    and returns whether to go on."""

    def __init__(self, work):
        super().__init__(daemon=True)
        self.fraction = 0.0
        self.warnings = []
        self._work = work
        self._cancelled = threading.Event()
        self._outcome = self._error = None

    def cancel(self):
        """The work ends at its next report of progress, with symsurf.Cancelled."""
        self._cancelled.set()

    def run(self):
        """The thread's part; without ``start`` the caller's."""
        try:
            with warnings.catch_warnings(record=True) as heard:
                warnings.simplefilter("always")
                self._outcome = self._work(self._report)
            self.warnings = [str(each.message) for each in heard]
        except BaseException as error:  # noqa: BLE001  # raised again where the result is asked for
            self._error = error

    def result(self):
        """What the work returned; raises what it raised."""
        if self._error is not None:
            raise self._error
        return self._outcome

    def _report(self, fraction):
        self.fraction = fraction
        return not self._cancelled.is_set()


def part(progress, first, last):
    """The progress of a part of the work."""
    return lambda fraction: progress(first + (last - first) * fraction)
