"""What tests send is forgotten after each of them: rules of one file are told apart by their names."""

from collections.abc import Iterator

import pytest

from antnav.register.sending import _PACKED, _RECEIVED


@pytest.fixture(autouse=True)
def _unsent() -> Iterator[None]:
    yield
    _PACKED.clear()
    _RECEIVED.clear()
