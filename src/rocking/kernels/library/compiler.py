"""Kernels and entry points as numba compiles them; only a process that compiles imports this module."""

from collections.abc import Callable
from itertools import product
from typing import Any

import numba
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.ccallback import CFunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_lock import global_compiler_lock
from numba.core.errors import TypingError
from numba.core.registry import cpu_target
from numba.core.typeconv import Conversion
from numba.extending import intrinsic

from rocking.kernels.library.signature import Array, Fields, Signature

WORD = ir.IntType(64)
NUMBERS = {float: types.float64, int: types.int64, bool: types.boolean}


def numba_type(kind: Any) -> types.Type:
    """Return the compiler's type for a type of ``signature``."""
    if isinstance(kind, Array):
        return types.Array(numba.from_dtype(kind.dtype), kind.dimensions, "C")
    if not isinstance(kind, Fields):
        return NUMBERS[kind]
    fields = [numba_type(part) for part in kind.types]
    return types.BaseTuple.from_types(fields, None if kind.kind is tuple else kind.kind)


class Words:
    """Code that reads and writes one word after another, from an address on."""

    def __init__(self, context: Any, builder: Any, address: Any, first: int) -> None:
        self.context, self.builder, self.next = context, builder, first
        self.words = builder.inttoptr(address, WORD.as_pointer())

    def _place(self) -> Any:
        self.next += 1
        return self.builder.gep(self.words, [WORD(self.next - 1)])

    def load(self, kind: types.Type) -> Any:
        """Return the code of the next value, of this type."""
        builder = self.builder
        if isinstance(kind, types.BaseTuple):
            return self.context.make_tuple(builder, kind, [self.load(part) for part in kind.types])
        word = builder.load(self._place())
        if kind == types.float64:
            return builder.bitcast(word, ir.DoubleType())
        if kind == types.boolean:
            return builder.icmp_unsigned("!=", word, WORD(0))
        return self._load_array(word, kind) if isinstance(kind, types.Array) else word

    def _load_array(self, address: Any, kind: types.Array) -> Any:
        builder, array = self.builder, self.context.make_array(kind)(self.context, self.builder)
        shape = [builder.load(self._place()) for _ in range(kind.ndim)]
        size = WORD(self.context.get_abi_sizeof(self.context.get_data_type(kind.dtype)))
        strides, count = [size], WORD(1)
        for length in reversed(shape):
            strides.insert(0, builder.mul(strides[0], length))
            count = builder.mul(count, length)
        array.data = builder.inttoptr(address, array.data.type)
        array.shape, array.strides = (
            cgutils.pack_array(builder, shape),
            cgutils.pack_array(builder, strides[1:]),
        )
        array.itemsize, array.nitems = size, count
        array.meminfo, array.parent = (
            cgutils.get_null_value(part.type) for part in (array.meminfo, array.parent)
        )
        return array._getvalue()

    def store(self, kind: types.Type, value: Any) -> None:
        """Write the code that stores a value of this type."""
        builder = self.builder
        if isinstance(kind, types.BaseTuple):
            for k, part in enumerate(kind.types):
                self.store(part, builder.extract_value(value, k))
        elif kind == types.boolean:
            builder.store(builder.zext(value, WORD), self._place())
        elif kind != types.none:
            builder.store(builder.bitcast(value, WORD), self._place())


