"""Compiler pipeline for entry points: each library links private copies of its callees.

Copies of a shared function differ in their last bits, because each is optimised together with its callers. By
default the linker uses the copy that it met first. Results would then depend on the order of the calls, and
on whether the code was compiled or loaded from disk.
"""

from llvmlite.binding import Linkage
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler


class SelfContainedLibrary(JITCodeLibrary):
    """Machine code that contains private copies of all its callees."""

    def _optimize_final_module(self):
        here = [function for function in self._final_module.functions if not function.is_declaration]
        own = next(function.name for function in here if function.linkage == Linkage.external)
        for function in here:
            if function.linkage == Linkage.linkonce_odr:
                function.linkage = Linkage.internal
                # The linker keeps the names of internal functions too, and would let other libraries use
                # them.
                function.name = f"{function.name}.{own}"
        super()._optimize_final_module()


class WholeCompiler(Compiler):
    """Compiler that writes its code into a ``SelfContainedLibrary``."""

    def compile_extra(self, func):
        """Compile a function."""
        self.state.library = SelfContainedLibrary(self.state.targetctx.codegen(), func.__qualname__)
        self.state.library.enable_object_caching()
        return super().compile_extra(func)
