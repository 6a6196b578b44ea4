"""What is told while a run goes on: a bar of tqdm, or a line on stderr."""

import sys


class Progress:
    """Gives the engine a function `tell(step, time, seconds)`, or None.

    wanted : True, False, or a function of the user's own
    steps, time : how far the run goes, in steps or, where these are not known, in time; None: not known either
    begin : step and time where it begins; unit : of time
    """

    def __init__(self, wanted, *, steps=None, time=None, begin=(0, 0.0), unit=""):
        self._wanted, self._steps, self._time, self._begin, self._unit = wanted, steps, time, begin, unit
        self._bar, self._shown = None, 0

    def __enter__(self):
        if callable(self._wanted):
            return self._wanted
        if not self._wanted:
            return None
        try:
            from tqdm.auto import tqdm
        except ImportError:
            return self._line
        by_time = self._steps is None and self._time is not None
        self._bar = tqdm(total=self._time if by_time else self._steps, unit=self._unit or "1" if by_time else "step",
                         unit_scale=True)
        return self._tell

    def _tell(self, step, time, seconds):
        by_time = self._steps is None and self._time is not None
        done = abs(time - self._begin[1]) if by_time else step - self._begin[0]
        self._bar.update(done - self._shown)
        self._shown = done

    def _line(self, step, time, seconds):
        print(f"\rstep {step}, time {time:g}", end="", file=sys.stderr, flush=True)

    def __exit__(self, kind, value, trace):
        if self._bar is not None:
            if kind is None and self._bar.total is not None:
                self._bar.update(self._bar.total - self._shown)
            self._bar.close()
        elif self._wanted is True:
            print(file=sys.stderr)
