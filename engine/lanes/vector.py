"""Sixteen float32 numbers as one value in a compiled kernel, and what can be done with it.

Numba has no vector type, and loops over lanes become vector code only where the optimiser sees
through them. Here a value of type `Lanes` is LLVM's `<16 x float>`: one register where the machine
has 512-bit vectors, two or four where it has not, and each operation one instruction. What one
lane holds never touches another, so a face's bits do not depend on its neighbours.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol, cast

import numba
import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, lower_builtin, models, register_model, type_callable

from ..arrays import Float32Array

WIDTH = 16
"""Faces in a value."""

_FLOAT, _INT = ir.FloatType(), ir.IntType(32)
_VECTOR = ir.VectorType(_FLOAT, WIDTH)
_INTS = ir.VectorType(_INT, WIDTH)
_CONTRACT = ("reassoc", "contract", "arcp", "nsz")
"""As the kernels of one face: re-association and fused multiply-add, NaN stays NaN."""
_ESTIMATE = (*_CONTRACT, "afn")
"""With it 1/√ is the machine's estimate and a step of Newton's: 23 bits at a tenth of the time."""


class Lanes(Protocol):
    """Sixteen float32 numbers. Values exist in kernels only; this class is for type checkers."""

    def __add__(self, other: Lanes) -> Lanes:
        """Add lane by lane."""

    def __sub__(self, other: Lanes) -> Lanes:
        """Subtract lane by lane."""

    def __mul__(self, other: Lanes) -> Lanes:
        """Multiply lane by lane."""

    def __truediv__(self, other: Lanes) -> Lanes:
        """Divide lane by lane."""


class _LanesType(types.Type):
    def __init__(self) -> None:
        super().__init__(name="Lanes")


_LANES = _LanesType()


@register_model(_LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _VECTOR)


def _operator(of: Callable[..., Any], instruction: str) -> None:
    @type_callable(of)
    def typed(context: Any) -> Any:
        return lambda a, b: _LANES if a is _LANES and b is _LANES else None

    @lower_builtin(of, _LANES, _LANES)
    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return getattr(builder, instruction)(*args, flags=_CONTRACT)


_operator(operator.add, "fadd")
_operator(operator.sub, "fsub")
_operator(operator.mul, "fmul")
_operator(operator.truediv, "fdiv")


def _place(context: Any, builder: Any, kind: Any, array: Any, index: Any) -> Any:
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), _VECTOR.as_pointer())


@intrinsic
def _load(typing: Any, array: Any, index: Any) -> Any:
    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        value = builder.load(_place(context, builder, signature.args[0], *args))
        value.align = 4
        return value

    return _LANES(array, types.intp), lower


@intrinsic
def _store(typing: Any, array: Any, index: Any, value: Any) -> Any:
    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        place = _place(context, builder, signature.args[0], *args[:2])
        builder.store(args[2], place).align = 4
        return context.get_dummy_value()

    return types.void(array, types.intp, _LANES), lower


@intrinsic
def _splat(typing: Any, value: Any) -> Any:
    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        none = ir.Constant(_VECTOR, ir.Undefined)
        first = builder.insert_element(none, args[0], ir.Constant(_INT, 0))
        return builder.shuffle_vector(first, none, ir.Constant(_INTS, [0] * WIDTH))

    return _LANES(types.float32), lower


@intrinsic
def _pick(typing: Any, a: Any, b: Any, yes: Any, no: Any) -> Any:
    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.select(builder.fcmp_ordered(">", args[0], args[1]), args[2], args[3])

    return _LANES(_LANES, _LANES, _LANES, _LANES), lower


@intrinsic
def _inverse_root(typing: Any, value: Any) -> Any:
    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(_VECTOR, [_VECTOR])
        root = cgutils.get_or_insert_function(builder.module, kind, f"llvm.sqrt.v{WIDTH}f32")
        one = ir.Constant(_VECTOR, [1.0] * WIDTH)
        return builder.fdiv(one, builder.call(root, args, fastmath=_ESTIMATE), flags=_ESTIMATE)

    return _LANES(_LANES), lower


@intrinsic
def _floor(typing: Any, value: Any) -> Any:
    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(_VECTOR, [_VECTOR])
        function = cgutils.get_or_insert_function(builder.module, kind, f"llvm.floor.v{WIDTH}f32")
        return builder.call(function, args)

    return _LANES(_LANES), lower


@intrinsic
def _lookup(typing: Any, table: Any, index: Any) -> Any:
    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        cells = builder.fptosi(args[1], _INTS)
        value = ir.Constant(_VECTOR, ir.Undefined)
        for lane in range(WIDTH):
            at = ir.Constant(_INT, lane)
            entry = builder.load(builder.gep(data, [builder.extract_element(cells, at)]))
            value = builder.insert_element(value, entry, at)
        return value

    return _LANES(table, _LANES), lower


load = cast("Callable[[Float32Array, int], Lanes]", _load)
"""Return the sixteen numbers that begin at an index of a flat array."""
store = cast("Callable[[Float32Array, int, Lanes], None]", _store)
"""Write sixteen numbers to a flat array, beginning at an index."""
splat = cast("Callable[[np.float32], Lanes]", _splat)
"""Return one float32 in every lane."""
pick = cast("Callable[[Lanes, Lanes, Lanes, Lanes], Lanes]", _pick)
"""Return the third value where the first is greater than the second, else the fourth."""
inverse_root = cast("Callable[[Lanes], Lanes]", _inverse_root)
"""Return 1/√a, to 23 bits."""
floor = cast("Callable[[Lanes], Lanes]", _floor)
"""Return the greatest whole numbers that are not greater."""
lookup = cast("Callable[[Float32Array, Lanes], Lanes]", _lookup)
"""Return the entries of a table at indices given as numbers of 0 or more, rounded down."""


def part(function: Callable[..., Any]) -> Any:
    """Compile what takes or returns lanes, for use in kernels: called from Python it crashes."""
    if TYPE_CHECKING:
        return function
    jit: Callable[..., Any] = numba.njit  # Its annotations leave out what it takes.
    compile_part = jit(
        error_model="numpy",
        forceinline=True,
        no_cfunc_wrapper=True,  # Never called from outside: compiling the ways in takes as long.
        no_cpython_wrapper=True,
    )
    return compile_part(function)


@part
def greater(a: Lanes, b: Lanes) -> Lanes:
    """Return the greater of two, lane by lane; `b` where either is NaN."""
    return pick(a, b, a, b)


@part
def lesser(a: Lanes, b: Lanes) -> Lanes:
    """Return the lesser of two, lane by lane; `b` where either is NaN."""
    return pick(b, a, a, b)


@part
def add_at(array: Float32Array, index: int, value: Lanes) -> None:
    """Add to sixteen numbers of a flat array, beginning at `index`."""
    store(array, index, load(array, index) + value)


@part
def sine_cosine(angle: Lanes) -> tuple[Lanes, Lanes]:
    """Return sine and cosine of angles, radians, within 1e-7 up to 0.9: jaw and lids turn less."""
    one = splat(np.float32(1.0))
    square = angle * angle
    sine = splat(np.float32(1.0 / 362880.0)) * square - splat(np.float32(1.0 / 5040.0))
    sine = sine * square + splat(np.float32(1.0 / 120.0))
    sine = sine * square - splat(np.float32(1.0 / 6.0))
    sine = angle + angle * square * sine
    cosine = splat(np.float32(1.0 / 40320.0)) - square * splat(np.float32(1.0 / 3628800.0))
    cosine = square * cosine - splat(np.float32(1.0 / 720.0))
    cosine = square * cosine + splat(np.float32(1.0 / 24.0))
    cosine = square * cosine - splat(np.float32(0.5))
    return sine, one + square * cosine


def aligned(count: int) -> Float32Array:
    """Return `count` zeros that begin on a line of the cache: a value then never spans two."""
    raw = np.zeros(4 * count + 64, np.uint8)
    start = -raw.ctypes.data % 64
    return raw[start : start + 4 * count].view(np.float32)
