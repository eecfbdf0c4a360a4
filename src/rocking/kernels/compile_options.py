"""Options of the compiler: one set for each kind of kernel."""

# Kernels borrow arrays. Reference counting at every call took a fifth of the time of a map, so it is off.
KERNEL = dict(
    nogil=True,
    error_model="numpy",
    no_cfunc_wrapper=True,
    forceinline=False,
    _nrt=False,
)
# Internal kernels are called by kernels only. They have no wrapper for Python, which takes as long to compile
# as the kernel itself. A call from Python would end the process.
INTERNAL = dict(KERNEL, no_cpython_wrapper=True)
KERNEL_INLINE = dict(KERNEL, forceinline=True)
INTERNAL_INLINE = dict(INTERNAL, forceinline=True)
# The compiler optimises a callee again in each caller. A short kernel between a caller and the march is
# inlined as syntax instead, before that step.
AST_INLINE = dict(INTERNAL, inline="always")