class KernelLibrary(JITCodeLibrary):
    """Code of a kernel before optimisation. What it calls is only noted, and linked once for a whole group of entry points."""

    stays = False

    def finalize(self) -> None:
        """Neither link what the kernel calls, nor optimise, nor emit."""
        self._raise_if_finalized()
        for function in self._final_module.functions:
            if self.stays and not function.is_declaration:
                function.add_function_attribute("noinline")
                function.add_function_attribute("cold")
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return that there is no such function: Python never runs the kernel."""
        return 0

    @property
    def codegen(self) -> Any:
        """The code generator, as an object that ignores the environment of the function."""
        return NoEnvironment()

    def parts(self, seen: dict[Any, None]) -> dict[Any, None]:
        """Add this library, and all libraries that it calls, to those seen, each once."""
        left = [self]
        while left:
            part = left.pop()
            if part not in seen:
                seen[part] = None
                left += part._linking_libraries
        return seen

    def module(self) -> Any:
        """Return the module of its code."""
        return self._final_module

    @property
    def entry_name(self) -> str:
        """Name of the function for calls from C."""
        return next(
            each.name
            for each in self._final_module.functions
            if not each.is_declaration and each.name.startswith("cfunc.")
        )


class NoEnvironment:
    """Code generator of a kernel without machine code."""

    def set_env(self, env_name: str, env: object) -> None:
        """Do nothing: Python never runs the kernel."""


class KernelCompiler(Compiler):
    """Compiler that stops before LLVM."""

    def compile_extra(self, func: Callable[..., Any]) -> Any:
        """Compile a function into a library of its own."""
        self.state.library = KernelLibrary(self.state.targetctx.codegen(), func.__qualname__)
        self.state.library.stays = func in SELDOM
        return super().compile_extra(func)


SELDOM: set[Callable[..., Any]] = set()
"""Kernels that stay functions, and that the compiler takes for unlikely: it keeps its registers for the code that does not call them."""
LOWERING = {"pipeline_class": KernelCompiler, "no_cpython_wrapper": True}
"""Options of a process that makes a library. Elsewhere kernels are compiled whole, so that tests can call them."""
_more: dict[str, Any] = {}


def stop_before_llvm() -> None:
    """Let this process lower kernels only; it must have compiled none before."""
    _more.update(LOWERING)


def dispatcher_of(function: Callable[..., Any], options: dict[str, Any], seldom: bool = False) -> Any:
    """Return the dispatcher of a kernel."""
    if seldom:
        SELDOM.add(function)
    return numba.njit(**options | _more)(function)


def type_of_global(made: Any) -> types.Type:
    """Return the type of an object that the compiler finds under a name."""
    context = cpu_target.typing_context
    context.refresh()
    return context.resolve_value_type(made)


class ChosenByType:
    """Dispatcher that stands for one of several kernels in compiled code, by the block and the base of the system, its first argument.

    It has what numba asks of a dispatcher when it types and lowers a call, and no more.
    """

    is_compiling = False

    def __init__(self, stub: Callable[..., Any], bodies: dict[tuple[type | None, type | None], Any]) -> None:
        self.__name__, self.py_func, self.bodies = stub.__name__, stub, bodies
        self._numba_type_ = types.Dispatcher(self)

    def _body(self, args: Any) -> Any:
        system = args[0]
        block, base = system.instance_class, system.types[system.fields.index("forcing")].instance_class
        blocks = (block, block.LIKE) if hasattr(block, "LIKE") else (block,)
        for key in (*product(blocks, (base, None)), (None, base)):
            if key in self.bodies:
                return self.bodies[key].compiled
        raise TypingError(f"{self.__name__} has no body for {block.__name__}[{base.__name__}]")

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Return the template of a call of the body."""
        return self._body(args).get_call_template(args, kws)

    def get_overload(self, args: Any) -> Any:
        """Return the compiled body."""
        return self._body(args).get_overload(args)


def compile_entry(
    name: str, function: Callable[..., Any], types_of: Signature, options: dict[str, Any]
) -> KernelLibrary:
    """Lower an entry point to a function that takes the address of a row of words."""
    kernel = dispatcher_of(function, options | {"forceinline": True})
    arguments, offset = numba_type(types_of.arguments), types_of.offset
    result = types.none if types_of.result is None else numba_type(types_of.result)

    @intrinsic
    def load_arguments(typingctx: Any, address: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            return Words(context, builder, values[0], 0).load(arguments)

        return arguments(types.intp), generate

    @intrinsic
    def store_result(typingctx: Any, address: Any, found: Any) -> Any:
        if typingctx.can_convert(found, result) not in (
            Conversion.exact,
            Conversion.promote,
            Conversion.safe,
        ):
            raise TypingError(f"{name} is declared to return {result}, and returns {found}")

        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            Words(context, builder, values[0], offset).store(result, values[1])
            return context.get_dummy_value()

        return types.void(types.intp, result), generate

    names = ", ".join(f"a[{k}]" for k in range(len(arguments)))
    scope = {"kernel": kernel, "load_arguments": load_arguments, "store_result": store_result}
    exec(
        f"def run(address):\n    a = load_arguments(address)\n    store_result(address, kernel({names}))",
        scope,
    )
    made = CFunc(scope["run"], ((types.intp,), types.void), {}, dict(options), pipeline_class=KernelCompiler)
    with global_compiler_lock:
        return made._compile_uncached().library
