"""Compiled functions kept on disk under a hash of all the code that they may be made of.

Numba keys what it keeps by the file of the function alone: one that calls into another file would
go on as it was when that one changes.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, TypeVar, cast

import numba
from numba.core.caching import FunctionCache, IndexDataCacheFile, NullCache

from .sources import HEAD_HASH, KERNELS_HASH

# Without annotations.
_function_cache: Callable[..., Any] = FunctionCache
_cache_file: Callable[..., Any] = IndexDataCacheFile
F = TypeVar("F", bound=Callable[..., object])


def kept(**options: Any) -> Callable[[F], F]:
    """Return a decorator that compiles a function when it is first called, and keeps the code.

    Args:
        options: Of `numba.njit`, all but `cache`.
    """

    def decorate(function: F) -> F:
        compiled: Any = numba.njit(**options)(function)
        if compiled is not function:  # NUMBA_DISABLE_JIT leaves it.
            compiled._cache = _Kept(function)
        return cast(F, compiled)

    return decorate


def kernel(function: F) -> F:
    """Compile `function` when it is first called, without the GIL, and keep the code on disk.

    Of fast mathematics only re-association and fused multiply-add: NaN stays NaN, so a diverging
    face is seen.
    """
    return kept(nogil=True, error_model="numpy", fastmath={"reassoc", "contract", "arcp", "nsz"})(
        function
    )


class _Kept(NullCache):
    """Numba's cache under another stamp; its folder is looked for when it is first needed."""

    def __init__(self, function: Callable[..., object]) -> None:
        self._function = function

    @property
    def cache_path(self) -> Any:
        """Folder of the files."""
        return self._files.cache_path

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the code kept for a signature, or None."""
        return self._files.load_overload(sig, target_context)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the code compiled for a signature."""
        self._files.save_overload(sig, data)

    @cached_property
    def _files(self) -> Any:
        files = _function_cache(self._function)
        of_head = self._function.__module__.startswith(f"{__package__}.head")
        files._cache_file = _cache_file(
            cache_path=files.cache_path,
            filename_base=files._impl.filename_base,
            source_stamp=HEAD_HASH if of_head else KERNELS_HASH,
        )
        return files
