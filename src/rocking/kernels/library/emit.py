"""Optimise a module, and write its object files: ``python -m rocking.kernels.library.emit FILE.bc CLASS...``.

It uses LLVM alone, not numba. Beside the bitcode a file is written for each class of processors.
"""

import sys
from pathlib import Path

import llvmlite.binding as llvm
from llvmlite import ir

from rocking.kernels.library.load import SOURCES, TEXTS, hash_sources, hash_texts
from rocking.kernels.library.processor import CLASSES

TRIPLES = {"aarch64": "aarch64-unknown-linux-gnu"}
# All that the kernels may take from the C library. Their results are exact, so that they are the same in every version of it. Ceil,
# floor, fma and sqrt are instructions where the processor has them.
C_LIBRARY = {"ceil", "floor", "fma", "fmod", "memset", "sqrt"}
MARKS = "marks.bc"
"""File name of the module of the constants by which a library is recognised."""


def marks() -> bytes:
    """Return the bitcode of the constants by which a library is recognised."""
    text = ir.Module()
    for symbol, content in ((SOURCES, hash_sources().encode()), (TEXTS, hash_texts().encode())):
        kind = ir.ArrayType(ir.IntType(8), len(content))
        mark = ir.GlobalVariable(text, kind, symbol)
        mark.initializer, mark.global_constant = ir.Constant(kind, bytearray(content)), True
    return llvm.parse_assembly(str(text)).as_bitcode()


def emit(bitcode: bytes, processor: str) -> bytes:
    """Optimise a module for a class of processors, and return its object file.

    ImportError: if it calls what is not in ``C_LIBRARY``, such as functions of numba or of Python.
    """
    features = [f"+{each}" for each in CLASSES[processor].split(",") if each]
    machine = llvm.Target.from_triple(
        TRIPLES.get(processor, llvm.get_process_triple())
    ).create_target_machine(
        cpu=processor if processor.startswith("x86") else "generic",
        features=",".join([*features, "-prefer-256-bit"] if features else []),
        opt=3,
        reloc="pic",
        codemodel="small",
    )
    module = llvm.parse_bitcode(bitcode)
    module.triple, module.data_layout = machine.triple, str(machine.target_data)
    tuning = llvm.create_pipeline_tuning_options(speed_level=3)
    tuning.loop_vectorization = tuning.slp_vectorization = True
    builder = llvm.create_pass_builder(machine, tuning)
    builder.getModulePassManager().run(module, builder)
    declared = {
        each.name for each in module.functions if each.is_declaration and not each.name.startswith("llvm.")
    }
    if declared - C_LIBRARY:
        others = ", ".join(sorted(declared - C_LIBRARY))
        raise ImportError(
            f"the kernels must call the C library alone, by the names of C_LIBRARY; they call {others}"
        )
    return bytes(machine.emit_object(module))


def main() -> None:
    """Optimise a module for each class of processors."""
    file, processors = Path(sys.argv[1]), sys.argv[2:]
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    bitcode = marks() if file.name == MARKS else file.read_bytes()
    for processor in processors:
        file.with_name(f"{file.stem}-{processor}.o").write_bytes(emit(bitcode, processor))


if __name__ == "__main__":
    main()
