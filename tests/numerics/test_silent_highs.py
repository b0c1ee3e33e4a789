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


def test_a_programme_is_solved_beside_another_user_of_highs_with_more_threads():
    highspy.Highs.resetGlobalScheduler(True)
    other = SilentHighs(threads=2)
    other.addVar(0.0, 1.0)
    assert other.run() == highspy.HighsStatus.kOk
    ours = SilentHighs(threads=1)
    ours.addVar(0.0, 1.0)
    assert ours.run() == highspy.HighsStatus.kOk
    assert ours.getModelStatus() == highspy.HighsModelStatus.kOptimal
