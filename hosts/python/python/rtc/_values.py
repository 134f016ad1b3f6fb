"""Numbers of numpy and Python, as the library takes them."""

from __future__ import annotations

from typing import Dict, List, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike

Vector = Tuple[float, float, float]
Json = Union[None, bool, int, float, str, List["Json"], Dict[str, "Json"]]


def vector(values: ArrayLike) -> Vector:
    """Three numbers; one stands for all three."""
    own = np.asarray(values, np.float64)
    if own.shape not in [(), (3,)]:
        raise ValueError(f"three numbers are wanted, not {own.shape}")
    x, y, z = np.broadcast_to(own, (3,)).tolist()
    return x, y, z


def plain(value: object) -> Json:
    """A value of numpy or Python, as JSON has it."""
    if isinstance(value, (np.ndarray, np.generic)):
        numbers: Json = value.tolist()
        return numbers
    if isinstance(value, dict):
        return {str(key): plain(own) for key, own in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(own) for own in value]
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    raise TypeError(f"a setting cannot be {type(value).__name__}")
