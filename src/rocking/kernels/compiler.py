"""How what Python calls is compiled: with a copy of its own of all that it calls.

Copies of a shared function differ in their last bits, for each is optimised with its callers. Left to itself the linker
takes the copy that it met first, and then a process that compiles rounds otherwise than one that finds all on disk, and
the order of calls decides.
"""

from llvmlite.binding import Linkage
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler


class SelfContainedLibrary(JITCodeLibrary):
    """Machine code that takes no function from elsewhere."""

    def _optimize_final_module(self):
        here = [function for function in self._final_module.functions if not function.is_declaration]
        own = next(function.name for function in here if function.linkage == Linkage.external)
        for function in here:
            if function.linkage == Linkage.linkonce_odr:
                function.linkage = Linkage.internal
                # The linker keeps names of internal functions too, and would hand them to others.
                function.name = f"{function.name}.{own}"
        super()._optimize_final_module()


class WholeCompiler(Compiler):
    """The compiler as it is, but for where the code goes."""

    def compile_extra(self, func):
        """Compile a function."""
        self.state.library = SelfContainedLibrary(self.state.targetctx.codegen(), func.__qualname__)
        self.state.library.enable_object_caching()
        return super().compile_extra(func)
