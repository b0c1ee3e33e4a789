"""Standard output belongs to the documents of the commands: HiGHS is silenced before it can write."""

from __future__ import annotations

import highspy
import pytest

from methods.numerics.silent_highs import SilentHighs


def test_output_is_off_when_callbacks_are_enabled(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """HiGHS 1.16 prints a banner there, unlike releases before it; what it would see is held here."""
    seen = []
    enable = highspy.Highs.enableCallbacks
    monkeypatch.setattr(
        highspy.Highs, "enableCallbacks", lambda own: (seen.append(own.getOptionValue("output_flag")[1]), enable(own))
    )
    assert SilentHighs(threads=1).getOptionValue("threads")[1] == 1
    assert seen == [False]
    assert capfd.readouterr().out == ""
