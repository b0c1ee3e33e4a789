"""HiGHS without a message on the terminal, whichever release is installed."""

from __future__ import annotations

from typing import Any

import highspy


class SilentHighs(highspy.Highs):  # type: ignore[misc]
    """HiGHS that writes nothing to standard output, which belongs to the documents of the commands.

    HiGHS 1.16 prints its name and licence when callbacks are enabled, which its own constructor does before any option
    can be set; so output is switched off first.

    Args:
        options: values by their names in HiGHS.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__()
        for name, value in options.items():
            self.setOptionValue(name, value)

    def enableCallbacks(self) -> None:
        """Enable callbacks, silently."""
        self.setOptionValue("output_flag", False)
        super().enableCallbacks()

    def run(self) -> Any:
        """Solve the model, whatever else in this process uses HiGHS.

        The threads of HiGHS are common to a process, and it refuses to run with another number of them than the first
        user asked for, as cvxpy or the script around the library may have.
        """
        status = super().run()
        if status == highspy.HighsStatus.kError:
            highspy.Highs.resetGlobalScheduler(True)
            status = super().run()
        return status
