"""Profiles of hypothesis, for all tests."""

import pytest
from hypothesis import Phase, settings

#: Examples a test in the profile `mutation`, which runs each test hundreds of times.
FEW = 12

settings.register_profile(
    "mutation",
    max_examples=FEW,
    deadline=None,
    derandomize=True,
    database=None,
    phases=(Phase.explicit, Phase.generate),  # a failure is enough, it need not be small
)


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config, items):
    """Give few examples also to tests that ask for many."""
    if config.getoption("--hypothesis-profile", None) != "mutation":
        return
    for item in items:
        asked = getattr(item.obj, "_hypothesis_internal_use_settings", None)
        if asked is not None:
            few = settings(asked, max_examples=min(asked.max_examples, FEW))
            item.obj._hypothesis_internal_use_settings = few
