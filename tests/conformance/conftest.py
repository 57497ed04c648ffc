"""What tests register and send is forgotten after each of them: rules of one file are told apart by their names."""

from collections.abc import Iterator

import pytest

from antnav.register.sending import PACKED, RECEIVED
from tests.register.conftest import _forgotten

__all__ = ["_forgotten"]


@pytest.fixture(autouse=True)
def _unsent() -> Iterator[None]:
    yield
    PACKED.clear()
    RECEIVED.clear()
