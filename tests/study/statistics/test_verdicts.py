import pytest

from study.statistics.verdicts import all_of


@pytest.mark.parametrize(
    ("verdicts", "together"),
    [
        (["yes", "yes"], "yes"),
        (["yes", "undecided"], "undecided"),
        (["undecided", "no"], "no"),
        (["yes", "no"], "no"),
        ([], "undecided"),
    ],
)
def test_one_case_refutes_and_only_all_confirm(verdicts, together):
    assert all_of(verdicts) == together
