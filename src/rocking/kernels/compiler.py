"""Machine code of entry points, by numba, which is imported only where something is compiled.

Each entry point has private copies of all that it calls. Copies of a shared function differ in their last bits, because each
is optimised with its callers. Left to itself the linker takes the copy that it met first. A process that compiles would then
round differently from one that finds all on disk, and the order of calls would decide.
"""

import inspect
from collections.abc import Callable
from typing import Any

import numba
from llvmlite import ir
from llvmlite.binding import Linkage
from numba import types
from numba.core import cgutils
from numba.core.ccallback import CFunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_lock import global_compiler_lock
from numba.core.errors import TypingError
from numba.core.typeconv import Conversion
from numba.extending import intrinsic, overload

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.machine_code import symbol_of
from rocking.kernels.signature import Array, Fields, Signature

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
    """Optimised code of a kernel. Its machine code is loaded only if the kernel has a wrapper for Python: most have none."""

    _added = False

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        # Callers do not need the object file. But the last steps towards it change the module, and the march gets 3 % faster.
        self.object_file = bytes(self._codegen._tm.emit_object(self._final_module))
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return the address of a function, for which machine code is made; 0 if there is no such function."""
        self._ensure_finalized()
        if all(function.name != name for function in self.get_defined_functions()):
            return 0
        if not self._added:
            self._added = True
            # A copy, because callers still need the module, and the engine changes it.
            self._machine_module = self._final_module.clone()
            self._codegen._add_module(self._machine_module)
            self._finalize_specific()
        return super().get_pointer_to_function(name)

    @property
    def codegen(self) -> Any:
        """The code generator; without machine code, an object that ignores the environment of the function."""
        return self._codegen if self._added else NoEnvironment()


class NoEnvironment:
    """Code generator of a kernel without machine code."""

    def set_env(self, env_name: str, env: object) -> None:
        """Do nothing: Python never runs the kernel."""


class EntryLibrary(KernelLibrary):
    """Code of one entry point, which takes no function from elsewhere and gives its symbol away alone."""

    symbol = ""

    def _optimize_final_module(self) -> None:
        for function in [one for one in self._final_module.functions if not one.is_declaration]:
            if function.name.startswith("cfunc."):
                function.name = self.symbol
            else:
                function.linkage = Linkage.internal
        # The environments of functions, which nothing uses.
        for variable in [one for one in self._final_module.global_variables if not one.is_declaration]:
            variable.linkage = Linkage.internal
        super()._optimize_final_module()


class KernelCompiler(Compiler):
    """Compiler of kernels."""

    library_class: type[KernelLibrary] = KernelLibrary

    def compile_extra(self, func: Callable[..., Any]) -> Any:
        """Compile a function into a library of its own."""
        self.state.library = self.library_class(self.state.targetctx.codegen(), func.__qualname__)
        return super().compile_extra(func)


def dispatcher_of(function: Callable[..., Any], options: dict[str, Any]) -> Any:
    """Return the dispatcher of a kernel."""
    return numba.njit(pipeline_class=KernelCompiler, **options)(function)


def chosen_by_type(stub: Callable[..., Any], bodies: dict[type, Any]) -> Callable[..., Any]:
    """Return a function that stands for one of several kernels in compiled code, by the type of its first argument."""
    parameters = inspect.signature(stub)
    names = ", ".join(parameters.parameters)

    def choose(p: types.NamedTuple, *_: types.Type) -> Callable[..., Any]:
        scope = {"body": bodies[p.instance_class].compiled}
        exec(f"def forward({names}):\n    return body({names})", scope)
        return scope["forward"]

    choose.__signature__ = parameters  # type: ignore[attr-defined]
    overload(stub, jit_options=dict(INTERNAL_INLINE, pipeline_class=KernelCompiler))(choose)
    return stub


def compile_entry(
    name: str, function: Callable[..., Any], types_of: Signature, options: dict[str, Any]
) -> bytes:
    """Compile an entry point: an object file with the function ``machine_code.symbol_of``, which takes the address of a row of words."""
    kernel = numba.njit(inline="always", pipeline_class=KernelCompiler, **options)(function)
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
    library_class = type("SymbolLibrary", (EntryLibrary,), {"symbol": symbol_of(name)})
    pipeline = type("EntryCompiler", (KernelCompiler,), {"library_class": library_class})
    made = CFunc(scope["run"], ((types.intp,), types.void), {}, dict(options), pipeline_class=pipeline)
    with global_compiler_lock:
        library = made._compile_uncached().library
        library._ensure_finalized()
        return library.object_file
