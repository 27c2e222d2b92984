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
from numba.core.runtime.nrt import rtsys

from .sources import HEAD_HASH, KERNELS_HASH

# Without annotations.
_function_cache: Callable[..., Any] = FunctionCache
_jit: Callable[..., Any] = numba.njit
_cache_file: Callable[..., Any] = IndexDataCacheFile
_NUMBERS = {"error_model": "numpy", "fastmath": {"reassoc", "contract", "arcp", "nsz"}}
F = TypeVar("F", bound=Callable[..., object])


def kept(**options: Any) -> Callable[[F], F]:
    """Return a decorator that compiles a function when it is first called, and keeps the code.

    Args:
        options: Of `numba.njit`, all but `cache`.
    """

    def decorate(function: F) -> F:
        # Nothing calls them as C functions: such an entry takes its time to compile.
        compiled: Any = _jit(no_cfunc_wrapper=True, **options)(function)
        if compiled is not function:  # NUMBA_DISABLE_JIT leaves it.
            compiled._cache = _Kept(function)
        return cast(F, compiled)

    return decorate


def kernel(function: F) -> F:
    """Compile `function` when it is first called, without the GIL, and keep the code on disk.

    Of fast mathematics only re-association and fused multiply-add: NaN stays NaN, so a diverging
    face is seen.
    """
    return kept(nogil=True, **_NUMBERS)(function)


def brief(function: F) -> F:
    """As `kernel`, for what takes a few µs: the GIL is kept.

    Where another thread wants it, asking for it again may take half a millisecond.
    """
    return kept(**_NUMBERS)(function)


def is_kept(function: Callable[..., object]) -> bool:
    """Return whether compiled code of a kernel lies on disk."""
    cache = getattr(function, "_cache", None)
    return not isinstance(cache, _Kept) or cache.holds_any()


class _Kept(NullCache):
    """Numba's cache under another stamp; its folder is looked for when it is first needed."""

    def __init__(self, function: Callable[..., object]) -> None:
        self._function = function

    @property
    def cache_path(self) -> Any:
        """Folder of the files."""
        return self._files.cache_path

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the code kept for a signature, or None.

        Numba's own way first reads in all that a compiler knows, a quarter of a second; compiled
        code needs only the runtime.
        """
        rtsys.initialize(target_context)
        return self._files._load_overload(sig, target_context)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the code compiled for a signature."""
        self._files.save_overload(sig, data)

    def holds_any(self) -> bool:
        """Return whether there is code for some signature."""
        return bool(self._files._cache_file._load_index())

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
