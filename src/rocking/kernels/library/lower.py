"""Lower a group of entry points to bitcode: ``python -m rocking.kernels.library.lower GROUP FOLDER``.

numba types and lowers the functions one by one. LLVM will see the group as one module, and each entry point that runs long as
another. The folder gets a file for each module, for any processor.
"""

import gc
import sys
from collections.abc import Iterator
from pathlib import Path

import llvmlite.binding as llvm

from rocking.kernels.library import compiler
from rocking.kernels.library.build import GROUPS
from rocking.kernels.library.export import ENTRY_POINTS
from rocking.kernels.library.kernel import import_all


def group_of(name: str) -> str:
    """Return the group of an entry point: that of the block. The groups share few functions."""
    _, *function = name.split(".")
    found = (group for group in GROUPS for part in function if part.lower().startswith(group))
    return next(found, "slender")


def lower(names: list[str]) -> bytes:
    """Return the bitcode of entry points and of all that they call, before optimisation and for any processor."""
    gc.disable()  # the objects of numba live to the end of the process
    compiler.stop_before_llvm()
    entries, parts = {}, {}
    for name in names:
        entries[ENTRY_POINTS[name].symbol] = lowered = ENTRY_POINTS[name].lower()
        lowered.parts(parts)
    module = llvm.parse_assembly("")
    for part in parts:
        own = part.module() if isinstance(part, compiler.KernelLibrary) else part._get_module_for_linking()
        module.link_in(own, preserve=True)
    symbols = {entry.entry_name: symbol for symbol, entry in entries.items()}
    for function in [one for one in module.functions if not one.is_declaration]:
        if function.name in symbols:
            function.name, function.linkage = symbols[function.name], llvm.Linkage.external
        else:
            function.linkage = llvm.Linkage.internal
    for variable in [one for one in module.global_variables if not one.is_declaration]:
        variable.linkage = llvm.Linkage.internal
    return module.as_bitcode()


def modules_of(bitcode: bytes, names: list[str]) -> Iterator[bytes]:
    """Yield the bitcode of the entry points that do not run long, and of each of the others."""
    long = [name for name in names if ENTRY_POINTS[name].runs_long]
    for chosen in ([name for name in names if name not in long], *([name] for name in long)):
        module = llvm.parse_bitcode(bitcode)
        for name in set(names) - set(chosen):  # what nothing calls is left out when the module is optimised
            module.get_function(ENTRY_POINTS[name].symbol).linkage = llvm.Linkage.internal
        yield module.as_bitcode()


def main() -> None:
    """Lower a group, or the entry point of a symbol."""
    group, folder = sys.argv[1:]
    import_all()
    names = [name for name in ENTRY_POINTS if group in (group_of(name), ENTRY_POINTS[name].symbol)]
    for k, bitcode in enumerate(modules_of(lower(names), names)):
        Path(folder, f"{group}-{k}.bc").write_bytes(bitcode)


if __name__ == "__main__":
    main()
