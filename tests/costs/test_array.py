from __future__ import annotations

import numpy as np
import pytest

from antnav import costs
from antnav.errors import ParameterError


def test_numbers_are_taken_as_they_are() -> None:
    field = costs.array([[0, 2.5], [1, True]], "floor")
    assert field.values.tolist() == [[0.0, 2.5], [1.0, 1.0]]
    assert not field.blocked.any()
    assert field.name == "floor"


@pytest.mark.parametrize("values", [[[np.nan]], [[-0.1]], [[1e308]], [1.0], [["1"]]])
def test_others_are_refused(values: object) -> None:
    with pytest.raises(ParameterError, match="cost"):
        costs.array(values)  # type: ignore[arg-type]
