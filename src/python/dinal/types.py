"""The types in the signatures of dinal, for annotations of your own."""

import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Protocol, SupportsFloat, Union

import numpy

Number = SupportsFloat
Numbers = Iterable[SupportsFloat]
Callback = Callable[..., Any]
Options = Mapping[str, Any]
Path = Union[str, "os.PathLike[str]"]
Vector = numpy.ndarray[Any, numpy.dtype[numpy.float64]]


class Columns(Protocol):
    """A run, data, a dictionary of columns or a data frame."""

    def keys(self) -> Any: ...

    def __getitem__(self, key: Any, /) -> Any: ...
