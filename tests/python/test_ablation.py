"""The list of mechanisms of tests/ablation fits the sources."""

import pytest
from ablation.mechanisms import ROOT, mechanisms

MECHANISMS = mechanisms()


@pytest.mark.parametrize("mechanism", MECHANISMS, ids=lambda each: each.name)
def test_text_occurs_once(mechanism):
    assert (ROOT / mechanism.file).read_text().count(mechanism.find) == 1


@pytest.mark.parametrize("mechanism", MECHANISMS, ids=lambda each: each.name)
def test_replacement_asks_for_the_mechanism(mechanism):
    assert f'without("{mechanism.name}")' in mechanism.replace
